#include "tests/vis/residency_fixture.h"

namespace tessera::test {
namespace {

using vis::Scene;

// While time moves on, the next frame is read before it is wanted.
TEST_F(ResidencyTest, NextTimeIsPrefetched) {
    for (const bool dense : {true, false}) {
        const auto source = waves(4);
        vis::Renderer renderer(dense ? vis::RendererOptions() : bricks());
        renderer.setSource(source);
        const vis::ViewTargetPtr target = renderer.makeTarget();
        Scene scene = volumeScene();
        vis::FrameRequest request;
        request.size = {16, 16};
        for (int time = 0; time < 2; ++time) {
            scene.time = time;
            refine(renderer, *target, scene, request.size);
        }
        const auto coming = [&] { return source->count(2, 0) + source->count(2, 1) + source->count(2, 2); };
        for (int frame = 0; frame < 20000 && coming() == 0; ++frame) {
            renderer.render(*target, scene, request);
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        EXPECT_GT(coming(), 0);
        EXPECT_EQ(source->count(3, 0), 0);
    }
}

// Between stored times, that is the one after both that are shown, or the one before them.
TEST_F(ResidencyTest, NextTimeIsPrefetchedBetweenTimes) {
    for (const bool back : {false, true}) {
        const auto source = waves(5);
        vis::Renderer renderer;
        renderer.setSource(source);
        const vis::ViewTargetPtr target = renderer.makeTarget();
        Scene scene = volumeScene();
        vis::FrameRequest request;
        request.size = {16, 16};
        for (const double time : back ? std::vector{3.5, 2.5} : std::vector{0.5, 1.5}) {
            scene.time = time;
            refine(renderer, *target, scene, request.size);
        }
        const int next = back ? 1 : 3;
        const auto coming = [&] { return source->count(next, 0) + source->count(next, 1) + source->count(next, 2); };
        for (int frame = 0; frame < 2000 && coming() == 0; ++frame) {
            renderer.render(*target, scene, request);
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        EXPECT_GT(coming(), 0) << next;
    }
}

/// Waves of which one half of the box rises with time; every change is known.
class Rising : public volume::BrickSource {
public:
    explicit Rising(std::shared_ptr<const volume::BrickSource> source) : source_(std::move(source)) {
        info_ = source_->info();
        info_.times = {0, 1, 2, 3};
        info_.parameters[0].ranges = {{0, 1.2}};
    }
    static constexpr float kRise = 0.1f;
    bool rises(const volume::BrickKey& key) const { return key.index.x >= grid().count().x / 2; }
    const volume::DatasetInfo& info() const override { return info_; }
    const volume::BrickGrid& grid() const override { return source_->grid(); }
    volume::BrickStats stats(const volume::BrickKey& key) const override {
        volume::BrickStats stats = source_->stats(key);
        stats.min += rises(key) ? kRise * float(key.time) : 0;
        stats.max += rises(key) ? kRise * float(key.time) : 0;
        return stats;
    }
    std::optional<volume::BrickChange> change(const volume::BrickKey& key, int toTime) const override {
        const float moved = rises(key) ? kRise * 1.001f * float(std::abs(toTime - key.time)) : 0;
        return volume::BrickChange{moved, moved};
    }
    volume::BrickSamples read(const volume::BrickKey& key) const override {
        volume::BrickSamples samples = source_->read(key);
        if (rises(key))
            for (float& value : samples.values) value += kRise * float(key.time);
        return samples;
    }

private:
    std::shared_ptr<const volume::BrickSource> source_;
    volume::DatasetInfo info_;
};

// As time moves on, bricks that do not move are neither read nor uploaded again; the picture is that of the new time.
TEST_F(ResidencyTest, BricksThatDoNotMoveKeepTheirTextures) {
    const auto source = std::make_shared<Rising>(waves());
    vis::Renderer renderer(bricks());
    renderer.setSource(source);
    const vis::ViewTargetPtr target = renderer.makeTarget();
    Scene scene = volumeScene();
    scene.render.detail = 0;
    int before = 0, whole = 0;
    for (const int time : {0, 1, 3, 2, 0}) {
        scene.time = time;
        renderAll(renderer, *target, scene, {48, 40});
        const vis::ResidencyInfo now = renderer.residency();
        EXPECT_LT(maxDifference(renderer.readLinear(*target), picture(source, {}, scene, {48, 40})), 1.0 / 255);
        if (before > 0) {
            EXPECT_LT(now.bricksUploaded - before, 3 * whole / 4) << "half of them, their neighbours, and coarse ones";
        }
        if (time == 0 && before > 0) {
            EXPECT_EQ(now.bricksUploaded, before) << "everything was still there";
        }
        before = now.bricksUploaded;
        if (whole == 0) whole = before;
    }
    EXPECT_GT(renderer.residency().bricksKept, 20);
    // Less would do: nothing is uploaded for a small change, and the picture lags by no more than that.
    vis::Renderer lazy(bricks());
    lazy.setSource(source);
    scene.render.limits.keptChange = 0.1f;
    scene.time = 0;
    renderAll(lazy, *target, scene, {48, 40});
    const int first = lazy.residency().bricksUploaded;
    scene.time = 1;
    renderAll(lazy, *target, scene, {48, 40});
    EXPECT_LT(lazy.residency().bricksUploaded - first, first / 4) << "coarse ones and the first";
}

// One texture: shared where nothing at all moves, else loaded.
TEST_F(ResidencyTest, ChannelsThatDoNotMoveShareTheirTexture) {
    const auto source = std::make_shared<Rising>(waves());
    vis::Renderer renderer;
    renderer.setSource(source);
    const vis::ViewTargetPtr target = renderer.makeTarget();
    Scene scene = volumeScene();
    renderAll(renderer, *target, scene, {48, 40});
    const vis::ResidencyInfo first = renderer.residency();
    scene.time = 1;
    scene.render.limits.keptChange = 0.1f;
    renderAll(renderer, *target, scene, {48, 40});
    EXPECT_EQ(renderer.residency().bricksUploaded, first.bricksUploaded);
    EXPECT_EQ(renderer.residency().textureBytes, first.textureBytes);
    EXPECT_GT(renderer.residency().bricksKept, 0);
    scene.time = 2;
    scene.render.limits.keptChange = 0.01f;
    renderAll(renderer, *target, scene, {48, 40});
    EXPECT_EQ(renderer.residency().bricksUploaded, 2 * first.bricksUploaded);
}

/// The same waves with one time more or a wider range of values, as of an archive that has grown.
std::shared_ptr<Watched> grown(int times, Range range) {
    const auto source = waves(times);
    source->setRange(range);
    return source;
}

// An archive grows while it is shown: what is resident, or decoded, of the times before is neither read nor uploaded
// again, and the picture is the same; the new time is read.
TEST_F(ResidencyTest, GrowthKeepsWhatIsThere) {
    for (const bool dense : {true, false}) {
        vis::Renderer renderer(dense ? vis::RendererOptions() : bricks());
        const auto before = grown(2, {0, 1}), after = grown(3, {0, 1.5}), other = grown(3, {0, 1});
        renderer.setSource(before);
        const vis::ViewTargetPtr target = renderer.makeTarget();
        Scene scene = volumeScene();
        scene.render.detail = 0;
        scene.time = 1;
        renderAll(renderer, *target, scene, {40, 32});
        const std::vector<glm::vec4> shown = renderer.readLinear(*target);
        const vis::ResidencyInfo first = renderer.residency();
        ASSERT_GT(first.bricksUploaded, 50);

        renderer.setSource(after, {1, 2});
        EXPECT_EQ(renderer.residency().bricksResident, first.bricksResident);
        EXPECT_EQ(renderer.residency().memoryBytes, first.memoryBytes);
        renderAll(renderer, *target, scene, {40, 32});
        EXPECT_EQ(maxDifference(renderer.readLinear(*target), shown), 0) << dense;
        EXPECT_EQ(renderer.residency().bricksUploaded, first.bricksUploaded);
        for (int level = 0; level < 3; ++level) EXPECT_EQ(after->count(1, level), 0) << level;

        scene.time = 2;
        renderAll(renderer, *target, scene, {40, 32});
        EXPECT_GT(after->count(2, 0), 20);
        EXPECT_LT(maxDifference(renderer.readLinear(*target), picture(after, {}, scene, {40, 32})), 1.0 / 255);
        EXPECT_GT(renderer.residency().bricksUploaded, first.bricksUploaded);

        // Another data set on the same grid has nothing in common: everything is read.
        scene.time = 1;
        renderer.setSource(other);
        renderAll(renderer, *target, scene, {40, 32});
        EXPECT_GT(other->count(1, 0), 20);
    }
}

// What was under way, or not wanted yet, of a time that stays comes after the growth, encoded as what is there already.
TEST_F(ResidencyTest, GrowthGoesOnWithWhatIsMissing) {
    vis::Renderer renderer(bricks());
    const auto before = grown(1, {0, 1}), after = grown(2, {-3, 4});
    renderer.setSource(before);
    const vis::ViewTargetPtr target = renderer.makeTarget();
    Scene scene = volumeScene();
    scene.render.detail = 100; // the coarsest levels
    renderAll(renderer, *target, scene, {40, 32});
    const int coarse = renderer.residency().bricksUploaded;
    ASSERT_EQ(before->count(0, 0), 0);
    scene.render.detail = 0;
    vis::FrameRequest request;
    request.size = {40, 32};
    renderer.render(*target, scene, request); // asks for bricks and does not wait
    renderer.setSource(after, {1, 1});
    renderAll(renderer, *target, scene, {40, 32});
    EXPECT_GT(renderer.residency().bricksUploaded, coarse + 20);
    EXPECT_EQ(renderer.residency().bricksWanted, 0);
    EXPECT_LT(maxDifference(renderer.readLinear(*target), picture(after, {}, scene, {40, 32})), 1.0 / 255);
    for (const std::string& message : renderer.takeMessages()) ADD_FAILURE() << message;
}
} // namespace
} // namespace tessera::test
