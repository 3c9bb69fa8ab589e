/* See nfr_freetype.h. Only public headers of FreeType are used. */

#include "nfr_freetype.h"
#include "nfr_freetype_loaded.h"

#include <stdlib.h>
#include <string.h>

#include FT_BITMAP_H
#include FT_MODULE_H
#include FT_OUTLINE_H
#include FT_RENDER_H
#include FT_TRUETYPE_TABLES_H

#if FREETYPE_MAJOR < 2 || (FREETYPE_MAJOR == 2 && FREETYPE_MINOR < 10)
#error "nfr_freetype needs FreeType 2.10 or later: older ones do not tell a renderer the glyph's number"
#endif

#define NFR_TABLE FT_MAKE_TAG('N', 'f', 'r', 't')
#define NFR_MODULE "nfr"

/*
 * FT_RendererRec is private. FreeType wants this much memory for a module of its own kind; it takes 17 words today.
 */
#define NFR_RENDERER_SIZE (64 * sizeof(void *))

/* From here on a status is a defect of the font, of which the first is remembered. */
static int nfr_is_defect(nfr_status status)
{
    return status != NFR_OK && status != NFR_MISSING_MODEL && status != NFR_INVALID_SIZE &&
           status != NFR_INVALID_OFFSET;
}

/* The models of a face: in the generic of its glyph slot, whose finalizer frees it before the face is closed. */
typedef struct nfr_face_ {
    nfr_rasterizer *rasterizer; /* NULL if the font cannot be opened. */
    nfr_loaded loaded;
    nfr_status status; /* The first defect. */
    char message[256];
} nfr_face;

/* Remembers the first defect; `message` is NULL for that of the last call. */
static void nfr_note(nfr_face *held, nfr_status status, const char *message)
{
    if (nfr_is_defect(status) && !nfr_is_defect(held->status)) {
        held->status = status;
        strncpy(held->message, message ? message : nfr_last_error(), sizeof held->message - 1);
    }
    /* What it holds is in doubt. */
    if (status == NFR_INTERNAL) {
        nfr_rasterizer_free(held->rasterizer);
        held->rasterizer = NULL;
    }
}

static void nfr_face_done(void *object)
{
    FT_GlyphSlot slot = (FT_GlyphSlot)object;
    nfr_face *held = (nfr_face *)slot->generic.data;

    slot->generic.data = NULL;
    slot->generic.finalizer = NULL;
    if (held->loaded.outline.points && slot->outline.points == held->loaded.outline.points)
        memset(&slot->outline, 0, sizeof slot->outline);
    nfr_rasterizer_free(held->rasterizer);
    FT_Outline_Done(slot->library, &held->loaded.outline);
    free(held);
}

/*
 * Opens the file of a face, without a copy where it lies in memory as long as the face is open. `message` is set if it was
 * not the library that failed.
 */
static nfr_status nfr_open(FT_Face face, nfr_font **font, const char **message)
{
    FT_Stream stream = face->stream;
    FT_UInt32 index = (FT_UInt32)face->face_index & 0xFFFF;
    FT_ULong length = 0;
    FT_Byte *copy;

    *font = NULL;
    *message = NULL;
    if (stream && stream->base && !stream->read)
        return nfr_font_new_borrowed(stream->base, stream->size, index, NULL, NULL, font);
    *message = "FreeType cannot read the whole file";
    /* The tag 0 stands for it. */
    if (FT_Load_Sfnt_Table(face, 0, 0, NULL, &length) || length == 0)
        return NFR_NOT_A_FONT;
    copy = (FT_Byte *)malloc(length);
    if (!copy) {
        *message = "no memory for a copy of the file";
        return NFR_LIMIT;
    }
    if (FT_Load_Sfnt_Table(face, 0, 0, copy, &length)) {
        free(copy);
        return NFR_NOT_A_FONT;
    }
    *message = NULL;
    return nfr_font_new_borrowed(copy, length, index, free, copy, font);
}

/* The models of the slot's face, opened now if they were not yet; NULL if it has none. */
static nfr_face *nfr_face_of(FT_GlyphSlot slot)
{
    FT_ULong length = 0;
    nfr_font *font = NULL;
    const char *message;
    nfr_status status;
    nfr_face *held;

    if (slot->generic.finalizer == nfr_face_done)
        return (nfr_face *)slot->generic.data;
    if (slot->generic.data || slot->generic.finalizer)
        return NULL;
    if (!FT_IS_SFNT(slot->face) || FT_Load_Sfnt_Table(slot->face, NFR_TABLE, 0, NULL, &length))
        return NULL;
    held = (nfr_face *)calloc(1, sizeof *held);
    if (!held)
        return NULL;
    status = nfr_open(slot->face, &font, &message);
    if (status == NFR_OK)
        status = nfr_rasterizer_new(font, &held->rasterizer);
    nfr_font_free(font);
    nfr_note(held, status, message);
    slot->generic.data = held;
    slot->generic.finalizer = nfr_face_done;
    return held;
}

