#include "volume/flow/paths.h"

#include "volume/base/parallel.h"
#include "volume/flow/step_cells.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tessera::volume {

namespace {

constexpr double kMostOfTime = 1.0 / 16;    ///< of the whole time: the longest step of a particle at rest
constexpr double kLeastOfTime = 1.0 / 4096; ///< of the whole time: how near to the end of the field one at rest comes

struct Particle {
    glm::dvec3 place;
    double time;
};

/// The next of rising times beyond `time` on the way to `last`.
double nextStop(const std::vector<double>& times, double time, double last) {
    if (last > time) {
        const auto next = std::upper_bound(times.begin(), times.end(), time);
        return next == times.end() ? last : std::min(*next, last);
    }
    const auto next = std::lower_bound(times.begin(), times.end(), time);
    return next == times.begin() ? last : std::max(*(next - 1), last);
}

/// Moves a particle until time `last`, or to where the field ends; keeps its way, but for the first place, in `way`.
Particle travel(const ChangingField& field, Particle at, double last, const PathSettings& s, Pathline* way) {
    const StepCells cells{s.cell, s.lattice ? &*s.lattice : nullptr, s.longestStep};
    const double sign = last < at.time ? -1 : 1, whole = std::abs(last - at.time);
    const std::optional<glm::dvec3> first = field(at.place, at.time);
    if (!first) return at;
    glm::dvec3 slope = *first;
    double length = 0, wanted = -1;
    for (int steps = 0; at.time != last && length < s.longest * (1 - 1e-9);) {
        if (steps == s.mostSteps) {
            if (s.stopped) ++*s.stopped;
            break;
        }
        const glm::dvec3 cell = cells.at(at.place, sign * slope);
        const double speed = glm::length(slope / cell), stop = nextStop(s.times, at.time, last);
        double h = std::min(std::abs(stop - at.time), whole * kMostOfTime);
        if (wanted < 0 && speed > 0) wanted = 0.25 / speed;
        if (wanted > 0) h = std::min(h, wanted);
        if (speed > 0)
            h = std::min({h, s.longestStep / speed, cells.most(at.place, sign * slope),
                          (s.longest - length) / glm::length(slope)});
        if (!(h > 0) || !std::isfinite(h)) break;
        const double next = h == std::abs(stop - at.time) ? stop : at.time + sign * h;
        if (next == at.time) break;
        const FlowStep step = flowStep(field, at.place, at.time, slope, next - at.time, cell);
        const bool least = step.reach <= kShortestStep && (!std::isfinite(whole) || h <= whole * kLeastOfTime);
        if (!step.present) {
            if (least) break;
            wanted = h / 2;
            continue;
        }
        const bool far = glm::length((step.end - at.place) / cell) > 1.5 * s.longestStep; // it began slowly
        if ((step.error > s.tolerance || far) && !(step.reach <= kShortestStep / 16)) {
            wanted = step.error > s.tolerance ? h * std::min(stepFactor(s.tolerance, step.error), 0.9) : h / 2;
            continue;
        }
        wanted = h < wanted ? std::max(wanted, h * stepFactor(s.tolerance, step.error))
                            : h * stepFactor(s.tolerance, step.error);
        length += glm::distance(step.end, at.place);
        at = {step.end, next};
        slope = step.slope;
        ++steps;
        if (!way) continue;
        way->places.push_back(at.place);
        way->times.push_back(at.time);
    }
    return at;
}

} // namespace

Pathline pathline(const ChangingField& field, glm::dvec3 seed, double time, double begin, double end,
                  const PathSettings& settings) {
    if (!field(seed, time)) return {};
    Pathline line;
    if (begin < time) travel(field, {seed, time}, begin, settings, &line);
    std::reverse(line.places.begin(), line.places.end());
    std::reverse(line.times.begin(), line.times.end());
    line.places.push_back(seed);
    line.times.push_back(time);
    if (end > time) travel(field, {seed, time}, end, settings, &line);
    return line;
}

std::vector<Pathline> pathlines(const ChangingField& field, std::span<const glm::dvec3> seeds, double time,
                                double begin, double end, const PathSettings& settings, const Progress& progress) {
    std::vector<Pathline> out(seeds.size());
    parallelFor(seeds.size(), [&](std::size_t i) {
        if (progress.stop.stop_requested()) throw Cancelled();
        out[i] = pathline(field, seeds[i], time, begin, end, settings);
    });
    progress.advance(1);
    return out;
}

std::optional<glm::dvec3> carried(const ChangingField& field, glm::dvec3 place, double from, double to,
                                  const PathSettings& settings) {
    if (!field(place, from)) return std::nullopt;
    const Particle end = travel(field, {place, from}, to, settings, nullptr);
    return end.time == to ? std::optional(end.place) : std::nullopt;
}

} // namespace tessera::volume
