/* What the test programs share. A failed check ends the program. */
#ifndef COMMON_H
#define COMMON_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "nfr.h"

#define CHECK(condition)                                                                          \
    do {                                                                                          \
        if (!(condition)) {                                                                       \
            fprintf(stderr, "%s:%d: %s (last: %s)\n", __FILE__, __LINE__, #condition, nfr_last_error()); \
            exit(1);                                                                              \
        }                                                                                         \
    } while (0)

typedef struct {
    unsigned char *data;
    size_t len;
} bytes;

/* NAME in FOLDER, in memory that is exactly as long, so that reading beyond it shows. */
static inline bytes read_file(const char *folder, const char *name)
{
    char path[1024];
    bytes file = {NULL, 0};
    FILE *stream;
    long len;

    snprintf(path, sizeof path, "%s/%s", folder, name);
    stream = fopen(path, "rb");
    if (!stream || fseek(stream, 0, SEEK_END) || (len = ftell(stream)) < 0) {
        fprintf(stderr, "cannot read %s\n", path);
        exit(1);
    }
    rewind(stream);
    file.len = (size_t)len;
    file.data = (unsigned char *)malloc(file.len);
    CHECK(file.data && fread(file.data, 1, file.len, stream) == file.len);
    fclose(stream);
    return file;
}

static inline nfr_rasterizer *open_rasterizer(bytes file, nfr_font **font)
{
    nfr_rasterizer *rasterizer;

    CHECK(nfr_font_new(file.data, file.len, 0, font) == NFR_OK);
    CHECK(nfr_rasterizer_new(*font, &rasterizer) == NFR_OK);
    return rasterizer;
}

/* FNV-1a, 64 bits, as in spec/vectors. */
static inline unsigned long long hash_of(const unsigned char *pixels, size_t len)
{
    unsigned long long hash = 0xCBF29CE484222325ULL;
    size_t i;

    for (i = 0; i < len; i++)
        hash = (hash ^ pixels[i]) * 0x100000001B3ULL;
    return hash;
}

#endif