/* Whole pixels of a move in 1/64 pixel; `part` receives the rest in pixels, from 0 to below 1. */
static FT_Int nfr_whole(FT_Pos move, float *part)
{
    FT_Pos rest = move & 63;

    *part = (float)rest / 64.0f;
    return (FT_Int)((move - rest) / 64);
}

/* Gives the slot a copy of the bitmap in FreeType's own memory, so that it lives as any other. */
static FT_Error nfr_fill_slot(FT_GlyphSlot slot, const unsigned char *pixels, const nfr_placement *placement)
{
    FT_Error error;

    FT_Bitmap_Init(&slot->bitmap);
    slot->bitmap.width = placement->width;
    slot->bitmap.rows = placement->height;
    slot->bitmap.pitch = (int)placement->width;
    slot->bitmap.num_grays = 256;
    slot->bitmap.pixel_mode = FT_PIXEL_MODE_GRAY;
    /* FreeType only reads what it copies. */
    if (placement->width && placement->height)
        slot->bitmap.buffer = (unsigned char *)pixels;
    slot->format = FT_GLYPH_FORMAT_BITMAP;
    error = FT_GlyphSlot_Own_Bitmap(slot);
    if (error) {
        FT_Bitmap_Init(&slot->bitmap);
        slot->format = FT_GLYPH_FORMAT_OUTLINE;
        return error;
    }
    slot->bitmap_left = placement->left;
    slot->bitmap_top = placement->top;
    return FT_Err_Ok;
}

static void nfr_set_advance(nfr_face *held, FT_GlyphSlot slot, float ppem)
{
    float pixels = 0.0f;
    FT_Pos advance;

    if (slot->advance.x != slot->metrics.horiAdvance || slot->advance.y != 0 ||
        nfr_rasterizer_hinted_advance(held->rasterizer, slot->glyph_index, ppem, &pixels) != NFR_OK)
        return;
    /* It is whole where the model knows it, and linear elsewhere; with hinting FreeType rounds that, too. */
    advance = (FT_Pos)(pixels + 0.5f) * 64;
    slot->advance.x = slot->metrics.horiAdvance = advance;
    slot->lsb_delta = slot->rsb_delta = 0;
}

static FT_Error nfr_draw(nfr_face *held, FT_GlyphSlot slot, float ppem, const FT_Vector *move)
{
    nfr_placement placement;
    const unsigned char *pixels;
    float x, y;
    FT_Int left = nfr_whole(move->x, &x), top = nfr_whole(move->y, &y);
    nfr_status status;

    status = nfr_rasterizer_draw(held->rasterizer, slot->glyph_index, ppem, x, y, &pixels, &placement);
    nfr_note(held, status, NULL);
    if (status != NFR_OK)
        return FT_Err_Cannot_Render_Glyph;
    if (placement.width && placement.height) {
        placement.left += left;
        placement.top += top;
    }
    if (nfr_fill_slot(slot, pixels, &placement))
        return FT_Err_Cannot_Render_Glyph;
    nfr_set_advance(held, slot, ppem);
    return FT_Err_Ok;
}

/* FT_Err_Cannot_Render_Glyph makes FreeType ask its next renderer. */
static FT_Error nfr_render(FT_Renderer renderer, FT_GlyphSlot slot, FT_Render_Mode mode, const FT_Vector *origin)
{
    FT_Face face = slot->face;
    const FT_Size_Metrics *size;
    nfr_placement placement;
    FT_Vector move;
    nfr_status status;
    nfr_face *held;
    float ppem;

    (void)renderer;
    /* FT_Glyph_To_Bitmap has a slot without a face. */
    if (!face || slot != face->glyph || slot->format != FT_GLYPH_FORMAT_OUTLINE || !face->size || origin)
        return FT_Err_Cannot_Render_Glyph;
    /* Black and white takes the outline: half-covered pixels of thin strokes would leave gaps. */
    if (mode != FT_RENDER_MODE_NORMAL && mode != FT_RENDER_MODE_LIGHT)
        return FT_Err_Cannot_Render_Glyph;
    size = &face->size->metrics;
    if (size->x_scale != size->y_scale || FT_HAS_MULTIPLE_MASTERS(face))
        return FT_Err_Cannot_Render_Glyph;
    held = nfr_face_of(slot);
    if (!held || !held->rasterizer)
        return FT_Err_Cannot_Render_Glyph;
    /* The size in 1/64 pixel, of which the scale was made. */
    ppem = (float)FT_MulFix(face->units_per_EM, size->x_scale) / 64.0f;
    /* Whether there is a model is known sooner than how the glyph was loaded. */
    status = nfr_rasterizer_placement(held->rasterizer, slot->glyph_index, ppem, 0.0f, 0.0f, &placement);
    nfr_note(held, status, NULL);
    if (status != NFR_OK || !nfr_is_hinted(&held->loaded, slot, &move))
        return FT_Err_Cannot_Render_Glyph;
    return nfr_draw(held, slot, ppem, &move);
}

