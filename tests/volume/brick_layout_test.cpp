#include "tests/volume/fields.h"
#include "volume/bricks/brick_layout.h"
#include "volume/sources/memory_source.h"

#include <gtest/gtest.h>
#include <random>

namespace tessera::volume {
namespace {

/// Importance that varies slowly, with a few bricks that stand out.
std::vector<float> someImportance(glm::ivec3 count, std::mt19937& random) {
    std::vector<float> importance;
    for (int z = 0; z < count.z; ++z)
        for (int y = 0; y < count.y; ++y)
            for (int x = 0; x < count.x; ++x)
                importance.push_back(random() % 7 == 0
                                         ? float(random() % 1000) / 1000
                                         : 0.04f * float(x / 3) + 0.06f * float(y / 2) + 0.05f * float(z / 4));
    return importance;
}

TEST(BrickLayout, HoldsEveryBrickThatIsKeptOnce) {
    std::mt19937 random(1);
    for (int turn = 0; turn < 60; ++turn) {
        const auto side = [&] { return 1 + int(random() % 9); };
        const glm::ivec3 count(side(), side(), side());
        const std::vector<float> importance = someImportance(count, random);
        std::size_t kept = 0;
        for (const float value : importance) kept += value >= 0.1f ? 1 : 0;
        std::size_t mixed = 0;
        for (const MergeShape shape : {MergeShape::Uniform, MergeShape::Mixed, MergeShape::Best}) {
            const MergeOptions options{0.1, 0.07, 1 + int(random() % 5), shape};
            const auto boxes = mergeBricks(count, importance, options);
            std::vector<int> held(importance.size(), 0);
            for (const MergedBrick& box : boxes) {
                float lo = 2, hi = -1;
                const glm::ivec3 size = box.end - box.begin;
                for (int z = box.begin.z; z < box.end.z; ++z)
                    for (int y = box.begin.y; y < box.end.y; ++y)
                        for (int x = box.begin.x; x < box.end.x; ++x) {
                            const std::size_t i = std::size_t((z * count.y + y) * count.x + x);
                            ++held[i];
                            lo = std::min(lo, importance[i]);
                            hi = std::max(hi, importance[i]);
                        }
                EXPECT_LE(double(hi) - double(lo), options.alike);
                EXPECT_EQ(box.importance, hi);
                for (int axis = 0; axis < 3; ++axis) EXPECT_LE(size[axis], options.mostBricks);
                if (shape == MergeShape::Uniform) {
                    EXPECT_TRUE(size.x == size.y && size.y == size.z && (size.x & (size.x - 1)) == 0);
                }
            }
            for (std::size_t i = 0; i < held.size(); ++i) EXPECT_EQ(held[i], importance[i] >= 0.1f ? 1 : 0);
            EXPECT_LE(boxes.size(), kept);
            if (shape == MergeShape::Mixed) mixed = mergeBricks(count, importance, {0.1, 0.07, 4, shape}).size();
            if (shape == MergeShape::Best) {
                EXPECT_LE(mergeBricks(count, importance, {0.1, 0.07, 4, shape}).size(), mixed);
            }
        }
    }
}

TEST(BrickLayout, GrowsAlongEachAxisUpToTheLargestSize) {
    const glm::ivec3 count(4, 4, 4);
    const std::vector<float> same(64, 0.5f);
    for (const MergeShape shape : {MergeShape::Uniform, MergeShape::Mixed, MergeShape::Best}) {
        EXPECT_EQ(mergeBricks(count, same, {0, 0, 4, shape}), (std::vector<MergedBrick>{{{0, 0, 0}, {4, 4, 4}, 0.5f}}));
        EXPECT_EQ(mergeBricks(count, same, {0, 0, 2, shape}).size(), 8u);
        EXPECT_EQ(mergeBricks(count, same, {0, 0, 1, shape}).size(), 64u);
        EXPECT_TRUE(mergeBricks(count, same, {0.6, 0, 4, shape}).empty());
    }
}

// A row that is like all columns under it, which are not like each other: taken first, it stays alone.
TEST(BrickLayout, LookingInAllDirectionsFindsFewer) {
    const glm::ivec3 count(4, 4, 1);
    std::vector<float> importance;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) importance.push_back(y == 0 ? 0.5f : x % 2 == 0 ? 0.45f : 0.55f);
    EXPECT_EQ(mergeBricks(count, importance, {0, 0.06, 4, MergeShape::Mixed}).size(), 5u);
    EXPECT_EQ(mergeBricks(count, importance, {0, 0.06, 4, MergeShape::Best}).size(), 4u);
}

TEST(BrickLayout, TakesTheMostOfAllParametersAndTimes) {
    const Lattice lattice = test::ccLattice({16, 8, 8});
    const Field flat = test::sampled<float>(lattice, [](glm::dvec3) { return 1.0; });
    const Field left = test::sampled<float>(lattice, [](glm::dvec3 p) { return p.x < 4 ? 1.0 : 0.0; });
    const Field right = test::sampled<float>(lattice, [](glm::dvec3 p) { return p.x > 12 ? 1.0 : 0.0; });
    const auto of = [&](std::vector<Field> fields, std::size_t times) {
        return mostImportant(*makeMemorySource(test::datasetOf(std::move(fields), times), {.brickSize = 8}));
    };
    const auto none = of({flat}, 1), both = of({left, right}, 1), later = of({flat, right}, 2);
    EXPECT_EQ(none, (std::vector<float>{0, 0}));
    EXPECT_GT(both[0], 0.2f);
    EXPECT_GT(both[1], 0.2f);
    EXPECT_GT(later[1], 2 * later[0]);
}

} // namespace
} // namespace tessera::volume
