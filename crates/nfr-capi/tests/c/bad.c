/* bad FOLDER [STEP]: everything that a program or a font file can do wrong is a status. */
#include <math.h>

#include "common.h"

static int is_status(nfr_status status)
{
    return status >= NFR_OK && status < NFR_INTERNAL;
}

static void check_null(bytes file)
{
    nfr_font *font, *none_font;
    nfr_rasterizer *r = open_rasterizer(file, &font), *none;
    nfr_placement p;
    nfr_line_metrics m;
    nfr_limits limits;
    const unsigned char *lent;
    unsigned char pixel[1];
    float width;
    unsigned a = nfr_font_glyph_for_char(font, 'a');

    CHECK(nfr_font_new(NULL, 9, 0, &none_font) == NFR_NULL_POINTER && !none_font);
    CHECK(nfr_font_new(NULL, 0, 0, &none_font) == NFR_NULL_POINTER);
    CHECK(nfr_font_new(file.data, file.len, 0, NULL) == NFR_NULL_POINTER);
    CHECK(strcmp(nfr_last_error(), "the argument font is NULL") == 0);
    CHECK(nfr_font_new(file.data, (size_t)-1, 0, &none_font) == NFR_INVALID_ARGUMENT && !none_font);
    CHECK(nfr_rasterizer_new(NULL, &none) == NFR_NULL_POINTER && !none);
    CHECK(nfr_rasterizer_new(font, NULL) == NFR_NULL_POINTER);
    CHECK(nfr_font_glyph_count(NULL) == 0 && nfr_font_units_per_em(NULL) == 0);
    CHECK(nfr_font_target(NULL) == NFR_TARGET_UNKNOWN && nfr_font_target(font) == NFR_TARGET_SMOOTH);
    CHECK(!nfr_font_has_model(NULL, 1) && !nfr_font_outlines_dropped(NULL));
    CHECK(nfr_font_glyph_for_char(NULL, 'a') == 0 && nfr_font_glyph_for_variation(NULL, 'a', 0xFE00) == 0);
    CHECK(nfr_font_glyph_for_char(font, 0xD800) == 0 && nfr_font_glyph_for_char(font, 0xFFFFFFFF) == 0);
    CHECK(nfr_font_glyph_for_variation(font, 'a', 0xFFFFFFFF) == 0 && !nfr_font_has_model(font, 0xFFFFFFFF));
    CHECK(nfr_font_advance(NULL, a, 16) == 0 && nfr_font_advance(font, 0xFFFFFFFF, 16) == 0);
    CHECK(nfr_font_ppem_range(NULL, NULL, NULL) == NFR_NULL_POINTER);
    CHECK(nfr_font_ppem_range(font, NULL, NULL) == NFR_OK);
    CHECK(nfr_font_line_metrics(NULL, 16, &m) == NFR_NULL_POINTER);
    CHECK(nfr_font_line_metrics(font, 16, NULL) == NFR_NULL_POINTER);
    CHECK(nfr_font_line_metrics(font, NAN, &m) == NFR_INVALID_SIZE);
    CHECK(nfr_font_line_metrics(font, 16, &m) == NFR_OK && m.ascent > 12 && m.descent < -2);
    CHECK(nfr_limits_default(NULL) == NFR_NULL_POINTER && nfr_limits_default(&limits) == NFR_OK);
    CHECK(nfr_rasterizer_set_limits(NULL, &limits) == NFR_NULL_POINTER);
    CHECK(nfr_rasterizer_set_limits(r, NULL) == NFR_NULL_POINTER);
    CHECK(nfr_rasterizer_set_cache(NULL, 1) == NFR_NULL_POINTER);
    CHECK(nfr_rasterizer_set_missing_model(NULL, NFR_MISSING_MODEL_BLANK) == NFR_NULL_POINTER);
    CHECK(nfr_rasterizer_set_missing_model(r, 99) == NFR_INVALID_ARGUMENT);
    CHECK(nfr_rasterizer_hinted_advance(NULL, a, 16, &width) == NFR_NULL_POINTER);
    CHECK(nfr_rasterizer_hinted_advance(r, a, 16, NULL) == NFR_NULL_POINTER);
    CHECK(nfr_rasterizer_hinted_advance(r, a, -1, &width) == NFR_INVALID_SIZE);
    CHECK(nfr_rasterizer_placement(NULL, a, 16, 0, 0, &p) == NFR_NULL_POINTER);
    CHECK(nfr_rasterizer_placement(r, a, 16, 0, 0, NULL) == NFR_NULL_POINTER);
    CHECK(nfr_rasterizer_draw(NULL, a, 16, 0, 0, &lent, &p) == NFR_NULL_POINTER);
    CHECK(nfr_rasterizer_draw(r, a, 16, 0, 0, NULL, &p) == NFR_NULL_POINTER);
    CHECK(nfr_rasterizer_draw(r, a, 16, 0, 0, &lent, NULL) == NFR_NULL_POINTER);
    CHECK(nfr_rasterizer_draw_mono(NULL, a, 16, 0, 0, &lent, &p) == NFR_NULL_POINTER);
    CHECK(nfr_rasterizer_draw_mono(r, a, 16, 0, 0, NULL, &p) == NFR_NULL_POINTER);
    CHECK(nfr_rasterizer_draw_mono(r, a, 16, 0, 0, &lent, NULL) == NFR_NULL_POINTER);
    CHECK(nfr_rasterizer_draw_mono(r, a, 16, NAN, 0, &lent, &p) == NFR_INVALID_OFFSET);
    CHECK(nfr_rasterizer_render_into(NULL, a, 16, 0, 0, pixel, 1, 1, &p) == NFR_NULL_POINTER);
    CHECK(nfr_rasterizer_render_into(r, a, 16, 0, 0, NULL, 1, 1, &p) == NFR_NULL_POINTER);
    CHECK(nfr_rasterizer_render_into(r, a, 16, 0, 0, pixel, 1, 1, NULL) == NFR_NULL_POINTER);
    CHECK(nfr_rasterizer_render_into(r, a, 16, 0, 0, pixel, (size_t)-1, 1, &p) == NFR_INVALID_ARGUMENT);
    CHECK(nfr_rasterizer_placement(r, a, 0, 0, 0, &p) == NFR_INVALID_SIZE);
    CHECK(nfr_rasterizer_placement(r, a, INFINITY, 0, 0, &p) == NFR_INVALID_SIZE);
    CHECK(nfr_rasterizer_placement(r, a, 16, NAN, 0, &p) == NFR_INVALID_OFFSET);
    CHECK(nfr_rasterizer_placement(r, a, 16, 0, 1e9f, &p) == NFR_INVALID_OFFSET);
    CHECK(nfr_rasterizer_placement(r, 0xFFFFFFFF, 16, 0, 0, &p) == NFR_NO_SUCH_GLYPH);
    /* A space needs no room. */
    CHECK(nfr_rasterizer_render_into(r, nfr_font_glyph_for_char(font, ' '), 16, 0, 0, NULL, 0, 0, &p) == NFR_OK);
    CHECK(p.width == 0 && p.height == 0);
    nfr_rasterizer_free(NULL);
    nfr_font_free(NULL);
    /* In any order. */
    nfr_font_free(font);
    CHECK(nfr_rasterizer_draw(r, a, 16, 0, 0, &lent, &p) == NFR_OK);
    nfr_rasterizer_free(r);
}

