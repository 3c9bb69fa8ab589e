// glue FOLDER: nfr_imgui against the library, against Dear ImGui's own loader, and with everything that can be wrong with a font.
#include <math.h>

#include "../../tests/c/common.h"
#include "nfr_imgui.h"

#include "imgui_internal.h"
#ifdef IMGUI_ENABLE_FREETYPE
#include "misc/freetype/imgui_freetype.h"
#endif

#if IMGUI_VERSION_NUM >= 19301
#define SETUP "1.93"
#elif defined(IMGUI_ENABLE_FREETYPE)
#define SETUP "1.92 with FreeType"
#else
#define SETUP "1.92"
#endif

// An atlas, with nfr's loader or with the one that Dear ImGui takes by itself.
struct Atlas {
    ImFontAtlas atlas;

    explicit Atlas(bool is_ours = true, ImTextureFormat format = ImTextureFormat_Alpha8)
    {
        atlas.TexDesiredFormat = format;
        atlas.RendererHasTextures = true;
        if (is_ours)
            atlas.SetFontLoader(nfr_imgui_font_loader());
    }

    // NULL if it is refused.
    ImFont *add(const void *data, size_t len, ImFontConfig config = ImFontConfig())
    {
        config.FontDataOwnedByAtlas = false;
        return atlas.AddFontFromMemoryTTF(const_cast<void *>(data), static_cast<int>(len), 16.0f, &config);
    }

    ImFont *add(bytes file) { return add(file.data, file.len); }
};

// The pixel of a glyph in the atlas.
static unsigned char pixel_of(ImFontAtlas &atlas, const ImFontGlyph *glyph, int x, int y)
{
    ImTextureRect *rect = ImFontAtlasPackGetRect(&atlas, glyph->PackId);
    const unsigned char *at = static_cast<unsigned char *>(atlas.TexData->GetPixelsAt(rect->x + x, rect->y + y));

    CHECK(x < rect->w && y < rect->h);
    if (atlas.TexData->Format == ImTextureFormat_Alpha8)
        return *at;
    CHECK(at[0] == 255 && at[1] == 255 && at[2] == 255);
    return at[3];
}

static ImFontGlyph *find(ImFontBaked *baked, ImWchar letter)
{
    return baked->FindGlyphNoFallback(letter);
}

// A glyph in the atlas is what the library draws. Returns its pixels.
static unsigned is_librarys(ImFontAtlas &atlas, ImFontBaked *baked, ImWchar letter, nfr_font *font, nfr_rasterizer *rasterizer, float ppem)
{
    const ImFontGlyph *glyph = find(baked, letter);
    const uint8_t *pixels;
    const float density = baked->RasterizerDensity;
    nfr_placement place;
    float advance;
    uint32_t number = nfr_font_glyph_for_char(font, letter);

    CHECK(glyph != NULL && glyph->Codepoint == letter && baked->OwnerFont->IsGlyphInFont(letter));
    CHECK(nfr_rasterizer_hinted_advance(rasterizer, number, ppem, &advance) == NFR_OK);
    CHECK(nfr_rasterizer_draw(rasterizer, number, ppem, 0, 0, &pixels, &place) == NFR_OK);
    CHECK(glyph->AdvanceX == advance / density);
    CHECK((glyph->Visible != 0) == (place.width > 0 && place.height > 0) && glyph->Colored == 0);
    if (!glyph->Visible)
        return 0;
    CHECK(glyph->X0 * density == place.left && fabsf((baked->Ascent - glyph->Y0) * density - place.top) < 1e-3f);
    CHECK(fabsf((glyph->X1 - glyph->X0) * density - place.width) < 1e-3f);
    CHECK(fabsf((glyph->Y1 - glyph->Y0) * density - place.height) < 1e-3f);
    for (unsigned y = 0; y < place.height; y++)
        for (unsigned x = 0; x < place.width; x++)
            CHECK(pixel_of(atlas, glyph, x, y) == pixels[y * place.width + x]);
    return place.width * place.height;
}

// A glyph is the same in two atlases.
static void is_same(Atlas &a, ImFontBaked *one, Atlas &b, ImFontBaked *other, ImWchar letter)
{
    const ImFontGlyph *ours = find(one, letter), *theirs = find(other, letter);

    CHECK((ours == NULL) == (theirs == NULL));
    if (ours == NULL)
        return;
    CHECK(ours->Visible == theirs->Visible && ours->AdvanceX == theirs->AdvanceX && ours->X0 == theirs->X0 && ours->X1 == theirs->X1);
    CHECK(ours->Y0 == theirs->Y0 && ours->Y1 == theirs->Y1);
    if (!ours->Visible)
        return;
    const ImTextureRect rect = *ImFontAtlasPackGetRect(&a.atlas, ours->PackId);
    for (int y = 0; y < rect.h; y++)
        for (int x = 0; x < rect.w; x++)
            CHECK(pixel_of(a.atlas, ours, x, y) == pixel_of(b.atlas, theirs, x, y));
}

