// A Vulkan driver that passes everything on to another one, and fails when it is told to, as a card does that has too little memory or
// is lost in the middle. `tools/gpu/check` builds it; the loader takes it by a manifest of its own.
//   FAULTY_DRIVER          the driver's library
//   FAULTY_MEMORY_AFTER    so many allocations succeed, then the device's memory is full
//   FAULTY_SUBMIT_AFTER    so many submissions succeed, then the device is lost
//   FAULTY_NO_SPIRV        the driver has no memory model, which cubecl's SPIR-V needs: it makes WGSL instead
#include <dlfcn.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

typedef void (*Function)(void);
typedef Function (*Lookup)(void *, const char *);
enum { OUT_OF_DEVICE_MEMORY = -2, DEVICE_LOST = -4 };
enum { VULKAN_1_2_FEATURES = 51, MEMORY_MODEL_FEATURES = 1000211000 };

struct Structure {
    int32_t type;
    struct Structure *next;
};
struct MemoryModelFeatures {
    struct Structure head;
    uint32_t model, device_scope, chains;
};

static void *driver_symbol(const char *name) {
    static void *driver;
    const char *path = getenv("FAULTY_DRIVER");
    if (!driver && path) driver = dlopen(path, RTLD_NOW);
    return driver ? dlsym(driver, name) : NULL;
}

// Whether the call that is counted comes after those that succeed.
static int fails(const char *variable, atomic_long *calls) {
    const char *allowed = getenv(variable);
    return allowed && atomic_fetch_add(calls, 1) >= atol(allowed);
}

static int32_t (*next_allocate)(void *, const void *, const void *, void *);
static int32_t allocate(void *device, const void *info, const void *allocator, void *memory) {
    static atomic_long calls;
    if (fails("FAULTY_MEMORY_AFTER", &calls)) return OUT_OF_DEVICE_MEMORY;
    return next_allocate(device, info, allocator, memory);
}

static int32_t (*next_submit)(void *, uint32_t, const void *, uint64_t);
static int32_t submit(void *queue, uint32_t count, const void *submits, uint64_t fence) {
    static atomic_long calls;
    if (fails("FAULTY_SUBMIT_AFTER", &calls)) return DEVICE_LOST;
    return next_submit(queue, count, submits, fence);
}

static void (*next_features)(void *, struct Structure *);
static void features(void *device, struct Structure *found) {
    next_features(device, found);
    for (struct Structure *s = found->next; s && getenv("FAULTY_NO_SPIRV"); s = s->next) {
        if (s->type == MEMORY_MODEL_FEATURES) ((struct MemoryModelFeatures *)s)->model = 0;
    }
}

// The function in the place of the driver's, which it calls.
static Function replaced(const char *name, Function next) {
    if (!next) return next;
    if (!strcmp(name, "vkAllocateMemory")) return next_allocate = (void *)next, (Function)allocate;
    if (!strcmp(name, "vkQueueSubmit")) return next_submit = (void *)next, (Function)submit;
    if (!strcmp(name, "vkGetPhysicalDeviceFeatures2") || !strcmp(name, "vkGetPhysicalDeviceFeatures2KHR"))
        return next_features = (void *)next, (Function)features;
    return next;
}

static Lookup next_of_device;
static Function of_device(void *device, const char *name) { return replaced(name, next_of_device(device, name)); }

Function vk_icdGetInstanceProcAddr(void *instance, const char *name) {
    Lookup lookup = (Lookup)driver_symbol("vk_icdGetInstanceProcAddr");
    Function next = lookup ? lookup(instance, name) : NULL;
    if (next && !strcmp(name, "vkGetDeviceProcAddr")) return next_of_device = (Lookup)next, (Function)of_device;
    return replaced(name, next);
}

Function vk_icdGetPhysicalDeviceProcAddr(void *instance, const char *name) {
    Lookup lookup = (Lookup)driver_symbol("vk_icdGetPhysicalDeviceProcAddr");
    return lookup ? replaced(name, lookup(instance, name)) : NULL;
}

int32_t vk_icdNegotiateLoaderICDInterfaceVersion(uint32_t *version) {
    int32_t (*negotiate)(uint32_t *) = (int32_t (*)(uint32_t *))driver_symbol("vk_icdNegotiateLoaderICDInterfaceVersion");
    return negotiate ? negotiate(version) : -1;
}
