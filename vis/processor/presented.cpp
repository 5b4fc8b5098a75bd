#include "vis/processor/presented.h"

#include "vis/optics/grain.h"
#include "vis/processor/present_rows.h"
#include "vis/raycast/brush_uniforms.h"
#include "volume/base/parallel.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <span>

namespace tessera::vis {

namespace {

/// Adds what lines cover of a row's pixels, from `first` on.
void addLines(std::span<const glm::vec4> lines, glm::ivec2 first, std::vector<float>& covered) {
    constexpr double kReach = 0.5 * kBoxLineWidth + 0.5;
    const double y = first.y + 0.5;
    for (const glm::vec4& line : lines) {
        const glm::dvec2 from(line.x, line.y), along = glm::dvec2(line.z, line.w) - from, to = from + along;
        const double square = glm::dot(along, along);
        double low = std::min(from.x, to.x) - kReach, high = std::max(from.x, to.x) + kReach;
        if (y < std::min(from.y, to.y) - kReach || y > std::max(from.y, to.y) + kReach) continue;
        if (std::abs(along.y) > 1e-6) { // of the row only what the strip around the line meets
            const double middle = from.x + (y - from.y) * along.x / along.y;
            const double half = kReach * std::sqrt(square) / std::abs(along.y);
            low = std::max(low, middle - half);
            high = std::min(high, middle + half);
        }
        const auto texel = [&](double x) { return int(std::clamp(x - first.x, 0.0, double(covered.size()))); };
        const int begin = texel(std::floor(low - 0.5)), end = texel(std::ceil(high + 0.5));
        for (int i = begin; i < end; ++i) {
            const glm::dvec2 off = glm::dvec2(first.x + i + 0.5, y) - from;
            const double t = std::clamp(glm::dot(off, along) / std::max(square, 1e-6), 0.0, 1.0);
            const double share = std::clamp(kReach - glm::length(off - t * along), 0.0, 1.0);
            covered[std::size_t(i)] = std::max(covered[std::size_t(i)], float(share));
        }
    }
}

/// What all pixels of a picture share.
struct Ground {
    const Scene& scene;
    std::span<const glm::vec4> behind, before; ///< lines
    PresentedWith with;
    std::optional<Paper> paper; ///< with a grain

    Ground(const Scene& shown, const BoxLines& lines) : scene(shown) {
        const std::span<const glm::vec4> all(lines.edges);
        behind = all.first(all.size() - std::size_t(lines.front));
        before = all.last(std::size_t(lines.front));
        with = {linearFromSrgb(glm::dvec3(groundColor(scene))), linearFromSrgb(glm::dvec3(scene.boxColor)),
                scene.showGround};
        paper = paperOf(scene);
        if (paper && !(paper->tooth > 0)) paper.reset();
    }

    /// The same as rows on vector units, with tones and paper.
    void present(const PixelRow& row, glm::ivec2 first) const {
        for (int i = 0; i < row.count; ++i) {
            const float* seen = row.rgba + std::size_t(4) * std::size_t(i);
            glm::dvec3 light(seen[0], seen[1], seen[2]);
            const double opacity = seen[3];
            if (scene.tone.curve != ToneCurve::None)
                light = toneMap(light / std::max(opacity, 1e-6), scene.tone) * opacity;
            const glm::dvec2 at = (glm::dvec2(first) + glm::dvec2(i + 0.5, 0.5));
            const double shade =
                paper ? paperShade(*grainTile(), at * (kGrainTexels / double(paper->grain)), double(paper->tooth)) : 1;
            const glm::dvec4 shown =
                presentedPixel<double>(with, light, opacity, double(row.behind[i]), double(row.before[i]), shade);
            const glm::u8vec3 color = screenColor(glm::dvec3(shown));
            std::uint8_t* out = row.out + std::size_t(4) * std::size_t(i);
            for (int c = 0; c < 3; ++c) out[c] = color[c];
            out[3] = std::uint8_t(levelOf(shown.a));
        }
    }
};

} // namespace

glm::u8vec3 screenColor(glm::dvec3 linear) {
    return {std::uint8_t(screenLevel(linear.x)), std::uint8_t(screenLevel(linear.y)),
            std::uint8_t(screenLevel(linear.z))};
}

bool presentsPlainly(const Scene& scene) {
    const std::optional<Paper> paper = paperOf(scene);
    return scene.tone.curve == ToneCurve::None && !(paper && paper->tooth > 0) && !blursContext(scene) &&
           !scene.depthMask.any();
}

std::vector<std::uint8_t> presented(const packet::PacketPicture& picture, const packet::PixelBox& box,
                                    const Scene& scene, const BoxLines& lines, packet::InstructionSet with) {
    const Ground ground(scene, lines);
    const bool plain = presentsPlainly(scene);
    const glm::ivec2 extent = box.extent(), begin = glm::max(picture.box.begin, box.begin),
                     end = glm::min(picture.box.end, box.end);
    const auto width = std::size_t(extent.x), held = std::size_t(picture.box.extent().x);
    std::vector<std::uint8_t> out(width * std::size_t(extent.y) * 4);
    parallelFor(std::size_t(extent.y), [&](std::size_t row) {
        const int y = box.begin.y + int(row);
        std::vector<float> rgba(width * 4), behind(width), before(width);
        if (y >= begin.y && y < end.y && begin.x < end.x) {
            const float* from = picture.rgba.data() + 4 * (std::size_t(y - picture.box.begin.y) * held +
                                                           std::size_t(begin.x - picture.box.begin.x));
            std::copy_n(from, std::size_t(4) * std::size_t(end.x - begin.x),
                        rgba.begin() + std::ptrdiff_t(4) * (begin.x - box.begin.x));
        }
        addLines(ground.behind, {box.begin.x, y}, behind);
        addLines(ground.before, {box.begin.x, y}, before);
        const PixelRow pixels{extent.x, rgba.data(), behind.data(), before.data(), out.data() + row * width * 4};
        if (plain)
            presentRow(with, ground.with, pixels);
        else
            ground.present(pixels, {box.begin.x, y});
    });
    return out;
}

} // namespace tessera::vis
