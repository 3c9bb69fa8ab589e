/* Prints a font's line height, base line and bits a pixel, and a line for each character of it up to U+1FFFF: the code point, advance
 * width, box and offsets, and the levels of its pixels in hexadecimal. -DFONT=name names the font, whose file is -DFILE_NAME="\"name.c\"".
 * With -DLVGL, LVGL's own coverages are compared with the levels. */
#include "lvgl.h"
#include <stdio.h>
#include <stdlib.h>
#include FILE_NAME
#ifdef LVGL
    #include "lvgl_private.h"
#endif

#ifdef LVGL
static void compare(lv_font_glyph_dsc_t * glyph, const unsigned * levels, unsigned most)
{
    uint32_t stride = lv_draw_buf_width_to_stride(glyph->box_w, LV_COLOR_FORMAT_A8);
    uint8_t * pixels = calloc(stride, glyph->box_h);
    lv_draw_buf_t buffer = {.data = pixels, .handlers = lv_draw_buf_get_handlers()};
    glyph->req_raw_bitmap = 0;
    FONT.get_glyph_bitmap(glyph, &buffer);
    for(unsigned at = 0; at < (unsigned)glyph->box_w * glyph->box_h; at++) {
        unsigned pixel = pixels[at / glyph->box_w * stride + at % glyph->box_w];
        if(pixel != levels[at] * 255 / most) {
            fprintf(stderr, "glyph %u: LVGL draws %u for the level %u of %u\n", (unsigned)glyph->gid.index, pixel, levels[at], most);
            exit(1);
        }
    }
    free(pixels);
}
#endif

int main(void)
{
#ifdef LVGL
    lv_draw_buf_init_handlers();
#endif
    const lv_font_fmt_txt_dsc_t * dsc = FONT.dsc;
    unsigned bits = dsc->bpp, most = (1u << bits) - 1;
    printf("%d %d %u\n", (int)FONT.line_height, (int)FONT.base_line, bits);
    for(uint32_t letter = 1; letter < 0x20000; letter++) {
        lv_font_glyph_dsc_t glyph = {0};
        /* LVGL draws a tab as two spaces, whether the font has one or not. */
        if(letter == '\t' || !FONT.get_glyph_dsc(&FONT, &glyph, letter, 0)) continue;
        glyph.resolved_font = &FONT;
        glyph.req_raw_bitmap = 1;
        const uint8_t * bytes = FONT.get_glyph_bitmap(&glyph, NULL);
        unsigned count = (unsigned)glyph.box_w * glyph.box_h;
        unsigned * levels = calloc(count + 1, sizeof(unsigned));
        printf("%X %d %d %d %d %d ", (unsigned)letter, glyph.adv_w, glyph.box_w, glyph.box_h, glyph.ofs_x, glyph.ofs_y);
        for(unsigned at = 0; at < count; at++) {
            unsigned bit = at * bits;
            levels[at] = bytes[bit / 8] >> (8 - bits - bit % 8) & most;
            printf("%02X", levels[at]);
        }
        printf("\n");
#ifdef LVGL
        if(count > 0) compare(&glyph, levels, most);
#endif
        free(levels);
    }
    return 0;
}
