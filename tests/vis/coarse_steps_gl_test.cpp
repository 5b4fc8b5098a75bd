#include "tests/vis/residency_fixture.h"

namespace tessera::test {
namespace {

constexpr glm::ivec2 kPicture(32, 28); // half a pixel to a voxel of the waves, in either direction

/// The mean number of times that rays of a picture take a sample.
double samplesPerPixel(const vis::Scene& scene) {
    vis::RendererOptions options = bricks();
    options.countSamples = true;
    double sum = 0;
    const std::vector<glm::vec4> counts = picture(waves(), options, scene, kPicture);
    for (const glm::vec4& pixel : counts) sum += double(pixel.r);
    return sum / double(counts.size());
}

vis::Scene haze() {
    vis::Scene scene = volumeScene();
    scene.transfer["v"].opacity = {{0, 0.02f}, {1, 0.05f}};
    scene.render.importance = 0;
    scene.render.detail = 1.5f; // level 1
    scene.render.samples = 1;
    return scene;
}

// A step is counted in cells of the finest level that a picture wants: half as many samples where that has cells twice
// as large.
TEST_F(ResidencyTest, StepsAreOfTheLevelDrawn) {
    vis::Scene scene = haze();
    scene.render.detail = 0;
    const double fine = samplesPerPixel(scene);
    scene.render.detail = 1.5f;
    EXPECT_NEAR(samplesPerPixel(scene) / fine, 0.5, 0.03);
    scene.render.stepVoxels /= 2;
    EXPECT_NEAR(samplesPerPixel(scene) / fine, 1, 0.03);
}

// And these are enough: twice as many show the same.
TEST_F(ResidencyTest, StepsOfACoarseLevelLoseNothing) {
    vis::Scene scene = haze();
    for (const bool surface : {false, true}) {
        if (surface) scene.layers[0].technique = vis::IsoLayer{.channel = "v", .value = 0.7};
        scene.render.stepVoxels = 0.5f;
        const std::vector<glm::vec4> coarse = picture(waves(), bricks(), scene, kPicture);
        scene.render.stepVoxels = 0.25f;
        const std::vector<glm::vec4> finer = picture(waves(), bricks(), scene, kPicture);
        double sum = 0; // a ray may just meet a surface that others pass
        for (std::size_t i = 0; i < finer.size(); ++i) sum += double(glm::length(finer[i] - coarse[i]));
        EXPECT_LT(sum / double(finer.size()), 0.005) << surface;
    }
}

// Where only a part is wanted at full resolution, all steps are its.
TEST_F(ResidencyTest, TheFinestBrickGivesTheStep) {
    vis::Scene scene = haze();
    const double coarse = samplesPerPixel(scene);
    vis::Lens lens;
    lens.center = {30, 26, 35};
    lens.size = glm::vec3(0.1f);
    lens.detail = 0.5f;
    scene.lenses = {lens};
    EXPECT_NEAR(samplesPerPixel(scene) / coarse, 2, 0.1);
}

} // namespace
} // namespace tessera::test
