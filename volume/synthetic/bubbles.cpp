#include "volume/synthetic/bubbles.h"

#include "volume/base/parallel.h"
#include "volume/synthetic/settings.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

namespace tessera::volume {

namespace bubbles {

std::vector<Ball> at(double t) {
    constexpr double kMerging = 6e-3, kSplitting = 5e-3, kLeaving = 5e-3, kRise = 0.03;
    std::vector<Ball> balls;
    for (const double side : {-1.0, 1.0}) {
        const double apart = kMerging + (kMerge - t) * 6e-3; // half the distance: the radius at the meeting
        balls.push_back({{0.02 + side * apart, 0.026, 0.04 + 0.02 * t}, kMerging});
    }
    for (const double side : {-1.0, 1.0})
        balls.push_back({{0.02, 0.02 + side * kSplitting * t / kSplit, 0.016 + 0.01 * t}, kSplitting});
    if (t < kLeave) balls.push_back({{0.008, 0.008, kColumn.z + kLeaving - kRise * (kLeave - t)}, kLeaving});
    if (t > kBirth && t < kDeath)
        balls.push_back({{0.033, 0.009, 0.03}, 6e-3 * std::sin(std::numbers::pi * (t - kBirth) / (kDeath - kBirth))});
    return balls;
}

double depth(const std::vector<Ball>& balls, glm::dvec3 place) {
    double deepest = -std::numeric_limits<double>::infinity();
    for (const Ball& ball : balls) deepest = std::max(deepest, ball.radius - glm::distance(place, ball.centre));
    return deepest;
}

} // namespace bubbles

Dataset makeBubbles(const std::map<std::string, double>& given) {
    const auto settings = settingsFrom<BubblesSettings>(given, "bubbles");
    Dataset dataset;
    DatasetInfo& info = dataset.info;
    info.name = "bubbles";
    info.lattice.size = {settings.nx, settings.ny, settings.nz};
    info.lattice.spacing = bubbles::kColumn / glm::dvec3(info.lattice.size - 1);
    info.bounds = {glm::dvec3(0), bubbles::kColumn};
    Parameter gas, temperature;
    gas.name = "gas";
    gas.ranges = {{0, 1}};
    temperature.name = "T";
    temperature.unit = "K";
    temperature.ranges = {{340, 365}};
    info.parameters = {gas, temperature};
    info.times.clear();
    for (int t = 0; t < settings.times; ++t)
        info.times.push_back(bubbles::kDuration * t / std::max(1, settings.times - 1));
    info.provenance = "computed bubbles";
    dataset.read = [lattice = info.lattice, times = info.times](int parameter, int, int time) {
        Field field = makeField(lattice, ScalarType::F32);
        const auto samples = field.as<float>();
        const std::vector<bubbles::Ball> balls = bubbles::at(times[std::size_t(time)]);
        parallelFor(std::size_t(lattice.size.z), [&](std::size_t k) {
            std::size_t to = lattice.index({0, 0, int(k)});
            for (int j = 0; j < lattice.size.y; ++j)
                for (int i = 0; i < lattice.size.x; ++i, ++to) {
                    const glm::dvec3 place = lattice.position({i, j, int(k)});
                    const double share = std::clamp(0.5 + bubbles::depth(balls, place) / bubbles::kBorder, 0.0, 1.0);
                    samples[to] = float(parameter == 0 ? share : 360 - 20 * place.z / bubbles::kColumn.z + 5 * share);
                }
        });
        return field;
    };
    return dataset;
}

} // namespace tessera::volume
