#include "tests/vis/function_source.h"
#include "tests/vis/gl_fixture.h"

#include "volume/base/error.h"

#include <cmath>
#include <thread>

/// The renderer with rays cast by the processor, beside the same pictures by OpenGL.
namespace tessera::vis {
namespace {

class EngineGl : public test::GlTest {};

std::shared_ptr<FunctionSource> waves(volume::LatticeKind kind) {
    return std::make_shared<FunctionSource>(
        kind, glm::ivec3(21, 17, 25), glm::dvec3(1),
        std::vector<FunctionSource::Channel>{
            {"v", [](glm::dvec3 p) { return 0.5 + 0.3 * std::sin(0.5 * p.x) * std::cos(0.4 * p.y) + 0.008 * p.z; }}});
}

Scene wavesScene(Engine engine) {
    Scene scene;
    scene.layers = {{.name = "waves", .visible = true, .technique = VolumeLayer{.channel = "v", .density = 4}}};
    scene.transfer["v"].opacity = {{0, 0}, {0.5f, 0}, {1, 0.3f}};
    scene.render.engine = engine;
    scene.render.samples = 2;
    return scene;
}

double rms(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += double(glm::dot(a[i] - b[i], a[i] - b[i]));
    return std::sqrt(sum / double(a.size() * 4));
}

/// At the rim of a surface single precision may decide otherwise.
struct Apart {
    int outliers = 0;
    double rms = 0; ///< of the other pixels
};
Apart apartBy(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b) {
    Apart out;
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double squared = double(glm::dot(a[i] - b[i], a[i] - b[i]));
        if (squared > 1e-3)
            ++out.outliers;
        else
            sum += squared;
    }
    out.rms = std::sqrt(sum / double(a.size() * 4));
    return out;
}

TEST_F(EngineGl, BothEnginesDrawTheSamePicture) {
    for (const volume::LatticeKind kind : {volume::LatticeKind::CC, volume::LatticeKind::BCC})
        for (const bool surface : {false, true}) {
            Renderer renderer({.exactTextures = true});
            renderer.setSource(waves(kind));
            std::vector<std::vector<glm::vec4>> pictures;
            std::vector<glm::dvec3> picked;
            for (const Engine engine : {Engine::OpenGl, Engine::Processor}) {
                Scene scene = wavesScene(engine);
                if (surface) scene.layers[0].technique = IsoLayer{.channel = "v", .value = 0.6};
                const ViewTargetPtr target = renderer.makeTarget();
                const FrameStatus status = renderer.render(*target, scene, {.size = {160, 120}, .wait = true});
                EXPECT_TRUE(status.complete);
                EXPECT_EQ(status.engine.byProcessor, engine == Engine::Processor) << status.engine.refusal;
                EXPECT_GT(status.bytes, 21u * 17u);
                pictures.push_back(renderer.readLinear(*target));
                const std::optional<Pick> pick = renderer.pick(*target, {80, 70});
                ASSERT_TRUE(pick);
                picked.push_back(pick->position);
            }
            const Apart apart = apartBy(pictures[0], pictures[1]);
            EXPECT_LE(apart.outliers, 12) << surface;
            EXPECT_LT(apart.rms, 3e-4) << surface;
            EXPECT_LT(glm::length(picked[0] - picked[1]), 0.05);
            EXPECT_TRUE(renderer.takeMessages().empty());
        }
}

/// What a screen shows of both, where the processor presents its own pixels and where OpenGL does (with tones), with
/// and without the box and the ground, drawn in one go and tile by tile; after the box has moved, what was beside it is
/// empty again.
TEST_F(EngineGl, BothPresentTheSamePixels) {
    Renderer renderer({.exactTextures = true});
    renderer.setSource(waves(volume::LatticeKind::CC));
    const ViewTargetPtr byOpenGl = renderer.makeTarget(), byProcessor = renderer.makeTarget();
    Scene scene = wavesScene(Engine::Processor);
    scene.render.samples = 1;
    scene.background = {0.2f, 0.5f, 0.8f};
    scene.transfer["v"].opacity = {{0, 0.02f}, {1, 0.3f}}; // no pixel of the box is empty
    const glm::ivec2 size(333, 201);
    const auto shown = [&](ViewTarget& target, Engine engine, double budget) {
        scene.render.engine = engine;
        FrameStatus status;
        for (int frame = 0; frame < 20000 && !status.complete; ++frame)
            status = renderer.render(target, scene, {.size = size, .budgetMs = budget, .wait = budget == 0});
        EXPECT_TRUE(status.complete);
        EXPECT_EQ(status.engine.byProcessor, engine == Engine::Processor);
        glm::ivec2 read;
        return renderer.readPixels(target, read);
    };
    int way = 0;
    for (const bool ground : {true, false})
        for (const bool box : {true, false})
            for (const ToneCurve curve : {ToneCurve::None, ToneCurve::Filmic}) {
                SCOPED_TRACE(testing::Message() << ground << box << int(curve));
                scene.showGround = ground;
                scene.showBox = box;
                scene.tone.curve = curve;
                scene.camera.distance = 2.2f + 0.4f * float(way % 3);
                orbit(scene.camera, {0, 0}, {0.7f, 0.2f * float(way % 2)});
                const auto wanted = shown(*byOpenGl, Engine::OpenGl, 0),
                           got = shown(*byProcessor, Engine::Processor, way++ % 2 == 0 ? 0 : 0.1);
                std::size_t apart = 0;
                for (std::size_t i = 0; i < wanted.size(); ++i) apart += std::abs(int(wanted[i]) - int(got[i])) > 2;
                EXPECT_LT(apart, wanted.size() / 2000);
                std::size_t empty = 0; // corners of the picture hold nothing but the ground
                for (const std::size_t at : {std::size_t(0), std::size_t(4 * (size.x - 1)), wanted.size() - 4})
                    for (std::size_t c = 0; c < 4; ++c) empty += std::abs(int(wanted[at + c]) - int(got[at + c])) <= 1;
                EXPECT_EQ(empty, 12u);
            }
}

/// A picture of one tile, beside the box.
TEST_F(EngineGl, NothingIsLeftOfABoxThatWentAway) {
    Renderer renderer;
    renderer.setSource(waves(volume::LatticeKind::CC));
    const ViewTargetPtr target = renderer.makeTarget();
    Scene scene = wavesScene(Engine::Processor);
    scene.render.samples = 1;
    const auto shown = [&] {
        test::renderAll(renderer, *target, scene, {40, 30});
        glm::ivec2 read;
        return renderer.readPixels(*target, read);
    };
    const auto same = [](const std::vector<std::uint8_t>& pixels) {
        for (std::size_t i = 4; i < pixels.size(); ++i)
            if (pixels[i] != pixels[i - 4]) return false;
        return true;
    };
    EXPECT_FALSE(same(shown()));
    scene.camera.target += scene.camera.orientation * glm::vec3(6, 0, 0);
    EXPECT_TRUE(same(shown()));
}

TEST_F(EngineGl, AutomaticIsWhatTheOptionsSay) {
    for (const Packets packets : {Packets::Never, Packets::WhileCompiling, Packets::Always}) {
        Renderer renderer({.packets = packets});
        renderer.setSource(waves(volume::LatticeKind::CC));
        const ViewTargetPtr target = renderer.makeTarget();
        EXPECT_EQ(test::renderAll(renderer, *target, wavesScene(Engine::Automatic), {32, 32}).engine.byProcessor,
                  packets == Packets::Always);
        EXPECT_FALSE(test::renderAll(renderer, *target, wavesScene(Engine::OpenGl), {32, 32}).engine.byProcessor);
        EXPECT_TRUE(test::renderAll(renderer, *target, wavesScene(Engine::Processor), {32, 32}).engine.byProcessor);
        EXPECT_TRUE(renderer.engine().byProcessor);
    }
}

/// A renderer whose processor draws while OpenGL compiles, beside one picture that waits for OpenGL.
struct Meanwhile {
    Renderer renderer;
    ViewTargetPtr target = renderer.makeTarget(), waited = renderer.makeTarget();

