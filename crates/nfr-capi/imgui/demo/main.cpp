// demo NEURAL ORIGINAL OUT.ppm: draws a window of settings with nfr, with Dear ImGui's stb_truetype and with its FreeType, one beside the
// other, and prints what glyphs take.
#include <stdio.h>
#include <stdlib.h>

#include <algorithm>
#include <chrono>

#include "draw.h"
#include "imgui_internal.h"
#include "misc/freetype/imgui_freetype.h"
#include "nfr_imgui.h"

static const int width = 340, height = 320, ways = 3;

struct Way {
    const char *name, *path;
    const ImFontLoader *loader;
};

static void window(const char *name)
{
    static bool is_sharp = true, is_shown = false;
    static float size = 14;
    static int theme = 1;

    ImGui::SetNextWindowPos(ImVec2(8, 8));
    ImGui::SetNextWindowSize(ImVec2(width - 16, height - 16));
    ImGui::Begin("Settings", NULL, ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse);
    ImGui::SeparatorText(name);
    ImGui::Checkbox("Align text to whole pixels", &is_sharp);
    ImGui::Checkbox("Show invisible characters", &is_shown);
    ImGui::SliderFloat("Text size", &size, 9, 24, "%.0f px");
    ImGui::Combo("Theme", &theme, "Light\0Dark, with high contrast\0");
    for (float pixels : {14.0f, 16.0f, 18.0f}) { // Liberation Sans: 12, 14, 16 pixels per em
        ImGui::PushFont(NULL, pixels);
        ImGui::Text("Hamburgefonstiv illegal 0123 (%.0f)", pixels);
        ImGui::TextDisabled("The quick brown fox jumps over 4");
        ImGui::PopFont();
    }
    ImGui::Button("Cancel");
    ImGui::SameLine();
    ImGui::Button("Save changes");
    ImGui::End();
}

static void show(const Way &way, Picture &picture)
{
    ImGui::CreateContext();
    ImGuiIO &io = ImGui::GetIO();
    io.IniFilename = NULL;
    io.DisplaySize = ImVec2(width, height);
    io.BackendFlags |= ImGuiBackendFlags_RendererHasTextures;
    io.Fonts->SetFontLoader(way.loader);
    if (io.Fonts->AddFontFromFileTTF(way.path, 16.0f) == NULL) {
        fprintf(stderr, "cannot open %s: %s\n", way.path, nfr_last_error());
        exit(1);
    }
    for (int frame = 0; frame < 3; frame++) { // until the layout is settled
        ImGui::NewFrame();
        window(way.name);
        ImGui::Render();
        for (ImTextureData *texture : *ImGui::GetDrawData()->Textures) {
            if (texture->Status != ImTextureStatus_WantDestroy)
                texture->SetTexID(1);
            texture->SetStatus(texture->Status == ImTextureStatus_WantDestroy ? ImTextureStatus_Destroyed : ImTextureStatus_OK);
        }
    }
    std::fill(picture.pixels.begin(), picture.pixels.end(), 30);
    draw(ImGui::GetDrawData(), picture);
    ImGui::DestroyContext();
}

// Microseconds a glyph of ASCII in a new atlas, at one size after the other.
static void time_of(const Way &way)
{
    const float sizes[] = {16.0f, 18.0f, 14.0f};
    double best[] = {1e9, 1e9, 1e9};
    int texels = 0;

    for (int round = 0; round < 200; round++) {
        ImFontAtlas atlas;
        atlas.TexDesiredFormat = ImTextureFormat_Alpha8;
        atlas.TexMinWidth = 1024; // so that it need not grow
        atlas.RendererHasTextures = true;
        atlas.SetFontLoader(way.loader);
        ImFont *font = atlas.AddFontFromFileTTF(way.path, 16.0f);
        for (int i = 0; i < 3; i++) {
            const auto start = std::chrono::steady_clock::now();
            ImFontBaked *baked = font->GetFontBaked(sizes[i], 1);
            for (ImWchar letter = ' '; letter < 0x7F; letter++)
                baked->FindGlyph(letter);
            const std::chrono::duration<double, std::micro> taken = std::chrono::steady_clock::now() - start;
            best[i] = std::min(best[i], taken.count() / 95);
            texels = i ? texels : static_cast<int>(baked->MetricsTotalSurface);
        }
    }
    printf("%-13s a glyph of 16 pixels %6.2f us, then of 18 %6.2f, then of 14 %6.2f; ASCII at 16 takes %d texels\n", way.name,
           best[0], best[1], best[2], texels);
}

int main(int argc, char **argv)
{
    if (argc != 4)
        return fprintf(stderr, "usage: demo NEURAL ORIGINAL OUT.ppm\n"), 2;
    const Way all[ways] = {{"nfr", argv[1], nfr_imgui_font_loader()},
                           {"stb_truetype", argv[2], ImFontAtlasGetFontLoaderForStbTruetype()},
                           {"FreeType", argv[2], ImGuiFreeType::GetFontLoader()}};
    std::vector<Picture> pictures(ways, Picture(width, height));
    FILE *out = fopen(argv[3], "wb");

    for (int i = 0; i < ways; i++) {
        show(all[i], pictures[i]);
        time_of(all[i]);
    }
    for (int i = 1; i < ways; i++) {
        double sum = 0;
        for (size_t at = 0; at < pictures[0].pixels.size(); at++)
            sum += abs(pictures[0].pixels[at] - pictures[i].pixels[at]);
        printf("mean difference of the windows of nfr and %s: %.2f of 255 levels\n", all[i].name, sum / pictures[0].pixels.size());
    }
    if (out == NULL || fprintf(out, "P6\n%d %d\n255\n", ways * width, height) < 0)
        return fprintf(stderr, "cannot write %s\n", argv[3]), 1;
    for (int y = 0; y < height; y++)
        for (const Picture &picture : pictures)
            fwrite(&picture.pixels[static_cast<size_t>(y) * width * 3], 3, width, out);
    return fclose(out) != 0;
}
