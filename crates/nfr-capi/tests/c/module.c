/* module FOLDER [quick]: FreeType with the module, beside the library and beside FreeType without it. */
#include "module.h"

/* All that a model draws is the library's, however the glyph is loaded with hinting. */
static void check_pixels(bytes sans, int step)
{
    static const FT_Int32 loads[] = {FT_LOAD_DEFAULT,     FT_LOAD_TARGET_LIGHT, FT_LOAD_FORCE_AUTOHINT,
                                     FT_LOAD_NO_AUTOHINT, FT_LOAD_TARGET_MONO,  FT_LOAD_TARGET_LCD};
    FT_Library library = library_with(1);
    FT_Face face = face_of(library, sans);
    nfr_font *font;
    nfr_rasterizer *rasterizer = open_rasterizer(sans, &font);
    const char *message;
    unsigned long compared = 0;
    float advance;
    int ppem, c, version[3];
    size_t i;

    CHECK(nfr_freetype_add(library) == 0 && nfr_freetype_add(NULL) != 0);
    CHECK(nfr_freetype_status(face, &message) == NFR_NO_MODELS && nfr_freetype_status(NULL, NULL) == NFR_NO_MODELS);
    for (ppem = 8; ppem <= 66; ppem += step) {
        CHECK(FT_Set_Char_Size(face, 0, ppem * 64 + (ppem % 3 == 2 ? 16 : 0), 72, 72) == 0);
        for (c = ' '; c <= '~'; c++) {
            float size = (float)ppem + (ppem % 3 == 2 ? 0.25f : 0.0f);
            i = (size_t)(c + ppem) % (sizeof loads / sizeof loads[0]);
            CHECK(FT_Load_Char(face, (FT_ULong)c, loads[i]) == 0);
            CHECK(FT_Render_Glyph(face->glyph, i % 2 ? FT_RENDER_MODE_LIGHT : FT_RENDER_MODE_NORMAL) == 0);
            CHECK(is_ours(face->glyph, rasterizer, size, 0, 0));
            CHECK(nfr_rasterizer_hinted_advance(rasterizer, face->glyph->glyph_index, size, &advance) == NFR_OK);
            CHECK(face->glyph->advance.x == (FT_Pos)(advance + 0.5f) * 64);
            CHECK(face->glyph->metrics.horiAdvance == face->glyph->advance.x);
            compared++;
        }
    }
    CHECK(nfr_freetype_status(face, &message) == NFR_OK && message[0] == 0);
    FT_Library_Version(library, &version[0], &version[1], &version[2]);
    printf("FreeType %d.%d.%d: %lu bitmaps, 0 differ\n", version[0], version[1], version[2], compared);
    nfr_rasterizer_free(rasterizer);
    nfr_font_free(font);
    FT_Done_Face(face);
    FT_Done_FreeType(library);
}

static void check_moves(bytes sans)
{
    FT_Library library = library_with(1);
    FT_Face face = face_of(library, sans);
    FT_Vector delta = {16, 40};
    nfr_font *font;
    nfr_rasterizer *rasterizer = open_rasterizer(sans, &font);
    FT_Pos x;

    for (x = -200; x < 200; x += 24) {
        CHECK(FT_Load_Char(face, 'g', FT_LOAD_DEFAULT) == 0);
        FT_Outline_Translate(&face->glyph->outline, x, 0);
        CHECK(FT_Render_Glyph(face->glyph, FT_RENDER_MODE_NORMAL) == 0);
        face->glyph->bitmap_left -= (FT_Int)((x - (x & 63)) / 64);
        CHECK(is_ours(face->glyph, rasterizer, 14, (float)(x & 63) / 64.0f, 0));
    }
    FT_Set_Transform(face, NULL, &delta);
    CHECK(FT_Load_Char(face, 'g', NORMAL) == 0 && is_ours(face->glyph, rasterizer, 14, 0.25f, 0.625f));
    CHECK(FT_Load_Char(face, 'g', NORMAL | FT_LOAD_IGNORE_TRANSFORM) == 0 && is_ours(face->glyph, rasterizer, 14, 0, 0));
    nfr_rasterizer_free(rasterizer);
    nfr_font_free(font);
    FT_Done_FreeType(library);
}