static void check_pixels(bytes file)
{
    static const float densities[] = {1.0f, 1.25f, 1.5f, 2.0f};
    nfr_font *plain;
    nfr_rasterizer *rasterizer = open_rasterizer(file, &plain);
    unsigned letters = 0, pixels = 0, fractions = 0;
    uint16_t first, last;
    nfr_line_metrics line;

    CHECK(nfr_font_ppem_range(plain, &first, &last) == NFR_OK);
    CHECK(nfr_font_line_metrics(plain, 1.0f, &line) == NFR_OK);
    for (int format = 0; format < 2; format++) {
        Atlas ours(true, format ? ImTextureFormat_RGBA32 : ImTextureFormat_Alpha8);
        ImFont *font = ours.add(file);
        CHECK(font != NULL && nfr_imgui_status(font, NULL) == NFR_OK);
        for (float size = 5; size < 80; size += size < 30 ? 1 : 17)
            for (float density : densities) {
                ImFontBaked *baked = font->GetFontBaked(size, density);
                float ppem = size * density / (line.ascent - line.descent);
                if (roundf(ppem) >= first && roundf(ppem) <= last)
                    ppem = roundf(ppem);
                CHECK(baked->Ascent == ceilf(line.ascent * ppem) / density && baked->Descent == floorf(line.descent * ppem) / density);
                for (ImWchar letter = ' '; letter < 0x7F; letter++, letters++) {
                    pixels += is_librarys(ours.atlas, baked, letter, plain, rasterizer, ppem);
                    const float advance = find(baked, letter)->AdvanceX;
                    fractions += density == 1 && ppem >= first && ppem <= last && advance != roundf(advance);
                }
            }
        CHECK(nfr_imgui_status(font, NULL) == NFR_OK);
    }
    CHECK(fractions == 0);
    nfr_rasterizer_free(rasterizer);
    nfr_font_free(plain);
    printf("glue: %u letters and %u pixels are the library's\n", letters, pixels);
}

// An advance that was asked for before the glyph is the glyph's.
static void check_advances(const char *folder, const char *name)
{
    bytes file = read_file(folder, name);
    Atlas ours;
    ImFontBaked *baked = ours.add(file)->GetFontBaked(21, 1);
    int unloaded = 0;

    baked->LoadNoRenderOnLayout = true;
    for (ImWchar letter = 'z'; letter > ' '; letter--) {
        float advance = baked->GetCharAdvance(letter);
        unloaded += !baked->IsGlyphLoaded(letter);
        CHECK(baked->FindGlyph(letter)->AdvanceX == advance);
    }
    CHECK(unloaded > 80);
    free(file.data);
}

// Letters that are drawn as before, and a good one that is not.
static void check_rest(const char *folder, const char *name, ImWchar letter, ImWchar good, nfr_status status)
{
    bytes file = read_file(folder, name);
    Atlas ours, theirs(false);
    ImFont *font = ours.add(file), *other = theirs.add(file);
    const char *message;

    CHECK(font != NULL && other != NULL);
    for (int size = 9; size < 30; size += 4) {
        ImFontBaked *baked = font->GetFontBaked(size, 1), *before = other->GetFontBaked(size, 1);
        before->Ascent = baked->Ascent;
        is_same(ours, baked, theirs, before, letter);
        if (good != 0) {
            nfr_font *plain;
            nfr_rasterizer *rasterizer = open_rasterizer(file, &plain);
            nfr_line_metrics line;
            CHECK(nfr_font_line_metrics(plain, 1.0f, &line) == NFR_OK);
            CHECK(is_librarys(ours.atlas, baked, good, plain, rasterizer, roundf(size / (line.ascent - line.descent))) > 0);
            nfr_rasterizer_free(rasterizer);
            nfr_font_free(plain);
        }
    }
    CHECK(nfr_imgui_status(font, &message) == status && (message[0] == 0) == (status == NFR_OK));
    CHECK(nfr_imgui_status(other, &message) == NFR_NULL_POINTER && message[0] != 0);
    free(file.data);
}

