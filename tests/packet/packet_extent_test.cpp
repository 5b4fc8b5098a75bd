#include "tests/packet/packet_pictures.h"

/// Data of unusual extents, and bounds that are not those of their samples: no position outside of the samples is read.
/// With the sanitizers these tests see every one.
namespace tessera::vis::packet {
namespace {

std::shared_ptr<FunctionSource> extended(LatticeKind kind, glm::ivec3 size, glm::dvec3 inset,
                                         glm::dvec3 spacing = glm::dvec3(1)) {
    const auto wave = [scale = 6.0 / double(size.x + size.y + size.z)](glm::dvec3 p) -> std::optional<double> {
        return 0.5 + 0.4 * std::sin(scale * (p.x + p.y + p.z));
    };
    const auto label = [](glm::dvec3 p) -> std::optional<double> { return p.x < 3 ? 0 : 1; };
    return std::make_shared<FunctionSource>(
        kind, size, spacing, std::vector<FunctionSource::Channel>{{"a", wave, {0, 1}}, {"label", label, {0, 1}, true}},
        8, inset);
}

const Mode kTechniques[] = {
    {"volume", [](Scene& s) { s.layers = {layerOf(VolumeLayer{.channel = "a"})}; }},
    {"maximum", [](Scene& s) { s.layers = {layerOf(VolumeLayer{.channel = "a", .style = RayStyle::Maximum})}; }},
    {"surface", [](Scene& s) { s.layers = {layerOf(IsoLayer{.channel = "a", .value = 0.5})}; }},
    {"slice", [](Scene& s) { s.layers = {layerOf(SliceLayer{.channel = "a", .atCursor = false, .position = 1})}; }},
    {"labels", [](Scene& s) { s.layers = {layerOf(VolumeLayer{.channel = "label"})}; }},
    {"wide gradients", [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "a"})};
         s.render.gradient = volume::GradientSpan::Wide;
     }}};

void expectNumbers(const std::shared_ptr<const volume::BrickSource>& data, const std::string& which) {
    std::vector<PacketRenderer> renderers = everyRenderer(data);
    for (const Mode& mode : kTechniques)
        for (const bool perspective : {false, true})
            for (const float distance : {0.1f, 500.0f}) {
                Scene scene = wavyScene(perspective);
                scene.camera.distance = distance;
                scene.render.stepVoxels = 4;
                mode.apply(scene);
                for (PacketRenderer& renderer : renderers)
                    for (const float part : renderer.render(scene, {13, 9}).rgba)
                        ASSERT_TRUE(part >= 0 && part < 1.001f) << which << ", " << mode.name << ": " << part;
            }
}

TEST(PacketExtent, BoundsFarFromTheSamplesReadNothingElse) {
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC})
        for (const double inset : {-2e5, -300.0, -1.0, 2.0, 4e4}) {
            const auto data = extended(kind, {9, 8, 11}, glm::dvec3(inset, inset / 7, inset * 3));
            expectNumbers(data, "inset " + std::to_string(inset));
        }
}

TEST(PacketExtent, ThinAndLongDataAreDrawn) {
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC}) {
        expectNumbers(extended(kind, {20000, 1, 1}, {}), "a line");
        expectNumbers(extended(kind, {1, 3, 20000}, {}), "a ribbon");
        expectNumbers(extended(kind, {30, 20, 1}, {}, {1, 1, 1e-7}), "a sheet");
        expectNumbers(extended(kind, {5, 5, 5}, {}, {1, 1e-6, 1}), "a foil");
    }
}

TEST(PacketExtent, WhatPositionsCannotReachIsRefused) {
    Scene scene = wavyScene(false);
    kTechniques[0].apply(scene);
    const auto refusal = [&](glm::ivec3 size) {
        const auto data = extended(LatticeKind::CC, size, {});
        return packetRefusal(scene, data->info(), data->grid().lattice);
    };
    EXPECT_EQ(refusal({32000, 2, 2}), "");
    EXPECT_EQ(refusal({33000, 2, 2}), "so long data");
    EXPECT_EQ(refusal({2, 60000, 16}), "so long data");
    EXPECT_EQ(refusal({1200, 1200, 1000}), "");
    EXPECT_EQ(refusal({1400, 1400, 1000}), "so long data");
}

} // namespace
} // namespace tessera::vis::packet
