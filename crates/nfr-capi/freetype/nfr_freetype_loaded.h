/*
 * How the glyph in a slot was loaded, which FreeType does not tell a renderer. A part of nfr_freetype.c, for no other file.
 */

#ifndef NFR_FREETYPE_LOADED_H
#define NFR_FREETYPE_LOADED_H

#include <string.h>

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

/* How a program may load a glyph whose hinting nfr replaces; and without hinting, which it leaves alone. */
static const FT_Int32 nfr_loads[] = {
    FT_LOAD_DEFAULT,     FT_LOAD_NO_HINTING,  FT_LOAD_TARGET_LIGHT,
    FT_LOAD_TARGET_MONO, FT_LOAD_TARGET_LCD,  FT_LOAD_NO_AUTOHINT,
    FT_LOAD_TARGET_LCD_V,
};
#define NFR_LOADS (sizeof nfr_loads / sizeof nfr_loads[0])

/* What is kept between the glyphs of a slot. */
typedef struct nfr_loaded_ {
    size_t load;        /* How the last glyph was loaded: an index of nfr_loads. */
    FT_Outline outline; /* What the slot held when it was to be rendered. */
} nfr_loaded;

/*
 * Whether two outlines are the same but for a move, which is added to the second. Anything else that was done to an
 * outline since it was loaded shows in its points.
 */
static int nfr_moved(const FT_Outline *loaded, const FT_Outline *now, FT_Vector *move)
{
    int i;

    move->x = move->y = 0;
    if (loaded->n_points != now->n_points || loaded->n_contours != now->n_contours)
        return 0;
    if (now->n_points == 0)
        return 1;
    move->x = now->points[0].x - loaded->points[0].x;
    move->y = now->points[0].y - loaded->points[0].y;
    for (i = 0; i < now->n_points; i++) {
        if (now->points[i].x - loaded->points[i].x != move->x || now->points[i].y - loaded->points[i].y != move->y)
            return 0;
    }
    return memcmp(now->tags, loaded->tags, (size_t)now->n_points * sizeof *now->tags) == 0 &&
           memcmp(now->contours, loaded->contours, (size_t)now->n_contours * sizeof *now->contours) == 0;
}

/* What FT_Set_Transform has set: the move, and whether there is nothing more than that. */
static int nfr_is_upright(FT_Face face, FT_Vector *delta)
{
    delta->x = delta->y = 0;
#if FREETYPE_MAJOR > 2 || FREETYPE_MINOR >= 11
    FT_Matrix matrix;

    FT_Get_Transform(face, &matrix, delta);
    return matrix.xx == 0x10000L && matrix.yy == 0x10000L && matrix.xy == 0 && matrix.yx == 0;
#else
    (void)face;
    return 1;
#endif
}

static int nfr_same_metrics(const FT_Glyph_Metrics *a, const FT_Glyph_Metrics *b)
{
    return a->width == b->width && a->height == b->height && a->horiBearingX == b->horiBearingX &&
           a->horiBearingY == b->horiBearingY && a->horiAdvance == b->horiAdvance;
}

/* Keeps a copy of the slot's outline, since loading the glyph again writes over it. */
static int nfr_keep_outline(FT_GlyphSlot slot, FT_Outline *kept)
{
    const FT_Outline *outline = &slot->outline;

    if (kept->n_points != outline->n_points || kept->n_contours != outline->n_contours) {
        FT_Outline_Done(slot->library, kept);
        memset(kept, 0, sizeof *kept);
        if (outline->n_points == 0)
            return 1;
        if (FT_Outline_New(slot->library, (FT_UInt)outline->n_points, outline->n_contours, kept))
            return 0;
    }
    return outline->n_points == 0 || FT_Outline_Copy(outline, kept) == 0;
}

/*
 * Loads the glyph in each way until its metrics and outline are those that the slot had. Returns the index of the way, or
 * NFR_LOADS. A way that needs no move other than FT_Set_Transform's goes before one that does: with different hinting
 * a glyph as simple as T may differ by a move only.
 */
static size_t nfr_find_load(nfr_loaded *held, FT_GlyphSlot slot, const FT_GlyphSlotRec *before, FT_Vector *move)
{
    FT_Vector delta, found_move;
    size_t i, load, found = NFR_LOADS;
    int upright = nfr_is_upright(slot->face, &delta);

    /* Without points, as where outlines were dropped, a transformation does not show in them. */
    if (!upright && before->outline.n_points == 0)
        return NFR_LOADS;
    for (i = 0; i < NFR_LOADS; i++) {
        load = (held->load + i) % NFR_LOADS;
        if (FT_Load_Glyph(slot->face, before->glyph_index, nfr_loads[load] | FT_LOAD_NO_BITMAP | FT_LOAD_IGNORE_TRANSFORM))
            return NFR_LOADS;
        if (slot->format != FT_GLYPH_FORMAT_OUTLINE || !nfr_same_metrics(&slot->metrics, &before->metrics) ||
            !nfr_moved(&slot->outline, &held->outline, &found_move))
            continue;
        if (found == NFR_LOADS)
            found = load, *move = found_move;
        if ((found_move.x == 0 && found_move.y == 0) || (found_move.x == delta.x && found_move.y == delta.y)) {
            *move = found_move;
            return load;
        }
    }
    return found;
}

/*
 * Finds out how the glyph in the slot was loaded, by loading it again: FreeType does not tell a renderer, and whether a
 * program has changed the outline since does not show otherwise. Returns whether it is hinted and unchanged but for a
 * move. The slot is as before afterwards; its outline is in our memory, which lives as long as the slot.
 */
static int nfr_is_hinted(nfr_loaded *held, FT_GlyphSlot slot, FT_Vector *move)
{
    FT_GlyphSlotRec before = *slot;
    size_t load;

    if (!nfr_keep_outline(slot, &held->outline))
        return 0;
    load = nfr_find_load(held, slot, &before, move);
    /* Loading has freed a bitmap of the slot's. */
    memset(&before.bitmap, 0, sizeof before.bitmap);
    *slot = before;
    slot->outline = held->outline;
    slot->outline.flags = before.outline.flags & ~FT_OUTLINE_OWNER;
    if (load == NFR_LOADS)
        return 0;
    held->load = load;
    return nfr_loads[load] != FT_LOAD_NO_HINTING;
}

#endif
