#include "tests/vis/gl_fixture.h"
#include "tests/vis/raycast_compare.h"

/// Pictures with depth of field: both engines against the reference, and what a small ball becomes.
namespace tessera::vis {
namespace {

class DepthOfFieldGl : public test::GlTest {};

constexpr glm::ivec2 kBallPicture{96, 96};

/// A ball of radius 1.2 at a place of a box of 24.
std::shared_ptr<FunctionSource> smallBall(glm::dvec3 middle) {
    return std::make_shared<FunctionSource>(
        LatticeKind::CC, glm::ivec3(25), glm::dvec3(1),
        std::vector<FunctionSource::Channel>{
            {"v", [middle](glm::dvec3 p) { return std::max(0.0, 2 - glm::length(p - middle) / 1.2); }}});
}

Scene smallBallScene(Engine engine) {
    Scene scene;
    scene.camera = test::frontCamera();
    scene.camera.projection = Projection::Perspective;
    scene.camera.distance = 2;
    scene.showBox = false;
    scene.layers = {{"ball", true, IsoLayer{.channel = "v", .value = 1}}};
    scene.render.engine = engine;
    scene.render.samples = 4;
    return scene;
}

/// Mass, middle and variance along x, in pixels, of the opacity of a picture.
struct BlurMoments {
    double mass = 0, middle = 0, variance = 0;
};
BlurMoments momentsOf(const std::vector<glm::vec4>& picture) {
    BlurMoments out;
    for (int y = 0; y < kBallPicture.y; ++y)
        for (int x = 0; x < kBallPicture.x; ++x) {
            const double alpha = double(picture[std::size_t(y * kBallPicture.x + x)].a);
            out.mass += alpha;
            out.middle += alpha * x;
            out.variance += alpha * x * x;
        }
    out.middle /= out.mass;
    out.variance = out.variance / out.mass - out.middle * out.middle;
    return out;
}

BlurMoments blurOf(Renderer& renderer, const Scene& scene) {
    const ViewTargetPtr target = renderer.makeTarget();
    EXPECT_TRUE(renderer.render(*target, scene, {.size = kBallPicture, .wait = true}).complete);
    return momentsOf(renderer.readLinear(*target));
}

/// A disc of radius r has the variance r^2 / 4 along each axis, which adds to that of what is blurred.
TEST_F(DepthOfFieldGl, ABallIsBlurredByTheThinLensAndSharpInFocus) {
    for (const Engine engine : {Engine::OpenGl, Engine::Processor}) {
        Renderer renderer({.exactTextures = true});
        renderer.setSource(smallBall({12, 12, 18}));
        Scene scene = smallBallScene(engine);
        const BlurMoments sharp = blurOf(renderer, scene);
        ASSERT_GT(sharp.mass, 10);
        scene.camera.aperture = 0.3f;
        scene.camera.focus = {0.2f, 0.3f, 0.25f}; // as deep as the ball
        const BlurMoments focused = blurOf(renderer, scene);
        EXPECT_NEAR(focused.mass, sharp.mass, 0.03 * sharp.mass);
        EXPECT_NEAR(focused.variance, sharp.variance, 0.35) << "but for its own depth";
        scene.camera.focus = {0, 0, -0.35f};
        const double radius = blurRadius(scene.camera, 2 - 0.25) * kBallPicture.y;
        ASSERT_GT(radius, 3);
        const BlurMoments blurred = blurOf(renderer, scene);
        EXPECT_NEAR(blurred.mass, sharp.mass, 0.03 * sharp.mass) << "light is spread, not lost";
        EXPECT_NEAR(blurred.middle, sharp.middle, 0.2);
        EXPECT_NEAR(blurred.variance - sharp.variance, radius * radius / 4, 0.08 * radius * radius / 4);
        EXPECT_TRUE(renderer.takeMessages().empty());
    }
}

TEST_F(DepthOfFieldGl, BothEnginesAgreeWithTheReference) {
    for (const bool perspective : {true, false}) {
        SCOPED_TRACE(perspective);
        Drawing drawing(LatticeKind::CC, false, true);
        Scene scene = baseScene(perspective);
        scene.camera.aperture = 0.25f;
        scene.camera.focus = {0.1f, 0.1f, 0.3f};
        scene.render.stepVoxels = 1;
        scene.layers = {{"fog", true, VolumeLayer{.channel = "a", .density = 3}},
                        {"surface", true, IsoLayer{.channel = "b", .value = 0.9}}};
        const Linear wanted = drawing.truth(scene);
        for (const Engine engine : {Engine::OpenGl, Engine::Processor}) {
            scene.render.engine = engine;
            const Linear got = drawing.draw(scene);
            const reference::Difference difference = reference::compare(got, wanted, kOutlier * 20);
            EXPECT_GT(difference.psnr, 55) << words(difference) << evidence("depth of field", got, wanted);
        }
        scene.camera.aperture = 0;
        EXPECT_LT(reference::compare(drawing.draw(scene), wanted, kOutlier).psnr, 40) << "there is a blur";
    }
}

/// What is drawn while the mouse moves, and what is picked, is that of the middle of the lens.
TEST_F(DepthOfFieldGl, PicksAreSharp) {
    Renderer renderer({.exactTextures = true});
    renderer.setSource(smallBall({12, 12, 18}));
    Scene scene = smallBallScene(Engine::OpenGl);
    const ViewTargetPtr target = renderer.makeTarget();
    ASSERT_TRUE(renderer.render(*target, scene, {.size = kBallPicture, .wait = true}).complete);
    const auto before = renderer.pick(*target, kBallPicture / 2);
    ASSERT_TRUE(before);
    scene.camera.aperture = 0.3f;
    scene.camera.focus = {0, 0, -0.3f};
    ASSERT_TRUE(renderer.render(*target, scene, {.size = kBallPicture, .wait = true}).complete);
    const auto after = renderer.pick(*target, kBallPicture / 2);
    ASSERT_TRUE(after);
    EXPECT_LT(glm::length(after->position - before->position), 1e-4);
}

} // namespace
} // namespace tessera::vis
