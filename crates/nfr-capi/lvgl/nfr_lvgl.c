#include "nfr_lvgl.h"
#include "lvgl_private.h"

#include <math.h>

/* Lists of drawn glyphs; a glyph's number and size choose one. */
#define LISTS 64u

/* A drawn glyph. Its pixels follow, rows of box_w bytes. */
typedef struct {
    uint32_t older; /* the position of the glyph that was put into the same list before */
    uint32_t glyph;
    uint16_t px, adv_w, box_w, box_h;
    int16_t ofs_x, ofs_y;
} drawn_t;

struct nfr_lvgl_face {
    lv_mutex_t lock; /* for all below */
    nfr_font * font;
    nfr_rasterizer * rasterizer;
    uint32_t users; /* the program, until it closes the face, and the fonts */
    nfr_status status;
    drawn_t single; /* a glyph that has no room in the ring */
    /*
     * Drawn glyphs, written one behind the other. Positions count on when the ring begins anew: position P is byte P % capacity, and
     * is overwritten when `end` is more than the capacity beyond it. Position 0 always is.
     */
    uint32_t capacity, end;
    uint32_t newest[LISTS];
    uint8_t * ring;
};

typedef struct {
    lv_font_t font; /* the first member: its address is the font's */
    nfr_lvgl_face * face;
    uint16_t px;
} sized_t;

static void empty(nfr_lvgl_face * face)
{
    lv_memzero(face->newest, sizeof face->newest);
    face->end = 2 * face->capacity;
}

/* Where a new glyph is written, or NULL if it has no room. */
static drawn_t * reserve(nfr_lvgl_face * face, size_t pixels, uint32_t * list)
{
    uint32_t size, at;
    drawn_t * drawn;

    if(pixels + sizeof(drawn_t) + 3 > face->capacity) return NULL;
    size = (uint32_t)(sizeof(drawn_t) + pixels + 3) & ~3u;
    if(face->end > UINT32_MAX - 2 * face->capacity) empty(face);
    at = face->end % face->capacity;
    if(at + size > face->capacity) {
        face->end += face->capacity - at;
        at = 0;
    }
    drawn = (drawn_t *)(void *)(face->ring + at);
    drawn->older = *list;
    *list = face->end;
    face->end += size;
    return drawn;
}

/* Notes why a glyph cannot be drawn: the first reason is logged. */
static void note(nfr_lvgl_face * face, nfr_status status, const char * why)
{
    if(status == NFR_MISSING_MODEL || face->status != NFR_OK) return;
    face->status = status;
    LV_LOG_WARN("nfr: %s", why);
}

/* Draws a glyph, and keeps it if there is room. Its pixels are lent until the next call. NULL if it cannot be drawn. */
static const drawn_t * draw(nfr_lvgl_face * face, uint16_t px, uint32_t glyph, uint32_t * list, const uint8_t ** pixels)
{
    nfr_placement place;
    float advance;
    drawn_t * drawn;
    size_t size;
    int32_t bottom;
    nfr_status status = nfr_rasterizer_hinted_advance(face->rasterizer, glyph, px, &advance);

    /* The model is decoded once: the last one is kept. */
    if(status == NFR_OK) status = nfr_rasterizer_draw(face->rasterizer, glyph, px, 0, 0, pixels, &place);
    if(status != NFR_OK) {
        note(face, status, nfr_last_error());
        return NULL;
    }
    bottom = place.top - (int32_t)place.height;
    if(place.left != (int16_t)place.left || bottom != (int16_t)bottom) {
        note(face, NFR_LIMIT, "a glyph lies farther from its origin than LVGL counts");
        return NULL;
    }
    size = (size_t)place.width * place.height;
    drawn = reserve(face, size, list);
    if(drawn) *pixels = lv_memcpy(drawn + 1, *pixels, size);
    else drawn = &face->single;
    drawn->glyph = glyph;
    drawn->px = px;
    drawn->adv_w = (uint16_t)lroundf(LV_CLAMP(0, advance, INT16_MAX));
    drawn->box_w = (uint16_t)place.width;
    drawn->box_h = (uint16_t)place.height;
    drawn->ofs_x = (int16_t)place.left;
    drawn->ofs_y = (int16_t)(size ? bottom : 0);
    return drawn;
}

/* A drawn glyph and its pixels, both valid while the lock is held; NULL if it cannot be drawn. */
static const drawn_t * find(nfr_lvgl_face * face, uint16_t px, uint32_t glyph, const uint8_t ** pixels)
{
    uint32_t * list = &face->newest[(glyph + px * 37u) % LISTS];
    uint32_t at;

    for(at = *list; face->end - at <= face->capacity && face->capacity > 0;) {
        const drawn_t * drawn = (const drawn_t *)(void *)(face->ring + at % face->capacity);
        if(drawn->glyph == glyph && drawn->px == px) {
            *pixels = (const uint8_t *)(drawn + 1);
            return drawn;
        }
        at = drawn->older;
    }
    return draw(face, px, glyph, list, pixels);
}

