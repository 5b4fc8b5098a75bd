#include "vis/processor/presented.h"

#include "vis/optics/grain.h"
#include "vis/optics/ray_setup.h"
#include "volume/base/parallel.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <span>

namespace tessera::vis {

namespace {

std::uint8_t bitsOf(double share) {
    return std::uint8_t(std::clamp(share, 0.0, 1.0) * 255 + 0.5);
}

/// What all pixels of a picture share.
struct Ground {
    const Scene& scene;
    std::span<const glm::vec4> behind, before; ///< lines
    glm::dvec3 color, lineColor;               ///< linear
    std::optional<Paper> paper;                ///< with a grain

    Ground(const Scene& shown, const BoxLines& lines) : scene(shown) {
        const std::span<const glm::vec4> all(lines.edges);
        behind = all.first(all.size() - std::size_t(lines.front));
        before = all.last(std::size_t(lines.front));
        color = linearFromSrgb(glm::dvec3(groundColor(scene)));
        lineColor = linearFromSrgb(glm::dvec3(scene.boxColor));
        paper = paperOf(scene);
        if (paper && !(paper->tooth > 0)) paper.reset();
    }
};

/// Coverage of a pixel by lines.
double coveredByLines(std::span<const glm::vec4> lines, glm::dvec2 pixel) {
    double covered = 0;
    for (const glm::vec4& line : lines) {
        const glm::dvec2 from(line.x, line.y), along = glm::dvec2(line.z, line.w) - from, to = pixel - from;
        const double t = glm::clamp(glm::dot(to, along) / std::max(glm::dot(along, along), 1e-6), 0.0, 1.0);
        covered = std::max(covered, 0.5 * kBoxLineWidth + 0.5 - glm::length(to - t * along));
    }
    return std::min(covered, 1.0);
}

/// The colour of a pixel, linear, and its opacity. `seen`: of the picture there, linear and premultiplied.
glm::dvec4 presentedPixel(const Ground& ground, glm::dvec4 seen, glm::dvec2 pixel) {
    glm::dvec3 light(seen);
    const double opacity = seen.a;
    if (ground.scene.tone.curve != ToneCurve::None)
        light = toneMap(light / std::max(opacity, 1e-6), ground.scene.tone) * opacity;
    const double behind = coveredByLines(ground.behind, pixel), before = coveredByLines(ground.before, pixel);
    if (ground.scene.showGround) {
        glm::dvec3 color = light + (1 - opacity) * glm::mix(ground.color, ground.lineColor, behind);
        if (const auto& paper = ground.paper)
            color *= paperShade(*grainTile(), pixel * (kGrainTexels / double(paper->grain)), double(paper->tooth));
        return {glm::mix(color, ground.lineColor, before), 1};
    }
    glm::dvec4 over(light + (1 - opacity) * ground.lineColor * behind, opacity + (1 - opacity) * behind);
    over = glm::mix(over, glm::dvec4(ground.lineColor, 1), before);
    return {glm::dvec3(over) / std::max(over.a, 1e-6), over.a};
}

} // namespace

glm::u8vec3 screenColor(glm::dvec3 linear) {
    return {bitsOf(srgbFromLinear(std::clamp(linear.x, 0.0, 1.0))),
            bitsOf(srgbFromLinear(std::clamp(linear.y, 0.0, 1.0))),
            bitsOf(srgbFromLinear(std::clamp(linear.z, 0.0, 1.0)))};
}

std::vector<std::uint8_t> presented(const packet::PacketPicture& picture, const Scene& scene, const BoxLines& lines) {
    const Ground ground(scene, lines);
    std::vector<std::uint8_t> out(picture.rgba.size());
    const std::size_t width = std::size_t(picture.size.x);
    parallelFor(std::size_t(picture.size.y), [&](std::size_t y) {
        for (std::size_t x = 0; x < width; ++x) {
            const std::size_t at = (y * width + x) * 4;
            const float* seen = &picture.rgba[at];
            const glm::dvec4 shown =
                presentedPixel(ground, {seen[0], seen[1], seen[2], seen[3]}, glm::dvec2(double(x), double(y)) + 0.5);
            const glm::u8vec3 color = screenColor(glm::dvec3(shown));
            for (int c = 0; c < 3; ++c) out[at + std::size_t(c)] = color[c];
            out[at + 3] = bitsOf(shown.a);
        }
    });
    return out;
}

} // namespace tessera::vis
