#include "draw.h"

#include <math.h>

namespace {

struct Color {
    float channel[4];
};

Color unpack(ImU32 packed)
{
    Color color;

    for (int i = 0; i < 4; i++)
        color.channel[i] = static_cast<float>(packed >> (8 * i) & 255) / 255.0f;
    return color;
}

// A texel; those outside are the nearest ones at the edge.
Color texel(const ImTextureData &texture, int x, int y)
{
    x = x < 0 ? 0 : x >= texture.Width ? texture.Width - 1 : x;
    y = y < 0 ? 0 : y >= texture.Height ? texture.Height - 1 : y;
    const unsigned char *at = texture.Pixels + (static_cast<size_t>(y) * texture.Width + x) * texture.BytesPerPixel;
    Color color = {{1, 1, 1, 1}};

    if (texture.Format == ImTextureFormat_Alpha8)
        color.channel[3] = at[0] / 255.0f;
    for (int i = 0; texture.Format == ImTextureFormat_RGBA32 && i < 4; i++)
        color.channel[i] = at[i] / 255.0f;
    return color;
}

Color sample(const ImTextureData &texture, float u, float v)
{
    const float x = u * texture.Width - 0.5f, y = v * texture.Height - 0.5f;
    const float left = floorf(x), top = floorf(y);
    Color sum = {{0, 0, 0, 0}};

    for (int corner = 0; corner < 4; corner++) {
        const int right = corner & 1, down = corner >> 1;
        const float weight = (right ? x - left : 1 - (x - left)) * (down ? y - top : 1 - (y - top));
        const Color color = texel(texture, static_cast<int>(left) + right, static_cast<int>(top) + down);
        for (int i = 0; i < 4; i++)
            sum.channel[i] += weight * color.channel[i];
    }
    return sum;
}

// Twice the area of a triangle of two corners and a point; positive to the right of the edge, with y down.
double edge(const ImVec2 &a, const ImVec2 &b, double x, double y)
{
    return (double(b.x) - a.x) * (y - a.y) - (double(b.y) - a.y) * (x - a.x);
}

// Whether points on an edge belong to the triangle: one of two neighbours has them.
bool is_top_left(const ImVec2 &a, const ImVec2 &b)
{
    return a.y > b.y || (a.y == b.y && a.x < b.x);
}

void triangle(const ImDrawVert *const corners[3], const ImVec4 &clip, const ImTextureData &texture, Picture &picture)
{
    const ImDrawVert *v[3] = {corners[0], corners[1], corners[2]};
    double area = edge(v[0]->pos, v[1]->pos, v[2]->pos.x, v[2]->pos.y);
    if (area == 0)
        return;
    if (area < 0) {
        const ImDrawVert *other = v[1];
        v[1] = v[2];
        v[2] = other;
        area = -area;
    }
    const float left = fminf(v[0]->pos.x, fminf(v[1]->pos.x, v[2]->pos.x)), right = fmaxf(v[0]->pos.x, fmaxf(v[1]->pos.x, v[2]->pos.x));
    const float top = fminf(v[0]->pos.y, fminf(v[1]->pos.y, v[2]->pos.y)), bottom = fmaxf(v[0]->pos.y, fmaxf(v[1]->pos.y, v[2]->pos.y));
    const int first = static_cast<int>(fmaxf(0, fmaxf(clip.x, floorf(left))));
    const int last = static_cast<int>(fminf(picture.width, fminf(clip.z, ceilf(right))));
    const int first_row = static_cast<int>(fmaxf(0, fmaxf(clip.y, floorf(top))));
    const int last_row = static_cast<int>(fminf(picture.height, fminf(clip.w, ceilf(bottom))));

    for (int y = first_row; y < last_row; y++)
        for (int x = first; x < last; x++) {
            float weight[3], u = 0, w = 0;
            bool is_inside = true;
            Color color = {{0, 0, 0, 0}};
            for (int i = 0; i < 3; i++) {
                const ImVec2 &a = v[(i + 1) % 3]->pos, &b = v[(i + 2) % 3]->pos;
                const double side = edge(a, b, x + 0.5, y + 0.5);
                is_inside = is_inside && (side > 0 || (side == 0 && is_top_left(a, b)));
                weight[i] = static_cast<float>(side / area);
            }
            if (!is_inside)
                continue;
            for (int i = 0; i < 3; i++) {
                const Color corner = unpack(v[i]->col);
                u += weight[i] * v[i]->uv.x;
                w += weight[i] * v[i]->uv.y;
                for (int c = 0; c < 4; c++)
                    color.channel[c] += weight[i] * corner.channel[c];
            }
            const Color texture_color = sample(texture, u, w);
            const float alpha = color.channel[3] * texture_color.channel[3];
            unsigned char *pixel = &picture.pixels[(static_cast<size_t>(y) * picture.width + x) * 3];
            for (int c = 0; c < 3; c++) {
                const float above = 255 * color.channel[c] * texture_color.channel[c];
                pixel[c] = static_cast<unsigned char>(lroundf(alpha * above + (1 - alpha) * pixel[c]));
            }
        }
}

} // namespace

void draw(const ImDrawData *data, Picture &picture)
{
    for (const ImDrawList *list : data->CmdLists)
        for (const ImDrawCmd &command : list->CmdBuffer) {
            // The demonstration has no other textures than Dear ImGui's own.
            const ImTextureData &texture = *command.TexRef._TexData;
            for (unsigned i = 0; i + 2 < command.ElemCount; i += 3) {
                const ImDrawVert *corners[3];
                for (unsigned corner = 0; corner < 3; corner++) {
                    const ImDrawIdx index = list->IdxBuffer[static_cast<int>(command.IdxOffset + i + corner)];
                    corners[corner] = &list->VtxBuffer[static_cast<int>(index + command.VtxOffset)];
                }
                triangle(corners, command.ClipRect, texture, picture);
            }
        }
}
