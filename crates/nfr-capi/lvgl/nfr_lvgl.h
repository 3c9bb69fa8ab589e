/*
 * Fonts for LVGL 9.5, of all sizes from one font that nfr-convert has written.
 *
 *     nfr_lvgl_face * face = nfr_lvgl_open(sans_ttf, sizeof sans_ttf, 8 * 1024, NULL);
 *     lv_font_t * small = nfr_lvgl_font_create(face, 12, NULL);
 *     lv_font_t * large = nfr_lvgl_font_create(face, 20, NULL);
 *     large->fallback = &lv_font_montserrat_20; // for the symbols
 *     lv_obj_set_style_text_font(label, large, 0);
 *
 * Compile nfr_lvgl.c into the program and link LVGL and libnfr.
 *
 * Glyphs are drawn as A8 bitmaps with the hinted advance, rounded to a whole pixel; there is no kerning. A tab is two spaces wide, as in
 * LVGL's own fonts. A character that the font lacks, or whose glyph has no model or cannot be drawn, is left to the font's `fallback`,
 * which the program sets. Sizes beyond nfr_font_ppem_range are drawn without hinting.
 *
 * Lines are as high as the font's ascent and descent, each rounded. The fields of lv_font_t may be changed before the font is used, as
 * for more room above accented capitals.
 *
 * Memory. The font's bytes are not copied. The face keeps drawn glyphs in one block of the size that the program gives; a glyph takes its
 * pixels and 20 bytes. Of nfr's decoded models only the last one is kept. A font file cannot ask for more than the limits below.
 * nfr_lvgl.c allocates by lv_malloc; libnfr by malloc, and it ends the process if that fails.
 *
 * Threads. Open, create, destroy and close as LVGL's own functions: in its thread or under lv_lock(). LVGL's draw threads may draw at the
 * same time; a mutex of the face, of LVGL's operating system layer, lets in one.
 */
#ifndef NFR_LVGL_H
#define NFR_LVGL_H

#include "lvgl.h"
#include "nfr.h"

/* What a font file may ask for: see nfr_limits. */
#ifndef NFR_LVGL_BITMAP_SIDE
    #define NFR_LVGL_BITMAP_SIDE 512
#endif
#ifndef NFR_LVGL_DECODED_BYTES
    #define NFR_LVGL_DECODED_BYTES (64 * 1024)
#endif
#ifndef NFR_LVGL_WORK
    #define NFR_LVGL_WORK (1 << 22)
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* An open font, for any number of sizes. */
typedef struct nfr_lvgl_face nfr_lvgl_face;

/*
 * Opens a font. data: `size` bytes that stay readable and unchanged until the face and all its fonts are gone, as in flash. cache: the
 * bytes for drawn glyphs; with 0 each is drawn anew. status: receives what went wrong, or NFR_OK; may be NULL. Returns NULL if
 * something did: also for NULL, bytes that are no font or half of one, a font that was not converted, and models of another version;
 * NFR_LIMIT if LVGL has no memory left.
 */
nfr_lvgl_face * nfr_lvgl_open(const void * data, size_t size, size_t cache, nfr_status * status);

/* Closes a face, or NULL. Its fonts stay valid, and hold what they need. */
void nfr_lvgl_close(nfr_lvgl_face * face);

/*
 * Makes a font of a size in pixels per em. status: as in nfr_lvgl_open. Returns NULL if face is NULL, if the size is 0 or above 2048,
 * and if LVGL has no memory left.
 */
lv_font_t * nfr_lvgl_font_create(nfr_lvgl_face * face, uint16_t px, nfr_status * status);

/* Destroys a font of nfr_lvgl_font_create, or NULL. Nothing may use it any more. */
void nfr_lvgl_font_destroy(lv_font_t * font);

/*
 * The first thing that went wrong when a glyph was drawn, which LVGL's log has a warning of: NFR_DAMAGED_GLYPH, NFR_STALE, NFR_LIMIT;
 * NFR_OK if nothing did. Glyphs without models are no error. NFR_NULL_POINTER if face is NULL.
 */
nfr_status nfr_lvgl_status(const nfr_lvgl_face * face);

#ifdef __cplusplus
}
#endif

#endif