// A font without models is as with Dear ImGui's own loader, and so are its default fonts.
static void check_plain(const char *folder)
{
    bytes file = read_file(folder, "plain.ttf");
    Atlas ours, theirs(false);
    ImFont *fonts[2][2] = {{ours.add(file), theirs.add(file)}, {ours.atlas.AddFontDefault(), theirs.atlas.AddFontDefault()}};

    for (auto &pair : fonts)
        for (int size = 9; size < 30; size++) {
            ImFontBaked *one = pair[0]->GetFontBaked(size, 1), *other = pair[1]->GetFontBaked(size, 1);
            CHECK(one->Ascent == other->Ascent && one->Descent == other->Descent);
            for (ImWchar letter = 1; letter < 0x180; letter++)
                is_same(ours, one, theirs, other, letter);
        }
    CHECK(nfr_imgui_status(fonts[0][0], NULL) == NFR_NO_MODELS && nfr_imgui_status(NULL, NULL) == NFR_NULL_POINTER);
    free(file.data);
}

// A font whose outlines are no more in it, drawn by its models alone.
static void check_dropped(const char *folder, bytes sans)
{
    bytes file = read_file(folder, "dropped.ttf");
    Atlas ours;
    ImFontConfig merge;
    ImFont *font = ours.add(file);
    ImFontGlyph *glyph;
    int counts[2] = {0, 0};

    CHECK(font != NULL && nfr_imgui_status(font, NULL) == NFR_OK);
    merge.MergeMode = true; // what the first lacks
    CHECK(ours.add(sans.data, sans.len, merge) == font);
    glyph = find(font->GetFontBaked(16, 1), 'a');
    CHECK(glyph != NULL && glyph->Visible && glyph->SourceIdx == 0);
    for (ImWchar letter = '!'; letter < 0x7F; letter++) {
        glyph = find(font->GetFontBaked(16, 1), letter);
        CHECK(glyph != NULL && glyph->Visible);
        counts[glyph->SourceIdx]++;
    }
    CHECK(counts[0] > 20 && counts[1] > 20);
    ours.atlas.Clear();
    free(file.data);
}

// Loaders that are changed while there are fonts, and fonts with a loader of their own.
static void check_loaders(bytes sans)
{
    Atlas ours(false), always;
    ImFont *font = ours.add(sans);
    const float before = find(font->GetFontBaked(15, 1), 'W')->AdvanceX;
    const float advance = find(always.add(sans)->GetFontBaked(15, 1), 'W')->AdvanceX;

    for (int i = 0; i < 3; i++) {
        ours.atlas.SetFontLoader(nfr_imgui_font_loader());
        CHECK(find(font->GetFontBaked(15, 1), 'W')->AdvanceX == advance);
#ifdef IMGUI_ENABLE_FREETYPE
        ours.atlas.SetFontLoader(ImGuiFreeType::GetFontLoader());
#else
        ours.atlas.SetFontLoader(ImFontAtlasGetFontLoaderForStbTruetype());
        CHECK(before != advance);
#endif
        CHECK(find(font->GetFontBaked(15, 1), 'W')->AdvanceX == before && nfr_imgui_status(font, NULL) == NFR_NULL_POINTER);
    }
#ifndef IMGUI_ENABLE_FREETYPE
    ImFontConfig config;
    config.FontLoader = nfr_imgui_font_loader();
    ImFont *own = ours.add(sans.data, sans.len, config);
    CHECK(own != NULL && find(own->GetFontBaked(15, 1), 'W')->AdvanceX == advance && nfr_imgui_status(own, NULL) == NFR_OK);
    CHECK(find(font->GetFontBaked(15, 1), 'W')->AdvanceX == before);
    ours.atlas.RemoveFont(own);
    CHECK(find(font->GetFontBaked(15, 1), 'W')->AdvanceX == before);
#endif
}

static void put_u32(unsigned char *at, uint32_t number)
{
    for (int i = 0; i < 4; i++)
        at[i] = static_cast<unsigned char>(number >> (24 - 8 * i));
}

static uint32_t u32(const unsigned char *at)
{
    return static_cast<uint32_t>(at[0]) << 24 | at[1] << 16 | at[2] << 8 | at[3];
}

// The two fonts as a collection (OpenType 1.9, "Font Collections").
static bytes collection_of(bytes one, bytes other)
{
    bytes made = {static_cast<unsigned char *>(calloc(1, 20 + one.len + 3 + other.len)), 0};
    const bytes fonts[] = {one, other};

    CHECK(made.data);
    memcpy(made.data, "ttcf\0\1\0\0\0\0\0\2", 12);
    made.len = 20;
    for (int i = 0; i < 2; i++) {
        made.len = (made.len + 3) & ~static_cast<size_t>(3);
        unsigned char *font = made.data + made.len;
        memcpy(font, fonts[i].data, fonts[i].len);
        put_u32(made.data + 12 + 4 * i, static_cast<uint32_t>(made.len));
        for (int table = 0; table < (font[4] << 8 | font[5]); table++)
            put_u32(font + 20 + 16 * table, u32(font + 20 + 16 * table) + static_cast<uint32_t>(made.len));
        made.len += fonts[i].len;
    }
    return made;
}

