#pragma once

#include "tests/vis/wavy_data.h"

#include <cmath>
#include <memory>

/// Data of two regions whose values must not be mixed: what the tests of parts share.
namespace tessera::vis {

/// What the regions hold: 1 and 2, or linear functions around these.
enum class Regions { Constant, Sloped };

/// Regions 1 and 3 on either side of a slanted face, and land (0), where the gas is absent, in a corner. Channels:
/// "gas" by parts {1}, {3}; "heat" everywhere, likewise; "three", the land as a
/// third part; "smooth", which is one; "region", the label.
inline std::shared_ptr<FunctionSource> regionSource(volume::LatticeKind kind, Regions regions, bool parts,
                                                    double shift = 0, glm::ivec3 size = {19, 17, 25}) {
    const auto region = [shift](glm::dvec3 p) -> double {
        if (glm::length(p - glm::dvec3(17, 3, 20)) < 7) return 0;
        return p.y + 0.31 * p.x - 0.17 * p.z < 8.7 + shift ? 1 : 3;
    };
    const auto heat = [=](glm::dvec3 p) -> std::optional<double> {
        const bool lower = region(p) < 2;
        if (regions == Regions::Constant) return lower ? 1 : 2;
        return lower ? 0.9 + 0.008 * p.x + 0.004 * p.z + 0.01 * shift : 2.1 - 0.009 * p.y - 0.003 * p.z;
    };
    const auto gas = [=](glm::dvec3 p) -> std::optional<double> {
        if (region(p) == 0) return std::nullopt;
        return heat(p);
    };
    const auto smooth = [](glm::dvec3 p) -> std::optional<double> {
        return 0.5 + 0.4 * std::sin(0.3 * p.x - 0.2 * p.z);
    };
    const auto three = [=](glm::dvec3 p) -> std::optional<double> {
        return region(p) == 0 ? 3 + 0.01 * p.y : *heat(p);
    };
    const volume::Parts own = parts ? volume::Parts{"region", {{1}, {3}}} : volume::Parts{};
    return std::make_shared<FunctionSource>(
        kind, size, glm::dvec3(1),
        std::vector<FunctionSource::Channel>{
            {"gas", gas, {0.8, 2.2}, false, own},
            {"heat", heat, {0.8, 2.2}, false, own},
            {"three", three, {0.8, 3.2}, false, parts ? volume::Parts{"region", {{0}, {1}, {3}}} : own},
            {"smooth", smooth, {0, 1}},
            {"region", region, {0, 3}, true}},
        8, glm::dvec3(0.137, 0.211, 0.173));
}

/// The data at two times, between which the face moves.
class RegionSeries : public volume::BrickSource {
public:
    RegionSeries(volume::LatticeKind kind, Regions regions, bool parts)
        : frames_{regionSource(kind, regions, parts), regionSource(kind, regions, parts, 1.3)} {
        info_ = frames_[0]->info();
        info_.times = {0, 1};
    }
    const volume::DatasetInfo& info() const override { return info_; }
    const volume::BrickGrid& grid() const override { return frames_[0]->grid(); }
    volume::BrickStats stats(const volume::BrickKey& key) const override { return at(key).stats(key); }
    volume::BrickSamples read(const volume::BrickKey& key) const override { return at(key).read(key); }

private:
    const FunctionSource& at(const volume::BrickKey& key) const { return *frames_[std::size_t(key.time)]; }
    std::shared_ptr<FunctionSource> frames_[2];
    volume::DatasetInfo info_;
};

/// Light gets out where the value is between what the regions hold, and nowhere else.
inline TransferFunction between() {
    TransferFunction function;
    function.autoRange = false;
    function.range = {0.5, 2.5};
    function.opacity = {{0, 0}, {0.4f, 0}, {0.41f, 1}, {0.59f, 1}, {0.6f, 0}, {1, 0}}; // 1.3 to 1.7
    return function;
}

inline Scene regionScene(bool perspective = true) {
    Scene scene = bareScene(perspective);
    scene.cursor = {9.3, 7.7, 12.2};
    return scene;
}

} // namespace tessera::vis
