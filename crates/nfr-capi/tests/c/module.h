/* What the two parts of the module's test share. */
#ifndef MODULE_H
#define MODULE_H

#include "common.h"

#include "nfr_freetype.h"

#include FT_BITMAP_H
#include FT_GLYPH_H
#include FT_MODULE_H
#include FT_OUTLINE_H
#include FT_SYNTHESIS_H

#define NORMAL (FT_LOAD_DEFAULT | FT_LOAD_RENDER)

/* A library with the module or without. */
static inline FT_Library library_with(int module)
{
    FT_Library library;

    CHECK(FT_Init_FreeType(&library) == 0);
    CHECK(!module || nfr_freetype_add(library) == 0);
    return library;
}

static inline FT_Face face_of(FT_Library library, bytes file)
{
    FT_Face face;

    CHECK(FT_New_Memory_Face(library, file.data, (FT_Long)file.len, 0, &face) == 0);
    CHECK(FT_Set_Pixel_Sizes(face, 0, 14) == 0);
    return face;
}

static inline int same_bitmap(FT_GlyphSlot a, FT_GlyphSlot b)
{
    return a->format == b->format && a->bitmap_left == b->bitmap_left && a->bitmap_top == b->bitmap_top &&
           a->bitmap.width == b->bitmap.width && a->bitmap.rows == b->bitmap.rows && a->bitmap.pitch == b->bitmap.pitch &&
           a->bitmap.pixel_mode == b->bitmap.pixel_mode && a->bitmap.num_grays == b->bitmap.num_grays &&
           memcmp(a->bitmap.buffer, b->bitmap.buffer, (size_t)a->bitmap.rows * (size_t)a->bitmap.pitch) == 0;
}

/* Whether the slot has the pixels that the library draws at a subpixel offset. */
static inline int is_ours(FT_GlyphSlot slot, nfr_rasterizer *rasterizer, float ppem, float x, float y)
{
    nfr_placement p;
    const unsigned char *pixels;

    CHECK(nfr_rasterizer_draw(rasterizer, slot->glyph_index, ppem, x, y, &pixels, &p) == NFR_OK);
    return slot->format == FT_GLYPH_FORMAT_BITMAP && slot->bitmap.pixel_mode == FT_PIXEL_MODE_GRAY &&
           slot->bitmap_left == p.left && slot->bitmap_top == p.top && slot->bitmap.width == p.width &&
           slot->bitmap.rows == p.height && slot->bitmap.pitch == (int)p.width &&
           (p.height == 0 || memcmp(slot->bitmap.buffer, pixels, (size_t)p.width * p.height) == 0);
}

/* Faces that are opened, closed and used in all orders. In faces.c. */
void check_lifetimes(bytes sans, bytes other, const char *folder);
void check_threads(bytes sans);

#endif
