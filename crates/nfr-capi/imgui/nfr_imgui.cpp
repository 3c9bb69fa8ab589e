#include "nfr_imgui.h"

#include "imgui_internal.h"

#include <math.h>
#include <stdio.h>

#ifdef IMGUI_ENABLE_FREETYPE
#include "misc/freetype/imgui_freetype.h"
#endif

// Glyphs are asked for by character until 1.93, by their number in the font from then on.
#if IMGUI_VERSION_NUM >= 19301
#define NFR_IMGUI_BY_NUMBER
typedef int GlyphName;
#else
typedef ImWchar GlyphName;
#endif

namespace {

// Draws what nfr does not: what Dear ImGui would draw with by itself.
const ImFontLoader *rest()
{
#ifdef IMGUI_ENABLE_FREETYPE
    return ImGuiFreeType::GetFontLoader();
#else
    return ImFontAtlasGetFontLoaderForStbTruetype();
#endif
}

void log_line(const char *message)
{
    if (ImGui::GetCurrentContext() != NULL)
        IMGUI_DEBUG_LOG("nfr: %s\n", message);
}

// What is kept for a source of a font, in ImFontConfig::FontLoaderData.
struct Source {
    nfr_font *font;             // NULL if it has no models
    nfr_rasterizer *rasterizer; // NULL if it has no models
    float ascent, descent;      // of a font of one pixel per em
    bool has_rest;              // the loader for the rest has it open
    void *rest_data;            // what that one keeps for it
    nfr_status status;
    char message[200];

    Source() : font(NULL), rasterizer(NULL), ascent(0), descent(0), has_rest(false), rest_data(NULL), status(NFR_OK) { message[0] = 0; }

    ~Source()
    {
        nfr_rasterizer_free(rasterizer);
        nfr_font_free(font);
    }

    // Keeps the first thing that went wrong.
    void note(nfr_status what)
    {
        if (what == NFR_OK || what == NFR_MISSING_MODEL || status != NFR_OK)
            return;
        status = what;
        snprintf(message, sizeof message, "%s", nfr_last_error());
        if (what != NFR_NO_MODELS)
            log_line(message);
    }
};

Source *source_of(const ImFontConfig *src)
{
    return static_cast<Source *>(src->FontLoaderData);
}

// While it lives, the source belongs to the loader for the rest.
struct Lent {
    ImFontConfig *src;
    Source *source;

    explicit Lent(ImFontConfig *src) : src(src), source(source_of(src)) { src->FontLoaderData = source->rest_data; }

    ~Lent()
    {
        source->rest_data = src->FontLoaderData;
        src->FontLoaderData = source;
    }
};

// A source at a size.
struct Scale {
    float density; // pixels of the display in one of Dear ImGui's
    float ppem;

