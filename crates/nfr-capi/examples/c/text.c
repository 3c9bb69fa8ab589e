/*
 * Draws a word as text, the darker the more of a pixel is covered: text FONT WORD PPEM. The font is one that nfr-convert wrote.
 *
 *     cc text.c $(pkg-config --cflags --libs nfr) -o text
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <nfr.h>

#define WIDTH 160
#define HEIGHT 64

static int fail(const char *what)
{
    fprintf(stderr, "%s: %s\n", what, nfr_last_error());
    return EXIT_FAILURE;
}

/* The bytes of a file, or NULL. */
static uint8_t *read_file(const char *path, size_t *len)
{
    FILE *file = fopen(path, "rb");
    uint8_t *data = NULL;
    long size;

    if (!file)
        return NULL;
    if (fseek(file, 0, SEEK_END) == 0 && (size = ftell(file)) > 0 && fseek(file, 0, SEEK_SET) == 0) {
        data = (uint8_t *)malloc((size_t)size);
        *len = data ? fread(data, 1, (size_t)size, file) : 0;
    }
    fclose(file);
    return data;
}

/* Draws the word at a baseline, as far as there is room. */
static nfr_status draw(const nfr_font *font, nfr_rasterizer *r, const char *word, float ppem, uint8_t *canvas)
{
    nfr_line_metrics line;
    nfr_status status = nfr_font_line_metrics(font, ppem, &line);
    int x = 0, baseline = (int)(line.ascent + 1.0f);

    for (; *word && status == NFR_OK; word++) {
        uint32_t glyph = nfr_font_glyph_for_char(font, (unsigned char)*word);
        nfr_placement p;
        float advance = 0.0f;
        /* Where it lies is asked first: a glyph may begin left of the pen. */
        status = nfr_rasterizer_placement(r, glyph, ppem, 0, 0, &p);
        if (status == NFR_OK && p.width && x + p.left >= 0 && x + p.left + (int)p.width <= WIDTH && p.top <= baseline) {
            size_t at = (size_t)(baseline - p.top) * WIDTH + (size_t)(x + p.left);
            status = nfr_rasterizer_render_into(r, glyph, ppem, 0, 0, canvas + at, WIDTH * HEIGHT - at, WIDTH, &p);
        }
        if (status == NFR_OK)
            status = nfr_rasterizer_hinted_advance(r, glyph, ppem, &advance);
        x += (int)(advance + 0.5f);
    }
    return status;
}

int main(int argc, char **argv)
{
    static uint8_t canvas[WIDTH * HEIGHT];
    nfr_font *font;
    nfr_rasterizer *rasterizer;
    nfr_status status;
    size_t len = 0, row, column, end;
    uint8_t *data;

    if (argc != 4) {
        fprintf(stderr, "usage: text FONT WORD PPEM, a size up to 48\n");
        return 2;
    }
    data = read_file(argv[1], &len);
    if (!data) {
        fprintf(stderr, "cannot read %s\n", argv[1]);
        return EXIT_FAILURE;
    }
    /* The font takes the memory and frees it when it is not needed any more. */
    if (nfr_font_new_borrowed(data, len, 0, free, data, &font) != NFR_OK)
        return fail(argv[1]);
    status = nfr_rasterizer_new(font, &rasterizer);
    if (status == NFR_OK)
        status = nfr_rasterizer_set_missing_model(rasterizer, NFR_MISSING_MODEL_OUTLINE);
    if (status == NFR_OK)
        status = draw(font, rasterizer, argv[2], (float)atof(argv[3]), canvas);
    if (status != NFR_OK)
        fail(argv[2]);
    nfr_rasterizer_free(rasterizer);
    nfr_font_free(font);
    for (row = 0; status == NFR_OK && row < HEIGHT; row++) {
        for (end = WIDTH; end > 0 && canvas[row * WIDTH + end - 1] < 64; end--)
            ;
        for (column = 0; column < end; column++)
            putchar(" .o#"[canvas[row * WIDTH + column] / 64]);
        if (end)
            putchar('\n');
    }
    return status == NFR_OK ? EXIT_SUCCESS : EXIT_FAILURE;
}
