#include "tests/vis/residency_fixture.h"

namespace tessera::test {
namespace {

using vis::Scene;

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
    EXPECT_NE(said[0].find("texture memory"), std::string::npos);
}

// One time takes room for one; further times make the atlas larger, with what it holds, as far as the budget goes.
TEST_F(ResidencyTest, AnAtlasGrowsWithTheTimesShown) {
    vis::Renderer renderer(bricks());
    renderer.setSource(waves(4));
    const vis::ViewTargetPtr target = renderer.makeTarget();
    Scene scene = volumeScene();
    scene.render.detail = 0;
    std::vector<glm::vec4> first;
    std::vector<vis::ResidencyInfo> infos;
    for (const double time : {0.0, 1.0, 2.0, 0.0}) {
        scene.time = time;
        refine(renderer, *target, scene, {32, 24});
        infos.push_back(renderer.residency());
        if (first.empty()) first = renderer.readLinear(*target);
    }
    EXPECT_LT(infos[0].textureBytes, infos[2].textureBytes);
    EXPECT_GE(infos[2].bricksResident, 3 * infos[0].bricksResident);
    EXPECT_LT(infos[3].bricksUploaded - infos[2].bricksUploaded, infos[0].bricksResident / 4)
        << "what had been shown is still there; only the next time may be fetched ahead";
    // Bricks lie elsewhere in the atlas now: the last bit of a coordinate may differ.
    EXPECT_LT(maxDifference(renderer.readLinear(*target), first), 1e-3);
}

// Texture memory that is taken away: bricks go, coarser ones stay, no hole; given back, the picture is what it was.
TEST_F(ResidencyTest, BudgetMayShrinkAndGrow) {
    vis::Renderer renderer(bricks());
    renderer.setSource(waves());
    const vis::ViewTargetPtr target = renderer.makeTarget();
    Scene scene = volumeScene();
    scene.render.detail = 0;
    scene.render.cullHidden = false; // what is loaded before it is known to be hidden is chance
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
    EXPECT_LT(maxDifference(coarse, first), 0.2);

    scene.render.limits.textureMemory = 1024;
    refine(renderer, *target, scene, {24, 24});
    // Bricks lie elsewhere in the atlas now: the last bit of a coordinate may differ.
    EXPECT_LT(maxDifference(renderer.readLinear(*target), first), 1e-3);
    EXPECT_EQ(renderer.residency().bricksResident, full.bricksResident);
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
            renderAll(renderer, *target, scene, {48, 40});
            EXPECT_LE(renderer.residency().textureBytes, memory * 5 / 4) << "an atlas is rounded up to a box";
            const double difference = maxDifference(renderer.readLinear(*target), wanted);
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

// More views than fit at once: what one of them draws makes no room for the next one within the same frame, and all
// come to rest.
TEST_F(ResidencyTest, ManyViewsComeToRestWithinTheBudget) {
    vis::RendererOptions options = bricks();
    options.textureBudget = std::size_t(1) << 20;
    vis::Renderer renderer(options);
    renderer.setSource(waves());
    struct View {
        vis::ViewTargetPtr target;
        Scene scene;
        bool complete = false;
    };
    std::vector<View> views;
    for (int i = 0; i < 14; ++i) {
        View view{renderer.makeTarget(), volumeScene(), false};
        view.scene.camera.distance = 0.35f;
        vis::orbit(view.scene.camera, {0, 0}, {0.25f * float(i), 0.1f * float(i % 3)});
        views.push_back(std::move(view));
    }
    vis::FrameRequest request;
    request.size = {16, 16};
    bool rest = false;
    for (int frame = 0; frame < 20000 && !rest; ++frame) {
        rest = true;
        for (View& view : views) rest &= renderer.render(*view.target, view.scene, request).complete;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_TRUE(rest);
    EXPECT_LE(renderer.residency().textureBytes, options.textureBudget);
}

// Two views of two channels, memory for one of them: one is shown coarser, none of them takes the other's for ever.
TEST_F(ResidencyTest, RefusedMemoryIsSharedByTwoViews) {
    const auto v = [](glm::dvec3 p) { return 0.5 + 0.4 * std::sin(0.2 * p.x); };
    const auto source = std::make_shared<Watched>(
        std::make_shared<vis::FunctionSource>(volume::LatticeKind::CC, glm::ivec3(40), glm::dvec3(1),
                                              std::vector<vis::FunctionSource::Channel>{{"v", v}, {"w", v}}, 8));
    vis::RendererOptions options;
    options.driverMemory = std::size_t(200) << 10; // a channel takes 44^3 texels of 2 bytes
    vis::Renderer renderer(options);
    renderer.setSource(source);
    Scene scene = volumeScene(), other = scene;
    std::get<vis::VolumeLayer>(other.layers[0].technique).channel = "w";
    other.transfer["w"] = scene.transfer["v"];
    const vis::ViewTargetPtr a = renderer.makeTarget(), b = renderer.makeTarget();
    vis::FrameRequest request;
    request.size = {16, 16};
    bool rest = false;
    for (int frame = 0; frame < 20000 && !rest; ++frame) {
        rest = renderer.render(*a, scene, request).complete;
        rest &= renderer.render(*b, other, request).complete;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_TRUE(rest);
    EXPECT_EQ(renderer.takeMessages().size(), 1u);
}

// The source that is there already is not read again.
TEST_F(ResidencyTest, TheSameSourceStays) {
    const auto source = waves();
    vis::Renderer renderer(bricks());
    renderer.setSource(source);
    const vis::ViewTargetPtr target = renderer.makeTarget();
    refine(renderer, *target, volumeScene(), {24, 24});
    const std::uint64_t revision = std::uint64_t(renderer.residency().bricksUploaded);
    EXPECT_GT(revision, 0u);
    renderer.setSource(source);
    const vis::ViewTargetPtr next = renderer.makeTarget();
    refine(renderer, *next, volumeScene(), {24, 24});
    EXPECT_EQ(std::uint64_t(renderer.residency().bricksUploaded), revision);
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
    renderAll(renderer, *target, scene, {64, 48});
    EXPECT_TRUE(renderer.takeMessages().empty());
}
} // namespace
} // namespace tessera::test
