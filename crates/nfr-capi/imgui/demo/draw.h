// Draws what Dear ImGui asks for, without a graphics processor.
#ifndef DRAW_H
#define DRAW_H

#include <vector>

#include "imgui.h"

// Red, green and blue of a row's pixels after the other.
struct Picture {
    int width, height;
    std::vector<unsigned char> pixels;

    Picture(int width, int height) : width(width), height(height), pixels(static_cast<size_t>(width) * height * 3) {}
};

// Draws triangles with bilinear filtering, as graphics processors do, onto an opaque picture.
void draw(const ImDrawData *data, Picture &picture);

#endif