    Scale(const ImFontConfig *src, const ImFontBaked *baked) : density(src->RasterizerDensity * baked->RasterizerDensity)
    {
        const Source *source = source_of(src);
        const float reference = baked->OwnerFont->Sources[0]->SizePixels;
        const float height = source->ascent - source->descent;
        uint16_t first, last;

        ppem = baked->Size * src->ExtraSizeScale * density / height;
        if (src->MergeMode && src->SizePixels != 0.0f && reference != 0.0f)
            ppem *= src->SizePixels / reference;
        const float whole = floorf(ppem + 0.5f);
        if (nfr_font_ppem_range(source->font, &first, &last) == NFR_OK && whole >= first && whole <= last)
            ppem = whole;
    }
};

uint32_t u32(const uint8_t *at)
{
    return static_cast<uint32_t>(at[0]) << 24 | static_cast<uint32_t>(at[1]) << 16 | static_cast<uint32_t>(at[2]) << 8 | at[3];
}

// Whether all tables of a font are inside the file, which stb_truetype does not check (OpenType 1.9, "Organization of an OpenType Font").
bool has_all_tables(const uint8_t *data, size_t len, uint32_t index)
{
    size_t font = 0;

    if (len < 12)
        return false;
    if (u32(data) == 0x74746366) { // ttcf
        if (index >= u32(data + 8) || index >= (len - 12) / 4)
            return false;
        font = u32(data + 12 + 4 * static_cast<size_t>(index));
    } else if (index > 0) {
        return false;
    }
    if (font > len || len - font < 12)
        return false;
    const size_t tables = static_cast<size_t>(data[font + 4]) << 8 | data[font + 5];
    if (tables > (len - font - 12) / 16)
        return false;
    for (size_t i = 0; i < tables; i++) {
        const uint8_t *table = data + font + 12 + 16 * i;
        if (u32(table + 8) > len || u32(table + 12) > len - u32(table + 8))
            return false;
    }
    return true;
}

// Opens the models of a source.
nfr_status open_models(Source *source, const ImFontConfig *src)
{
    nfr_line_metrics line;
    const uint8_t *data = static_cast<const uint8_t *>(src->FontData);
    const size_t len = src->FontDataSize > 0 ? static_cast<size_t>(src->FontDataSize) : 0;
    nfr_status status = nfr_font_new_borrowed(data, len, src->FontNo, NULL, NULL, &source->font);

    if (status == NFR_OK)
        status = nfr_font_line_metrics(source->font, 1.0f, &line);
    if (status == NFR_OK && line.ascent > line.descent) {
        source->ascent = line.ascent;
        source->descent = line.descent;
        status = nfr_rasterizer_new(source->font, &source->rasterizer);
    }
    return status;
}

bool src_init(ImFontAtlas *atlas, ImFontConfig *src)
{
    IM_ASSERT(src->FontLoaderData == NULL);
    Source *source = IM_NEW(Source);
    const nfr_status status = open_models(source, src);

    source->note(status);
    src->FontLoaderData = source;
    const bool is_read = status == NFR_OK || status == NFR_NO_MODELS || status == NFR_UNKNOWN_VERSION || status == NFR_STALE;
    if (is_read && has_all_tables(static_cast<const uint8_t *>(src->FontData), static_cast<size_t>(src->FontDataSize), src->FontNo)) {
        Lent lent(src);
        source->has_rest = rest()->FontSrcInit(atlas, src);
    } else if (is_read) {
        log_line("the file ends before the font's last table");
    }
    if (!source->has_rest && source->rasterizer == NULL) {
        IM_DELETE(source);
        src->FontLoaderData = NULL;
        return false;
    }
    if (src->MergeMode && src->SizePixels == 0.0f)
        src->SizePixels = src->DstFont->Sources[0]->SizePixels;
    return true;
}

void src_destroy(ImFontAtlas *atlas, ImFontConfig *src)
{
    Source *source = source_of(src);

    if (source != NULL && source->has_rest) {
        Lent lent(src);
        rest()->FontSrcDestroy(atlas, src);
    }
    IM_DELETE(source);
    src->FontLoaderData = NULL;
}

uint32_t glyph_of(const Source *source, GlyphName name)
{
#ifdef NFR_IMGUI_BY_NUMBER
    IM_UNUSED(source);
    return static_cast<uint32_t>(name);
#else
    return nfr_font_glyph_for_char(source->font, name);
#endif
}

#ifdef NFR_IMGUI_BY_NUMBER
int src_glyph_index(ImFontAtlas *atlas, ImFontConfig *src, ImWchar character)
{
    const Source *source = source_of(src);

    if (source == NULL)
        return 0;
    if (source->font != NULL)
        return static_cast<int>(nfr_font_glyph_for_char(source->font, character));
    Lent lent(src);
    return rest()->FontSrcGetGlyphIndexFromCodepoint(atlas, src, character);
}
#endif

bool src_contains_glyph(ImFontAtlas *atlas, ImFontConfig *src, GlyphName name)
{
    const Source *source = source_of(src);

    if (source == NULL)
        return false;
    if (source->font != NULL) {
        const uint32_t glyph = glyph_of(source, name);
        return glyph > 0 && glyph < nfr_font_glyph_count(source->font);
    }
    Lent lent(src);
    return rest()->FontSrcContainsGlyph(atlas, src, name);
}

bool baked_init(ImFontAtlas *atlas, ImFontConfig *src, ImFontBaked *baked, void *data)
{
    const Source *source = source_of(src);

    if (source == NULL)
        return false;
    if (source->has_rest) {
        Lent lent(src);
        if (!rest()->FontBakedInit(atlas, src, baked, data))
            return false;
    }
    if (source->rasterizer != NULL && !src->MergeMode) {
        // A line's metrics are not multiplied by ExtraSizeScale. The baseline is at a whole pixel of the display.
        const Scale scale(src, baked);
        const float size = scale.ppem / src->ExtraSizeScale;
        baked->Ascent = ceilf(source->ascent * size) / scale.density;
        baked->Descent = floorf(source->descent * size) / scale.density;
    }
    return true;
}

void baked_destroy(ImFontAtlas *atlas, ImFontConfig *src, ImFontBaked *baked, void *data)
{
    const Source *source = source_of(src);

    if (source != NULL && source->has_rest && rest()->FontBakedDestroy != NULL) {
        Lent lent(src);
        rest()->FontBakedDestroy(atlas, src, baked, data);
    }
}

// Puts pixels into the atlas; false if it has no room.
bool pack(ImFontAtlas *atlas, ImFontConfig *src, ImFontBaked *baked, float density, const uint8_t *pixels, const nfr_placement &place,
          ImFontGlyph *out)
{
    const int width = static_cast<int>(place.width), height = static_cast<int>(place.height);
    const ImFontAtlasRectId id = ImFontAtlasPackAddRect(atlas, width, height);
    if (id == ImFontAtlasRectId_Invalid)
        return false;
    const float reference = baked->OwnerFont->Sources[0]->SizePixels;
    const float factor = reference != 0.0f ? baked->Size / reference : 1.0f;
    const float x = floorf(src->GlyphOffset.x * factor + 0.5f);
    const float y = floorf(src->GlyphOffset.y * factor + 0.5f) + baked->Ascent;

    out->X0 = x + static_cast<float>(place.left) / density;
    out->Y0 = y - static_cast<float>(place.top) / density;
    out->X1 = x + static_cast<float>(place.left + width) / density;
    out->Y1 = y - static_cast<float>(place.top - height) / density;
    out->Visible = true;
    out->PackId = id;
    ImFontAtlasBakedSetFontGlyphBitmap(atlas, baked, src, out, ImFontAtlasPackGetRect(atlas, id), pixels, ImTextureFormat_Alpha8, width);
    return true;
}

bool baked_load_glyph(ImFontAtlas *atlas, ImFontConfig *src, ImFontBaked *baked, void *data, GlyphName name, ImFontGlyph *out,
                      float *out_advance)
{
    Source *source = source_of(src);

    if (source != NULL && source->rasterizer != NULL) {
        const Scale scale(src, baked);
        const uint32_t glyph = glyph_of(source, name);
        const uint8_t *pixels = NULL;
        nfr_placement place = {0, 0, 0, 0};
        float advance;
        // Also where only the advance is asked for: that of a glyph that cannot be drawn is the other loader's.
        nfr_status status = glyph == 0 ? NFR_MISSING_MODEL : nfr_rasterizer_hinted_advance(source->rasterizer, glyph, scale.ppem, &advance);

        if (status == NFR_OK)
            status = nfr_rasterizer_draw(source->rasterizer, glyph, scale.ppem, 0, 0, &pixels, &place);
        source->note(status);
        if (status == NFR_OK && out_advance != NULL) {
            *out_advance = advance / scale.density;
            return true;
        }
        if (status == NFR_OK) {
#ifndef NFR_IMGUI_BY_NUMBER
            out->Codepoint = name;
#endif
            out->AdvanceX = advance / scale.density;
            return place.width == 0 || place.height == 0 || pack(atlas, src, baked, scale.density, pixels, place, out);
        }
        // It would draw an empty outline.
        if (nfr_font_outlines_dropped(source->font) && nfr_font_has_model(source->font, glyph))
            return false;
    }
    if (source == NULL || !source->has_rest)
        return false;
    Lent lent(src);
    return rest()->FontBakedLoadGlyph(atlas, src, baked, data, name, out, out_advance);
}

ImFontLoader make_loader()
{
    ImFontLoader loader;

    loader.Name = "nfr";
    // Called with the atlas, not with a source: the other loader's as they are.
    loader.LoaderInit = rest()->LoaderInit;
    loader.LoaderShutdown = rest()->LoaderShutdown;
    loader.FontSrcInit = src_init;
    loader.FontSrcDestroy = src_destroy;
#ifdef NFR_IMGUI_BY_NUMBER
    loader.FontSrcGetGlyphIndexFromCodepoint = src_glyph_index;
#endif
    loader.FontSrcContainsGlyph = src_contains_glyph;
    loader.FontBakedInit = baked_init;
    loader.FontBakedDestroy = baked_destroy;
    loader.FontBakedLoadGlyph = baked_load_glyph;
    loader.FontBakedSrcLoaderDataSize = rest()->FontBakedSrcLoaderDataSize;
    return loader;
}

} // namespace

const ImFontLoader *nfr_imgui_font_loader()
{
    static const ImFontLoader loader = make_loader();

    return &loader;
}

nfr_status nfr_imgui_status(const ImFont *font, const char **message)
{
    static const char none[] = "the font is not one of nfr's loader";
    nfr_status status = NFR_NULL_POINTER;

    if (message != NULL)
        *message = none;
    if (font == NULL || font->OwnerAtlas == NULL)
        return status;
    for (int i = 0; i < font->Sources.Size; i++) {
        const ImFontConfig *src = font->Sources[i];
        const ImFontLoader *loader = src->FontLoader != NULL ? src->FontLoader : font->OwnerAtlas->FontLoader;
        if (loader != nfr_imgui_font_loader() || source_of(src) == NULL || (status != NFR_OK && status != NFR_NULL_POINTER))
            continue;
        status = source_of(src)->status;
        if (message != NULL)
            *message = source_of(src)->message;
    }
    return status;
}