/* Without an outline a glyph is drawn from its model, unless a transformation is asked for: FreeType draws nothing then. */
static void check_dropped(bytes dropped)
{
    FT_Library library = library_with(1);
    FT_Face face = face_of(library, dropped);
    FT_Matrix slant = {0x10000L, 0x3000L, 0, 0x10000L};
    nfr_font *font;
    nfr_rasterizer *rasterizer = open_rasterizer(dropped, &font);

    CHECK(nfr_font_outlines_dropped(font));
    CHECK(FT_Load_Char(face, 'a', NORMAL) == 0 && is_ours(face->glyph, rasterizer, 14, 0, 0));
    CHECK(face->glyph->bitmap.width > 4);
    FT_Set_Transform(face, &slant, NULL);
    CHECK(FT_Load_Char(face, 'a', NORMAL) == 0 && face->glyph->bitmap.width == 0);
    nfr_rasterizer_free(rasterizer);
    nfr_font_free(font);
    FT_Done_FreeType(library);
}

/* Loads and renders in some way; the number of ways is WAYS. */
#define WAYS 12
static void render_in_way(FT_Face face, FT_ULong c, int way)
{
    FT_GlyphSlot slot = face->glyph;
    FT_Matrix slant = {0x10000L, 0x3000L, 0, 0x10000L};
    FT_Int32 flags = FT_LOAD_DEFAULT;
    FT_Render_Mode mode = FT_RENDER_MODE_NORMAL;

    if (way == 1) flags = FT_LOAD_NO_HINTING;
    if (way == 2) mode = FT_RENDER_MODE_LCD;
    if (way == 3) mode = FT_RENDER_MODE_MONO;
    if (way == 4) FT_Set_Transform(face, &slant, NULL);
    if (way == 5) CHECK(FT_Set_Char_Size(face, 14 * 64, 20 * 64, 72, 72) == 0);
    CHECK(FT_Load_Char(face, c, flags) == 0);
    if (way == 6) FT_GlyphSlot_Embolden(slot);
    if (way == 7) FT_GlyphSlot_Oblique(slot);
    if (way == 8) FT_Outline_Embolden(&slot->outline, 4);
    if (way == 9) FT_Outline_Transform(&slot->outline, &slant);
    if (way == 10 && slot->outline.n_points) slot->outline.points[0].x++;
    if (way == 11) CHECK(FT_Set_Pixel_Sizes(face, 0, 15) == 0);
    CHECK(FT_Render_Glyph(slot, mode) == 0);
    FT_Set_Transform(face, NULL, NULL);
    CHECK(FT_Set_Pixel_Sizes(face, 0, 14) == 0);
}

/* What nfr does not draw is drawn as without the module, to the last bit. `way` 0 alone is drawn where it has models. */
static void check_fallback(bytes file, const char *text, int first, nfr_status status)
{
    FT_Library with = library_with(1), without = library_with(0);
    FT_Face a = face_of(with, file), b = face_of(without, file);
    const char *message;
    int way;
    size_t i;

    for (way = first; way < WAYS; way++) {
        for (i = 0; text[i]; i++) {
            render_in_way(a, (FT_ULong)text[i], way);
            render_in_way(b, (FT_ULong)text[i], way);
            CHECK(same_bitmap(a->glyph, b->glyph));
            CHECK(a->glyph->advance.x == b->glyph->advance.x);
            CHECK(memcmp(&a->glyph->metrics, &b->glyph->metrics, sizeof a->glyph->metrics) == 0);
            CHECK(a->glyph->outline.n_points == b->glyph->outline.n_points);
        }
    }
    CHECK(nfr_freetype_status(a, &message) == status && (message[0] != 0) == (status != NFR_OK && status != NFR_NO_MODELS));
    FT_Done_Face(a);
    FT_Done_Face(b);
    FT_Done_FreeType(with);
    FT_Done_FreeType(without);
}

