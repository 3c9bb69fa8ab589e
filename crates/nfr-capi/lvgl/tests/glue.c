/* glue FOLDER: nfr_lvgl against the library, against fonts of nfr bake at 8 bits, and with everything that can be wrong with a font. */
#include <pthread.h>

#include "../../tests/c/common.h"
#include "lvgl_private.h"
#include "nfr_lvgl.h"
#include "page.h"

extern const lv_font_t eight_12, eight_14, eight_16, eight_20;
static const lv_font_t * const baked[SIZES] = {&eight_12, &eight_14, &eight_16, &eight_20};
static unsigned logged;

static void count_log(lv_log_level_t level, const char * line)
{
    LV_UNUSED(level);
    if(strstr(line, "nfr: ")) logged++;
}

static lv_font_t * font_of(nfr_lvgl_face * face, uint16_t px)
{
    nfr_status status;
    lv_font_t * font = nfr_lvgl_font_create(face, px, &status);

    CHECK(font && status == NFR_OK);
    return font;
}

static nfr_lvgl_face * face_of(bytes file, size_t cache)
{
    nfr_status status;
    nfr_lvgl_face * face = nfr_lvgl_open(file.data, file.len, cache, &status);

    CHECK(face && status == NFR_OK);
    return face;
}

/* A letter's pixels without padding, or NULL if it has none; its description too. */
static uint8_t * pixels_of(const lv_font_t * font, uint32_t letter, lv_font_glyph_dsc_t * dsc)
{
    const lv_draw_buf_t * drawn;
    lv_draw_buf_t * buffer;
    uint8_t * pixels;
    unsigned y;

    if(!lv_font_get_glyph_dsc(font, dsc, letter, 0) || dsc->box_w == 0 || dsc->box_h == 0) return NULL;
    buffer = lv_draw_buf_create(dsc->box_w, dsc->box_h, LV_COLOR_FORMAT_A8, LV_STRIDE_AUTO);
    drawn = lv_font_get_glyph_bitmap(dsc, buffer);
    CHECK(drawn == buffer);
    pixels = malloc((size_t)dsc->box_w * dsc->box_h);
    CHECK(pixels);
    for(y = 0; y < dsc->box_h; y++)
        memcpy(pixels + y * dsc->box_w, drawn->data + y * drawn->header.stride, dsc->box_w);
    lv_font_glyph_release_draw_data(dsc);
    lv_draw_buf_destroy(buffer);
    return pixels;
}

/* The coverage at a place relative to the letter's origin, y up. */
static unsigned coverage(const uint8_t * pixels, const lv_font_glyph_dsc_t * dsc, int x, int y)
{
    int column = x - dsc->ofs_x, row = dsc->ofs_y + dsc->box_h - 1 - y;

    if(!pixels || column < 0 || row < 0 || column >= dsc->box_w || row >= dsc->box_h) return 0;
    return pixels[row * dsc->box_w + column];
}

/* Compares a letter with the baked font, whose boxes have no blank edges, and with the library. Returns the pixels of its box. */
static unsigned compare(const lv_font_t * font, int size, uint32_t letter, nfr_font * plain, nfr_rasterizer * rasterizer)
{
    lv_font_glyph_dsc_t a, b;
    nfr_placement place;
    const unsigned char * lent;
    uint8_t * ours = pixels_of(font, letter, &a), * theirs = pixels_of(baked[size], letter, &b);
    bool is_inked = ours != NULL;
    int x, y;

    CHECK(!a.resolved_font == !b.resolved_font);
    if(a.resolved_font) {
        CHECK(a.adv_w == b.adv_w && a.format == LV_FONT_GLYPH_FORMAT_A8 && a.stride == a.box_w);
        for(y = -10; y < 30; y++)
            for(x = -10; x < 40; x++) CHECK(coverage(ours, &a, x, y) == coverage(theirs, &b, x, y));
    }
    if(ours) {
        uint32_t glyph = nfr_font_glyph_for_char(plain, letter);
        CHECK(nfr_rasterizer_draw(rasterizer, glyph, page_px[size], 0, 0, &lent, &place) == NFR_OK);
        CHECK(place.width == a.box_w && place.height == a.box_h && memcmp(ours, lent, (size_t)a.box_w * a.box_h) == 0);
        CHECK(place.left == a.ofs_x && place.top - (int)place.height == a.ofs_y);
    }
    free(ours);
    free(theirs);
    return is_inked ? (unsigned)a.box_w * a.box_h : 0;
}

