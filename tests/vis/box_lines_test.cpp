#include "vis/demand/box_lines.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <set>

namespace tessera::vis {
namespace {

using Ends = std::array<long, 4>;

/// The ends of a line, to a thousandth of a pixel, whichever comes first.
Ends endsOf(glm::dvec2 a, glm::dvec2 b) {
    std::array<std::array<long, 2>, 2> ends{
        {{std::lround(a.x * 1000), std::lround(a.y * 1000)}, {std::lround(b.x * 1000), std::lround(b.y * 1000)}}};
    std::ranges::sort(ends);
    return {ends[0][0], ends[0][1], ends[1][0], ends[1][1]};
}

// A box has twelve edges; the three where faces that one sees meet are before all that is in it.
TEST(BoxLines, AreTheTwelveEdgesWithTheNearOnesLast) {
    const glm::dvec3 half(0.5, 0.35, 0.2);
    const glm::ivec2 size(200, 150);
    for (const Projection kind : {Projection::Orthographic, Projection::Perspective}) {
        Camera camera;
        camera.projection = kind;
        const glm::dmat4 toClip = projectionMatrix(camera, double(size.x) / size.y) * viewMatrix(camera);
        const glm::dvec3 toEye = glm::conjugate(glm::dquat(camera.orientation)) * glm::dvec3(0, 0, 1);
        const auto pixel = [&](int corner) {
            const glm::dvec3 sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
            const glm::dvec4 clip = toClip * glm::dvec4(half * sign, 1);
            return (glm::dvec2(clip) / clip.w * 0.5 + 0.5) * glm::dvec2(size);
        };
        const int nearest = (toEye.x > 0 ? 1 : 0) | (toEye.y > 0 ? 2 : 0) | (toEye.z > 0 ? 4 : 0);
        std::set<Ends> all, front;
        for (int corner = 0; corner < 8; ++corner)
            for (const int axis : {1, 2, 4})
                if (!(corner & axis)) {
                    const Ends ends = endsOf(pixel(corner), pixel(corner | axis));
                    all.insert(ends);
                    if (corner == nearest || (corner | axis) == nearest) front.insert(ends);
                }
        ASSERT_EQ(all.size(), 12u);
        const BoxLines lines = boxLines(camera, half, size);
        ASSERT_EQ(lines.edges.size(), 12u);
        ASSERT_EQ(lines.front, 3);
        std::set<Ends> drawn, last;
        for (std::size_t i = 0; i < 12; ++i) {
            const glm::dvec4 line(lines.edges[i]);
            Ends ends = endsOf({line.x, line.y}, {line.z, line.w});
            // Lines are floats: the same edge may be a thousandth apart.
            for (const Ends& one : all)
                if (std::abs(one[0] - ends[0]) + std::abs(one[1] - ends[1]) + std::abs(one[2] - ends[2]) +
                        std::abs(one[3] - ends[3]) <=
                    4)
                    ends = one;
            drawn.insert(ends);
            if (i >= 9) last.insert(ends);
        }
        EXPECT_EQ(drawn, all);
        EXPECT_EQ(last, front);
    }
}

} // namespace
} // namespace tessera::vis
