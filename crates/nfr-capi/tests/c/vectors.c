/*
 * vectors FOLDER NAME [EVERY]: NAME.ttf drawn in each way as NAME.txt says, in the format of spec/vectors; every line, or
 * each so-manieth. On two threads that share the font.
 */
#include <pthread.h>

#include "common.h"

typedef struct {
    unsigned glyph, width, height;
    float ppem, x, y;
    int left, top;
    unsigned long long hash;
} line;

typedef struct {
    const nfr_font *font;
    const line *lines;
    size_t count, first;
} share;

static void check_line(nfr_rasterizer *rasterizer, const line *l)
{
    nfr_placement p, q, r;
    size_t stride = l->width + 3u, area = (size_t)l->width * l->height, row;
    size_t need = l->height ? (l->height - 1u) * stride + l->width : 0;
    const unsigned char *lent;
    unsigned char *room = (unsigned char *)malloc(need ? need : 1), *packed = (unsigned char *)malloc(area + 1);

    CHECK(room && packed);
    memset(room, 7, need);
    CHECK(nfr_rasterizer_placement(rasterizer, l->glyph, l->ppem, l->x, l->y, &p) == NFR_OK);
    CHECK(p.left == l->left && p.top == l->top && p.width == l->width && p.height == l->height);
    CHECK(nfr_rasterizer_render_into(rasterizer, l->glyph, l->ppem, l->x, l->y, room, need, stride, &q) == NFR_OK);
    CHECK(memcmp(&p, &q, sizeof p) == 0);
    for (row = 0; row < l->height; row++) {
        memcpy(packed + row * l->width, room + row * stride, l->width);
        if (row + 1 < l->height)
            CHECK(memcmp(room + row * stride + l->width, "\7\7\7", 3) == 0);
    }
    CHECK(hash_of(packed, area) == l->hash);
    CHECK(nfr_rasterizer_draw(rasterizer, l->glyph, l->ppem, l->x, l->y, &lent, &r) == NFR_OK);
    CHECK(memcmp(&p, &r, sizeof p) == 0 && lent && memcmp(lent, packed, area) == 0);
    if (need) {
        memset(&q, 0, sizeof q);
        CHECK(nfr_rasterizer_render_into(rasterizer, l->glyph, l->ppem, l->x, l->y, room, need - 1, stride, &q) ==
              NFR_BUFFER_TOO_SMALL);
        CHECK(memcmp(&p, &q, sizeof p) == 0);
    }
    free(room);
    free(packed);
}

static void *work(void *argument)
{
    const share *mine = (const share *)argument;
    nfr_rasterizer *rasterizer;
    size_t i;

    CHECK(nfr_rasterizer_new(mine->font, &rasterizer) == NFR_OK);
    CHECK(nfr_rasterizer_set_cache(rasterizer, mine->first ? 0 : 1 << 20) == NFR_OK);
    for (i = mine->first; i < mine->count; i += 2)
        check_line(rasterizer, &mine->lines[i]);
    nfr_rasterizer_free(rasterizer);
    return NULL;
}

static size_t parse(bytes text, unsigned every, line *lines)
{
    char *at = strtok((char *)text.data, "\n");
    size_t count = 0, seen = 0;

    for (; at; at = strtok(NULL, "\n")) {
        line *l = &lines[count];
        if (at[0] == '#' || seen++ % every)
            continue;
        CHECK(sscanf(at, "%u %f %f %f %d %d %u %u %llx", &l->glyph, &l->ppem, &l->x, &l->y, &l->left, &l->top, &l->width,
                     &l->height, &l->hash) == 9);
        count++;
    }
    return count;
}

int main(int argc, char **argv)
{
    char name[64];
    bytes file, text;
    nfr_font *font;
    line *lines;
    size_t count, i;
    pthread_t threads[2];
    share shares[2];

    CHECK(argc >= 3);
    snprintf(name, sizeof name, "%s.ttf", argv[2]);
    file = read_file(argv[1], name);
    snprintf(name, sizeof name, "%s.txt", argv[2]);
    text = read_file(argv[1], name);
    text.data[text.len - 1] = 0;
    lines = (line *)calloc(text.len / 16 + 1, sizeof *lines);
    CHECK(lines);
    count = parse(text, argc > 3 ? (unsigned)atoi(argv[3]) : 1, lines);
    CHECK(count > 100);
    CHECK(nfr_font_new_borrowed(file.data, file.len, 0, free, file.data, &font) == NFR_OK);
    for (i = 0; i < 2; i++) {
        shares[i].font = font;
        shares[i].lines = lines;
        shares[i].count = count;
        shares[i].first = i;
        CHECK(pthread_create(&threads[i], NULL, work, &shares[i]) == 0);
    }
    for (i = 0; i < 2; i++)
        CHECK(pthread_join(threads[i], NULL) == 0);
    nfr_font_free(font);
    free(lines);
    free(text.data);
    printf("%s: %lu bitmaps, 0 differ\n", argv[2], (unsigned long)count);
    return 0;
}