static void check_pixels(bytes file)
{
    static const size_t caches[] = {0, 21, 100, 999, 8192, 1 << 20};
    nfr_font * plain;
    nfr_rasterizer * rasterizer = open_rasterizer(file, &plain);
    unsigned i, size, pixels = 0, letters = 0;
    uint32_t letter;

    for(i = 0; i < sizeof caches / sizeof caches[0]; i++) {
        nfr_lvgl_face * face = face_of(file, caches[i]);
        lv_font_t * fonts[SIZES];
        for(size = 0; size < SIZES; size++) fonts[size] = font_of(face, page_px[size]);
        /* Sizes in turn, so that all caches but the last drop glyphs and draw them again. */
        for(letter = 1; letter < 0x2100; letter = letter == 0x24F ? 0x2000 : letter + 1) {
            for(size = 0; size < SIZES; size++, letters++) {
                pixels += compare(fonts[size], (int)size, letter, plain, rasterizer);
                pixels += compare(fonts[size], (int)size, 'a' + letter % 26, plain, rasterizer);
            }
        }
        CHECK(nfr_lvgl_status(face) == NFR_OK);
        nfr_lvgl_close(face); /* before its fonts */
        pixels += compare(fonts[0], 0, 'g', plain, rasterizer);
        for(size = 0; size < SIZES; size++) nfr_lvgl_font_destroy(fonts[size]);
    }
    nfr_rasterizer_free(rasterizer);
    nfr_font_free(plain);
    CHECK(logged == 0);
    printf("glue: %u letters and %u pixels are equal to the library's and to those baked at 8 bits\n", letters, pixels);
}

static void check_page(bytes file)
{
    nfr_lvgl_face * face = face_of(file, 8192);
    lv_font_t * made[SIZES], copies[SIZES];
    const lv_font_t * fonts[SIZES];
    size_t len = (size_t)PAGE_WIDTH * PAGE_HEIGHT * 3;
    uint8_t * frame = malloc(len);
    int i;

    CHECK(frame);
    for(i = 0; i < SIZES; i++) {
        fonts[i] = made[i] = font_of(face, page_px[i]);
        made[i]->fallback = &lv_font_montserrat_14;
    }
    page_build(fonts, "\tpage");
    memcpy(frame, page_draw(), len);
    for(i = 0; i < SIZES; i++) {
        copies[i] = *baked[i];
        copies[i].line_height = made[i]->line_height;
        copies[i].base_line = made[i]->base_line;
        copies[i].fallback = &lv_font_montserrat_14;
        CHECK(copies[i].underline_position == made[i]->underline_position);
        CHECK(copies[i].underline_thickness == made[i]->underline_thickness);
        fonts[i] = &copies[i];
    }
    page_build(fonts, "\tpage");
    CHECK(memcmp(frame, page_draw(), len) == 0);
    lv_obj_clean(lv_screen_active());
    for(i = 0; i < SIZES; i++) nfr_lvgl_font_destroy(made[i]);
    nfr_lvgl_close(face);
    free(frame);
    printf("glue: the page is the same, pixel for pixel\n");
}

static void check_buffers(bytes file)
{
    nfr_lvgl_face * face = face_of(file, 8192);
    lv_font_t * small = font_of(face, 12), * large = font_of(face, 12 + 64); /* whose glyphs are in the same lists */
    lv_draw_buf_t * buffer = lv_draw_buf_create(12, 9, LV_COLOR_FORMAT_A8, LV_STRIDE_AUTO);
    lv_font_glyph_dsc_t a, b;

    CHECK(lv_font_get_glyph_dsc(small, &a, 'W', 0) && lv_font_get_glyph_dsc(large, &b, 'W', 0));
    CHECK(a.box_w == 12 && a.box_h == 9 && b.box_h > 5 * a.box_h);
    CHECK(lv_font_get_glyph_bitmap(&a, buffer) == buffer);
    CHECK(lv_font_get_glyph_bitmap(&a, NULL) == NULL && lv_font_get_glyph_bitmap(&b, buffer) == NULL);
    lv_draw_buf_destroy(buffer);
    buffer = lv_draw_buf_create(12, 8, LV_COLOR_FORMAT_A8, LV_STRIDE_AUTO);
    buffer->data_size = 12 * 8;
    CHECK(lv_font_get_glyph_bitmap(&a, buffer) == NULL);
    lv_draw_buf_destroy(buffer);
    nfr_lvgl_font_destroy(small);
    nfr_lvgl_font_destroy(large);
    nfr_lvgl_close(face);
}

/* A letter that is left to the fallback, and a good one that is not. */
static void check_fallback(const char * folder, const char * name, uint32_t letter, uint32_t good, nfr_status status)
{
    bytes file = read_file(folder, name);
    nfr_lvgl_face * face = face_of(file, 4096);
    lv_font_t * font = font_of(face, 14);
    lv_font_glyph_dsc_t dsc;
    int i;

    logged = 0;
    CHECK(!lv_font_get_glyph_dsc(font, &dsc, letter, 0));
    font->fallback = &lv_font_montserrat_14;
    for(i = 0; i < 3; i++) CHECK(lv_font_get_glyph_dsc(font, &dsc, letter, 0) && dsc.resolved_font == font->fallback);
    CHECK(lv_font_get_glyph_dsc(font, &dsc, 0xF013, 0) && dsc.resolved_font == font->fallback);
    CHECK(lv_font_get_glyph_dsc(font, &dsc, good, 0) && dsc.resolved_font == font);
    CHECK(nfr_lvgl_status(face) == status && logged == (status != NFR_OK));
    nfr_lvgl_font_destroy(font);
    nfr_lvgl_close(face);
    free(file.data);
}

