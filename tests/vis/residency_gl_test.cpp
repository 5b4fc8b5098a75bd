#include "tests/vis/function_source.h"
#include "tests/vis/gl_fixture.h"

#include "vis/gl/brick_levels.h"
#include "vis/technique/brick_demand.h"

#include <algorithm>
#include <mutex>
#include <set>
#include <thread>
#include <tuple>

namespace tessera {
namespace {

using vis::Scene;

/// Remembers which bricks were read, and can hold them back.
class Watched : public volume::BrickSource {
public:
    explicit Watched(std::shared_ptr<const volume::BrickSource> source, int times = 1)
        : source_(std::move(source)), info_(source_->info()) {
        info_.times.clear();
        for (int i = 0; i < times; ++i) info_.times.push_back(i);
    }
    const volume::DatasetInfo& info() const override { return info_; }
    const volume::BrickGrid& grid() const override { return source_->grid(); }
    volume::BrickStats stats(const volume::BrickKey& key) const override { return source_->stats(key); }
    volume::BrickSamples read(const volume::BrickKey& key) const override {
        {
            const std::lock_guard lock(mutex_);
            read_.insert({key.time, key.level, key.index.x, key.index.y, key.index.z});
        }
        return source_->read(key);
    }
    /// Bricks read so far at a time and level.
    int count(int time, int level) const {
        const std::lock_guard lock(mutex_);
        return int(std::count_if(read_.begin(), read_.end(), [&](const auto& key) {
            return std::get<0>(key) == time && std::get<1>(key) == level;
        }));
    }

private:
    std::shared_ptr<const volume::BrickSource> source_;
    volume::DatasetInfo info_;
    mutable std::mutex mutex_;
    mutable std::set<std::tuple<int, int, int, int, int>> read_;
};

std::shared_ptr<Watched> waves(int times = 1, glm::ivec3 samples = {60, 52, 71}) {
    const auto v = [](glm::dvec3 p) -> std::optional<double> {
        return 0.5 + 0.4 * std::sin(0.2 * p.x) * std::cos(0.15 * p.y + 0.1 * p.z);
    };
    return std::make_shared<Watched>(
        std::make_shared<vis::FunctionSource>(volume::LatticeKind::BCC, samples, glm::dvec3(1),
                                              std::vector<vis::FunctionSource::Channel>{{"v", v}}, 8),
        times);
}

/// Half of it transparent.
Scene volumeScene() {
    Scene scene;
    scene.camera.distance = 1.8f;
    vis::VolumeLayer layer;
    layer.channel = "v";
    scene.layers.push_back({"volume", true, layer});
    vis::TransferFunction function;
    function.autoRange = false;
    function.range = {0, 1};
    function.opacity = {{0, 0}, {0.5f, 0}, {0.7f, 0.4f}, {1, 0.6f}};
    scene.transfer["v"] = function;
    scene.showBox = false;
    return scene;
}

vis::RendererOptions bricks() {
    vis::RendererOptions options;
    options.denseTexels = 0;
    return options;
}

using test::picture;

class ResidencyTest : public test::GlTest {
protected:
    /// Draws frame after frame, as a window does, until nothing is left to do.
    static vis::FrameStatus refine(vis::Renderer& renderer, vis::ViewTarget& target, const Scene& scene,
                                   glm::ivec2 size) {
        vis::FrameRequest request;
        request.size = size;
        vis::FrameStatus status;
        for (int frame = 0; frame < 20000 && !status.complete; ++frame) {
            status = renderer.render(target, scene, request);
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        EXPECT_TRUE(status.complete);
        return status;
    }
};

// Whole, in bricks, and with budgets of a few bricks only: the same picture.
TEST_F(ResidencyTest, AnyCacheSizeGivesTheSamePicture) {
    const auto source = waves();
    Scene scene = volumeScene();
    scene.render.detail = 0;
    const glm::ivec2 size(48, 40);
    const std::vector<glm::vec4> whole = picture(source, {}, scene, size);
    for (const std::size_t texture : {std::size_t(1), std::size_t(1) << 20, std::size_t(1) << 30})
        for (const std::size_t memory : {std::size_t(1), std::size_t(1) << 30}) {
            vis::RendererOptions options = bricks();
            options.textureBudget = texture;
            options.memoryBudget = memory;
            EXPECT_LT(test::maxDifference(whole, picture(source, options, scene, size)), 1.0 / 255)
                << texture << ' ' << memory;
        }
}

// Only what the picture shows is read at full resolution.
TEST_F(ResidencyTest, BricksOutOfSightAreNotRead) {
    Scene scene = volumeScene();
    scene.render.detail = 0;
    const auto all = waves(), part = waves();
    const std::vector<glm::vec4> far = picture(all, bricks(), scene, {32, 32});
    scene.camera.distance = 0.6f;
    scene.camera.target = {0.3f, 0.2f, 0.3f};
    const std::vector<glm::vec4> near = picture(part, bricks(), scene, {32, 32});
    EXPECT_LT(test::maxDifference(near, picture(part, {}, scene, {32, 32})), 1.0 / 255);
    const auto again = waves();
    picture(again, bricks(), scene, {32, 32});
    EXPECT_LT(again->count(0, 0), all->count(0, 0) * 3 / 4);
    EXPECT_GT(again->count(0, 0), 0);
}

// Nor is what the transfer function makes transparent.
TEST_F(ResidencyTest, TransparentBricksAreNotRead) {
    Scene scene = volumeScene();
    scene.render.detail = 0;
    const auto peak = [](glm::dvec3 p) -> std::optional<double> {
        return std::exp(-glm::dot(p - glm::dvec3(14), p - glm::dvec3(14)) / 60);
    };
    const auto make = [&] {
        return std::make_shared<Watched>(
            std::make_shared<vis::FunctionSource>(volume::LatticeKind::CC, glm::ivec3(64), glm::dvec3(1),
                                                  std::vector<vis::FunctionSource::Channel>{{"v", peak}}, 8));
    };
    const auto source = make(), other = make();
    const std::vector<glm::vec4> seen = picture(source, bricks(), scene, {40, 40});
    EXPECT_GT(source->count(0, 0), 0);
    EXPECT_LT(source->count(0, 0), 512 / 3);
    EXPECT_LT(test::maxDifference(seen, picture(other, {}, scene, {40, 40})), 1.0 / 255);
    scene.layers = {{"iso", true, vis::IsoLayer{.channel = "v", .value = 0.8}}};
    const auto surface = make();
    picture(surface, bricks(), scene, {40, 40});
    EXPECT_LT(surface->count(0, 0), 512 / 3);
}

// Voxels smaller than a pixel come from a coarser level, which hardly shows.
TEST_F(ResidencyTest, DistantBricksAreCoarse) {
    const auto source = waves();
    Scene scene = volumeScene();
    const glm::ivec2 size(12, 12);
    const std::vector<glm::vec4> coarse = picture(source, bricks(), scene, size);
    EXPECT_EQ(source->count(0, 0), 0);
    scene.render.detail = 0;
    const std::vector<glm::vec4> fine = picture(source, bricks(), scene, size);
    EXPECT_GT(source->count(0, 0), 0);
    double sum = 0;
    for (std::size_t i = 0; i < fine.size(); ++i) sum += glm::dot(fine[i] - coarse[i], fine[i] - coarse[i]);
    EXPECT_LT(std::sqrt(sum / (4 * double(fine.size()))), 0.03);
}

// A lens with a detail of its own: through its middle the picture is the fine one, away from it the coarse one.
TEST_F(ResidencyTest, ALensIsFinerThanWhatIsAroundIt) {
    Scene scene = volumeScene();
    const glm::ivec2 size(48, 48);
    // A slab seen from the front: few bricks behind each other, many beside the lens.
    const glm::ivec3 samples(96, 96, 16);
    const auto all = waves(1, samples), some = waves(1, samples), none = waves(1, samples);
    scene.camera.orientation = {1, 0, 0, 0};
    scene.render.detail = 0;
    const std::vector<glm::vec4> fine = picture(all, bricks(), scene, size);
    scene.render.detail = 100;
    const std::vector<glm::vec4> coarse = picture(none, bricks(), scene, size);
    ASSERT_EQ(none->count(0, 0), 0);
    vis::Lens lens;
    lens.shape = vis::LensShape::Disc;
    lens.effect = vis::LensEffect::Focus; // without brushes it changes nothing else
    const volume::Box& box = none->info().bounds;
    lens.center = 0.5 * (box.lo + box.hi);
    lens.size = glm::vec3(0.05f);
    lens.detail = 0;
    scene.lenses = {lens};
    const std::vector<glm::vec4> mixed = picture(some, bricks(), scene, size);
    EXPECT_GT(some->count(0, 0), 0);
    EXPECT_LT(some->count(0, 0), all->count(0, 0) / 2);
    const auto differ = [&](const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b, bool inside) {
        float most = 0;
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const double off = glm::length(glm::dvec2(x, y) + 0.5 - 0.5 * glm::dvec2(size));
                if (inside ? off > 2 : off < 14) continue;
                const glm::vec4 way = glm::abs(a[std::size_t(y * size.x + x)] - b[std::size_t(y * size.x + x)]);
                most = std::max({most, way.r, way.g, way.b, way.a});
            }
        return most;
    };
    ASSERT_GT(differ(fine, coarse, true), 0.005f);
    ASSERT_GT(differ(fine, coarse, false), 0.01f);
    EXPECT_LT(differ(mixed, fine, true), 0.001f);
    EXPECT_LT(differ(mixed, coarse, false), 0.001f);
}

// Where bricks of different levels meet there is no more of a seam than the coarser one is wrong by itself: the error
// of the mixed picture stays within that of a picture from the coarse level alone.
TEST_F(ResidencyTest, SeamsBetweenLevelsAreBounded) {
    Scene scene = volumeScene();
    scene.camera.fieldOfView = 90;
    scene.camera.distance = 0.75f; // near bricks are several times as large as far ones
    const glm::ivec2 size(56, 56);
    const auto with = [&](float detail, Watched& source) {
        scene.render.detail = detail;
        return picture(std::shared_ptr<Watched>(&source, [](Watched*) {}), bricks(), scene, size);
    };
    const auto all = waves(), some = waves(), none = waves();
    const std::vector<glm::vec4> fine = with(0, *all);
    const std::vector<glm::vec4> mixed = with(1.6f, *some);
    const std::vector<glm::vec4> coarse = with(100, *none);
    ASSERT_GT(some->count(0, 0), 5);
    ASSERT_LT(some->count(0, 0), all->count(0, 0) - 20) << "levels are mixed";
    ASSERT_LT(none->count(0, 0), some->count(0, 0) / 2);
    const auto rms = [&](const std::vector<glm::vec4>& image) {
        double sum = 0;
        for (std::size_t i = 0; i < image.size(); ++i) sum += glm::dot(image[i] - fine[i], image[i] - fine[i]);
        return std::sqrt(sum / (4 * double(image.size())));
    };
    EXPECT_GT(rms(coarse), 0.001);
    EXPECT_LT(rms(mixed), rms(coarse));
    EXPECT_LT(test::maxDifference(mixed, fine), test::maxDifference(coarse, fine) + 1.0 / 255);
}

// A budget that holds only some of the bricks: no hole while bricks come and go, and it says so.
TEST_F(ResidencyTest, NoHolesWithinTheBudget) {
    vis::RendererOptions options = bricks();
    options.textureBudget = std::size_t(1) << 20; // half of it for bricks: about 70 of 400
    vis::Renderer renderer(options);
    renderer.setSource(waves());
    const vis::ViewTargetPtr target = renderer.makeTarget();
    Scene scene = volumeScene();
    scene.render.detail = 0;
    scene.transfer["v"].opacity = {{0, 0.5f}, {1, 0.5f}}; // opaque wherever there is something
    std::vector<std::string> said;
    for (int view = 0; view < 4; ++view) {
        vis::orbit(scene.camera, {0, 0}, {0.4f, 0.1f});
        refine(renderer, *target, scene, {24, 24});
        EXPECT_GT(renderer.readLinear(*target)[12 * 24 + 12].a, 0.9);
        for (std::string& message : renderer.takeMessages()) said.push_back(std::move(message));
        const vis::ResidencyInfo info = renderer.residency();
        EXPECT_LE(info.textureBytes, options.textureBudget);
        EXPECT_GT(info.bricksResident, 20);
    }
    ASSERT_EQ(said.size(), 1u);
    EXPECT_NE(said[0].find("budget"), std::string::npos);
}

// Texture memory that is taken away: bricks go, coarser ones stay, no hole; given back, the picture is what it was.
TEST_F(ResidencyTest, BudgetMayShrinkAndGrow) {
    vis::Renderer renderer(bricks());
    renderer.setSource(waves());
    const vis::ViewTargetPtr target = renderer.makeTarget();
    Scene scene = volumeScene();
    scene.render.detail = 0;
    scene.transfer["v"].opacity = {{0, 0.5f}, {1, 0.5f}};
    refine(renderer, *target, scene, {24, 24});
    const std::vector<glm::vec4> first = renderer.readLinear(*target);
    const vis::ResidencyInfo full = renderer.residency();

    scene.render.limits.textureMemory = 1; // MiB
    refine(renderer, *target, scene, {24, 24});
    const std::vector<glm::vec4> coarse = renderer.readLinear(*target);
    EXPECT_LE(renderer.residency().textureBytes, std::size_t(1) << 20);
    EXPECT_LT(renderer.residency().bricksResident, full.bricksResident / 2);
    for (std::size_t i = 0; i < first.size(); ++i) EXPECT_NEAR(coarse[i].a, first[i].a, 0.02) << i;
    EXPECT_LT(test::maxDifference(coarse, first), 0.2);

    scene.render.limits.textureMemory = 1024;
    refine(renderer, *target, scene, {24, 24});
    // Bricks lie elsewhere in the atlas now: the last bit of a coordinate may differ.
    EXPECT_LT(test::maxDifference(renderer.readLinear(*target), first), 1e-3);
    EXPECT_EQ(renderer.residency().bricksResident, full.bricksResident);
}

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
        for (int frame = 0; frame < 500 && coming() == 0; ++frame) {
            renderer.render(*target, scene, request);
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        EXPECT_GT(coming(), 0);
        EXPECT_EQ(source->count(3, 0), 0);
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
        test::renderAll(renderer, *target, scene, {48, 40});
        const vis::ResidencyInfo now = renderer.residency();
        EXPECT_LT(test::maxDifference(renderer.readLinear(*target), picture(source, {}, scene, {48, 40})), 1.0 / 255);
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
    test::renderAll(lazy, *target, scene, {48, 40});
    const int first = lazy.residency().bricksUploaded;
    scene.time = 1;
    test::renderAll(lazy, *target, scene, {48, 40});
    EXPECT_LT(lazy.residency().bricksUploaded - first, first / 4) << "coarse ones and the first";
}

// One texture: shared where nothing at all moves, else loaded.
TEST_F(ResidencyTest, ChannelsThatDoNotMoveShareTheirTexture) {
    const auto source = std::make_shared<Rising>(waves());
    vis::Renderer renderer;
    renderer.setSource(source);
    const vis::ViewTargetPtr target = renderer.makeTarget();
    Scene scene = volumeScene();
    test::renderAll(renderer, *target, scene, {48, 40});
    const vis::ResidencyInfo first = renderer.residency();
    scene.time = 1;
    scene.render.limits.keptChange = 0.1f;
    test::renderAll(renderer, *target, scene, {48, 40});
    EXPECT_EQ(renderer.residency().bricksUploaded, first.bricksUploaded);
    EXPECT_EQ(renderer.residency().textureBytes, first.textureBytes);
    EXPECT_GT(renderer.residency().bricksKept, 0);
    scene.time = 2;
    scene.render.limits.keptChange = 0.01f;
    test::renderAll(renderer, *target, scene, {48, 40});
    EXPECT_EQ(renderer.residency().bricksUploaded, 2 * first.bricksUploaded);
}

// A driver that refuses memory: the picture is coarser, a message says so, and it comes back with memory.
TEST_F(ResidencyTest, RefusedMemoryMakesThePictureCoarser) {
    const Scene scene = volumeScene();
    const std::vector<glm::vec4> wanted = picture(waves(), {}, scene, {48, 40});
    for (const bool dense : {true, false}) {
        vis::RendererOptions options = dense ? vis::RendererOptions() : bricks();
        for (const std::size_t memory : {std::size_t(1) << 20, std::size_t(400) << 10, std::size_t(1000)}) {
            options.driverMemory = memory;
            vis::Renderer renderer(options);
            renderer.setSource(waves());
            const vis::ViewTargetPtr target = renderer.makeTarget();
            test::renderAll(renderer, *target, scene, {48, 40});
            EXPECT_LE(renderer.residency().textureBytes, memory * 5 / 4) << "an atlas is rounded up to a box";
            const double difference = test::maxDifference(renderer.readLinear(*target), wanted);
            const bool said = !renderer.takeMessages().empty();
            if (memory < 2000) {
                EXPECT_TRUE(said);
                continue; // nothing fits: an empty picture
            }
            EXPECT_LT(difference, 0.35) << dense << ' ' << memory;
            EXPECT_TRUE(said || difference < 1.0 / 255) << dense << ' ' << memory;
        }
    }
}

// Minimised windows, odd sizes and a storm of them: no GL error, and the last one is drawn.
TEST_F(ResidencyTest, SizesComeAndGo) {
    vis::Renderer renderer;
    renderer.setSource(waves());
    const vis::ViewTargetPtr target = renderer.makeTarget();
    const Scene scene = volumeScene();
    vis::FrameRequest request;
    for (const glm::ivec2 size : {glm::ivec2(0, 0), glm::ivec2(1, 1), glm::ivec2(300, 1), glm::ivec2(-1, 5),
                                  glm::ivec2(64, 48), glm::ivec2(0, 48), glm::ivec2(65, 47), glm::ivec2(64, 48)}) {
        request.size = size;
        request.moving = size.x % 2 == 0;
        const vis::FrameStatus status = renderer.render(*target, scene, request);
        EXPECT_EQ(status.texture != 0, size.x > 0 && size.y > 0);
    }
    test::renderAll(renderer, *target, scene, {64, 48});
    EXPECT_TRUE(renderer.takeMessages().empty());
}

// A coarse level on the grid of full resolution covers at least what its own blocks say.
TEST(BlockGrid, CoarseRangesAreConservative) {
    volume::BrickGrid grid;
    grid.lattice.size = {37, 21, 45};
    grid.brickSize = 16;
    grid.phase = 0.5;
    for (int level = 0; level < 3; ++level) {
        vis::BlockRanges coarse;
        coarse.level = level;
        coarse.count = (vis::levelTexels(grid, level) + 7) / 8;
        const glm::ivec3 n = coarse.count;
        for (int i = 0; i < n.x * n.y * n.z; ++i) {
            coarse.min.push_back(float(i));
            coarse.max.push_back(float(i));
        }
        const vis::BlockRanges fine = vis::onBlockGrid(grid, coarse);
        for (int z = 0; z < 45; ++z)
            for (int y = 0; y < 21; ++y)
                for (int x = 0; x < 37; ++x) {
                    const glm::dvec3 texel = (glm::dvec3(x, y, z) - grid.levelPhase(level)) / double(1 << level);
                    const glm::ivec3 from = glm::clamp(glm::ivec3(glm::floor(texel / 8.0)), glm::ivec3(0), n - 1);
                    const float value = float((from.z * n.y + from.y) * n.x + from.x);
                    const glm::ivec3 to(x / 8, y / 8, z / 8), m = fine.count;
                    const std::size_t at = std::size_t((to.z * m.y + to.y) * m.x + to.x);
                    ASSERT_LE(fine.min[at], value);
                    ASSERT_GE(fine.max[at], value);
                }
    }
}

} // namespace
} // namespace tessera
