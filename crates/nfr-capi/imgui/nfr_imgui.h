/*
 * A font loader for Dear ImGui, 1.92.9 and 1.93: what has a model in its font is drawn by nfr, everything else as before.
 *
 *     ImFontAtlas *fonts = ImGui::GetIO().Fonts;
 *     fonts->SetFontLoader(nfr_imgui_font_loader()); // for all fonts; or ImFontConfig::FontLoader for one
 *     fonts->AddFontFromFileTTF("sans.nfr.ttf", 16.0f);
 *
 * Compile nfr_imgui.cpp into the program, as C++11 or later, with Dear ImGui's headers and imconfig.h, and link libnfr.
 *
 * What is drawn as before, by stb_truetype, or by FreeType if IMGUI_ENABLE_FREETYPE is defined: fonts without models or with
 * models of another version, glyphs without a model and with a damaged or outdated one. nfr_imgui_status tells of these. A font
 * is refused, so that AddFont returns NULL, if it or its table of models is damaged, if the file ends early, and if it has no font
 * ImFontConfig::FontNo: Dear ImGui's debug log says why. It also has the first model of a font that cannot be used.
 *
 * Sizes. A size is Dear ImGui's, as with stb_truetype and FreeType: the font's ascent and descent together, so Liberation Sans
 * at 16 pixels has 14 pixels per em, and lines stay where they are. Pixels per em are rounded to a whole number where the models
 * are hinted (nfr_font_ppem_range), so that all advances are whole pixels; beyond these sizes nothing is hinted or rounded. For
 * a size that is pixels per em, set ImFontConfig::ExtraSizeScale to (ascent - descent) / ppem of nfr_font_line_metrics.
 * ImFontConfig::RasterizerDensity and the context's density multiply the size; a pixel is then the display's.
 *
 * Glyphs are drawn at whole pixels. OversampleH and OversampleV are for stb_truetype's glyphs only. GlyphOffset,
 * GlyphMinAdvanceX and GlyphMaxAdvanceX, GlyphExtraAdvanceX, RasterizerMultiply and MergeMode have their usual effect.
 *
 * With IMGUI_ENABLE_FREETYPE use SetFontLoader: Dear ImGui does not start a loader that a single font brings.
 *
 * Memory. The font's bytes are not copied. nfr_imgui.cpp allocates by IM_NEW; libnfr by malloc, and it ends the process if that
 * fails. A glyph for which the atlas has no room is replaced by the font's fallback glyph. Threads: as the atlas, one at a time.
 */
#ifndef NFR_IMGUI_H
#define NFR_IMGUI_H

#include "imgui.h"
#include "nfr.h"

/* The loader. Never NULL, valid always, always the same. */
const ImFontLoader *nfr_imgui_font_loader();

/*
 * What has happened to a font of this loader so far: NFR_OK; NFR_NO_MODELS if it was not converted; or the status of the first of its
 * sources or glyphs whose model is damaged, outdated, of another version, or asks for more than the limits allow. NFR_NULL_POINTER if
 * font is NULL or comes from another loader.
 *
 * message: receives a sentence on it, valid as long as the font, never NULL; or NULL.
 */
nfr_status nfr_imgui_status(const ImFont *font, const char **message);

#endif
