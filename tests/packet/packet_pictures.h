#pragma once

#include "tests/reference/raycast.h"
#include "tests/vis/wavy_data.h"
#include "vis/packet/packet_refusal.h"
#include "vis/packet/packet_renderer.h"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <span>

/// Pictures of the packet ray caster against the double-precision reference, for the tests of each kind of picture.
namespace tessera::vis::packet {

using volume::LatticeKind;

constexpr glm::ivec2 kSize{53, 41}; // odd: the last packets of a row are not full
constexpr double kPsnr = 70;        ///< dB for a peak of 1
/// Pixels where a yes or no (present or absent, crossed or grazed, one sample more or less) falls the other way,
/// because samples have 15 bits.
constexpr std::size_t kOutliers = 4;
constexpr double kOutlier = 0.01;

/// Scalars, of which some are absent outside a ball and in a slab if `masked`: not "whole" and "even", which is 4
/// everywhere. "label" and "region" have names, "parted" jumps between two parts.
inline std::shared_ptr<FunctionSource> source(LatticeKind kind, bool masked) {
    const WavyPresence present{masked};
    const auto whole = [](glm::dvec3 p) -> std::optional<double> { return 0.04 * p.x + 0.05 * p.y + 0.01 * p.z; };
    const auto label = [present](glm::dvec3 p) -> std::optional<double> {
        if (!present({p.x, p.y, p.z - 2})) return std::nullopt;
        return std::floor(p.x / 4.1) + std::floor(p.z / 17);
    };
    const auto region = [](glm::dvec3 p) -> std::optional<double> {
        return p.x + 0.4 * p.z < 11 ? 0 : p.y < 9 ? 1 : 2;
    };
    const auto parted = [=](glm::dvec3 p) -> std::optional<double> {
        if (!present({p.x - 1, p.y, p.z})) return std::nullopt;
        return *region(p) == 0 ? 5 + 0.15 * p.y : 1 + 0.12 * p.z + 0.4 * std::sin(0.5 * p.y);
    };
    const auto even = [](glm::dvec3) -> std::optional<double> { return 4; };
    return wavySource(kind, {wavyA(masked),
                             wavyB(masked),
                             {"whole", whole, {0, 1.8}},
                             {"even", even, {4, 4}},
                             {"label", label, {0, 5}, true},
                             {"parted", parted, {0, 8}, false, {"region", {{0}, {1, 2}}}},
                             {"region", region, {0, 2}, true}});
}

inline Layer layerOf(Technique technique) {
    return {"", true, std::move(technique)};
}

struct Mode {
    const char* name;
    std::function<void(Scene&)> apply;
};

inline reference::Image asImage(const PacketPicture& picture) {
    reference::Image image;
    image.size = picture.size;
    for (int y = picture.size.y - 1; y >= 0; --y)
        for (int x = 0; x < picture.size.x; ++x) {
            const float* pixel = &picture.rgba[std::size_t(y * picture.size.x + x) * 4];
            image.pixels.emplace_back(pixel[0], pixel[1], pixel[2], pixel[3]);
        }
    return image;
}

struct Case {
    LatticeKind kind;
    bool masked;
};
inline std::string nameOf(const testing::TestParamInfo<Case>& each) {
    return std::string(volume::kLatticeNames[std::size_t(each.param.kind)]) +
           (each.param.masked ? "_masked" : "_whole");
}
inline std::vector<Case> cases() {
    std::vector<Case> out;
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC})
        for (const bool masked : {false, true}) out.push_back({kind, masked});
    return out;
}

/// A renderer for each instruction set of this machine. A test draws by all of them, because the picture that they are
/// compared with takes far longer to compute than theirs.
inline std::vector<PacketRenderer> everyRenderer(const std::shared_ptr<const volume::BrickSource>& data) {
    std::vector<PacketRenderer> out;
    for (const InstructionSet with : instructionSets()) {
        out.emplace_back(with);
        out.back().setSource(data);
    }
    return out;
}

inline void expectAlike(const PacketRenderer& renderer, const PacketPicture& picture, const reference::Image& wanted,
                        std::size_t outliers, const std::string& what) {
    const reference::Difference apart = reference::compare(asImage(picture), wanted, kOutlier);
    EXPECT_TRUE(apart.beyond <= outliers && apart.rmseWithin <= std::pow(10, -kPsnr / 20))
        << what << " by " << kInstructionSetNames[std::size_t(renderer.instructions())] << ": " << apart.beyond
        << " outliers, RMSE of the others " << apart.rmseWithin << ", maximum " << apart.maximum << " at "
        << apart.worst.x << "," << apart.worst.y;
}

/// The pictures of all modes, parallel and perspective, by every instruction set.
inline void expectAgreement(const std::shared_ptr<const volume::BrickSource>& data, std::span<const Mode> modes,
                            const std::shared_ptr<const CubeMap>& surroundings = {}) {
    std::vector<PacketRenderer> renderers = everyRenderer(data);
    ASSERT_EQ(renderers.size(), instructionSets().size());
    for (const Mode& mode : modes)
        for (const bool perspective : {false, true}) {
            const std::string what = std::string(mode.name) + (perspective ? " perspective" : " parallel");
            Scene scene = wavyScene(perspective);
            mode.apply(scene);
            ASSERT_EQ(packetRefusal(scene, data->info(), data->grid().lattice), "") << what;
            const reference::Image wanted =
                reference::render(scene, *data, kSize, {.flaws = {}, .surroundings = surroundings});
            double most = 0;
            for (const glm::dvec4& pixel : wanted.pixels) most = std::max(most, pixel.a);
            EXPECT_GT(most, 0.2) << what << " shows next to nothing";
            for (PacketRenderer& renderer : renderers)
                expectAlike(renderer, renderer.render(scene, kSize, surroundings.get()), wanted, kOutliers, what);
        }
}
inline void expectAgreement(const Case& param, std::span<const Mode> modes) {
    expectAgreement(source(param.kind, param.masked), modes);
}

} // namespace tessera::vis::packet