/* FreeType's other ways to a bitmap. */
static void check_glyphs(bytes sans)
{
    FT_Library with = library_with(1), without = library_with(0);
    FT_Face a = face_of(with, sans), b = face_of(without, sans);
    FT_Glyph glyphs[2], copy;
    FT_BitmapGlyph bitmaps[2];
    nfr_font *font;
    nfr_rasterizer *rasterizer = open_rasterizer(sans, &font);
    unsigned char kept[1024];

    /* An outline glyph becomes a bitmap without its face: by FreeType's own renderer. */
    CHECK(FT_Load_Char(a, 'g', 0) == 0 && FT_Get_Glyph(a->glyph, &glyphs[0]) == 0);
    CHECK(FT_Load_Char(b, 'g', 0) == 0 && FT_Get_Glyph(b->glyph, &glyphs[1]) == 0);
    CHECK(FT_Glyph_To_Bitmap(&glyphs[0], FT_RENDER_MODE_NORMAL, NULL, 1) == 0);
    CHECK(FT_Glyph_To_Bitmap(&glyphs[1], FT_RENDER_MODE_NORMAL, NULL, 1) == 0);
    bitmaps[0] = (FT_BitmapGlyph)glyphs[0];
    bitmaps[1] = (FT_BitmapGlyph)glyphs[1];
    CHECK(bitmaps[0]->bitmap.rows == bitmaps[1]->bitmap.rows && bitmaps[0]->left == bitmaps[1]->left);
    CHECK(memcmp(bitmaps[0]->bitmap.buffer, bitmaps[1]->bitmap.buffer,
                 bitmaps[0]->bitmap.rows * (size_t)bitmaps[0]->bitmap.pitch) == 0);
    FT_Done_Glyph(glyphs[0]);
    FT_Done_Glyph(glyphs[1]);
    /* A rendered glyph is taken out of the slot with our pixels, and outlives the slot's next one. */
    CHECK(FT_Load_Char(a, 'g', NORMAL) == 0 && is_ours(a->glyph, rasterizer, 14, 0, 0));
    CHECK(a->glyph->bitmap.rows * (size_t)a->glyph->bitmap.pitch <= sizeof kept);
    memcpy(kept, a->glyph->bitmap.buffer, a->glyph->bitmap.rows * (size_t)a->glyph->bitmap.pitch);
    CHECK(FT_Get_Glyph(a->glyph, &glyphs[0]) == 0 && FT_Glyph_Copy(glyphs[0], &copy) == 0);
    CHECK(FT_Load_Char(a, 'a', NORMAL) == 0 && is_ours(a->glyph, rasterizer, 14, 0, 0));
    bitmaps[0] = (FT_BitmapGlyph)copy;
    CHECK(memcmp(bitmaps[0]->bitmap.buffer, kept, bitmaps[0]->bitmap.rows * (size_t)bitmaps[0]->bitmap.pitch) == 0);
    FT_Done_Glyph(copy);
    FT_Done_Glyph(glyphs[0]);
    /* A slot whose bitmap is FreeType's, which a program turns back into an outline. */
    CHECK(FT_Load_Char(a, 'g', 0) == 0 && FT_Render_Glyph(a->glyph, FT_RENDER_MODE_LCD) == 0);
    a->glyph->format = FT_GLYPH_FORMAT_OUTLINE;
    CHECK(FT_Render_Glyph(a->glyph, FT_RENDER_MODE_NORMAL) == 0 && is_ours(a->glyph, rasterizer, 14, 0, 0));
    a->glyph->format = FT_GLYPH_FORMAT_OUTLINE;
    CHECK(FT_Render_Glyph(a->glyph, FT_RENDER_MODE_LCD) == 0 && a->glyph->bitmap.pixel_mode == FT_PIXEL_MODE_LCD);
    nfr_rasterizer_free(rasterizer);
    nfr_font_free(font);
    FT_Done_FreeType(with);
    FT_Done_FreeType(without);
}

