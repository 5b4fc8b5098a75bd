#include "tests/vis/residency_fixture.h"

namespace tessera::test {
namespace {

using vis::Scene;

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
            EXPECT_LT(maxDifference(whole, picture(source, options, scene, size)), 1.0 / 255)
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
    EXPECT_LT(maxDifference(near, picture(part, {}, scene, {32, 32})), 1.0 / 255);
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
    EXPECT_LT(maxDifference(seen, picture(other, {}, scene, {40, 40})), 1.0 / 255);
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
    const float step = std::exchange(scene.render.stepVoxels, 0.125f); // of level 2: what the lens makes of it
    const std::vector<glm::vec4> coarse = picture(none, bricks(), scene, size);
    ASSERT_EQ(none->count(0, 0), 0);
    scene.render.stepVoxels = step;
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
    EXPECT_LT(maxDifference(mixed, fine), maxDifference(coarse, fine) + 1.0 / 255);
}
} // namespace
} // namespace tessera::test
