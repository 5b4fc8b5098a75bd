#include "tests/vis/residency_fixture.h"

#include "vis/demand/choose_bricks.h"
#include "vis/raycast/ray_plan.h"

#include <atomic>

namespace tessera::test {
namespace {

using vis::BrickDemand;
using vis::Scene;

/// Waves whose bricks matter in one half of the box (large x) and not in the other; counts what is read at full
/// resolution of each.
class HalfImportant : public volume::BrickSource {
public:
    explicit HalfImportant(float rest = 0) : rest_(rest), source_(waves()) {}
    bool matters(glm::ivec3 brick) const { return brick.x >= grid().count().x / 2; }
    const volume::DatasetInfo& info() const override { return source_->info(); }
    const volume::BrickGrid& grid() const override { return source_->grid(); }
    volume::BrickStats stats(const volume::BrickKey& key) const override { return source_->stats(key); }
    std::optional<volume::BrickImportance> importance(const volume::BrickKey& key) const override {
        return volume::BrickImportance{matters(key.index) ? 0.6f : rest_, 0};
    }
    volume::BrickSamples read(const volume::BrickKey& key) const override {
        if (key.level == 0) ++(matters(key.index) ? important : other);
        return source_->read(key);
    }
    mutable std::atomic<int> important = 0, other = 0;

private:
    float rest_;
    std::shared_ptr<const volume::BrickSource> source_;
};

/// Opaque wherever there is something, seen along z so that both halves are as far away.
Scene opaqueScene() {
    Scene scene = volumeScene();
    scene.transfer["v"].opacity = {{0, 0.5f}, {1, 0.5f}};
    scene.camera.projection = vis::Projection::Orthographic;
    scene.camera.orientation = {1, 0, 0, 0};
    scene.cursor = glm::dvec3(29.5, 25.5, 35);
    return scene;
}

/// The levels that a picture of the scene wants of the waves, by brick.
std::vector<std::uint8_t> levelsFor(const volume::BrickSource& source, const std::vector<float>& importance,
                                    const vis::DemandSettings& settings, const Scene& scene = opaqueScene()) {
    const vis::RayPlan plan = vis::planRays(scene, source.info());
    const volume::BrickGrid& grid = source.grid();
    vis::BlockRanges ranges;
    ranges.count = grid.count();
    ranges.edge = grid.brickSize;
    ranges.min.assign(std::size_t(ranges.count.x) * std::size_t(ranges.count.y) * std::size_t(ranges.count.z), 0.1f);
    ranges.max.assign(ranges.min.size(), 0.9f);
    const auto demands =
        vis::brickDemands(plan, scene, source.info(), grid, {&ranges}, {std::span<const float>(importance)}, settings);
    return demands.at(0)->level;
}

TEST(BrickImportanceLevels, FollowTheFormula) {
    const HalfImportant source;
    const std::size_t bricks = levelsFor(source, {}, {{64, 64}, 1, 0}).size();
    // One pixel is so large that voxels of level 1 are as small: with detail d the level is floor(log2(d x)) + c.
    for (const double detail : {0.5, 1.0, 2.0, 4.0, 8.0})
        for (const double levels : {0.0, 0.5, 1.0, 2.0})
            for (const float least : {0.0f, 0.3f, 0.6f}) {
                std::vector<float> importance(bricks, least);
                importance[bricks - 1] = 0.6f;
                const auto plain = levelsFor(source, {}, {{64, 64}, detail, levels});
                const auto all = levelsFor(source, std::vector<float>(bricks, 0.2f), {{64, 64}, detail, levels});
                EXPECT_EQ(plain, all) << "alike: none is coarser";
                const auto weighed = levelsFor(source, importance, {{64, 64}, detail, levels});
                const auto coarse =
                    levelsFor(source, {}, {{64, 64}, detail * std::exp2(levels * (1 - double(least) / 0.6)), 0});
                EXPECT_EQ(weighed.back(), plain.back()) << "the most important is as fine as ever";
                for (std::size_t i = 0; i + 1 < bricks; ++i)
                    EXPECT_EQ(weighed[i], coarse[i]) << i << ' ' << detail << ' ' << levels << ' ' << least;
            }
    // Full resolution is full resolution.
    std::vector<float> importance(bricks, 0);
    importance[0] = 1;
    for (const std::uint8_t level : levelsFor(source, importance, {{64, 64}, 0, 4}))
        EXPECT_TRUE(level == 0 || level == BrickDemand::kNotWanted) << int(level);
}

// A lens makes bricks more urgent.
TEST(BrickImportanceLevels, BricksInALensComeFirst) {
    const HalfImportant source;
    Scene scene = opaqueScene();
    const auto priorities = [&] {
        const vis::RayPlan plan = vis::planRays(scene, source.info());
        vis::BlockRanges ranges;
        ranges.count = source.grid().count();
        ranges.edge = source.grid().brickSize;
        ranges.min.assign(std::size_t(ranges.count.x * ranges.count.y * ranges.count.z), 0.1f);
        ranges.max.assign(ranges.min.size(), 0.9f);
        return vis::brickDemands(plan, scene, source.info(), source.grid(), {&ranges}, {{}}, {{64, 64}, 1, 0})
            .at(0)
            ->priority;
    };
    const std::vector<float> before = priorities();
    vis::Lens lens;
    lens.name = "lens";
    scene.lenses.push_back(lens);
    const std::vector<float> after = priorities();
    int sooner = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
        if (after[i] == before[i]) continue;
        EXPECT_FLOAT_EQ(after[i], before[i] / 2);
        ++sooner;
    }
    EXPECT_GT(sooner, 0);
    EXPECT_LT(sooner, int(before.size()));
}

/// RMS difference of two pictures left and right of the middle, where bricks do not matter and where they do.
struct Halves {
    double other = 0, important = 0;
};
Halves differences(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b, glm::ivec2 size) {
    const int margin = size.x / 10;
    const auto rms = [&](int first, int end) {
        double sum = 0;
        for (int y = 0; y < size.y; ++y)
            for (int x = first; x < end; ++x) {
                const glm::vec4 apart = a[std::size_t(y * size.x + x)] - b[std::size_t(y * size.x + x)];
                sum += double(glm::dot(apart, apart));
            }
        return std::sqrt(sum / (4.0 * size.y * (end - first)));
    };
    return {rms(0, size.x / 2 - margin), rms(size.x / 2 + margin, size.x)};
}

// With room for a part of the bricks only, those that matter are shown finer, and there is no hole.
TEST_F(ResidencyTest, ATightBudgetGoesToWhatMatters) {
    const glm::ivec2 size(40, 40);
    Scene scene = opaqueScene();
    scene.render.cullHidden = false; // else the budget suffices for what is seen
    scene.render.detail = 0;         // the levels are alike: it is the order that counts
    const std::vector<glm::vec4> fine = picture(std::make_shared<HalfImportant>(), bricks(), scene, size);
    scene.render.detail = 100;
    const std::vector<glm::vec4> coarsest = picture(std::make_shared<HalfImportant>(), bricks(), scene, size);
    const Halves coarse = differences(coarsest, fine, size);
    ASSERT_GT(coarse.important, 1e-3);
    ASSERT_GT(coarse.other, 1e-3);

    vis::RendererOptions options = bricks();
    options.textureBudget = std::size_t(1) << 20;
    vis::Renderer renderer(options);
    renderer.setSource(std::make_shared<HalfImportant>());
    const vis::ViewTargetPtr target = renderer.makeTarget();
    scene.render.detail = 0;
    refine(renderer, *target, scene, size);
    const std::vector<glm::vec4> tight = renderer.readLinear(*target);
    const Halves left = differences(tight, fine, size);
    EXPECT_LT(left.important / coarse.important, 0.5 * left.other / coarse.other)
        << left.important << " of " << coarse.important << ", " << left.other << " of " << coarse.other;
    EXPECT_LE(renderer.residency().textureBytes, options.textureBudget);
    for (std::size_t i = 0; i < tight.size(); ++i) EXPECT_NEAR(tight[i].a, fine[i].a, 0.05) << i;
}

// Where levels differ by importance alone, only what matters is read at full resolution; again there is no hole.
TEST_F(ResidencyTest, LevelsFollowImportance) {
    for (const float rest : {0.0f, 0.6f}) {
        const auto source = std::make_shared<HalfImportant>(rest);
        vis::Renderer renderer(bricks());
        renderer.setSource(source);
        const vis::ViewTargetPtr target = renderer.makeTarget();
        Scene scene = opaqueScene();
        scene.render.importance = 2;
        scene.render.cullHidden = false;
        const glm::ivec2 size(64, 64);
        // The largest detail at which everything is wanted at full resolution.
        scene.render.detail = 4;
        const auto coarseAt = [&](float detail) {
            const auto levels = levelsFor(*source, {}, {size, detail, 0}, scene);
            return std::any_of(levels.begin(), levels.end(),
                               [](std::uint8_t level) { return level > 0 && level != BrickDemand::kNotWanted; });
        };
        while (coarseAt(scene.render.detail)) scene.render.detail *= 0.9f;
        renderAll(renderer, *target, scene, size);
        EXPECT_GT(source->important, 100);
        if (rest == 0) {
            const glm::ivec3 count = source->grid().count();
            EXPECT_LE(source->other, count.y * count.z) << "neighbours of what matters, for its border";
        } else {
            EXPECT_GT(source->other, 100) << "all alike";
        }
        for (const int y : {24, 32, 40})
            for (const int x : {24, 32, 40})
                EXPECT_GT(renderer.readLinear(*target)[std::size_t(y * size.x + x)].a, 0.9) << x << ' ' << y;
    }
}

} // namespace
} // namespace tessera::test
