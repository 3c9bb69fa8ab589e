/*
 * nfr: draws glyphs as their hints would have them, from small models in the font, with no bytecode interpreter.
 *
 * Pointers. Unless a comment says otherwise, a pointer must not be NULL, and must be valid for the call only. NULL where
 * none may be is the status NFR_NULL_POINTER, or 0 from functions without a status: no function crashes for it. A pointer
 * that is neither NULL nor valid cannot be noticed. Pointers that receive a result may point to uninitialised memory, and
 * keep what they point to if the call fails unless a comment says otherwise.
 *
 * Threads. A font may be used by all threads at the same time, a rasterizer by one at a time. Fonts and rasterizers may
 * be freed on any thread, once nothing else uses them. nfr_last_error is the calling thread's own.
 *
 * Files are not trusted: a damaged font is a status. No function throws, and none ends the process, unless memory
 * cannot be allocated.
 *
 * Made by cbindgen from the Rust sources of nfr-capi; do not edit. After a change of these:
 *     NFR_WRITE_HEADER=1 cargo test -p nfr-capi --test header
 */

#ifndef NFR_H
#define NFR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// What a call came to. Later releases may add values, and keep the numbers of these.
typedef enum {
    // Done.
    NFR_OK = 0,
    // A pointer is NULL that must not be.
    NFR_NULL_POINTER = 1,
    // A number is none of those that the argument may have.
    NFR_INVALID_ARGUMENT = 2,
    // The bytes are no OpenType font.
    NFR_NOT_A_FONT = 3,
    // The file has no font with this index.
    NFR_NO_SUCH_FONT = 4,
    // A table of the font, or its table of models, is missing or damaged.
    NFR_DAMAGED_FONT = 5,
    // The font has no models: it was not converted.
    NFR_NO_MODELS = 6,
    // The models have a format that this release does not read.
    NFR_UNKNOWN_VERSION = 7,
    // The font was changed after its models were made: glyphs were renumbered, or this glyph's outline or advance width
    // is another one.
    NFR_STALE = 8,
    // The glyph's model or outline is damaged.
    NFR_DAMAGED_GLYPH = 9,
    // The font has no glyph with this number.
    NFR_NO_SUCH_GLYPH = 10,
    // The font has this glyph, but no model of it. See nfr_rasterizer_set_missing_model.
    NFR_MISSING_MODEL = 11,
    // The size is not above 0 and at most 2048 pixels per em.
    NFR_INVALID_SIZE = 12,
    // The subpixel offset is not a number, or beyond 1024 pixels.
    NFR_INVALID_OFFSET = 13,
    // The buffer does not hold the bitmap: the placement tells its size.
    NFR_BUFFER_TOO_SMALL = 14,
    // The glyph asks for more than the limits allow. See nfr_rasterizer_set_limits.
    NFR_LIMIT = 15,
    // A network draws this glyph, and this build has no networks or the network does not draw this size or offset.
    NFR_UNSUPPORTED = 16,
    // A defect of this library. Free the rasterizer of the call, if there is one: what it holds is in doubt.
    NFR_INTERNAL = 17,
} nfr_status;

// What a font's models were made for.
typedef enum {
    // None that this release knows, or no font.
    NFR_TARGET_UNKNOWN = 0,
    // Hinting in y, for grey antialiasing (FT_LOAD_TARGET_NORMAL).
    NFR_TARGET_SMOOTH = 1,
    // Hinting in x and y, drawn with grey coverage (FT_LOAD_TARGET_MONO).
    NFR_TARGET_MONO = 2,
    // Hinting for horizontal subpixels, drawn with grey coverage (FT_LOAD_TARGET_LCD).
    NFR_TARGET_LCD = 3,
} nfr_target;

// What is drawn for a glyph that the font has, but no model of. A damaged model is an error in any case.
typedef enum {
    // Nothing, and the call returns NFR_MISSING_MODEL, so that the application draws the glyph by other means.
    NFR_MISSING_MODEL_ERROR = 0,
    // An empty bitmap.
    NFR_MISSING_MODEL_BLANK = 1,
    // The glyph's plain outline, without hinting.
    NFR_MISSING_MODEL_OUTLINE = 2,
} nfr_missing_model;

// A font with models. Threads may use one font at the same time.
typedef struct nfr_font nfr_font;

// Draws the glyphs of a font. It keeps decoded models and its working memory. One thread at a time may use it; each
// thread may have its own for the same font.
typedef struct nfr_rasterizer nfr_rasterizer;

// Tells an application that its bytes are not used any more. `user` is what it gave with them. It must not throw.
typedef void (*nfr_release)(void *user);

