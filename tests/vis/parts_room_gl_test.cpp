#include "tests/vis/parts_drawing.h"

/// What parts take of texture memory and of texture units, and that what lies between them casts no shadow.
namespace tessera::vis {
namespace {

/// Bricks of one part alone are stored once, those at the border once for each part.
TEST(PartsRoom, NothingIsStoredOfAPartWhereItIsAbsent) {
    const HeadlessContext context;
    const auto resident = [](const volume::Parts& parts) {
        const auto value = [](glm::dvec3 p) -> std::optional<double> { return p.x < 31.5 ? 1 : 2; };
        const auto region = [](glm::dvec3 p) -> std::optional<double> { return p.x < 31.5 ? 1 : 3; };
        const std::vector<FunctionSource::Channel> channels{{"a", value, {0.8, 2.2}, false, parts},
                                                            {"region", region, {1, 3}, true}};
        const glm::ivec3 size(64, 16, 16);
        Drawn drawn(std::make_shared<FunctionSource>(LatticeKind::CC, size, glm::dvec3(1), channels), true);
        Scene scene = regionScene();
        scene.layers = {{"", true, VolumeLayer{.channel = "a", .shaded = false}}};
        scene.transfer["a"] = fog();
        scene.render.detail = 1e-3f; // full resolution everywhere
        EXPECT_GT(Drawn::greatest(drawn.draw(scene)), 0.2);
        return drawn.renderer.residency().bricksResident;
    };
    const int one = resident({}), two = resident({"region", {{1}, {3}}});
    // 8 x 2 x 2 bricks, the border between the fourth and the fifth: each part has its own four and, for what its
    // samples weigh beyond, the next one; of the coarser levels both have theirs.
    EXPECT_GT(one, 32);
    EXPECT_GE(two, one);
    EXPECT_LE(two, one * 3 / 2);
    EXPECT_EQ(resident({"region", {{1}, {3}, {7}}}), two) << "a part that is nowhere";
}

/// What a program has no texture units for is said, and not mixed.
TEST(PartsRoom, TooManyChannelsShowTheNearestSamplesAndSaySo) {
    const HeadlessContext context;
    const volume::Parts parts{"region", {{0}, {1}, {2}, {3}, {4}, {5}, {6}, {7}}};
    std::vector<FunctionSource::Channel> channels;
    const auto value = [](glm::dvec3 p) -> std::optional<double> { return p.x < 7.3 ? 1 : 2; };
    const auto region = [](glm::dvec3 p) -> std::optional<double> { return p.x < 7.3 ? 1 : 2; };
    for (const char* name : {"a", "b", "c"}) channels.push_back({name, value, {0.8, 2.2}, false, parts});
    channels.push_back({"region", region, {0, 7}, true});
    const auto data = std::make_shared<FunctionSource>(LatticeKind::BCC, glm::ivec3(15), glm::dvec3(1), channels);
    Renderer renderer(optionsFor(true, false));
    renderer.setSource(data);
    Scene scene = regionScene();
    for (const char* name : {"a", "b", "c"}) {
        scene.layers.push_back({"", true, VolumeLayer{.channel = name, .shaded = false}});
        scene.transfer[name] = between();
    }
    scene.layers.push_back({"", true, IsoLayer{.channel = "c", .value = 1.5}});
    const ViewTargetPtr target = renderer.makeTarget();
    const FrameRequest request{.size = kSize, .wait = true};
    EXPECT_TRUE(renderer.render(*target, scene, request).complete);
    for (const glm::vec4& pixel : renderer.readLinear(*target)) EXPECT_EQ(pixel.a, 0);
    const std::vector<std::string> messages = renderer.takeMessages();
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_NE(messages[0].find("too many parameters are drawn at once to separate the parts of c"), std::string::npos)
        << messages[0];
    scene.transfer["c"] = fog();
    EXPECT_TRUE(renderer.render(*target, scene, request).complete);
    EXPECT_TRUE(std::ranges::any_of(renderer.readLinear(*target), [](glm::vec4 p) { return p.a > 0.05f; }))
        << "c is shown all the same";
}

/// A surface at a value that neither part reaches darkens nothing.
TEST(PartsRoom, WhatIsNotThereCastsNoShadow) {
    const HeadlessContext context;
    for (const bool parts : {true, false}) {
        Drawn drawn(regionSource(LatticeKind::BCC, Regions::Sloped, parts));
        Scene scene = regionScene();
        scene.layers = {{"", true, VolumeLayer{.channel = "smooth", .density = 0.5f}}};
        scene.lighting.shadows = {.strength = 0.9f, .occlusion = 0.8f, .resolution = 24};
        const Linear alone = drawn.draw(scene);
        scene.layers.push_back({"", true, IsoLayer{.channel = "heat", .value = 1.5}});
        const Linear both = drawn.draw(scene), wanted = reference::render(scene, *drawn.data, kSize, {});
        double most = 0;
        for (std::size_t i = 0; i < both.pixels.size(); ++i)
            most = std::max(most, glm::length(both.pixels[i] - alone.pixels[i]));
        if (parts)
            EXPECT_LT(most, 1e-6);
        else
            EXPECT_GT(most, 0.05);
        EXPECT_GT(reference::compare(both, wanted, kOutlier).psnr, 70);
    }
}

} // namespace
} // namespace tessera::vis
