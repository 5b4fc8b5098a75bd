#include "tests/vis/function_source.h"
#include "tests/vis/gl_fixture.h"

#include "vis/gl/driver.h"
#include "vis/gl/program_cache.h"
#include "vis/gl/warm_up.h"
#include "vis/raycast/ray_uniforms.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>
#include <unistd.h>

namespace tessera {
namespace {

/// An empty folder until the process ends: Mesa goes on writing into its cache.
const std::filesystem::path& scratch() {
    struct Folder {
        std::filesystem::path path;
        ~Folder() {
            std::error_code ignored;
            std::filesystem::remove_all(path, ignored);
        }
    };
    static const Folder folder{std::filesystem::path(TESSERA_BINARY_DIR) /
                               ("program-cache-" + std::to_string(getpid()))};
    std::filesystem::create_directories(folder.path);
    return folder.path;
}

/// With an empty disk cache of Mesa's, so that machine code is made anew.
class ProgramCacheTest : public ::testing::Test {
protected:
    ProgramCacheTest() {
        setenv("MESA_SHADER_CACHE_DIR", scratch().c_str(), 1);
        context_ = std::make_unique<vis::HeadlessContext>();
    }
    ~ProgramCacheTest() override {
        context_.reset();
        unsetenv("MESA_SHADER_CACHE_DIR");
        unsetenv("TESSERA_SHADER_DIR");
    }
    std::unique_ptr<vis::HeadlessContext> context_;
};

/// A volume, two surfaces and a brush: seconds of work for the compiler of software GL.
vis::Scene heavyScene() {
    vis::Scene scene;
    vis::VolumeLayer volume;
    volume.channel = "v";
    scene.layers.push_back({"volume", true, volume});
    scene.layers.push_back({"iso", true, vis::IsoLayer{.channel = "w", .value = 0.4, .opacity = 0.5f}});
    scene.layers.push_back({"iso 2", true, vis::IsoLayer{.channel = "v", .value = 0.6, .opacity = 0.5f}});
    scene.selection.brushes = {vis::rangeBrush({{"w", 0.2, 0.9, 0.1}})};
    return scene;
}

std::shared_ptr<vis::FunctionSource> source() {
    return std::make_shared<vis::FunctionSource>(
        volume::LatticeKind::BCC, glm::ivec3(29, 25, 37), glm::dvec3(1),
        std::vector<vis::FunctionSource::Channel>{{"v", [](glm::dvec3 p) { return 0.03 * p.x; }},
                                                  {"w", [](glm::dvec3 p) { return 0.02 * p.y; }}});
}

// While a variant is compiled, calls return within a frame's time and the former picture stays; then the picture is the
// one that waiting gives.
TEST_F(ProgramCacheTest, CompilingBlocksNobody) {
    vis::Renderer renderer;
    renderer.setSource(source());
    const vis::ViewTargetPtr target = renderer.makeTarget(), waited = renderer.makeTarget();
    vis::Scene simple = heavyScene();
    simple.layers.resize(1);
    simple.selection = {};
    vis::FrameRequest request;
    request.size = {64, 64};
    test::renderAll(renderer, *target, simple, request.size);
    glm::ivec2 size;
    const std::vector<std::uint8_t> former = renderer.readPixels(*target, size);
    test::renderAll(renderer, *waited, simple, request.size);

    const vis::Scene heavy = heavyScene();
    int unchanged = 0;
    vis::FrameStatus status;
    for (int frame = 0; frame < 20000 && !status.complete; ++frame) {
        status = renderer.render(*target, heavy, request);
        if (unchanged == frame && renderer.readPixels(*target, size) == former) ++unchanged;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ASSERT_TRUE(status.complete);
    EXPECT_GT(unchanged, 0) << "calls come back, and the former picture stays, while the program is compiled";
    test::renderAll(renderer, *waited, heavy, request.size);
    EXPECT_EQ(test::maxDifference(renderer.readLinear(*target), renderer.readLinear(*waited)), 0);
    EXPECT_TRUE(renderer.takeMessages().empty());
}

/// The same program with another constant: as different ones as numbers.
vis::ProgramRecipe numbered(int number) {
    return {"screen.vert.glsl", "accumulate.frag.glsl", {}, {{"NUMBER", std::to_string(number)}}};
}

/// Programs that GL has.
int livePrograms() {
    int live = 0;
    for (GLuint name = 1; name < 200; ++name) live += glIsProgram(name) ? 1 : 0;
    return live;
}

// Sessions of a day use hundreds of combinations of settings; the code of each takes memory.
TEST_F(ProgramCacheTest, ProgramsThatAreNoLongerUsedAreDeleted) {
    using namespace std::chrono_literals;
    vis::ProgramCache cache(false, {.count = 3, .unused = 0ms});
    const int before = livePrograms();
    const vis::Program* const first = cache.find(numbered(0));
    ASSERT_TRUE(first);
    const GLuint name = first->name();
    for (int number = 1; number < 20; ++number) {
        EXPECT_TRUE(cache.find(numbered(number)));
        const vis::Program* const again = cache.find(numbered(0));
        ASSERT_TRUE(again);
        EXPECT_EQ(again->name(), name) << "the one in use stays";
    }
    EXPECT_EQ(cache.size(), 3u);
    EXPECT_EQ(livePrograms() - before, 3);
    EXPECT_TRUE(cache.find(numbered(1))) << "one that was deleted is made again";
    EXPECT_TRUE(cache.takeMessages().empty());
}

TEST_F(ProgramCacheTest, APictureOfManyProgramsKeepsThemAll) {
    vis::ProgramCache cache(false, {.count = 3, .unused = std::chrono::hours(1)});
    std::vector<const vis::Program*> made;
    for (int number = 0; number < 8; ++number) made.push_back(cache.find(numbered(number)));
    for (int number = 0; number < 8; ++number) EXPECT_EQ(cache.find(numbered(number)), made[std::size_t(number)]);
    EXPECT_EQ(cache.size(), 8u);
}

// A picture that stays, as after a day's work, needs no others.
TEST_F(ProgramCacheTest, OthersAreDeletedWhileOneIsUsed) {
    using namespace std::chrono_literals;
    vis::ProgramCache cache(false, {.count = 3, .unused = 100ms});
    for (int number = 0; number < 8; ++number) ASSERT_TRUE(cache.find(numbered(number)));
    std::this_thread::sleep_for(150ms);
    ASSERT_TRUE(cache.find(numbered(7)));
    EXPECT_EQ(cache.size(), 3u);
}

// So it is with the program that presents: another tone curve is waited for under the former picture.
TEST_F(ProgramCacheTest, PresentingBlocksNobody) {
    vis::Renderer renderer;
    renderer.setSource(source());
    const vis::ViewTargetPtr target = renderer.makeTarget();
    vis::Scene scene = heavyScene();
    scene.layers.resize(1);
    vis::FrameRequest request;
    request.size = {64, 64};
    test::renderAll(renderer, *target, scene, request.size);
    glm::ivec2 size;
    const std::vector<std::uint8_t> former = renderer.readPixels(*target, size);
    scene.tone.curve = vis::ToneCurve::Filmic;
    scene.tone.exposure = 1;
    vis::FrameStatus status;
    int compiling = 0;
    for (int frame = 0; frame < 20000 && !status.complete; ++frame) {
        status = renderer.render(*target, scene, request);
        if (!status.compiling) continue;
        ++compiling;
        EXPECT_EQ(renderer.readPixels(*target, size), former);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ASSERT_TRUE(status.complete);
    EXPECT_GT(compiling, 0);
    EXPECT_NE(renderer.readPixels(*target, size), former);
}

// The picture's light volume too.
TEST_F(ProgramCacheTest, ShadowsAreCompiledInTheBackground) {
    vis::Renderer renderer;
    renderer.setSource(source());
    const vis::ViewTargetPtr target = renderer.makeTarget(), waited = renderer.makeTarget();
    vis::Scene scene = heavyScene();
    scene.layers.resize(1);
    scene.lighting.shadows = {.strength = 0.9f, .resolution = 16};
    vis::FrameRequest request;
    request.size = {64, 64};
    vis::FrameStatus status;
    for (int frame = 0; frame < 20000 && !status.complete; ++frame) {
        status = renderer.render(*target, scene, request);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ASSERT_TRUE(status.complete);
    test::renderAll(renderer, *waited, scene, request.size);
    EXPECT_LT(test::maxDifference(renderer.readLinear(*target), renderer.readLinear(*waited)), 1e-5);
}

// What a second context is to draw with: every unit that anything is bound to.
TEST_F(ProgramCacheTest, DrawStatesHoldAllUnits) {
    const vis::Program program = vis::makeProgram(numbered(0));
    program.set("source", 3);
    const vis::Texture high = vis::makeTexture2D({4, 5}, GL_RG32F, GL_LINEAR, "high"),
                       color = vis::makeTexture2D({4, 4}, GL_RGBA16F, GL_NEAREST, "color");
    const vis::Framebuffer framebuffer = vis::makeFramebuffer({color.name()}, "framebuffer");
    glTextureParameteri(high.name(), GL_TEXTURE_WRAP_S, GL_REPEAT);
    for (const int at : {1, vis::RayUnits::kGeometry, vis::RayUnits::kPaper}) {
        const auto unit = GLuint(at);
        glBindTextureUnit(unit, high.name());
        const vis::DrawState state = vis::captureDrawState(program, framebuffer);
        ASSERT_EQ(state.textures.size(), 1u);
        const vis::BoundTexture& found = state.textures[0];
        EXPECT_EQ(found.unit, unit);
        EXPECT_EQ(found.target, GLenum(GL_TEXTURE_2D));
        EXPECT_EQ(found.format, GLenum(GL_RG32F));
        EXPECT_EQ(found.size, glm::ivec3(4, 5, 1));
        EXPECT_EQ(found.sampling,
                  (std::array<GLint, 5>{GL_LINEAR, GL_LINEAR, GL_REPEAT, GL_CLAMP_TO_EDGE, GL_CLAMP_TO_EDGE}));
        EXPECT_EQ(state.samplers, (std::vector<std::pair<std::string, int>>{{"source", 3}, {"sourceTermination", 0}}));
        EXPECT_EQ(state.colorFormats, std::vector<GLenum>{GL_RGBA16F});
        glBindTextureUnit(unit, 0);
    }
}

// Contexts of one display of Mesa's software GL are not safe beside each other; elsewhere programs are shared.
TEST_F(ProgramCacheTest, TheWorkersContextSharesNothingOrEverything) {
    const vis::Texture texture = vis::makeTexture2D({4, 4}, GL_RG32F, GL_LINEAR, "texture");
    for (const bool apart : {true, false}) {
        const std::unique_ptr<vis::WorkerContext> context = vis::WorkerContext::make(apart);
        ASSERT_TRUE(context) << apart;
        EXPECT_TRUE(glIsTexture(texture.name())) << "the first context is current as before";
        const std::string renderer = vis::currentDriver().renderer;
        std::thread([&] {
            const vis::WorkerContext::Use use(*context);
            EXPECT_EQ(bool(glIsTexture(texture.name())), !apart);
            EXPECT_EQ(vis::currentDriver().renderer, renderer);
        }).join();
    }
}

// Before its first picture a target shows the background, and says what it waits for.
TEST_F(ProgramCacheTest, TheFirstPictureIsWaitedForOnAnEmptyGround) {
    vis::Renderer renderer;
    renderer.setSource(source());
    const vis::ViewTargetPtr target = renderer.makeTarget();
    vis::Scene scene = heavyScene();
    scene.showBox = false;
    scene.background = {1, 0, 0};
    vis::FrameRequest request;
    request.size = {64, 64};
    int compiling = 0;
    vis::FrameStatus status;
    for (int frame = 0; frame < 20000 && !status.complete; ++frame) {
        status = renderer.render(*target, scene, request);
        compiling += status.compiling ? 1 : 0;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        if (status.current) continue;
        glm::ivec2 size;
        const std::vector<std::uint8_t> shown = renderer.readPixels(*target, size);
        for (std::size_t i = 0; i < shown.size(); i += 4)
            ASSERT_TRUE(shown[i] == 255 && shown[i + 1] == 0 && shown[i + 2] == 0) << "frame " << frame;
    }
    ASSERT_TRUE(status.complete);
    EXPECT_FALSE(status.compiling);
    if (vis::currentDriver().software) { // others may have kept it
        EXPECT_GT(compiling, 0);
    }
}

// A variant that does not compile says so once; the picture before it stays, and the next good variant replaces it.
TEST_F(ProgramCacheTest, BrokenVariantKeepsTheFormerPicture) {
    vis::Renderer renderer;
    renderer.setSource(source());
    const vis::ViewTargetPtr target = renderer.makeTarget();
    vis::Scene scene = heavyScene();
    scene.layers.resize(1);
    scene.selection = {};
    test::renderAll(renderer, *target, scene, {32, 32});
    glm::ivec2 size;
    const std::vector<std::uint8_t> former = renderer.readPixels(*target, size);
    std::filesystem::create_directories(scratch() / "shaders/lib/layers");
    std::ofstream(scratch() / "shaders/lib/layers/doi.glsl") << "float broken() { return nothing; }\n";
    setenv("TESSERA_SHADER_DIR", (scratch() / "shaders").c_str(), 1);
    vis::FrameRequest request;
    request.size = {32, 32};
    std::vector<std::string> messages;
    vis::FrameStatus status;
    for (int frame = 0; frame < 20000 && !status.complete; ++frame) {
        status = renderer.render(*target, heavyScene(), request);
        for (std::string& message : renderer.takeMessages()) messages.push_back(std::move(message));
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_TRUE(status.complete);
    ASSERT_FALSE(messages.empty());
    EXPECT_NE(messages[0].find("doi.glsl:1"), std::string::npos) << messages[0];
    EXPECT_EQ(renderer.readPixels(*target, size), former);
    unsetenv("TESSERA_SHADER_DIR");
    scene.camera.distance *= 0.7f;
    test::renderAll(renderer, *target, scene, {32, 32});
    EXPECT_NE(renderer.readPixels(*target, size), former);
}

} // namespace
} // namespace tessera