static void is_refused(const void * data, size_t size, nfr_status expected)
{
    nfr_status status = NFR_OK;

    CHECK(nfr_lvgl_open(data, size, 100, &status) == NULL && status == expected);
    CHECK(nfr_lvgl_open(data, size, 100, NULL) == NULL);
}

static size_t models_at(bytes file)
{
    size_t i;

    for(i = 12; i + 16 <= file.len && memcmp(file.data + i, "Nfrt", 4) != 0; i += 16) {}
    return (size_t)file.data[i + 9] << 16 | (size_t)file.data[i + 10] << 8 | file.data[i + 11];
}

static void check_bad(const char * folder, bytes file)
{
    static const uint8_t erased[4096] = {0xFF, 0xFF, 0xFF, 0xFF};
    bytes plain = read_file(folder, "plain.ttf");
    nfr_lvgl_face * face = face_of(file, 100);
    nfr_status status;
    size_t i, opened = 0, models = models_at(file);

    is_refused(NULL, 0, NFR_NULL_POINTER);
    is_refused(NULL, 100, NFR_NULL_POINTER);
    is_refused(erased, 0, NFR_NOT_A_FONT);
    is_refused(erased, sizeof erased, NFR_NOT_A_FONT);
    is_refused(plain.data, plain.len, NFR_NO_MODELS);
    file.data[models] ^= 0x40;
    is_refused(file.data, file.len, NFR_UNKNOWN_VERSION);
    file.data[models] ^= 0x40;
    CHECK(nfr_lvgl_font_create(NULL, 12, &status) == NULL && status == NFR_NULL_POINTER);
    CHECK(nfr_lvgl_font_create(face, 0, &status) == NULL && status == NFR_INVALID_SIZE);
    CHECK(nfr_lvgl_font_create(face, 2049, &status) == NULL && status == NFR_INVALID_SIZE);
    CHECK(nfr_lvgl_status(NULL) == NFR_NULL_POINTER && nfr_lvgl_status(face) == NFR_OK);
    nfr_lvgl_font_destroy(NULL);
    nfr_lvgl_close(NULL);
    nfr_lvgl_close(face);

    /* Half a font, and bytes that have changed: fewer letters, or none. */
    for(i = 0; i < 400; i++) {
        size_t len = i % 4 ? file.len : file.len * i / 400;
        uint8_t * copy = malloc(len + 1);
        lv_font_glyph_dsc_t dsc;
        memcpy(copy, file.data, len);
        if(i % 4) copy[(i * 7919 + i % 3 * models) % len] ^= (uint8_t)(1u << i % 8);
        face = nfr_lvgl_open(copy, len, 300, &status);
        CHECK((face != NULL) == (status == NFR_OK) && status != NFR_INTERNAL);
        if(face) {
            lv_font_t * font = font_of(face, 12);
            uint32_t letter;
            opened++;
            for(letter = ' '; letter < 0x7F; letter++) free(pixels_of(font, letter, &dsc));
            nfr_lvgl_close(face);
            nfr_lvgl_font_destroy(font);
        }
        free(copy);
    }
    free(plain.data);
    printf("glue: of 400 damaged fonts %u opened\n", (unsigned)opened);
}

/* What a draw thread of LVGL does. */
static void * draw_all(void * font)
{
    unsigned long long * hash = calloc(1, sizeof *hash);
    lv_font_glyph_dsc_t dsc;
    int i;

    CHECK(hash);
    for(i = 0; i < 3000; i++) {
        uint8_t * pixels = pixels_of(font, '!' + (uint32_t)i % 94, &dsc);
        *hash = *hash * 31 + hash_of(pixels, (size_t)dsc.box_w * dsc.box_h);
        free(pixels);
    }
    return hash;
}

static void check_threads(bytes file)
{
    nfr_lvgl_face * face = face_of(file, 2000);
    lv_font_t * font = font_of(face, 16);
    unsigned long long * alone = draw_all(font), * hash;
    pthread_t threads[4];
    int i;

    for(i = 0; i < 4; i++) CHECK(pthread_create(&threads[i], NULL, draw_all, font) == 0);
    for(i = 0; i < 4; i++) {
        CHECK(pthread_join(threads[i], (void **)&hash) == 0 && *hash == *alone);
        free(hash);
    }
    free(alone);
    nfr_lvgl_font_destroy(font);
    nfr_lvgl_close(face);
}

int main(int argc, char ** argv)
{
    bytes file;

    CHECK(argc == 2);
    page_begin();
    lv_log_register_print_cb(count_log);
    file = read_file(argv[1], "latin.ttf");
    check_pixels(file);
    check_page(file);
    check_buffers(file);
    check_threads(file);
    check_bad(argv[1], file);
    check_fallback(argv[1], "partial.ttf", 'b', 'g', NFR_OK);
    check_fallback(argv[1], "damaged.ttf", 'a', 'x', NFR_DAMAGED_GLYPH);
    check_fallback(argv[1], "stale.ttf", 'a', 'x', NFR_STALE);
    free(file.data);
    lv_deinit();
    printf("glue: passed\n");
    return 0;
}