    explicit Meanwhile(bool bricks)
        : renderer({.denseTexels = bricks ? 1000 : std::size_t(1) << 20,
                    .packets = Packets::WhileCompiling,
                    .patience = 0}) {
        renderer.setSource(waves(volume::LatticeKind::BCC));
    }
    /// Draws until nothing is left to do. Returns in how many frames the processor's picture was there meanwhile.
    int untilComplete(const Scene& scene) {
        int meanwhile = 0;
        for (int frame = 0; frame < 20000; ++frame) {
            const FrameStatus status = renderer.render(*target, scene, {.size = {64, 48}, .budgetMs = 1});
            meanwhile += status.compiling && status.current && status.engine.byProcessor ? 1 : 0;
            if (status.complete) return meanwhile;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        ADD_FAILURE() << "not complete";
        return meanwhile;
    }
    std::vector<glm::vec4> byOpenGl(Scene scene) {
        scene.render.engine = Engine::OpenGl;
        test::renderAll(renderer, *waited, scene, {64, 48});
        return renderer.readLinear(*waited);
    }
};

/// Where OpenGL is to draw, the processor does while OpenGL compiles. With bricks its picture is then drawn again,
/// since only OpenGL finds out which of them are occluded.
TEST_F(EngineGl, TheProcessorDrawsWhileOpenGlCompiles) {
    for (const bool bricks : {false, true}) {
        Meanwhile drawing(bricks);
        Scene scene = wavesScene(Engine::Processor);
        int meanwhile = 0;
        for (int tries = 0; tries < 8 && meanwhile == 0; ++tries) { // a driver may have a program at once
            scene.layers.push_back(scene.layers.front());
            scene.render.engine = Engine::Processor;
            test::renderAll(drawing.renderer, *drawing.target, scene, {64, 48}); // now it has the samples
            scene.render.engine = Engine::Automatic;
            scene.transfer["v"].opacity[2].y *= 0.9f;
            meanwhile = drawing.untilComplete(scene);
            const bool byProcessor = drawing.renderer.engine().byProcessor;
            EXPECT_FALSE(bricks && byProcessor);
            const std::vector<glm::vec4> shown = drawing.renderer.readLinear(*drawing.target);
            EXPECT_LT(rms(shown, drawing.byOpenGl(scene)), byProcessor ? 3e-4 : 1e-6) << bricks;
        }
        EXPECT_GT(meanwhile, 0) << bricks;
        // The program is there now.
        scene.transfer["v"].opacity[2].y *= 0.9f;
        drawing.untilComplete(scene);
        EXPECT_FALSE(drawing.renderer.engine().byProcessor);
        EXPECT_LT(rms(drawing.renderer.readLinear(*drawing.target), drawing.byOpenGl(scene)), 1e-6) << bricks;
        EXPECT_TRUE(drawing.renderer.takeMessages().empty());
    }
}

/// Users who ask for OpenGL wait for it, as they do where they have asked for patience.
TEST_F(EngineGl, OpenGlIsWaitedForWhereItIsAskedFor) {
    for (const bool asked : {false, true}) {
        Renderer renderer({.packets = Packets::WhileCompiling, .patience = asked ? 0.0 : 1e9});
        renderer.setSource(waves(volume::LatticeKind::CC));
        const ViewTargetPtr target = renderer.makeTarget();
        Scene scene = wavesScene(asked ? Engine::OpenGl : Engine::Automatic);
        scene.render.samples = asked ? 1 : 3; // another program
        FrameStatus status;
        for (int frame = 0; frame < 20000 && !status.complete; ++frame) {
            status = renderer.render(*target, scene, {.size = {64, 48}, .budgetMs = 1});
            EXPECT_FALSE(status.engine.byProcessor);
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        EXPECT_TRUE(status.complete);
    }
}

/// What the processor cannot draw is drawn by OpenGL, which says why; and back.
TEST_F(EngineGl, OpenGlTakesOverAndSaysWhy) {
    Renderer renderer;
    renderer.setSource(waves(volume::LatticeKind::BCC));
    const ViewTargetPtr target = renderer.makeTarget();
    Scene scene = wavesScene(Engine::Processor);
    test::renderAll(renderer, *target, scene, {48, 48});
    const std::vector<glm::vec4> before = renderer.readLinear(*target);
    scene.render.adaptiveStep = 0.5f;
    const FrameStatus other = test::renderAll(renderer, *target, scene, {48, 48});
    EXPECT_FALSE(other.engine.byProcessor);
    EXPECT_EQ(other.engine.refusal, "adaptive steps");
    scene.render.adaptiveStep = 0;
    EXPECT_TRUE(test::renderAll(renderer, *target, scene, {48, 48}).engine.byProcessor);
    EXPECT_LT(rms(before, renderer.readLinear(*target)), 1e-6);
    // Data that do not fit into the memory for bricks.
    scene.render.limits.brickMemory = 0;
    EXPECT_FALSE(test::renderAll(renderer, *target, scene, {48, 48}).engine.byProcessor);
}

TEST_F(EngineGl, BothSayWhatExceedsALimit) {
    for (const Engine engine : {Engine::OpenGl, Engine::Processor}) {
        Renderer renderer;
        renderer.setSource(waves(volume::LatticeKind::CC));
        const ViewTargetPtr target = renderer.makeTarget();
        Scene scene = wavesScene(engine);
        scene.clips.assign(kMaxClips, Clip{.center = glm::vec3(0.1f)});
        test::renderAll(renderer, *target, scene, {32, 32});
        EXPECT_TRUE(renderer.takeMessages().empty());
        scene.clips.push_back(scene.clips.back());
        test::renderAll(renderer, *target, scene, {32, 32});
        EXPECT_EQ(renderer.takeMessages(), std::vector<std::string>{"the first 8 clips are used"}) << int(engine);
    }
}

/// What a window says of its volume is not what its slices are drawn by.
TEST_F(EngineGl, PicturesOfSectionsSayNothingOfRays) {
    Renderer renderer;
    renderer.setSource(waves(volume::LatticeKind::CC));
    const ViewTargetPtr volume = renderer.makeTarget(), slice = renderer.makeTarget();
    Scene scene = wavesScene(Engine::Processor);
    scene.layers.push_back({.name = "cut", .visible = false, .technique = SliceLayer{.channel = "v"}});
    test::renderAll(renderer, *volume, scene, {32, 32});
    Scene section = scene;
    section.layers = {{.name = "cut", .technique = SliceLayer{.channel = "v"}}};
    const EngineUse alone = test::renderAll(renderer, *slice, section, {32, 32}).engine;
    EXPECT_FALSE(alone.byProcessor) << "a sample for each pixel";
    EXPECT_EQ(alone.refusal, "");
    EXPECT_TRUE(renderer.engine().byProcessor);
    scene.layers.back().visible = true;
    test::renderAll(renderer, *volume, scene, {32, 32});
    EXPECT_TRUE(renderer.engine().byProcessor) << "a slice in the volume's picture";
    scene.render.adaptiveStep = 0.5f;
    test::renderAll(renderer, *volume, scene, {32, 32});
    EXPECT_EQ(renderer.engine().refusal, "adaptive steps");
}

/// OpenGL rasterises meshes and lines for both engines.
std::shared_ptr<const Geometry> crossedRectangles() {
    auto geometry = std::make_shared<Geometry>();
    for (const int axis : {0, 2})
        for (int corner = 0; corner < 4; ++corner) {
            glm::vec3 at(10, 8, 12);
            at[axis] += float((corner == 1 || corner == 2) ? 9 : -9);
            at.y += float(corner >= 2 ? 7 : -7);
            at[2 - axis] += 0.3f * (at.y - 8);
            geometry->mesh.positions.push_back(at);
            geometry->mesh.scalars.push_back(0.1f * at.y);
        }
    geometry->mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
    return geometry;
}

TEST_F(EngineGl, MeshesAndSlicesAmongLayersAreAlike) {
    for (const volume::LatticeKind kind : {volume::LatticeKind::CC, volume::LatticeKind::BCC})
        for (const bool brushed : {false, true}) {
            Renderer renderer({.exactTextures = true});
            renderer.setSource(waves(kind));
            std::vector<std::vector<glm::vec4>> pictures;
            for (const Engine engine : {Engine::OpenGl, Engine::Processor}) {
                Scene scene = wavesScene(engine);
                scene.cursor = {8, 7, 9};
                scene.layers.push_back({.name = "cut",
                                        .technique = SliceLayer{.channel = "v",
                                                                .orientation = SliceOrientation::Oblique,
                                                                .normal = {0.3f, 0.5f, -0.8f},
                                                                .contours = 5,
                                                                .opacity = 0.7f}});
                GeometryLayer mesh{.geometry = crossedRectangles()};
                mesh.style.opacity = 0.6f;
                scene.geometry = {mesh};
                if (brushed) {
                    scene.selection.brushes = {rangeBrush({{.channel = "v", .lo = 0.5, .hi = 0.7, .soft = 0.1}})};
                    scene.geometry[0].brushes = BrushEffect::FocusOnly;
                }
                const ViewTargetPtr target = renderer.makeTarget();
                const FrameStatus status = renderer.render(*target, scene, {.size = {161, 121}, .wait = true});
                EXPECT_EQ(status.engine.byProcessor, engine == Engine::Processor) << status.engine.refusal;
                pictures.push_back(renderer.readLinear(*target));
                scene.geometry.clear();
                renderer.render(*target, scene, {.size = {161, 121}, .wait = true});
                EXPECT_GT(rms(pictures.back(), renderer.readLinear(*target)), 0.01) << "the mesh is seen";
            }
            const Apart apart = apartBy(pictures[0], pictures[1]);
            EXPECT_LE(apart.outliers, 25);
            EXPECT_LT(apart.rms, 5e-4);
            EXPECT_TRUE(renderer.takeMessages().empty());
        }
}

/// A mesh casts its shadow, and gets shadows and light from its surroundings, as the volume does.
TEST_F(EngineGl, LightIsAlike) {
    for (const bool maps : {false, true}) {
        Renderer renderer({.exactTextures = true});
        renderer.setSource(waves(volume::LatticeKind::BCC));
        std::vector<std::vector<glm::vec4>> pictures, unlit;
        for (const Engine engine : {Engine::OpenGl, Engine::Processor}) {
            Scene scene = wavesScene(engine);
            scene.geometry = {GeometryLayer{.geometry = crossedRectangles()}};
            const ViewTargetPtr target = renderer.makeTarget();
            test::renderAll(renderer, *target, scene, {161, 121});
            unlit.push_back(renderer.readLinear(*target));
            if (maps) scene.lighting.environment.kind = Environment::Studio;
            scene.lighting.shadows = {
                .strength = maps ? 0.0f : 0.9f, .occlusion = 0.5f, .translucency = maps ? 0.0f : 0.4f};
            const FrameStatus status = test::renderAll(renderer, *target, scene, {161, 121});
            EXPECT_EQ(status.engine.byProcessor, engine == Engine::Processor) << status.engine.refusal;
            pictures.push_back(renderer.readLinear(*target));
            EXPECT_GT(rms(pictures.back(), unlit.back()), 0.01) << "the light is seen";
            if (maps) continue;
            scene.lighting.shadows.meshes = false;
            test::renderAll(renderer, *target, scene, {161, 121});
            EXPECT_GT(rms(pictures.back(), renderer.readLinear(*target)), 0.003) << "the mesh casts a shadow";
        }
        const Apart apart = apartBy(pictures[0], pictures[1]);
        EXPECT_LE(apart.outliers, 25);
        EXPECT_LT(apart.rms, 5e-4);
        EXPECT_TRUE(renderer.takeMessages().empty());
    }
}

/// While shadows are computed, the picture comes without them; then with them. Lights that move move shadows.
TEST_F(EngineGl, ShadowsComeWithoutWaiting) {
    Renderer renderer;
    renderer.setSource(waves(volume::LatticeKind::CC));
    Scene scene = wavesScene(Engine::Processor);
    scene.lighting.shadows.strength = 1;
    const ViewTargetPtr target = renderer.makeTarget(), whole = renderer.makeTarget();
    for (const float azimuth : {-30.0f, 60.0f}) {
        scene.lighting.lights = {Light{.azimuth = azimuth}};
        bool complete = false;
        for (int i = 0; i < 4000 && !complete; ++i) {
            complete = renderer.render(*target, scene, {.size = {160, 120}, .budgetMs = 4}).complete;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        EXPECT_TRUE(complete);
        renderer.render(*whole, scene, {.size = {160, 120}, .wait = true});
        EXPECT_LT(test::maxDifference(renderer.readLinear(*target), renderer.readLinear(*whole)), 2e-3);
    }
    Scene plain = scene;
    plain.lighting.shadows.strength = 0;
    renderer.render(*target, plain, {.size = {160, 120}, .wait = true});
    EXPECT_GT(rms(renderer.readLinear(*target), renderer.readLinear(*whole)), 0.01);
}

/// Without waiting, the picture comes once its samples are read; a moving view gets a reduced one that is current.
TEST_F(EngineGl, PicturesComeWhenTheirSamplesAreRead) {
    Renderer renderer;
    renderer.setSource(waves(volume::LatticeKind::CC));
    const ViewTargetPtr target = renderer.makeTarget(), whole = renderer.makeTarget();
    const Scene scene = wavesScene(Engine::Processor);
    const auto drawUntil = [&](bool moving, auto&& done) {
        FrameStatus status;
        for (int i = 0; i < 2000; ++i) {
            status = renderer.render(*target, scene, {.size = {160, 120}, .moving = moving, .budgetMs = 4});
            if (done(status)) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return false;
    };
    EXPECT_TRUE(drawUntil(true, [](const FrameStatus& status) { return status.current; }));
    EXPECT_TRUE(drawUntil(false, [](const FrameStatus& status) { return status.complete; }));
    renderer.render(*whole, scene, {.size = {160, 120}, .wait = true});
    EXPECT_LT(test::maxDifference(renderer.readLinear(*target), renderer.readLinear(*whole)), 2e-3);
}

/// So it does where other views are drawn already, and an empty picture could be shown at once.
TEST_F(EngineGl, ANewViewBesideOthersComesWhenItsSamplesAreRead) {
    Renderer renderer;
    const Scene scene = wavesScene(Engine::Processor);
    renderer.setSource(waves(volume::LatticeKind::CC));
    const ViewTargetPtr first = renderer.makeTarget(), second = renderer.makeTarget(), whole = renderer.makeTarget();
    renderer.render(*first, scene, {.size = {80, 60}, .wait = true});
    renderer.setSource(waves(volume::LatticeKind::BCC)); // no sample of it is read
    bool complete = false;
    for (int i = 0; i < 2000 && !complete; ++i) {
        complete = renderer.render(*second, scene, {.size = {80, 60}, .budgetMs = 4}).complete;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_TRUE(complete);
    renderer.render(*whole, scene, {.size = {80, 60}, .wait = true});
    EXPECT_LT(test::maxDifference(renderer.readLinear(*second), renderer.readLinear(*whole)), 2e-3);
}

/// Another time, and another data set, are other samples.
TEST_F(EngineGl, NewDataAreDrawn) {
    Renderer renderer;
    const ViewTargetPtr target = renderer.makeTarget();
    const Scene scene = wavesScene(Engine::Processor);
    std::vector<std::vector<glm::vec4>> pictures;
    for (const double level : {0.6, 0.9}) {
        renderer.setSource(std::make_shared<FunctionSource>(
            volume::LatticeKind::CC, glm::ivec3(9), glm::dvec3(1),
            std::vector<FunctionSource::Channel>{{"v", [level](glm::dvec3) { return level; }}}));
        test::renderAll(renderer, *target, scene, {32, 32});
        pictures.push_back(renderer.readLinear(*target));
    }
    EXPECT_GT(rms(pictures[0], pictures[1]), 0.05);
}

/// A damaged brick: OpenGL draws the others, and the reason is told once.
TEST_F(EngineGl, DamagedSamplesAreLeftToOpenGl) {
    struct Damaged : FunctionSource {
        using FunctionSource::FunctionSource;
        volume::BrickSamples read(const volume::BrickKey& key) const override {
            if (key.index == glm::ivec3(1, 0, 0)) throw Error("checksum", "damaged.tsr", "brick 1");
            return FunctionSource::read(key);
        }
    };
    Renderer renderer;
    renderer.setSource(std::make_shared<Damaged>(
        volume::LatticeKind::CC, glm::ivec3(17, 9, 9), glm::dvec3(1),
        std::vector<FunctionSource::Channel>{{"v", [](glm::dvec3 p) { return 0.5 + 0.02 * p.x; }}}));
    const ViewTargetPtr target = renderer.makeTarget();
    const FrameStatus status = test::renderAll(renderer, *target, wavesScene(Engine::Processor), {32, 32});
    EXPECT_FALSE(status.engine.byProcessor);
    EXPECT_EQ(status.engine.refusal, "damaged samples");
    const std::vector<std::string> messages = renderer.takeMessages();
    ASSERT_FALSE(messages.empty());
    EXPECT_NE(messages[0].find("damaged.tsr"), std::string::npos) << messages[0];
}

} // namespace
} // namespace tessera::vis
