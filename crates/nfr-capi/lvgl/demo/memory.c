/*
 * memory NEURAL ORIGINAL CACHE: the heap and the stack that fonts take when they draw printable ASCII at 12, 14, 16 and 20 pixels per em:
 * nfr_lvgl with a cache of so many bytes, and LVGL's tiny_ttf. Everything is linked with
 * -Wl,--wrap=malloc,--wrap=calloc,--wrap=realloc,--wrap=free,--wrap=posix_memalign,--wrap=aligned_alloc, so that each block is counted,
 * with the size that the C library gives it. Nothing else of LVGL allocates meanwhile.
 */
#include <malloc.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "nfr_lvgl.h"

#define SIZES 4
#define STACK (1 << 20)
#define UNTOUCHED 0xA5

static const uint16_t sizes[SIZES] = {12, 14, 16, 20};
static size_t held, most;
static uint8_t neural[1 << 20], original[1 << 22];
static size_t neural_size, original_size, cache;

void * __real_malloc(size_t size);
void * __real_calloc(size_t count, size_t size);
void * __real_realloc(void * block, size_t size);
void __real_free(void * block);
int __real_posix_memalign(void ** block, size_t align, size_t size);
void * __real_aligned_alloc(size_t align, size_t size);

static void * count(void * block)
{
    held += malloc_usable_size(block);
    if(held > most) most = held;
    return block;
}

void * __wrap_malloc(size_t size)
{
    return count(__real_malloc(size));
}

void * __wrap_calloc(size_t number, size_t size)
{
    return count(__real_calloc(number, size));
}

void * __wrap_realloc(void * block, size_t size)
{
    held -= malloc_usable_size(block);
    return count(__real_realloc(block, size));
}

void __wrap_free(void * block)
{
    held -= malloc_usable_size(block);
    __real_free(block);
}

int __wrap_posix_memalign(void ** block, size_t align, size_t size)
{
    int failed = __real_posix_memalign(block, align, size);

    if(!failed) count(*block);
    return failed;
}

void * __wrap_aligned_alloc(size_t align, size_t size)
{
    return count(__real_aligned_alloc(align, size));
}

static void draw_all(lv_font_t * const fonts[SIZES])
{
    static uint8_t pixels[64 * 64];
    lv_draw_buf_t buffer;
    lv_font_glyph_dsc_t dsc;
    uint32_t letter;
    int i;

    lv_draw_buf_init(&buffer, 64, 64, LV_COLOR_FORMAT_A8, 64, pixels, sizeof pixels);
    for(i = 0; i < SIZES; i++) {
        for(letter = ' '; letter <= '~'; letter++) {
            if(!lv_font_get_glyph_dsc(fonts[i], &dsc, letter, 0) || dsc.box_w == 0) continue;
            if(lv_font_get_glyph_bitmap(&dsc, &buffer) == NULL) exit(1);
            lv_font_glyph_release_draw_data(&dsc);
        }
    }
}

static void * with_nfr(void * unused)
{
    nfr_lvgl_face * face = nfr_lvgl_open(neural, neural_size, cache, NULL);
    lv_font_t * fonts[SIZES];
    int i;

    if(face == NULL) exit(1);
    for(i = 0; i < SIZES; i++) fonts[i] = nfr_lvgl_font_create(face, sizes[i], NULL);
    draw_all(fonts);
    for(i = 0; i < SIZES; i++) nfr_lvgl_font_destroy(fonts[i]);
    nfr_lvgl_close(face);
    return unused;
}

static void * with_tiny_ttf(void * unused)
{
    lv_font_t * fonts[SIZES];
    int i;

    for(i = 0; i < SIZES; i++) fonts[i] = lv_tiny_ttf_create_data(original, original_size, sizes[i]);
    draw_all(fonts);
    for(i = 0; i < SIZES; i++) lv_tiny_ttf_destroy(fonts[i]);
    return unused;
}

static void * with_nothing(void * unused)
{
    return unused;
}

/* The bytes of stack that a thread has written to. */
static size_t run(void * (*work)(void *))
{
    static uint8_t stack[STACK] __attribute__((aligned(4096)));
    pthread_attr_t attributes;
    pthread_t thread;
    size_t at = 0;

    memset(stack, UNTOUCHED, sizeof stack);
    if(pthread_attr_init(&attributes) || pthread_attr_setstack(&attributes, stack, sizeof stack) ||
       pthread_create(&thread, &attributes, work, NULL) || pthread_join(thread, NULL)) exit(1);
    while(stack[at] == UNTOUCHED) at++;
    return sizeof stack - at;
}

static void measure(const char * name, void * (*work)(void *))
{
    size_t idle = run(with_nothing), before, used;

    run(work); /* what is allocated once for a process */
    before = most = held;
    used = run(work);
    printf("%-10s heap at most %lu bytes, stack %lu bytes\n", name, (unsigned long)(most - before), (unsigned long)(used - idle));
    if(held > before) printf("%lu bytes were not freed\n", (unsigned long)(held - before));
}

static size_t read_file(const char * path, uint8_t * data, size_t size)
{
    FILE * stream = fopen(path, "rb");

    if(stream == NULL) {
        fprintf(stderr, "cannot read %s\n", path);
        exit(1);
    }
    size = fread(data, 1, size, stream);
    fclose(stream);
    return size;
}

int main(int argc, char ** argv)
{
    if(argc != 4) return fprintf(stderr, "usage: memory NEURAL ORIGINAL CACHE\n"), 2;
    neural_size = read_file(argv[1], neural, sizeof neural);
    original_size = read_file(argv[2], original, sizeof original);
    cache = strtoul(argv[3], NULL, 10);
    lv_init();
    measure("nfr_lvgl", with_nfr);
    measure("tiny_ttf", with_tiny_ttf);
    return 0;
}