// Metrics of a line of horizontal text in pixels, y up, linear in the size.
typedef struct {
    // From the baseline up to the top of the line.
    float ascent;
    // From the baseline up to the bottom of the line, which is below: negative in most fonts.
    float descent;
    // What is left free between two lines. Baselines are ascent - descent + line_gap apart.
    float line_gap;
    // From the baseline up to the top of the underline: negative in most fonts.
    float underline_position;
    // The underline's thickness.
    float underline_thickness;
} nfr_line_metrics;

// What drawing a glyph may take, whatever the font file asks for. Begin with nfr_limits_default.
typedef struct {
    // The longest side of a bitmap in pixels: 8192, which is also the most.
    uint32_t bitmap_side;
    // The memory that a decoded glyph may take, in bytes: 8 MiB. While a model is decoded, up to 1 MiB more is taken for
    // a moment.
    size_t decoded_bytes;
    // The steps that drawing a glyph may take: 2^28, some tenths of a second. Text takes some thousands a glyph.
    uint64_t work;
} nfr_limits;

// Where a bitmap lies relative to the glyph's origin, in pixels.
typedef struct {
    // From the origin to the left edge of the left column (FreeType's bitmap_left).
    int32_t left;
    // From the baseline up to the top edge of the top row (FreeType's bitmap_top).
    int32_t top;
    // Columns; 0 for a glyph without ink.
    uint32_t width;
    // Rows; 0 for a glyph without ink.
    uint32_t height;
} nfr_placement;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// Why the last call on this thread failed that returned a status: one sentence in UTF-8, for people; empty before the
// first failure. A call that succeeds does not change it.
//
// Never NULL. The text is valid until the next call on this thread that fails, and until the thread ends.
const char *nfr_last_error(void);

// The version of the library, as "0.1.0". Never NULL, valid always.
const char *nfr_version(void);

// Opens a font from a copy of a file's bytes. `index` counts the fonts of a collection and is 0 for a plain font.
//
// data: `len` bytes to read in this call. font: receives the font, to be freed with nfr_font_free, or NULL on failure.
nfr_status nfr_font_new(const uint8_t *data,
                        size_t len,
                        uint32_t index,
                        nfr_font **font);

// Opens a font from bytes that stay where they are, as in flash memory or a mapped file: nothing is copied.
//
// data: `len` bytes that must stay readable and unchanged until `release` is called; without one, until the font and all
// rasterizers of it are freed. release: called with `user` exactly once, and in this call if it fails, for whatever
// reason; on the thread that frees the last of the font and its rasterizers. It may be NULL. font: as in nfr_font_new.
nfr_status nfr_font_new_borrowed(const uint8_t *data,
                                 size_t len,
                                 uint32_t index,
                                 nfr_release release,
                                 void *user,
                                 nfr_font **font);

// Frees a font. Its rasterizers stay valid.
//
// font: from nfr_font_new or nfr_font_new_borrowed and not freed yet, or NULL, which does nothing.
void nfr_font_free(nfr_font *font);

// The number of glyphs in the font, with a model or without; 0 if font is NULL.
uint32_t nfr_font_glyph_count(const nfr_font *font);

// Font units in an em; 0 if font is NULL.
uint16_t nfr_font_units_per_em(const nfr_font *font);

// What the models were made for; NFR_TARGET_UNKNOWN if font is NULL.
nfr_target nfr_font_target(const nfr_font *font);

// The models know every whole size from `first` to `last`, in pixels per em; glyphs that a network draws, some of them.
//
// font: a font. first, last: receive the sizes; either may be NULL.
nfr_status nfr_font_ppem_range(const nfr_font *font,
                               uint16_t *first,
                               uint16_t *last);

// Whether a glyph has a model; false if font is NULL.
bool nfr_font_has_model(const nfr_font *font, uint32_t glyph);

// Whether the glyphs that have models have no outlines in this font, so that no other renderer draws them; false if font
// is NULL.
bool nfr_font_outlines_dropped(const nfr_font *font);

// The glyph of a Unicode code point; 0, the glyph for what is missing, if the font has none or font is NULL.
uint32_t nfr_font_glyph_for_char(const nfr_font *font, uint32_t code_point);

// The glyph of a code point with a variation selector behind it, U+FE00-FE0F or U+E0100-E01EF; 0 if the font does not
// list them or font is NULL. nfr_font_glyph_for_char has the glyph then, and nothing is drawn for the selector.
uint32_t nfr_font_glyph_for_variation(const nfr_font *font,
                                      uint32_t code_point,
                                      uint32_t selector);

// The advance width in pixels, linear in the size; 0 for a glyph that the font does not have, and if font is NULL.
float nfr_font_advance(const nfr_font *font,
                       uint32_t glyph,
                       float ppem);

// Metrics of a line of text at a size in pixels per em.
//
// font: a font. metrics: receives them.
nfr_status nfr_font_line_metrics(const nfr_font *font, float ppem, nfr_line_metrics *metrics);

