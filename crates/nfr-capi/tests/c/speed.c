/* speed FOLDER: microseconds a glyph, the best of many rounds over ASCII at 16 pixels per em. */
#include "module.h"

#include <time.h>

#define ROUNDS 200

static double now(void)
{
    struct timespec time;

    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec * 1e6 + (double)time.tv_nsec / 1e3;
}

static double of_library(bytes sans)
{
    static unsigned char pixels[4096];
    unsigned glyphs[95], c;
    nfr_font *font;
    nfr_rasterizer *rasterizer = open_rasterizer(sans, &font);
    nfr_placement p;
    double best = 1e9, from;
    int round;

    for (c = 0; c < 95; c++)
        glyphs[c] = nfr_font_glyph_for_char(font, ' ' + c);
    for (round = 0; round < 10 * ROUNDS; round++) {
        from = now();
        for (c = 0; c < 95; c++)
            CHECK(nfr_rasterizer_render_into(rasterizer, glyphs[c], 16, 0, 0, pixels, sizeof pixels, 64, &p) == NFR_OK);
        from = now() - from;
        best = from < best ? from : best;
    }
    nfr_rasterizer_free(rasterizer);
    nfr_font_free(font);
    return best / 95;
}

static double of_freetype(bytes file, int module)
{
    FT_Library library = library_with(module);
    FT_Face face = face_of(library, file);
    double best = 1e9, from;
    FT_ULong c;
    int round;

    CHECK(FT_Set_Pixel_Sizes(face, 0, 16) == 0);
    for (round = 0; round < ROUNDS; round++) {
        from = now();
        for (c = ' '; c <= '~'; c++)
            CHECK(FT_Load_Char(face, c, NORMAL) == 0);
        from = now() - from;
        best = from < best ? from : best;
    }
    FT_Done_FreeType(library);
    return best / 95;
}

int main(int argc, char **argv)
{
    const char *folder = argv[argc > 1 ? 1 : 0];
    bytes sans = read_file(folder, "sans.ttf"), plain = read_file(folder, "plain.ttf");

    printf("through C: %.2f us\n", of_library(sans));
    printf("FreeType with the module: %.2f us\n", of_freetype(sans, 1));
    printf("FreeType alone, autohinted: %.2f us; the original with its hint programs: %.2f us\n", of_freetype(sans, 0),
           of_freetype(plain, 0));
    free(sans.data);
    free(plain.data);
    return 0;
}