static bool get_glyph_dsc(const lv_font_t * font, lv_font_glyph_dsc_t * dsc, uint32_t letter, uint32_t letter_next)
{
    const sized_t * sized = font->dsc;
    uint32_t glyph = nfr_font_glyph_for_char(sized->face->font, letter == '\t' ? ' ' : letter);
    const uint8_t * pixels;
    const drawn_t * drawn;

    LV_UNUSED(letter_next);
    if(glyph == 0) return false;
    lv_mutex_lock(&sized->face->lock);
    drawn = find(sized->face, sized->px, glyph, &pixels);
    if(drawn) {
        dsc->adv_w = letter == '\t' ? drawn->adv_w * 2 : drawn->adv_w;
        dsc->box_w = drawn->box_w;
        dsc->box_h = drawn->box_h;
        dsc->ofs_x = drawn->ofs_x;
        dsc->ofs_y = drawn->ofs_y;
        dsc->stride = drawn->box_w;
        dsc->format = LV_FONT_GLYPH_FORMAT_A8;
        dsc->is_placeholder = false;
        dsc->gid.index = glyph;
    }
    lv_mutex_unlock(&sized->face->lock);
    return drawn != NULL;
}

static const void * get_glyph_bitmap(lv_font_glyph_dsc_t * dsc, lv_draw_buf_t * to)
{
    const sized_t * sized = dsc->resolved_font->dsc;
    const drawn_t * drawn;
    const uint8_t * pixels;
    uint32_t row, stride;
    bool fits;

    if(to == NULL) return NULL;
    stride = to->header.stride;
    lv_mutex_lock(&sized->face->lock);
    drawn = find(sized->face, sized->px, dsc->gid.index, &pixels);
    fits = drawn && drawn->box_w <= stride && (size_t)stride * drawn->box_h <= to->data_size;
    for(row = 0; fits && row < drawn->box_h; row++)
        lv_memcpy(to->data + (size_t)row * stride, pixels + (size_t)row * drawn->box_w, drawn->box_w);
    lv_mutex_unlock(&sized->face->lock);
    if(!fits) return NULL;
    lv_draw_buf_flush_cache(to, NULL);
    return to;
}

/* One user less; the last one frees. */
static void leave(nfr_lvgl_face * face)
{
    if(--face->users > 0) return;
    nfr_rasterizer_free(face->rasterizer);
    nfr_font_free(face->font);
    lv_mutex_delete(&face->lock);
    lv_free(face->ring);
    lv_free(face);
}

static nfr_status open_font(nfr_lvgl_face * face, const void * data, size_t size, size_t cache)
{
    nfr_limits limits;
    nfr_status status = nfr_font_new_borrowed(data, size, 0, NULL, NULL, &face->font);

    if(status == NFR_OK) status = nfr_rasterizer_new(face->font, &face->rasterizer);
    if(status == NFR_OK) status = nfr_limits_default(&limits);
    if(status != NFR_OK) return status;
    limits.bitmap_side = NFR_LVGL_BITMAP_SIDE;
    limits.decoded_bytes = NFR_LVGL_DECODED_BYTES;
    limits.work = NFR_LVGL_WORK;
    status = nfr_rasterizer_set_limits(face->rasterizer, &limits);
    if(status == NFR_OK) status = nfr_rasterizer_set_cache(face->rasterizer, 0);
    face->capacity = (uint32_t)LV_MIN(cache, 1u << 28) & ~3u;
    if(face->capacity > 0 && (face->ring = lv_malloc(face->capacity)) == NULL) return NFR_LIMIT;
    empty(face);
    return status;
}

nfr_lvgl_face * nfr_lvgl_open(const void * data, size_t size, size_t cache, nfr_status * status)
{
    nfr_lvgl_face * face = lv_malloc_zeroed(sizeof *face);
    nfr_status opened = NFR_LIMIT;

    if(face) {
        face->users = 1;
        lv_mutex_init(&face->lock);
        opened = open_font(face, data, size, cache);
        if(opened != NFR_OK) {
            LV_LOG_ERROR("nfr: cannot open the font: %s", opened == NFR_LIMIT ? "no memory" : nfr_last_error());
            leave(face);
            face = NULL;
        }
    }
    if(status) *status = opened;
    return face;
}

void nfr_lvgl_close(nfr_lvgl_face * face)
{
    if(face) leave(face);
}

lv_font_t * nfr_lvgl_font_create(nfr_lvgl_face * face, uint16_t px, nfr_status * status)
{
    nfr_line_metrics line;
    sized_t * sized = NULL;
    nfr_status made = face ? nfr_font_line_metrics(face->font, px, &line) : NFR_NULL_POINTER;

    if(made == NFR_OK && (sized = lv_malloc_zeroed(sizeof *sized)) == NULL) made = NFR_LIMIT;
    if(status) *status = made;
    if(sized == NULL) return NULL;
    face->users++;
    sized->face = face;
    sized->px = px;
    sized->font.get_glyph_dsc = get_glyph_dsc;
    sized->font.get_glyph_bitmap = get_glyph_bitmap;
    sized->font.base_line = lroundf(-line.descent);
    sized->font.line_height = lroundf(line.ascent) + sized->font.base_line;
    sized->font.kerning = LV_FONT_KERNING_NONE;
    /* An underline below the baseline does not touch it, however small the size. */
    if(line.underline_position < 0) line.underline_position = LV_MIN(line.underline_position, -1);
    sized->font.underline_position = (int8_t)lroundf(LV_CLAMP(INT8_MIN, line.underline_position, INT8_MAX));
    sized->font.underline_thickness = (int8_t)lroundf(LV_CLAMP(1, line.underline_thickness, INT8_MAX));
    sized->font.dsc = sized;
    return &sized->font;
}

void nfr_lvgl_font_destroy(lv_font_t * font)
{
    if(font == NULL) return;
    leave(((sized_t *)font->dsc)->face);
    lv_free((void *)font->dsc);
}

nfr_status nfr_lvgl_status(const nfr_lvgl_face * face)
{
    return face ? face->status : NFR_NULL_POINTER;
}