/* Opens and draws whatever it is; returns the status of the first failure. */
static nfr_status draw_some(const unsigned char *data, size_t len)
{
    nfr_font *font;
    nfr_rasterizer *r;
    nfr_placement p;
    const unsigned char *lent;
    float width;
    nfr_status status = nfr_font_new_borrowed(data, len, 0, NULL, NULL, &font), first = status;
    unsigned c;

    CHECK(is_status(status));
    if (status != NFR_OK)
        return status;
    CHECK(nfr_rasterizer_new(font, &r) == NFR_OK);
    for (c = ' '; c <= '~'; c++) {
        unsigned glyph = nfr_font_glyph_for_char(font, c);
        status = nfr_rasterizer_draw(r, glyph, c % 2 ? 11.0f : 50.0f, 0, 0, &lent, &p);
        CHECK(is_status(status) && is_status(nfr_rasterizer_hinted_advance(r, glyph, 16, &width)));
        if (status == NFR_OK)
            (void)hash_of(lent, (size_t)p.width * p.height);
        else if (first == NFR_OK)
            first = status;
        status = nfr_rasterizer_draw_mono(r, glyph, c % 2 ? 11.0f : 50.0f, 0, 0, &lent, &p);
        CHECK(is_status(status));
        if (status == NFR_OK)
            (void)hash_of(lent, (size_t)(p.width + 7) / 8 * p.height);
    }
    nfr_rasterizer_free(r);
    nfr_font_free(font);
    return first;
}

