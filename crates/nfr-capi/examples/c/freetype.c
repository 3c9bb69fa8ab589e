/*
 * A line at 9 to 16 pixels per em, three times: by FreeType with the module, by FreeType alone (autohinted, since a converted
 * font has no hint programs), and by FreeType without hinting: freetype FONT OUT.pgm [TEXT].
 *
 *     cc freetype.c nfr_freetype.c $(pkg-config --cflags --libs nfr freetype2) -o freetype
 */
#include <stdio.h>
#include <stdlib.h>

#include "nfr_freetype.h"

#define WIDTH 440
#define FIRST 9
#define LAST 16
#define LINE 20
#define HEIGHT ((LAST - FIRST + 1) * 3 * LINE + 8)
/* Each pixel of the text is so many pixels of the picture wide and high. */
#define ZOOM 3

static unsigned char canvas[HEIGHT][WIDTH];

/* Black on white. */
static void put(const FT_GlyphSlot slot, int x, int y)
{
    int row, column;

    for (row = 0; row < (int)slot->bitmap.rows; row++)
        for (column = 0; column < (int)slot->bitmap.width; column++) {
            int at = x + slot->bitmap_left + column, line = y - slot->bitmap_top + row;
            int level = slot->bitmap.buffer[row * slot->bitmap.pitch + column];
            if (at >= 0 && at < WIDTH && line >= 0 && line < HEIGHT && level > 255 - canvas[line][at])
                canvas[line][at] = (unsigned char)(255 - level);
        }
}

static FT_Error draw(FT_Face face, const char *text, int ppem, int y, FT_Int32 flags)
{
    FT_Error error = FT_Set_Pixel_Sizes(face, 0, (FT_UInt)ppem);
    int x = 4;

    for (; *text && !error; text++) {
        error = FT_Load_Char(face, (unsigned char)*text, FT_LOAD_RENDER | flags);
        if (!error) {
            put(face->glyph, x, y);
            x += (int)((face->glyph->advance.x + 32) >> 6);
        }
    }
    return error;
}

/* The line at all sizes, in one of the three ways. */
static FT_Error draw_all(const char *font, const char *text, int way)
{
    FT_Library library;
    FT_Face face;
    FT_Error error = FT_Init_FreeType(&library);
    int ppem;

    if (error)
        return error;
    if (way == 0)
        error = nfr_freetype_add(library);
    if (!error)
        error = FT_New_Face(library, font, 0, &face);
    for (ppem = FIRST; ppem <= LAST && !error; ppem++)
        error = draw(face, text, ppem, ((ppem - FIRST) * 3 + way + 1) * LINE - 4, way == 2 ? FT_LOAD_NO_HINTING : FT_LOAD_DEFAULT);
    FT_Done_FreeType(library);
    return error;
}

static int write_picture(const char *path)
{
    FILE *file = fopen(path, "wb");
    int x, y;

    if (!file)
        return 0;
    fprintf(file, "P5\n%d %d\n255\n", WIDTH * ZOOM, HEIGHT * ZOOM);
    for (y = 0; y < HEIGHT * ZOOM; y++)
        for (x = 0; x < WIDTH * ZOOM; x++)
            putc(canvas[y / ZOOM][x / ZOOM], file);
    return fclose(file) == 0;
}

int main(int argc, char **argv)
{
    const char *text = "The quick brown fox jumps over the lazy dog (0123 & 4567)";
    int x, y, way;

    if (argc < 3) {
        fprintf(stderr, "usage: freetype FONT OUT.pgm [TEXT]\n");
        return 2;
    }
    for (y = 0; y < HEIGHT; y++)
        for (x = 0; x < WIDTH; x++)
            canvas[y][x] = 255;
    if (argc > 3)
        text = argv[3];
    for (way = 0; way < 3; way++) {
        if (draw_all(argv[1], text, way)) {
            fprintf(stderr, "FreeType cannot draw %s\n", argv[1]);
            return EXIT_FAILURE;
        }
    }
    if (!write_picture(argv[2])) {
        fprintf(stderr, "cannot write %s\n", argv[2]);
        return EXIT_FAILURE;
    }
    return EXIT_SUCCESS;
}
