#include "tests/vis/renderer_scenes.h"

#include "vis/gl/draw_timer.h"
#include "vis/gl/driver.h"
#include "vis/gl/program.h"
#include "vis/raycast/ray_plan.h"

#include <set>
#include <thread>

namespace tessera {
namespace {

/// A driver that is taken to be a GPU's: nobody waits for it, and it has timer queries.
vis::Driver gpu() {
    vis::Driver driver;
    driver.timerQueries = true;
    driver.fragmentSamplers = 32;
    return driver;
}

class DriverTest : public test::GlTest {};

TEST_F(DriverTest, SaysWhatTheContextOffers) {
    const vis::Driver driver = vis::currentDriver();
    EXPECT_FALSE(driver.renderer.empty());
    EXPECT_GE(driver.fragmentSamplers, 16);
    EXPECT_GE(driver.texture3DEdge, 2048);
    EXPECT_EQ(driver.software, driver.compilesAtFirstDraw);
    EXPECT_NE(driver.software, driver.timerQueries) << "one of the two tells how long a picture takes";
}

TEST(DriverNames, TellSoftwareFromHardware) {
    for (const char* name : {"llvmpipe (LLVM 15.0.6, 256 bits)", "softpipe", "zink Vulkan 1.3(llvmpipe (LLVM 15.0.6))",
                             "ANGLE (Google, Vulkan 1.3.0 (SwiftShader Device), SwiftShader driver)"})
        EXPECT_TRUE(vis::isSoftware(name)) << name;
    for (const char* name : {"NVIDIA GeForce RTX 3080/PCIe/SSE2", "Mesa Intel(R) UHD Graphics 620 (KBL GT2)",
                             "AMD Radeon RX 6700 XT (radeonsi, navi22)", ""})
        EXPECT_FALSE(vis::isSoftware(name)) << name;
}

TEST_F(DriverTest, TimesComeBackInTheirOrderWithoutWaiting) {
    const vis::Texture texture = vis::makeTexture2D({512, 512}, GL_RGBA8, GL_NEAREST, "timed");
    for (const bool queries : {false, true}) {
        vis::DrawTimer timer(queries);
        std::vector<int> came;
        for (int i = 0; i < 3; ++i)
            timer.measure(
                [&] {
                    const float color[] = {0, 1, 0, 1};
                    glClearTexImage(texture.name(), 0, GL_RGBA, GL_FLOAT, color);
                },
                [&came, i](double milliseconds) {
                    EXPECT_GE(milliseconds, 0);
                    came.push_back(i);
                });
        EXPECT_EQ(timer.pending(), queries ? 3u : 0u);
        timer.collect(true);
        EXPECT_EQ(came, (std::vector<int>{0, 1, 2}));
        EXPECT_EQ(timer.pending(), 0u);
    }
}

// Frame by frame, with a driver that is not waited for, the picture becomes the one that is waited for. The ray caster
// then interpolates by itself.
TEST_F(DriverTest, PicturesAreTheSameWhereTheDriverIsNotWaitedFor) {
    const auto data = test::brickedSource(volume::LatticeKind::BCC);
    vis::Scene scene = test::richScene();
    scene.render.samples = 2;
    const glm::ivec2 size(150, 140);
    vis::RendererOptions options = test::exact();
    const std::vector<glm::vec4> before = test::picture(data, options, scene, size);
    options.driver = gpu();
    const std::vector<glm::vec4> wanted = test::picture(data, options, scene, size);
    if (vis::currentDriver().exactFilter) {
        EXPECT_LT(test::maxDifference(wanted, before), 1e-4);
    }

    vis::Renderer renderer(options);
    renderer.setSource(data);
    const vis::ViewTargetPtr target = renderer.makeTarget();
    vis::FrameStatus status;
    int calls = 0;
    for (; calls < 20000 && !status.complete; ++calls) {
        status = renderer.render(*target, scene, {.size = size, .budgetMs = 5});
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_TRUE(status.complete);
    EXPECT_GT(calls, 4) << "no more is given to the driver than fits into the budget";
    EXPECT_GT(status.milliseconds, 0);
    EXPECT_EQ(test::maxDifference(renderer.readLinear(*target), wanted), 0);
    EXPECT_TRUE(renderer.takeMessages().empty());
}

/// Sampler uniforms of a program that the driver did not drop.
int samplersOf(const vis::Program& program) {
    static const std::set<GLenum> kSamplers{GL_SAMPLER_2D,
                                            GL_SAMPLER_3D,
                                            GL_SAMPLER_CUBE,
                                            GL_SAMPLER_1D_ARRAY,
                                            GL_SAMPLER_2D_ARRAY,
                                            GL_INT_SAMPLER_3D,
                                            GL_UNSIGNED_INT_SAMPLER_2D,
                                            GL_UNSIGNED_INT_SAMPLER_3D};
    GLint count = 0;
    int samplers = 0;
    glGetProgramiv(program.name(), GL_ACTIVE_UNIFORMS, &count);
    for (GLint i = 0; i < count; ++i) {
        char name[128];
        GLsizei length = 0;
        GLint size = 0;
        GLenum type = 0;
        glGetActiveUniform(program.name(), GLuint(i), sizeof name, &length, &size, &type, name);
        if (kSamplers.contains(type)) samplers += size;
    }
    return samplers;
}

/// More channels than the 16 samplers that GL guarantees, and everything else that a scene looks up.
TEST_F(DriverTest, ProgramsDoWithTheSamplersThatGlGuarantees) {
    constexpr int kGuaranteed = 16;
    std::vector<vis::FunctionSource::Channel> channels;
    vis::Scene scene;
    for (int i = 0; i < 20; ++i) {
        const std::string name = "c" + std::to_string(i);
        channels.push_back({name, [i](glm::dvec3 p) { return p.x + i; }});
        scene.layers.push_back({name, true, vis::VolumeLayer{.channel = name}});
    }
    const vis::FunctionSource data(volume::LatticeKind::CC, glm::ivec3(9), glm::dvec3(1), channels);
    std::vector<vis::Scene> scenes(3, scene);
    scenes[1].lighting.environment.kind = vis::Environment::Sky;
    scenes[1].lighting.shadows.strength = scenes[1].lighting.shadows.translucency = 0.5f;
    scenes[1].selection.brushes = {{.region = vis::LassoRegion{"c0", "c1", {{0, 0}, {1, 0}, {0, 1}}, 0}}};
    scenes[2] = scenes[1];
    scenes[2].transfer["c0"].kind = vis::TransferKind::Regions;
    scenes[2].transfer["c0"].regions = {{.shape = vis::RegionShape::Triangle, .opacity = 0.3f}};
    std::get<vis::VolumeLayer>(scenes[2].layers[1].technique).look.charcoal.emplace();
    for (const bool bricked : {false, true})
        for (const vis::Scene& each : scenes) {
            const int most = vis::mostFields(kGuaranteed, each, bricked);
            EXPECT_GE(most, 3);
            vis::RayPlan plan = vis::planRays(each, data.info(), most);
            EXPECT_LE(int(plan.fields.size()), most);
            EXPECT_GT(plan.layers.size(), 2u) << "what there is room for is drawn";
            EXPECT_NE(plan.limit.find("c19"), std::string::npos) << plan.limit;
            for (vis::BoundField& field : plan.fields) field.atlas = bricked;
            const vis::Program program = vis::makeProgram(vis::rayRecipe(plan, each, data.grid(), true));
            EXPECT_LE(samplersOf(program), kGuaranteed) << "a sampler that mostFields() does not know of";
            EXPECT_GT(samplersOf(program), most) << "fields are sampled";
        }
}

} // namespace
} // namespace tessera
