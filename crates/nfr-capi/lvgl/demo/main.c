/*
 * demo NEURAL ORIGINAL CACHE OUT.ppm: draws a page of settings with nfr_lvgl, with the same four sizes baked at 4 bits, and with LVGL's
 * tiny_ttf, side by side, and prints how long each takes. CACHE is what nfr_lvgl may take for drawn glyphs, in bytes.
 */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "nfr_lvgl.h"
#include "page.h"

#define PAGES 3
#define ROUNDS 300

extern const lv_font_t four_12, four_14, four_16, four_20;
static const lv_font_t * const symbols[SIZES] = {
    &lv_font_montserrat_12, &lv_font_montserrat_14, &lv_font_montserrat_16, &lv_font_montserrat_20};
static uint8_t picture[PAGE_HEIGHT][PAGES][PAGE_WIDTH * 3];

typedef struct {
    uint8_t * data;
    size_t size;
} file_t;

static file_t read_file(const char * path)
{
    static const size_t most = 8 << 20;
    file_t file = {malloc(most), 0};
    FILE * stream = fopen(path, "rb");

    if(stream == NULL || file.data == NULL) {
        fprintf(stderr, "cannot read %s\n", path);
        exit(1);
    }
    file.size = fread(file.data, 1, most, stream);
    fclose(stream);
    return file;
}

static double now(void)
{
    struct timespec time;

    clock_gettime(CLOCK_MONOTONIC, &time);
    return time.tv_sec * 1e3 + time.tv_nsec * 1e-6;
}

static void show(int at, const lv_font_t * const fonts[SIZES], const char * name)
{
    double start = now(), first, rest;
    const uint8_t * frame;
    int i, x;

    page_build(fonts, name);
    page_draw();
    first = now() - start;
    start = now();
    for(i = 0; i < ROUNDS; i++) frame = page_draw();
    rest = (now() - start) / ROUNDS;
    printf("%-36s first, with layout %6.2f ms, again %6.2f ms\n", name, first, rest);
    for(i = 0; i < PAGE_HEIGHT; i++)
        for(x = 0; x < PAGE_WIDTH * 3; x++) /* LVGL has blue first */
            picture[i][at][x] = frame[i * PAGE_WIDTH * 3 + x / 3 * 3 + 2 - x % 3];
}

static void write_picture(const char * path)
{
    FILE * stream = fopen(path, "wb");

    if(stream == NULL || fprintf(stream, "P6\n%d %d\n255\n", PAGES * PAGE_WIDTH, PAGE_HEIGHT) < 0 ||
       fwrite(picture, sizeof picture, 1, stream) != 1 || fclose(stream) != 0) {
        fprintf(stderr, "cannot write %s\n", path);
        exit(1);
    }
}

int main(int argc, char ** argv)
{
    lv_font_t baked[SIZES] = {four_12, four_14, four_16, four_20};
    lv_font_t * made[SIZES];
    const lv_font_t * fonts[SIZES];
    file_t neural, original;
    nfr_lvgl_face * face;
    int i;

    if(argc != 5) return fprintf(stderr, "usage: demo NEURAL ORIGINAL CACHE OUT.ppm\n"), 2;
    neural = read_file(argv[1]);
    original = read_file(argv[2]);
    page_begin();
    page_build(symbols, "");
    page_draw(); /* what LVGL itself does the first time */

    face = nfr_lvgl_open(neural.data, neural.size, strtoul(argv[3], NULL, 10), NULL);
    if(face == NULL) return fprintf(stderr, "%s\n", nfr_last_error()), 1;
    for(i = 0; i < SIZES; i++) {
        made[i] = nfr_lvgl_font_create(face, page_px[i], NULL);
        made[i]->fallback = symbols[i];
        fonts[i] = made[i];
    }
    show(0, fonts, "nfr, one font for the four sizes");

    for(i = 0; i < SIZES; i++) {
        /* nfr bake makes room for every accent; the same lines as beside it. */
        baked[i].line_height = made[i]->line_height;
        baked[i].base_line = made[i]->base_line;
        baked[i].fallback = symbols[i];
        fonts[i] = &baked[i];
    }
    show(1, fonts, "four fonts of nfr bake, 4 bits");
    lv_obj_clean(lv_screen_active());
    for(i = 0; i < SIZES; i++) nfr_lvgl_font_destroy(made[i]);
    nfr_lvgl_close(face);

    for(i = 0; i < SIZES; i++) {
        made[i] = lv_tiny_ttf_create_data(original.data, original.size, page_px[i]);
        made[i]->line_height = baked[i].line_height;
        made[i]->base_line = baked[i].base_line;
        made[i]->fallback = symbols[i];
        fonts[i] = made[i];
    }
    show(2, fonts, "tiny_ttf, the original font");
    write_picture(argv[4]);
    return 0;
}