static void check_collection(const char *folder, bytes sans)
{
    bytes plain = read_file(folder, "plain.ttf"), file = collection_of(plain, sans);
    Atlas ours;
    ImFontConfig config;

    CHECK(nfr_imgui_status(ours.add(file), NULL) == NFR_NO_MODELS);
    config.FontNo = 1;
    CHECK(nfr_imgui_status(ours.add(file.data, file.len, config), NULL) == NFR_OK);
    config.FontNo = 2;
    CHECK(ours.add(file.data, file.len, config) == NULL && strstr(nfr_last_error(), "2") != NULL);
    CHECK(ours.atlas.Fonts.Size == 2);
    ours.atlas.Clear();
    free(file.data);
    free(plain.data);
}

// Glyphs for which the atlas has no room are replaced.
static void check_full(bytes sans)
{
    Atlas ours;
    ImFontBaked *baked;
    int replaced = 0;

    ours.atlas.TexMaxWidth = ours.atlas.TexMaxHeight = 512;
    baked = ours.add(sans)->GetFontBaked(140, 1);
    for (ImWchar letter = '!'; letter < 0x7F; letter++) {
        const ImFontGlyph *glyph = baked->FindGlyph(letter);
        CHECK(glyph != NULL);
        replaced += glyph->Codepoint != letter;
    }
    CHECK(replaced > 20 && replaced < 94);
}

static void is_refused(Atlas &ours, const void *data, size_t len)
{
    CHECK(ours.add(data, len) == NULL && ours.atlas.Fonts.Size == 0 && nfr_last_error()[0] != 0);
}

static void check_bad(const char *folder, bytes sans)
{
    static const unsigned char erased[4096] = {0xFF, 0xFF, 0xFF, 0xFF};
    const bytes dropped = read_file(folder, "dropped.ttf");
    unsigned opened = 0, halves = 0;

    {
        Atlas ours;
        is_refused(ours, erased, sizeof erased);
        is_refused(ours, sans.data, 200);
    }
    for (unsigned i = 0; i < 400; i++) {
        // Half a font; or bytes of the models that have changed, since Dear ImGui's own loaders trust all others.
        bytes file = i % 8 < 4 ? sans : dropped;
        bool is_half = i % 4 == 0;
        size_t len = is_half ? file.len * i / 400 : file.len, at = 12;
        if (len < 101)
            continue; // which Dear ImGui asserts
        while (memcmp(file.data + at, "Nfrt", 4) != 0)
            at += 16;
        const size_t models = u32(file.data + at + 8);
        unsigned char *copy = static_cast<unsigned char *>(malloc(len));
        memcpy(copy, file.data, len);
        if (!is_half)
            copy[models + (i % 3 == 0 ? i : i * 7919) % u32(file.data + at + 12)] ^= static_cast<unsigned char>(1u << i % 8);
        Atlas ours;
        ImFont *font = ours.add(copy, len);
        if (font != NULL) {
            const char *message;
            halves += is_half;
            opened++;
            for (ImWchar letter = ' '; letter < 0x7F; letter++)
                CHECK(font->GetFontBaked(12, 1)->FindGlyph(letter) != NULL);
            CHECK(nfr_imgui_status(font, &message) != NFR_INTERNAL && message != NULL);
        }
        ours.atlas.Clear();
        free(copy);
    }
    free(dropped.data);
    printf("glue: of 400 damaged fonts %u opened, %u of them halves\n", opened, halves);
}

int main(int argc, char **argv)
{
    CHECK(argc == 2);
    ImGui::CreateContext(); // for the log
    const char *folder = argv[1];
    bytes sans = read_file(folder, "sans.ttf");
    check_pixels(sans);
    check_rest(folder, "partial.ttf", 'b', 'g', NFR_OK);
    check_rest(folder, "damaged.ttf", 'a', 'x', NFR_DAMAGED_GLYPH);
    check_rest(folder, "stale.ttf", 'a', 'x', NFR_STALE);
    check_advances(folder, "sans.ttf");
    check_advances(folder, "damaged.ttf");
    check_advances(folder, "stale.ttf");
    check_advances(folder, "partial.ttf");
    check_plain(folder);
    check_dropped(folder, sans);
    check_loaders(sans);
    check_collection(folder, sans);
    check_full(sans);
    check_bad(folder, sans);
    ImGui::DestroyContext();
    free(sans.data);
    printf("glue: passed with Dear ImGui " SETUP "\n");
    return 0;
}
