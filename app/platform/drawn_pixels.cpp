#include "app/platform/drawn_pixels.h"

#include "vis/gl/texture_name.h"
#include "volume/base/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace tessera::app {

namespace {

constexpr double kSubpixels = 256; ///< corners lie on this grid, as those of OpenGL do
using GridPoint = glm::vec<2, std::int64_t>;

glm::vec4 colorOf(ImU32 packed) {
    return glm::vec4(packed >> IM_COL32_R_SHIFT & 255, packed >> IM_COL32_G_SHIFT & 255,
                     packed >> IM_COL32_B_SHIFT & 255, packed >> IM_COL32_A_SHIFT & 255) /
           255.0f;
}

/// A texture at positions of 0..1 across it.
class Sampler {
public:
    /// `nearest`: the colour of the texel there, else interpolated.
    Sampler(const vis::MemoryTexture& texture, bool nearest) : texture_(texture), nearest_(nearest) {}

    glm::vec4 at(glm::vec2 place) const {
        const glm::vec2 texel = place * glm::vec2(texture_.size);
        if (nearest_) return texelAt(glm::ivec2(glm::floor(texel)));
        const glm::vec2 from = glm::floor(texel - 0.5f), part = texel - 0.5f - from;
        const glm::ivec2 a(from), b = a + 1;
        return glm::mix(glm::mix(texelAt(a), texelAt({b.x, a.y}), part.x),
                        glm::mix(texelAt({a.x, b.y}), texelAt(b), part.x), part.y);
    }

private:
    glm::vec4 texelAt(glm::ivec2 at) const {
        at = glm::clamp(at, glm::ivec2(0), texture_.size - 1);
        const std::uint8_t* of =
            &texture_.rgba[(std::size_t(at.y) * std::size_t(texture_.size.x) + std::size_t(at.x)) * 4];
        return glm::vec4(of[0], of[1], of[2], of[3]) / 255.0f;
    }

    const vis::MemoryTexture& texture_;
    bool nearest_;
};

/// What changes linearly across a triangle.
struct Corner {
    glm::vec2 texture{0};
    glm::vec4 color{0};
    Corner operator*(float f) const { return {texture * f, color * f}; }
    Corner operator+(const Corner& b) const { return {texture + b.texture, color + b.color}; }
};

struct PixelTriangle {
    std::array<GridPoint, 3> at; ///< on the grid, counter-clockwise in a space whose y runs down
    std::array<Corner, 3> corners;
    std::int64_t area = 0; ///< twice the area; 0: nothing is drawn

