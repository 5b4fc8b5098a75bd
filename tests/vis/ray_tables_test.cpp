#include "vis/optics/ray_setup.h"
#include "vis/raycast/ray_tables.h"

#include <cmath>
#include <gtest/gtest.h>

/// Which blocks can show something, and where the curves of layers are opaque.
namespace tessera::vis {
namespace {

/// A row of blocks of a channel "a" with values in 0..1, which are the texels.
struct BlockRow {
    volume::DatasetInfo info;
    Scene scene;
    BlockRanges blocks;

    explicit BlockRow(std::vector<Range> ranges) {
        info.lattice.size = {4, 4, 4};
        info.parameters.resize(1);
        info.parameters[0].name = "a";
        info.parameters[0].ranges = {{0, 1}};
        blocks.count = {int(ranges.size()), 1, 1};
        blocks.edge = 2 * kBlockTexels; // each block by itself
        for (const Range& range : ranges) {
            blocks.min.push_back(float(range.lo));
            blocks.max.push_back(float(range.hi));
        }
    }
    RayPlan plan() const {
        RayPlan made = planRays(scene, info);
        for (BoundField& field : made.fields) field.blocks = &blocks;
        return made;
    }
    std::vector<int> distances() const {
        const auto found = blockDistances(plan(), scene, info);
        return found ? std::vector<int>(found->distance.begin(), found->distance.end()) : std::vector<int>{};
    }
};

constexpr double kRounding = 5e-5; // of texels

TEST(BlockDistances, AnIsosurfaceIsWhereItsValueLies) {
    BlockRow row({{0.1, 0.2}, {0.2, 0.5 - kRounding}, {0.3, 0.6}, {0.5 + kRounding, 0.7}, {0.51, 0.9}, {0.6, 0.9}});
    row.scene.layers = {{"", true, IsoLayer{.channel = "a", .value = 0.5}}};
    EXPECT_EQ(row.distances(), (std::vector<int>{1, 0, 0, 0, 1, 2}));
    const auto found = blockDistances(row.plan(), row.scene, row.info);
    EXPECT_EQ(found->begin, glm::ivec3(1, 0, 0));
    EXPECT_EQ(found->end, glm::ivec3(4, 1, 1));
    EXPECT_EQ(found->occupied, 0.5);
}

TEST(BlockDistances, AVolumeIsWhereItIsNotClear) {
    BlockRow row({{0, 0.1}, {0, 0.55}, {0.4, 0.6}, {0, 1}, {0.7, 1}, {0.8, 0.9}, {1, -1}});
    row.scene.layers = {{"", true, VolumeLayer{.channel = "a"}}};
    row.scene.transfer["a"].opacity = {{0, 0}, {0.5f, 0}, {0.55f, 1}, {0.6f, 0}, {1, 0}};
    EXPECT_EQ(row.distances(), (std::vector<int>{1, 0, 0, 0, 1, 2, 3}));
    std::get<VolumeLayer>(row.scene.layers[0].technique).style = RayStyle::Maximum;
    EXPECT_EQ(row.distances(), (std::vector<int>{0, 0, 0, 0, 0, 0, 1})) << "all count but those without a sample";
}

TEST(BlockDistances, RegionsOfValueAndGradientCountAtTheirValues) {
    BlockRow row({{0, 0.3}, {0.35, 0.6}, {0.7, 0.8}, {0.95, 1}});
    row.scene.layers = {{"", true, VolumeLayer{.channel = "a"}}};
    TransferFunction& function = row.scene.transfer["a"];
    function.kind = TransferKind::Regions;
    function.regions.resize(1);
    function.regions[0].centre = {0.5f, 0.9f}; // strong gradients alone
    function.regions[0].size = {0.2f, 0.2f};
    EXPECT_EQ(row.distances(), (std::vector<int>{1, 0, 1, 2}));
}

// What no brush holds is left out where the context is not drawn, and nowhere else.
TEST(BlockDistances, WhatIsHiddenByBrushesDoesNotCount) {
    const auto distances = [](float contextOpacity, BrushEffect effect) {
        BlockRow row(
            {{0.1, 0.15}, {0.1, 0.2 - kRounding}, {0.25, 0.3}, {0.4 + kRounding, 0.9}, {0.41, 0.9}, {0.7, 0.8}});
        row.scene.layers = {{"", true, VolumeLayer{.channel = "a"}}};
        row.scene.layers[0].brushes = effect;
        row.scene.transfer["a"].opacity = {{0, 1}, {1, 1}};
        row.scene.selection.brushes = {rangeBrush({{"a", 0.2, 0.4, 0}})};
        row.scene.selection.contextOpacity = contextOpacity;
        return row.distances();
    };
    const std::vector<int> everywhere(6, 0), held{1, 0, 0, 0, 1, 2};
    EXPECT_EQ(distances(0, BrushEffect::Fade), held);
    EXPECT_EQ(distances(0.1f, BrushEffect::Fade), everywhere);
    EXPECT_EQ(distances(0.1f, BrushEffect::FocusOnly), held);
    EXPECT_EQ(distances(0, BrushEffect::None), everywhere);
}

TEST(OpaqueIntervals, BeginAndEndWhereTheTableDoes) {
    BlockRow row({{0, 1}});
    row.scene.layers = {{"", true, VolumeLayer{.channel = "a"}}};
    const auto intervalOf = [&](std::vector<glm::vec2> curve) {
        row.scene.transfer["a"].opacity = std::move(curve);
        const RayPlan plan = row.plan();
        return opaqueIntervals(plan, transferTables(plan, row.scene, row.info)).at(0);
    };
    const double entry = 1.0 / (kTableSize - 1);
    const auto middle = intervalOf({{0, 0}, {0.3f, 0}, {0.4f, 1}, {0.5f, 1}, {0.6f, 0}, {1, 0}});
    ASSERT_TRUE(middle);
    EXPECT_NEAR(middle->x, 0.3, entry);
    EXPECT_NEAR(middle->y, 0.6, entry);
    const auto upper = intervalOf({{0, 0}, {0.3f, 0}, {1, 1}});
    ASSERT_TRUE(upper);
    EXPECT_NEAR(upper->x, 0.3, entry);
    EXPECT_GT(upper->y, 1e30f) << "values beyond the range look like its end";
    EXPECT_FALSE(intervalOf({{0, 1}, {0.3f, 0}, {0.6f, 0}, {1, 1}})) << "a gap";
}

// The pages of such functions have fewer columns than tables; interpolation reaches to the next column.
TEST(OpaqueIntervals, OfRegionsReachToTheNextColumn) {
    BlockRow row({{0, 1}});
    row.scene.layers = {{"", true, VolumeLayer{.channel = "a"}}};
    TransferFunction& function = row.scene.transfer["a"];
    function.kind = TransferKind::Regions;
    function.regions.resize(1);
    for (const double centre : {0.06, 0.5, 0.83, 0.9, 0.94}) {
        function.regions[0].centre = {float(centre), 0.5f};
        function.regions[0].size = {0.05f, 0.5f};
        const int columns = kPlaneSize - 1, last = kTableSize - 1;
        const auto holds = [&](int entry) { // whether a column beside it is in the region
            const double at = double(std::min(entry, last)) / last * columns;
            const auto in = [&](double column) { return std::abs(column / columns - centre) < 0.025; };
            return in(std::floor(at)) || in(std::ceil(at));
        };
        int begin = 0; // entries count for what lies between them and the next
        while (!holds(begin) && !holds(begin + 1)) ++begin;
        int end = begin;
        while (holds(end) || holds(end + 1)) ++end;
        const RayPlan plan = row.plan();
        const auto found = opaqueIntervals(plan, transferTables(plan, row.scene, row.info)).at(0);
        ASSERT_TRUE(found);
        EXPECT_FLOAT_EQ(found->x * last, float(begin)) << centre;
        EXPECT_FLOAT_EQ(found->y * last, float(end)) << centre;
    }
}

} // namespace
} // namespace tessera::vis
