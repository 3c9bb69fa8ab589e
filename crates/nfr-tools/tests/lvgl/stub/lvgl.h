/* What a font in C needs of LVGL 9.5: the structures as `lv_font.h` and `lv_font_fmt_txt.h` declare them, and a reader for them that was
 * written from their documentation. `check` uses LVGL itself in its place. */
#ifndef LVGL_H
#define LVGL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define LV_ATTRIBUTE_LARGE_CONST
#ifndef LV_FONT_FMT_TXT_LARGE
    #define LV_FONT_FMT_TXT_LARGE 0
#endif

typedef struct _lv_font_t lv_font_t;
typedef struct _lv_draw_buf_t lv_draw_buf_t;

typedef struct {
    const lv_font_t * resolved_font;
    uint16_t adv_w, box_w, box_h;
    int16_t ofs_x, ofs_y;
    uint8_t req_raw_bitmap : 1;
    union {
        uint32_t index;
    } gid;
} lv_font_glyph_dsc_t;

enum { LV_FONT_SUBPX_NONE };

struct _lv_font_t {
    bool (*get_glyph_dsc)(const lv_font_t *, lv_font_glyph_dsc_t *, uint32_t letter, uint32_t letter_next);
    const void * (*get_glyph_bitmap)(lv_font_glyph_dsc_t *, lv_draw_buf_t *);
    void (*release_glyph)(const lv_font_t *, lv_font_glyph_dsc_t *);
    int32_t line_height, base_line;
    uint8_t subpx : 2, kerning : 1, static_bitmap : 1;
    int8_t underline_position, underline_thickness;
    const void * dsc;
    const lv_font_t * fallback;
    void * user_data;
};

typedef struct {
#if LV_FONT_FMT_TXT_LARGE == 0
    uint32_t bitmap_index : 20, adv_w : 12;
    uint8_t box_w, box_h;
    int8_t ofs_x, ofs_y;
#else
    uint32_t bitmap_index, adv_w;
    uint16_t box_w, box_h;
    int16_t ofs_x, ofs_y;
#endif
} lv_font_fmt_txt_glyph_dsc_t;

typedef enum {
    LV_FONT_FMT_TXT_CMAP_FORMAT0_FULL,
    LV_FONT_FMT_TXT_CMAP_SPARSE_FULL,
    LV_FONT_FMT_TXT_CMAP_FORMAT0_TINY,
    LV_FONT_FMT_TXT_CMAP_SPARSE_TINY,
} lv_font_fmt_txt_cmap_type_t;

typedef struct {
    uint32_t range_start;
    uint16_t range_length, glyph_id_start;
    const uint16_t * unicode_list;
    const void * glyph_id_ofs_list;
    uint16_t list_length;
    lv_font_fmt_txt_cmap_type_t type;
} lv_font_fmt_txt_cmap_t;

enum { LV_FONT_FMT_TXT_PLAIN };

typedef struct {
    const uint8_t * glyph_bitmap;
    const lv_font_fmt_txt_glyph_dsc_t * glyph_dsc;
    const lv_font_fmt_txt_cmap_t * cmaps;
    const void * kern_dsc;
    uint16_t kern_scale;
    uint16_t cmap_num : 9, bpp : 4, kern_classes : 1, bitmap_format : 2;
    uint8_t stride;
} lv_font_fmt_txt_dsc_t;

static uint32_t glyph_id(const lv_font_fmt_txt_cmap_t * map, uint32_t offset)
{
    if(map->type == LV_FONT_FMT_TXT_CMAP_FORMAT0_TINY) return map->glyph_id_start + offset;
    for(uint32_t i = 0; i < map->list_length; i++) {
        if(map->unicode_list[i] == offset) return map->glyph_id_start + i;
    }
    return 0;
}

static bool lv_font_get_glyph_dsc_fmt_txt(const lv_font_t * font, lv_font_glyph_dsc_t * out, uint32_t letter, uint32_t next)
{
    (void)next;
    const lv_font_fmt_txt_dsc_t * dsc = font->dsc;
    for(uint32_t i = 0; i < dsc->cmap_num; i++) {
        uint32_t offset = letter - dsc->cmaps[i].range_start;
        /* The first range that holds a character decides. */
        if(offset >= dsc->cmaps[i].range_length) continue;
        out->gid.index = glyph_id(&dsc->cmaps[i], offset);
        const lv_font_fmt_txt_glyph_dsc_t * glyph = &dsc->glyph_dsc[out->gid.index];
        out->adv_w = (uint16_t)((glyph->adv_w + 8) / 16);
        out->box_w = glyph->box_w;
        out->box_h = glyph->box_h;
        out->ofs_x = glyph->ofs_x;
        out->ofs_y = glyph->ofs_y;
        return out->gid.index != 0;
    }
    return false;
}

static const void * lv_font_get_bitmap_fmt_txt(lv_font_glyph_dsc_t * glyph, lv_draw_buf_t * buffer)
{
    (void)buffer;
    const lv_font_fmt_txt_dsc_t * dsc = glyph->resolved_font->dsc;
    return &dsc->glyph_bitmap[dsc->glyph_dsc[glyph->gid.index].bitmap_index];
}

#endif