static size_t table(bytes file, const char *tag, size_t *len)
{
    unsigned i, count = file.data[4] * 256u + file.data[5];

    for (i = 0; i < count; i++) {
        const unsigned char *at = file.data + 12 + 16 * i;
        if (memcmp(at, tag, 4) == 0) {
            *len = (size_t)at[12] << 24 | (size_t)at[13] << 16 | (size_t)at[14] << 8 | at[15];
            return (size_t)at[8] << 24 | (size_t)at[9] << 16 | (size_t)at[10] << 8 | at[11];
        }
    }
    CHECK(!"the table is there");
    return 0;
}

static void check_damage(bytes file, unsigned step)
{
    size_t len, start = table(file, "Nfrt", &len), i, opened = 0, failed = 0;
    unsigned char *cut;

    /* The directory, and the models. */
    for (i = 0; i < 400 + len; i += step) {
        size_t at = i < 400 ? i : start + i - 400;
        unsigned char before = file.data[at];
        file.data[at] = (unsigned char)(before ^ (1u << (i % 8)) ^ (i % 3 ? 0 : 0xFF));
        if (draw_some(file.data, file.len) == NFR_OK)
            opened++;
        else
            failed++;
        file.data[at] = before;
    }
    CHECK(failed > 0);
    /* Truncated, each in memory of just that length. */
    for (i = 1; i < file.len; i += file.len / 60) {
        cut = (unsigned char *)malloc(i);
        CHECK(cut);
        memcpy(cut, file.data, i);
        CHECK(draw_some(cut, i) != NFR_INTERNAL);
        free(cut);
    }
    CHECK(draw_some(file.data, 0) == NFR_NOT_A_FONT);
    CHECK(draw_some(file.data, file.len) == NFR_OK);
    printf("bad: of %lu damaged fonts %lu did not draw\n", (unsigned long)(opened + failed), (unsigned long)failed);
}

int main(int argc, char **argv)
{
    static const struct {
        const char *name;
        nfr_status status;
    } fonts[] = {{"sans.ttf", NFR_OK},           {"plain.ttf", NFR_NO_MODELS},       {"stale.ttf", NFR_STALE},
                 {"damaged.ttf", NFR_DAMAGED_GLYPH}, {"partial.ttf", NFR_MISSING_MODEL}};
    size_t i;
    bytes file;

    CHECK(argc >= 2 && nfr_last_error()[0] == 0 && nfr_version()[0]);
    for (i = 0; i < sizeof fonts / sizeof fonts[0]; i++) {
        file = read_file(argv[1], fonts[i].name);
        CHECK(draw_some(file.data, file.len) == fonts[i].status);
        CHECK(fonts[i].status == NFR_OK || nfr_last_error()[0]);
        free(file.data);
    }
    file = read_file(argv[1], "sans.ttf");
    check_null(file);
    check_damage(file, argc > 2 ? (unsigned)atoi(argv[2]) : 1);
    free(file.data);
    return 0;
}
