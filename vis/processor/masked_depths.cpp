#include "vis/processor/masked_depths.h"

#include "vis/formulas/depth_mask.h"
#include "volume/base/parallel.h"

#include <algorithm>
#include <cassert>
#include <glm/common.hpp>

namespace tessera::vis {

packet::PacketPicture maskedDepths(const packet::PacketPicture& picture, const Scene& scene, const WorldFrame& frame) {
    assert(picture.box.extent() == picture.size && !picture.pick.empty());
    const glm::ivec2 size = picture.size;
    const DepthSpan span = depthSpan(scene.camera, frame);
    const auto index = [&](glm::ivec2 at) { return std::size_t(at.y) * std::size_t(size.x) + std::size_t(at.x); };
    std::vector<float> depths(picture.pick.size());
    std::ranges::transform(picture.pick, depths.begin(), [&](float distance) {
        return float(pixelDepth<double>(double(distance), {span.near, span.perDistance}));
    });
    const auto depthAt = [&](glm::dvec2 pixel) {
        return double(depths[index(glm::clamp(glm::ivec2(glm::floor(pixel)), glm::ivec2(0), size - 1))]);
    };
    const double radius = double(scene.depthMask.width) * size.y;
    std::vector<glm::dvec3> taps; // offset in pixels and weight
    double weight = 0;
    for (int i = 0; i < kDepthTaps; ++i) {
        taps.emplace_back(radius * depthTap<double>(i), depthTapWeight<double>(i));
        weight += taps.back().z;
    }
    packet::PacketPicture out = picture;
    parallelFor(std::size_t(size.y), [&](std::size_t row) {
        for (int x = 0; x < size.x; ++x) {
            const glm::dvec2 pixel(x + 0.5, double(row) + 0.5);
            double sum = 0, own = 0;
            for (const glm::dvec3& tap : taps) sum += tap.z * depthAt(pixel + glm::dvec2(tap));
            for (int i = 0; i < 9; ++i) own += depthAt(pixel + glm::dvec2(i % 3 - 1, i / 3 - 1)) / 9;
            float* const color = out.rgba.data() + 4 * index({x, int(row)});
            const glm::dvec4 masked =
                maskedByDepth<double>(glm::dvec4(color[0], color[1], color[2], color[3]), sum / weight - own,
                                      double(scene.depthMask.strength), scene.depthMask.lighten ? 1 : 0);
            for (int c = 0; c < 4; ++c) color[c] = float(masked[c]);
        }
    });
    return out;
}

} // namespace tessera::vis
