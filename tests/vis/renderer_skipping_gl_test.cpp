#include "tests/vis/renderer_scenes.h"

#include "tests/reference/raycast.h"

#include <cmath>

namespace tessera {
namespace {

using test::brickedSource, test::CheckedSource, test::exact, test::flatScene, test::picture, test::richScene;
using vis::Scene;

class RendererSkipping : public test::GlTest {};

// Leaping over empty blocks changes nothing: a sparse volume, against the reference that visits every sample.
TEST_F(RendererSkipping, EmptySpaceIsSkippedExactly) {
    for (const volume::LatticeKind kind : {volume::LatticeKind::CC, volume::LatticeKind::BCC}) {
        const auto shells = [](glm::dvec3 p) -> std::optional<double> {
            if (p.z > 40) return std::nullopt;
            const double r = glm::length(p - glm::dvec3(20, 22, 26));
            return r < 15 ? 1 / (1 + 0.05 * (r - 9) * (r - 9)) : 0.2 / (1 + 0.3 * (r - 15));
        };
        const auto source = std::make_shared<vis::FunctionSource>(
            kind, glm::ivec3(61, 47, 53), glm::dvec3(1), std::vector<vis::FunctionSource::Channel>{{"v", shells}}, 16);
        Scene scene = flatScene(0);
        scene.camera = {};
        scene.camera.distance = 1.7f;
        scene.transfer["v"].opacity = {{0, 0}, {0.85f, 0}, {0.95f, 0.5f}, {1, 0.8f}};
        for (const bool shaded : {false, true}) {
            std::get<vis::VolumeLayer>(scene.layers[0].technique).shaded = shaded;
            if (shaded) {
                scene.layers.push_back({"iso", true, vis::IsoLayer{.channel = "v", .value = 0.7, .opacity = 0.5f}});
                scene.layers.push_back(
                    {"slice", true,
                     vis::SliceLayer{.channel = "v", .atCursor = false, .position = 0.6, .opacity = 0.5f}});
            }
            const glm::ivec2 size(56, 44);
            vis::reference::Image drawn{size, {}};
            for (const glm::vec4& pixel : picture(source, exact(), scene, size)) drawn.pixels.emplace_back(pixel);
            const vis::reference::Difference difference =
                vis::reference::compare(drawn, vis::reference::render(scene, *source, size), 2e-3);
            EXPECT_LT(difference.rmseWithin, 2e-5);
            EXPECT_LE(difference.beyond, 8u) << difference.worst.x << ", " << difference.worst.y;
        }
    }
}

// Where a brush leaves nothing and the rest is hidden, blocks are leapt over, and nothing changes.
TEST_F(RendererSkipping, WhatBrushesHideIsSkippedExactly) {
    const auto ramp = [](glm::dvec3 p) -> std::optional<double> { return p.x / 60; };
    const auto waves = [](glm::dvec3 p) -> std::optional<double> {
        if (p.y > 40) return std::nullopt;
        return 0.5 + 0.5 * std::sin(0.1 * p.x) * std::sin(0.08 * p.z);
    };
    for (const volume::LatticeKind kind : {volume::LatticeKind::CC, volume::LatticeKind::BCC}) {
        const auto source = std::make_shared<vis::FunctionSource>(
            kind, glm::ivec3(61, 47, 53), glm::dvec3(1),
            std::vector<vis::FunctionSource::Channel>{{"v", ramp}, {"w", waves}}, 16);
        Scene scene = flatScene(0);
        scene.camera = {};
        scene.camera.distance = 1.7f;
        scene.transfer["v"].opacity = {{0, 0.2f}, {1, 0.2f}};
        scene.selection.contextOpacity = 0;
        scene.selection.brushes = {vis::rangeBrush({{"w", 0.94, 1, 0.02}}), vis::rangeBrush({{"v", 0.25, 0.75, 0.02}})};
        for (const bool outside : {false, true}) {
            scene.selection.brushes[1].inverted = outside;
            const glm::ivec2 size(56, 44);
            vis::reference::Image drawn{size, {}};
            double seen = 0;
            for (const glm::vec4& pixel : picture(source, exact(), scene, size)) {
                drawn.pixels.emplace_back(pixel);
                seen += double(pixel.a);
            }
            EXPECT_GT(seen, 10);
            const vis::reference::Difference difference =
                vis::reference::compare(drawn, vis::reference::render(scene, *source, size), 2e-3);
            EXPECT_LT(difference.rmseWithin, 2e-5);
            EXPECT_LE(difference.beyond, 8u) << difference.worst.x << ", " << difference.worst.y;
            vis::RendererOptions counting = exact();
            counting.countSamples = true;
            const auto samples = [&](const Scene& counted) {
                double sum = 0;
                for (const glm::vec4& pixel : picture(source, counting, counted, size)) sum += double(pixel.r);
                return sum;
            };
            Scene all = scene;
            all.selection.contextOpacity = 0.001f;
            EXPECT_LT(samples(scene), 0.9 * samples(all)) << "it leaps";
        }
    }
}

} // namespace
} // namespace tessera