/* FreeType lets the first renderer transform outlines for FT_Set_Transform. */
static FT_Error nfr_transform(FT_Renderer renderer, FT_GlyphSlot slot, const FT_Matrix *matrix, const FT_Vector *delta)
{
    (void)renderer;
    if (slot->format != FT_GLYPH_FORMAT_OUTLINE)
        return FT_Err_Invalid_Argument;
    if (matrix)
        FT_Outline_Transform(&slot->outline, matrix);
    if (delta)
        FT_Outline_Translate(&slot->outline, delta->x, delta->y);
    return FT_Err_Ok;
}

static void nfr_cbox(FT_Renderer renderer, FT_GlyphSlot slot, FT_BBox *box)
{
    (void)renderer;
    memset(box, 0, sizeof *box);
    if (slot->format == FT_GLYPH_FORMAT_OUTLINE)
        FT_Outline_Get_CBox(&slot->outline, box);
}

static FT_Error nfr_set_mode(FT_Renderer renderer, FT_ULong tag, FT_Pointer data)
{
    (void)renderer, (void)tag, (void)data;
    return FT_Err_Ok;
}

/* A rasteriser of outlines that leaves them all to the next one: FreeType wants one of each renderer of outlines. */
static int nfr_raster_new(void *memory, FT_Raster *raster)
{
    (void)memory;
    *raster = NULL;
    return 0;
}

static void nfr_raster_reset(FT_Raster raster, unsigned char *pool, unsigned long size)
{
    (void)raster, (void)pool, (void)size;
}

static int nfr_raster_set_mode(FT_Raster raster, unsigned long mode, void *data)
{
    (void)raster, (void)mode, (void)data;
    return 0;
}

static int nfr_raster_render(FT_Raster raster, const FT_Raster_Params *params)
{
    (void)raster, (void)params;
    return FT_Err_Cannot_Render_Glyph;
}

static void nfr_raster_done(FT_Raster raster)
{
    (void)raster;
}

static FT_Raster_Funcs nfr_raster = {
    FT_GLYPH_FORMAT_OUTLINE, nfr_raster_new,    nfr_raster_reset,
    nfr_raster_set_mode,     nfr_raster_render, nfr_raster_done,
};

static const FT_Renderer_Class nfr_class = {
    {FT_MODULE_RENDERER, (FT_Long)NFR_RENDERER_SIZE, NFR_MODULE, 0x10000L, 0x20000L, NULL, NULL, NULL, NULL},
    FT_GLYPH_FORMAT_OUTLINE,
    nfr_render,
    nfr_transform,
    nfr_cbox,
    nfr_set_mode,
    &nfr_raster,
};

FT_Error nfr_freetype_add(FT_Library library)
{
    FT_Module module;
    FT_Error error;

    if (!library)
        return FT_Err_Invalid_Library_Handle;
    if (FT_Get_Module(library, NFR_MODULE))
        return FT_Err_Ok;
    error = FT_Add_Module(library, &nfr_class.root);
    if (error)
        return error;
    module = FT_Get_Module(library, NFR_MODULE);
    /* A module is added behind the others; the first is asked first. */
    error = FT_Set_Renderer(library, (FT_Renderer)module, 0, NULL);
    if (error)
        FT_Remove_Module(library, module);
    return error;
}

nfr_status nfr_freetype_status(FT_Face face, const char **message)
{
    static const char nothing[] = "";
    const nfr_face *held = NULL;

    if (face && face->glyph && face->glyph->generic.finalizer == nfr_face_done)
        held = (const nfr_face *)face->glyph->generic.data;
    if (message)
        *message = held ? held->message : nothing;
    return held ? held->status : NFR_NO_MODELS;
}