// A rasterizer with a cache of 8 MiB and the default limits, for which a glyph without a model is an error.
//
// font: a font, which may be freed before the rasterizer. rasterizer: receives it, to be freed with
// nfr_rasterizer_free, or NULL on failure.
nfr_status nfr_rasterizer_new(const nfr_font *font, nfr_rasterizer **rasterizer);

// Frees a rasterizer, and the pixels that it lends.
//
// rasterizer: from nfr_rasterizer_new and not freed yet, or NULL, which does nothing.
void nfr_rasterizer_free(nfr_rasterizer *rasterizer);

// Keeps decoded models of at most so many bytes, and always at least the last one. What is kept is dropped.
//
// rasterizer: a rasterizer.
nfr_status nfr_rasterizer_set_cache(nfr_rasterizer *rasterizer, size_t bytes);

// The default limits.
//
// limits: receives them.
nfr_status nfr_limits_default(nfr_limits *limits);

// Sets what drawing a glyph may take. What the cache keeps is dropped.
//
// rasterizer: a rasterizer. limits: read in this call.
nfr_status nfr_rasterizer_set_limits(nfr_rasterizer *rasterizer, const nfr_limits *limits);

// Chooses what is drawn for a glyph without a model: a value of nfr_missing_model, else NFR_INVALID_ARGUMENT.
//
// rasterizer: a rasterizer.
nfr_status nfr_rasterizer_set_missing_model(nfr_rasterizer *rasterizer, uint32_t missing);

// The hinted advance width in pixels: a whole number at the sizes of nfr_font_ppem_range, and nfr_font_advance at others
// and for glyphs whose models do not know it.
//
// rasterizer: a rasterizer. advance: receives the width.
nfr_status nfr_rasterizer_hinted_advance(nfr_rasterizer *rasterizer,
                                         uint32_t glyph,
                                         float ppem,
                                         float *advance);

// Where a glyph's bitmap lies, without drawing it. The size is in pixels per em and may be fractional; the offset moves
// the glyph by parts of a pixel, x to the right and y up, and is 0, 0 for text at whole pixels.
//
// rasterizer: a rasterizer. placement: receives it.
nfr_status nfr_rasterizer_placement(nfr_rasterizer *rasterizer,
                                    uint32_t glyph,
                                    float ppem,
                                    float offset_x,
                                    float offset_y,
                                    nfr_placement *placement);

// Draws a glyph into the application's memory: coverage 0-255, top row first, rows `stride` bytes apart. Bytes beside
// and behind the bitmap are left alone. Size and offset are as in nfr_rasterizer_placement.
//
// If it returns NFR_BUFFER_TOO_SMALL, nothing was drawn and the placement tells what is needed: a stride of at least
// width, and (height - 1) * stride + width bytes. A glyph without ink needs none.
//
// rasterizer: a rasterizer. pixels: `len` bytes to write in this call, or NULL if len is 0. placement: receives it.
nfr_status nfr_rasterizer_render_into(nfr_rasterizer *rasterizer,
                                      uint32_t glyph,
                                      float ppem,
                                      float offset_x,
                                      float offset_y,
                                      uint8_t *pixels,
                                      size_t len,
                                      size_t stride,
                                      nfr_placement *placement);

// Draws a glyph into memory of the rasterizer's, and lends it: placement.height rows of placement.width bytes, coverage
// 0-255, top row first. Size and offset are as in nfr_rasterizer_placement.
//
// rasterizer: a rasterizer. pixels: receives a pointer that is never NULL on success, and valid until the next call with
// this rasterizer. placement: receives it.
nfr_status nfr_rasterizer_draw(nfr_rasterizer *rasterizer,
                               uint32_t glyph,
                               float ppem,
                               float offset_x,
                               float offset_y,
                               const uint8_t **pixels,
                               nfr_placement *placement);

// Draws a glyph in black and white into memory of the rasterizer's, and lends it: placement.height rows of
// (placement.width + 7) / 8 bytes, one bit a pixel, top row first, the first pixel of a byte in its highest bit. Drop-out
// control fills the gaps of thin strokes as FreeType's FT_RENDER_MODE_MONO does. Size and offset are as in
// nfr_rasterizer_placement, whose box is that of coverage; this one may be smaller.
//
// rasterizer: a rasterizer. bits: receives a pointer that is never NULL on success, and valid until the next call with
// this rasterizer. placement: receives it.
nfr_status nfr_rasterizer_draw_mono(nfr_rasterizer *rasterizer,
                                    uint32_t glyph,
                                    float ppem,
                                    float offset_x,
                                    float offset_y,
                                    const uint8_t **bits,
                                    nfr_placement *placement);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* NFR_H */
