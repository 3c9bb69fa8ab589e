/* The module while faces and libraries come and go. */
#include <pthread.h>

#include "module.h"

static unsigned long read_stream(FT_Stream stream, unsigned long offset, unsigned char *buffer, unsigned long count)
{
    const bytes *file = (const bytes *)stream->descriptor.pointer;

    if (count == 0)
        return offset > file->len;
    if (offset > file->len || count > file->len - offset)
        return 0;
    memcpy(buffer, file->data + offset, count);
    return count;
}

static void close_nothing(FT_Stream stream)
{
    (void)stream;
}

static void draw(FT_Face face, nfr_rasterizer *rasterizer)
{
    CHECK(FT_Set_Pixel_Sizes(face, 0, 14) == 0 && FT_Load_Char(face, 'g', NORMAL) == 0);
    CHECK(is_ours(face->glyph, rasterizer, 14, 0, 0));
}

/* A program that takes the generic for itself loses the models and not what is in the slot. */
static void check_generic(bytes sans, nfr_rasterizer *rasterizer)
{
    FT_Library library = library_with(1);
    FT_Face face = face_of(library, sans);

    draw(face, rasterizer);
    face->glyph->generic.finalizer(face->glyph);
    CHECK(nfr_freetype_status(face, NULL) == NFR_NO_MODELS && is_ours(face->glyph, rasterizer, 14, 0, 0));
    FT_Outline_Translate(&face->glyph->outline, 1, 1);
    draw(face, rasterizer);
    FT_Done_FreeType(library);
}

/* From a file, and from a stream that is not in memory. */
static void check_sources(bytes sans, const char *folder, nfr_rasterizer *rasterizer)
{
    FT_Library library = library_with(1);
    FT_StreamRec stream;
    FT_Open_Args arguments;
    FT_Face face;
    char path[1024];

    snprintf(path, sizeof path, "%s/sans.ttf", folder);
    CHECK(FT_New_Face(library, path, 0, &face) == 0);
    draw(face, rasterizer);
    FT_Done_Face(face);
    memset(&stream, 0, sizeof stream);
    memset(&arguments, 0, sizeof arguments);
    stream.size = (unsigned long)sans.len;
    stream.descriptor.pointer = &sans;
    stream.read = read_stream;
    stream.close = close_nothing;
    arguments.flags = FT_OPEN_STREAM;
    arguments.stream = &stream;
    CHECK(FT_Open_Face(library, &arguments, 0, &face) == 0);
    draw(face, rasterizer);
    FT_Done_Face(face);
    FT_Done_FreeType(library);
}

static int used;

static void program_finalizer(void *object)
{
    (void)object;
    used++;
}

void check_lifetimes(bytes sans, bytes other, const char *folder)
{
    FT_Library library = library_with(1);
    FT_Face a, b, faces[3];
    nfr_font *font;
    nfr_rasterizer *rasterizer = open_rasterizer(sans, &font);
    bytes copy;
    int i;

    check_sources(sans, folder, rasterizer);
    check_generic(sans, rasterizer);
    /* A face may get the memory of one that was closed. */
    for (i = 0; i < 20; i++) {
        a = face_of(library, i % 2 ? other : sans);
        CHECK(FT_Load_Char(a, 'g', NORMAL) == 0);
        CHECK(nfr_freetype_status(a, NULL) == (i % 2 ? NFR_NO_MODELS : NFR_OK));
        if (i % 2 == 0)
            CHECK(is_ours(a->glyph, rasterizer, 14, 0, 0));
        FT_Done_Face(a);
    }
    /* The file's memory may go when the face is closed. */
    copy.len = sans.len;
    copy.data = (unsigned char *)malloc(copy.len);
    CHECK(copy.data);
    memcpy(copy.data, sans.data, copy.len);
    a = face_of(library, copy);
    draw(a, rasterizer);
    FT_Done_Face(a);
    free(copy.data);
    /* The program's own use of the generics stays its own. */
    a = face_of(library, sans);
    a->generic.data = &used;
    a->generic.finalizer = program_finalizer;
    draw(a, rasterizer);
    b = face_of(library, sans);
    b->glyph->generic.data = &used;
    b->glyph->generic.finalizer = program_finalizer;
    CHECK(FT_Load_Char(b, 'g', NORMAL) == 0 && nfr_freetype_status(b, NULL) == NFR_NO_MODELS);
    FT_Done_Face(a);
    FT_Done_Face(b);
    CHECK(used == 2);
    /* A second reference to a face, several sizes of it, several faces of one file, closed in another order. */
    for (i = 0; i < 3; i++) {
        faces[i] = face_of(library, sans);
        draw(faces[i], rasterizer);
    }
    CHECK(FT_Reference_Face(faces[0]) == 0);
    FT_Done_Face(faces[0]);
    draw(faces[0], rasterizer);
    FT_Done_Face(faces[2]);
    draw(faces[1], rasterizer);
    /* Without the module, what is in the slots goes with the faces; and the module may come again. */
    CHECK(FT_Remove_Module(library, FT_Get_Module(library, "nfr")) == 0);
    CHECK(FT_Load_Char(faces[1], 'g', NORMAL) == 0 && !is_ours(faces[1]->glyph, rasterizer, 14, 0, 0));
    CHECK(nfr_freetype_add(library) == 0);
    draw(faces[1], rasterizer);
    FT_Done_Face(faces[1]);
    /* faces[0] is closed here. */
    FT_Done_FreeType(library);
    nfr_rasterizer_free(rasterizer);
    nfr_font_free(font);
}

static void *draw_many(void *argument)
{
    FT_Face face = (FT_Face)argument;
    int round, c;

    for (round = 9; round < 13; round++) {
        CHECK(FT_Set_Pixel_Sizes(face, 0, (FT_UInt)round) == 0);
        for (c = '!'; c <= '~'; c++)
            CHECK(FT_Load_Char(face, (FT_ULong)c, NORMAL) == 0);
    }
    return NULL;
}

void check_threads(bytes sans)
{
    FT_Library library = library_with(1);
    FT_Face faces[2];
    pthread_t threads[2];
    int i;

    for (i = 0; i < 2; i++)
        faces[i] = face_of(library, sans);
    for (i = 0; i < 2; i++)
        CHECK(pthread_create(&threads[i], NULL, draw_many, faces[i]) == 0);
    for (i = 0; i < 2; i++)
        CHECK(pthread_join(threads[i], NULL) == 0);
    FT_Done_FreeType(library);
}
