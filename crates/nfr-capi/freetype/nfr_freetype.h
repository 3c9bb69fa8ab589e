/*
 * A renderer module for FreeType, 2.10 or later: glyphs that have a model in their font are drawn by nfr, everything else
 * as before.
 *
 *     FT_Init_FreeType(&library);
 *     nfr_freetype_add(library);
 *
 * Compile nfr_freetype.c into the program and link libnfr and FreeType.
 *
 * What nfr draws: glyphs that FT_Load_Glyph or FT_Load_Char loads with hinting (FT_LOAD_DEFAULT and all FT_LOAD_TARGET_*)
 * and FT_LOAD_RENDER or FT_Render_Glyph renders with FT_RENDER_MODE_NORMAL or FT_RENDER_MODE_LIGHT. Outlines may have been
 * moved, by FT_Set_Transform or FT_Outline_Translate: subpixel offsets.
 *
 * What FreeType draws as before: glyphs without a model and with a damaged or outdated one, other fonts, other modes
 * (FT_RENDER_MODE_MONO too), glyphs that were loaded with FT_LOAD_NO_HINTING, sizes that differ in x and y, outlines that
 * were changed (FT_GlyphSlot_Embolden, rotation, stroking), FT_Glyph_To_Bitmap, FT_Outline_Get_Bitmap, and slots whose
 * generic.data the program uses itself: the module keeps its models in face->glyph->generic, and frees them with the face.
 *
 * FreeType does not tell a renderer how a glyph was loaded. The module finds out by loading it again, mostly once; an outline
 * that was changed takes seven loads, before FreeType draws it.
 *
 * The slot afterwards: bitmap, bitmap_left, bitmap_top as always, the bitmap in FreeType's memory. The advance width becomes
 * the hinted one (slot->advance.x and metrics.horiAdvance, lsb_delta and rsb_delta are 0), unless the layout is vertical
 * or a transformation has changed it. The rest of slot->metrics stays FreeType's.
 *
 * Threads. As FreeType: faces of one library may be rendered by several threads at the same time, each face by one.
 * A font that was opened from memory or a mapped file is not copied.
 */
#ifndef NFR_FREETYPE_H
#define NFR_FREETYPE_H

#include <ft2build.h>
#include FT_FREETYPE_H

#include "nfr.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Adds the module to a library, once: again it does nothing. Faces may be closed before FT_Done_FreeType or by it; the
 * program's code must stay loaded until then.
 */
FT_Error nfr_freetype_add(FT_Library library);

/*
 * What has happened to a face's models so far: NFR_OK; NFR_NO_MODELS for a font that was not converted or of which nothing
 * was rendered yet; or the status of the first table or glyph that was damaged or outdated, asked for more than the limits
 * allow, or is a network that this build does not draw.
 *
 * message: receives a sentence on it, valid until the face is closed, never NULL; or NULL.
 */
nfr_status nfr_freetype_status(FT_Face face, const char **message);

#ifdef __cplusplus
}
#endif

#endif