    PixelTriangle(const std::array<ImDrawVert, 3>& vertices) {
        for (std::size_t i = 0; i < 3; ++i) {
            const ImDrawVert& v = vertices[i];
            at[i] = {std::llround(double(v.pos.x) * kSubpixels), std::llround(double(v.pos.y) * kSubpixels)};
            corners[i] = {{v.uv.x, v.uv.y}, colorOf(v.col)};
        }
        area = edge(0, at[2]);
        if (area >= 0) return;
        std::swap(at[1], at[2]);
        std::swap(corners[1], corners[2]);
        area = -area;
    }
    /// Twice the area between edge i and a point: positive inside.
    std::int64_t edge(std::size_t i, GridPoint point) const {
        const GridPoint a = at[i], along = at[(i + 1) % 3] - a, to = point - a;
        return along.x * to.y - along.y * to.x;
    }
    /// Whether pixels exactly on edge i belong to the triangle, so that of two that share the edge one has them: those
    /// on left and lower edges, as in framebuffers of OpenGL.
    bool owns(std::size_t i) const {
        const GridPoint along = at[(i + 1) % 3] - at[i];
        return along.y < 0 || (along.y == 0 && along.x < 0);
    }
    bool plain(glm::vec2 white) const {
        return std::ranges::all_of(corners,
                                   [&](const Corner& c) { return c.texture == white && c.color == corners[0].color; });
    }
    /// Whether a texture has more than one pixel for each texel.
    bool magnifies(glm::ivec2 texels) const {
        glm::dvec2 dx(0), dy(0);
        for (std::size_t i = 0; i < 3; ++i) {
            const GridPoint along = at[(i + 1) % 3] - at[i]; // the weight of the corner opposite changes by this
            const glm::dvec2 place = glm::dvec2(corners[(i + 2) % 3].texture) * glm::dvec2(texels);
            dx += place * double(-along.y);
            dy += place * double(along.x);
        }
        return std::max(glm::length(dx), glm::length(dy)) * kSubpixels <= double(area);
    }
};

/// Blends a colour over a pixel.
void blendPixel(std::uint8_t* pixel, glm::vec4 color) {
    const float rest = 1 - color.a;
    const glm::vec4 added(glm::vec3(color) * color.a, color.a);
    for (int c = 0; c < 4; ++c)
        pixel[c] = std::uint8_t(std::min(added[c] * 255 + rest * float(pixel[c]), 255.0f) + 0.5f);
}

/// Pixels [lo, hi) of a frame.
struct PixelArea {
    glm::ivec2 lo{0}, hi{0};
};

/// The pixels that a command may draw. Rounded as by ImGui's back end for OpenGL, which counts rows from the bottom.
PixelArea clipOf(const ImDrawCmd& command) {
    const ImVec4 clip = command.ClipRect;
    const float height = ImGui::GetIO().DisplaySize.y;
    const int bottom = int(height) - int(height - clip.w), left = int(clip.x);
    return {{left, bottom - int(clip.w - clip.y)}, {left + int(clip.z - clip.x), bottom}};
}

/// Draws a triangle within `area`; `origin`: the frame's pixel that is the first one of the image.
void drawTriangle(const PixelTriangle& triangle, const vis::MemoryTexture& texture, glm::vec2 white, PixelArea area,
                  glm::ivec2 origin, vis::Image& image) {
    const auto [a, b, c] = triangle.at;
    const glm::dvec2 least(glm::min(glm::min(a, b), c)), most(glm::max(glm::max(a, b), c));
    area.lo = glm::max(area.lo, glm::ivec2(glm::floor(least / kSubpixels)));
    area.hi = glm::min(area.hi, glm::ivec2(glm::ceil(most / kSubpixels)));
    if (triangle.area == 0 || area.lo.x >= area.hi.x || area.lo.y >= area.hi.y) return;
    const bool plain = triangle.plain(white);
    const Sampler sampler(texture, !texture.smooth && triangle.magnifies(texture.size));
    const glm::vec4 one = plain ? sampler.at(white) * triangle.corners[0].color : glm::vec4(0);
    std::array<std::int64_t, 3> lowest;
    for (std::size_t i = 0; i < 3; ++i) lowest[i] = triangle.owns(i) ? 0 : 1;
    const auto drawRow = [&](int y) {
        std::uint8_t* row = &image.rgba[std::size_t(y - origin.y) * std::size_t(image.size.x) * 4];
        constexpr auto kGrid = std::int64_t(kSubpixels);
        std::array<std::int64_t, 3> inside, change;
        for (std::size_t i = 0; i < 3; ++i) {
            inside[i] = triangle.edge(i, GridPoint(area.lo.x, y) * kGrid + kGrid / 2);
            change[i] = -(triangle.at[(i + 1) % 3] - triangle.at[i]).y * kGrid;
        }
        for (int x = area.lo.x; x < area.hi.x; ++x) {
            if (inside[0] >= lowest[0] && inside[1] >= lowest[1] && inside[2] >= lowest[2]) {
                std::uint8_t* pixel = row + std::size_t(x - origin.x) * 4;
                if (plain) {
                    blendPixel(pixel, one);
                } else {
                    const float whole = 1 / float(triangle.area);
                    const Corner here = triangle.corners[2] * (float(inside[0]) * whole) +
                                        triangle.corners[0] * (float(inside[1]) * whole) +
                                        triangle.corners[1] * (float(inside[2]) * whole);
                    blendPixel(pixel, sampler.at(here.texture) * here.color);
                }
            }
            for (std::size_t i = 0; i < 3; ++i) inside[i] += change[i];
        }
    };
    const auto rows = std::size_t(area.hi.y - area.lo.y);
    constexpr std::size_t kMany = 64;
    parallelFor(
        rows, [&](std::size_t i) { drawRow(area.lo.y + int(i)); }, kMany);
}

} // namespace

void drawPixels(const ImDrawList& list, const ImDrawCmd& command, glm::ivec2 lo, vis::Image& image) {
    // NOLINTNEXTLINE(performance-no-int-to-ptr): a name of a picture in memory is its address
    const auto* texture = reinterpret_cast<const vis::MemoryTexture*>(std::uintptr_t(command.GetTexID()));
    if (!texture || texture->rgba.empty()) return;
    const PixelArea clip = clipOf(command);
    const PixelArea area{glm::max(clip.lo, lo), glm::min(clip.hi, lo + image.size)};
    const ImVec2 white = ImGui::GetIO().Fonts->TexUvWhitePixel;
    const bool letters = command.GetTexID() == ImGui::GetIO().Fonts->TexID;
    const glm::vec2 nowhere(-1);
    for (unsigned i = 0; i + 2 < command.ElemCount; i += 3) {
        std::array<ImDrawVert, 3> vertices;
        for (unsigned k = 0; k < 3; ++k)
            vertices[k] = list.VtxBuffer[int(command.VtxOffset + list.IdxBuffer[int(command.IdxOffset + i + k)])];
        drawTriangle(PixelTriangle(vertices), *texture, letters ? glm::vec2(white.x, white.y) : nowhere, area, lo,
                     image);
    }
}

} // namespace tessera::app
