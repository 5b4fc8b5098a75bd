#include "volume/worth/differs.h"
#include "volume/worth/significance.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

/// What is selected against what lies right around it, and the same brush moved elsewhere.
namespace tessera::volume {

namespace {

constexpr std::size_t kMostOfMask = 4000; ///< samples that means are of
constexpr int kMostShifts = 400;

/// Places of a selection and of what is around it, as grid indices.
struct BrushMask {
    std::vector<glm::ivec3> inside, around;
    glm::ivec3 lo, hi;    ///< of both
    glm::ivec3 extent{0}; ///< of the selection
};

/// Every nth, so that at most kMostOfMask are left.
std::vector<glm::ivec3> thinnedPlaces(const std::vector<glm::ivec3>& all) {
    const std::size_t every = all.size() / kMostOfMask + 1;
    std::vector<glm::ivec3> out;
    for (std::size_t i = 0; i < all.size(); i += every) out.push_back(all[i]);
    return out;
}

/// Around: up to a third of the selection's extent away along each axis, at least two samples.
BrushMask brushMaskOf(const WorthSamples& samples) {
    BrushMask mask{{}, {}, samples.size, glm::ivec3(-1)};
    for (std::size_t i = 0; i < samples.inside.size(); ++i)
        if (samples.inside[i] != 0) {
            const glm::ivec3 at = samples.indexOf(i);
            mask.inside.push_back(at);
            for (int axis = 0; axis < 3; ++axis) {
                mask.lo[axis] = std::min(mask.lo[axis], at[axis]);
                mask.hi[axis] = std::max(mask.hi[axis], at[axis]);
            }
        }
    if (!mask.inside.empty()) mask.extent = mask.hi - mask.lo + 1;
    std::vector<std::uint8_t> near = samples.inside;
    for (int axis = 0; axis < 3 && !mask.inside.empty(); ++axis) {
        const int reach = std::max(2, (mask.hi[axis] - mask.lo[axis] + 1) / 3);
        const std::vector<std::uint8_t> before = near;
        for (std::size_t i = 0; i < near.size(); ++i) {
            if (before[i] == 0) continue;
            const int at = samples.indexOf(i)[axis];
            for (int d = -reach; d <= reach; ++d)
                if (at + d >= 0 && at + d < samples.size[axis])
                    near[std::size_t(std::int64_t(i) + d * std::int64_t(samples.step(axis)))] = 1;
        }
        mask.lo[axis] = std::max(0, mask.lo[axis] - reach);
        mask.hi[axis] = std::min(samples.size[axis] - 1, mask.hi[axis] + reach);
    }
    for (std::size_t i = 0; i < near.size(); ++i)
        if (near[i] != 0 && samples.inside[i] == 0) mask.around.push_back(samples.indexOf(i));
    mask.inside = thinnedPlaces(mask.inside);
    mask.around = thinnedPlaces(mask.around);
    return mask;
}

/// The mean where the places are moved; NaN where fewer than half of those present unmoved are there.
double movedMean(const WorthSamples& samples, const std::vector<float>& values, const std::vector<glm::ivec3>& places,
                 glm::ivec3 by, double present, double& count) {
    double sum = 0;
    count = 0;
    for (const glm::ivec3 place : places) {
        const glm::ivec3 at = place + by;
        if (at.x < 0 || at.y < 0 || at.z < 0 || at.x >= samples.size.x || at.y >= samples.size.y ||
            at.z >= samples.size.z)
            continue;
        const float value =
            values[std::size_t(at.x) + std::size_t(at.y) * samples.step(1) + std::size_t(at.z) * samples.step(2)];
        if (std::isnan(value)) continue;
        sum += double(value);
        count += 1;
    }
    return count > 0 && count >= 0.5 * present ? sum / count : std::nan("");
}

/// Moves by which the brush and its surroundings lie elsewhere altogether.
std::vector<glm::ivec3> brushShifts(const WorthSamples& samples, const BrushMask& mask) {
    const glm::ivec3 extent = mask.hi - mask.lo + 1;
    glm::ivec3 stride;
    for (int axis = 0; axis < 3; ++axis) stride[axis] = std::max(1, extent[axis] / 3);
    std::vector<glm::ivec3> shifts;
    const glm::ivec3 reach = samples.size / stride;
    for (int z = -reach.z; z <= reach.z; ++z)
        for (int y = -reach.y; y <= reach.y; ++y)
            for (int x = -reach.x; x <= reach.x; ++x) {
                const glm::ivec3 by = glm::ivec3(x, y, z) * stride;
                bool elsewhere = false;
                for (int axis = 0; axis < 3; ++axis) elsewhere = elsewhere || std::abs(by[axis]) >= extent[axis];
                if (elsewhere) shifts.push_back(by);
            }
    std::vector<glm::ivec3> some;
    const std::size_t every = shifts.size() / kMostShifts + 1;
    for (std::size_t i = 0; i < shifts.size(); i += every) some.push_back(shifts[i]);
    return some;
}

/// How many of these moves lead to places of the brush that do not meet, taken in sequence.
double apartFrom(const std::vector<glm::ivec3>& moves, glm::ivec3 extent) {
    std::vector<glm::ivec3> apart;
    for (const glm::ivec3 by : moves) {
        const bool meets = std::ranges::any_of(apart, [&](const glm::ivec3 other) {
            const glm::ivec3 between = glm::abs(by - other);
            return between.x < extent.x && between.y < extent.y && between.z < extent.z;
        });
        if (!meets) apart.push_back(by);
    }
    return double(apart.size());
}

} // namespace

Findings findAround(const WorthSamples& samples, std::span<const int> without) {
    constexpr double kFewestElsewhere = 4; // places elsewhere that do not meet
    Findings out;
    if (samples.inside.empty()) return out;
    const BrushMask mask = brushMaskOf(samples);
    if (mask.inside.size() < 4 || mask.around.size() < 4) return out;
    const std::vector<glm::ivec3> shifts = brushShifts(samples, mask);
    for (std::size_t c = 0; c < samples.values.size(); ++c) {
        if (std::ranges::find(without, samples.channels[c]) != without.end()) continue;
        const std::vector<float>& values = samples.values[c];
        double inside = 0, around = 0, n = 0;
        const double in = movedMean(samples, values, mask.inside, {}, 4, inside);
        const double beside = movedMean(samples, values, mask.around, {}, 4, around);
        if (std::isnan(in) || std::isnan(beside)) continue;
        std::vector<double> elsewhere;
        std::vector<glm::ivec3> moves;
        for (const glm::ivec3 by : shifts) {
            const double there = movedMean(samples, values, mask.inside, by, inside, n);
            const double there2 = movedMean(samples, values, mask.around, by, around, n);
            if (std::isnan(there) || std::isnan(there2)) continue;
            elsewhere.push_back(there - there2);
            moves.push_back(by);
        }
        const double apart = apartFrom(moves, mask.extent);
        if (apart < kFewestElsewhere) continue;
        std::ranges::sort(elsewhere);
        const auto at = [&](double share) { return elsewhere[std::size_t(share * double(elsewhere.size() - 1))]; };
        // By quartiles: other events, elsewhere, do not hide this one.
        const double usual = at(0.5), deviation = (at(0.75) - at(0.25)) / 1.349;
        const double away = in - beside - usual, rounding = 1e-6 * std::max(std::abs(in), std::abs(beside));
        if (std::abs(away) <= rounding) continue;
        Finding one{.kind = FindingKind::Around, .x = samples.channels[c], .number = in, .other = beside};
        one.samples = double(mask.inside.size()), one.effective = apart;
        one.p = deviation > 0 ? studentTails(away / (deviation * std::sqrt(1 + 1.6 / apart)), apart - 1) : 0;
        const double deviations = deviation > 0 ? std::abs(away) / deviation : 1e3;
        one.strength = deviations / (3 + deviations);
        out.add(one);
    }
    return out;
}

} // namespace tessera::volume