/* A font for black and white: its hinting is drawn grey, black and white itself is FreeType's. */
static void check_mono(bytes mono)
{
    FT_Library library = library_with(1);
    FT_Face face = face_of(library, mono);
    nfr_font *font;
    nfr_rasterizer *rasterizer = open_rasterizer(mono, &font);
    int c;

    for (c = ' '; c <= '~'; c++) {
        CHECK(FT_Load_Char(face, (FT_ULong)c, FT_LOAD_TARGET_MONO) == 0);
        CHECK(FT_Render_Glyph(face->glyph, FT_RENDER_MODE_NORMAL) == 0 && is_ours(face->glyph, rasterizer, 14, 0, 0));
        CHECK(FT_Load_Char(face, (FT_ULong)c, FT_LOAD_TARGET_MONO | FT_LOAD_RENDER) == 0);
        CHECK(face->glyph->bitmap.pixel_mode == FT_PIXEL_MODE_MONO);
    }
    nfr_rasterizer_free(rasterizer);
    nfr_font_free(font);
    FT_Done_FreeType(library);
}

/* Whatever is wrong with the models, FreeType draws. */
static void check_damage(bytes sans, size_t step)
{
    FT_Library library = library_with(1);
    size_t at, drawn = 0;

    for (at = 12; at < sans.len; at += step) {
        unsigned char before = sans.data[at];
        FT_Face face;
        sans.data[at] ^= (unsigned char)(1u << at % 8 | 1u << at % 5);
        if (FT_New_Memory_Face(library, sans.data, (FT_Long)sans.len, 0, &face) == 0) {
            if (FT_Set_Pixel_Sizes(face, 0, 14) == 0)
                drawn += FT_Load_Char(face, 'a', NORMAL) == 0 && FT_Load_Char(face, 'R', NORMAL) == 0;
            CHECK(nfr_freetype_status(face, NULL) < NFR_INTERNAL);
            FT_Done_Face(face);
        }
        sans.data[at] = before;
    }
    CHECK(drawn > 0);
    FT_Done_FreeType(library);
}

int main(int argc, char **argv)
{
    const char *folder = argv[argc > 1 ? 1 : 0];
    int quick = argc > 2;
    bytes sans = read_file(folder, "sans.ttf"), other = read_file(folder, "other.ttf");
    bytes plain = read_file(folder, "plain.ttf"), partial = read_file(folder, "partial.ttf");
    bytes stale = read_file(folder, "stale.ttf"), damaged = read_file(folder, "damaged.ttf");
    bytes mono = read_file(folder, "mono.ttf"), dropped = read_file(folder, "dropped.ttf");

    check_pixels(sans, quick ? 13 : 1);
    check_moves(sans);
    check_dropped(dropped);
    check_fallback(sans, "gRi", 1, NFR_OK);
    check_fallback(partial, "Q&", 0, NFR_OK);
    check_fallback(other, "gR", 0, NFR_NO_MODELS);
    check_fallback(plain, "gR", 0, NFR_NO_MODELS);
    check_fallback(stale, "a", 0, NFR_STALE);
    check_fallback(damaged, "a", 0, NFR_DAMAGED_GLYPH);
    check_glyphs(sans);
    check_mono(mono);
    check_fallback(mono, "gR", 1, NFR_OK);
    check_damage(sans, sans.len / (quick ? 30 : 2000));
    check_lifetimes(sans, other, folder);
    check_threads(sans);
    free(sans.data), free(other.data), free(plain.data), free(partial.data), free(stale.data), free(damaged.data);
    free(mono.data), free(dropped.data);
    return 0;
}
