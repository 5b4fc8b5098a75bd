#include "volume/flow/streaks.h"

#include "volume/base/parallel.h"
#include "volume/flow/step_cells.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>

namespace tessera::volume {

namespace {

constexpr int kFirstParticles = 64;           ///< before any are inserted
constexpr double kLeastGap = 1.0 / (1 << 24); ///< between marks, of all of them
constexpr double kTornApart = 4;              ///< of `apart`: neighbours that no particle between them joins

/// A particle by its mark; no places: it is not in the field at the end.
struct Marked {
    double mark = 0;
    std::vector<glm::dvec3> places; ///< at each moment
};

using PlacesOf = std::function<std::vector<glm::dvec3>(double mark)>;

/// Cells between the last places of two particles.
double cellsBetween(const Marked& a, const Marked& b, const StepCells& cells) {
    const glm::dvec3 way = b.places.back() - a.places.back();
    return glm::length(way / cells.at((a.places.back() + b.places.back()) * 0.5, glm::dvec3(0)));
}

std::vector<Marked> particlesOf(const std::vector<double>& marks, const PlacesOf& placesOf, const Progress& progress) {
    std::vector<Marked> out(marks.size());
    parallelFor(marks.size(), [&](std::size_t i) {
        if (progress.stop.stop_requested()) throw Cancelled();
        out[i] = {marks[i], placesOf(marks[i])};
    });
    return out;
}

/// Whether a particle is to be inserted behind number `i`.
bool wantsAnother(const std::vector<Marked>& line, std::size_t i, double least, double apart, const StepCells& cells) {
    const Marked &a = line[i], &b = line[i + 1];
    if (b.mark - a.mark <= least || (a.places.empty() && b.places.empty())) return false;
    if (!a.places.empty() && !b.places.empty()) return cellsBetween(a, b, cells) > apart;
    // The end of a piece: by how far its neighbours are apart, until less than a quarter of that is missing.
    const bool first = b.places.empty();
    if (first ? i == 0 || line[i - 1].places.empty() : i + 2 >= line.size() || line[i + 2].places.empty()) return true;
    const Marked &inner = first ? line[i - 1] : line[i + 2], &outer = first ? a : b;
    const double rate = cellsBetween(inner, outer, cells) / std::abs(inner.mark - outer.mark);
    return rate * (b.mark - a.mark) > apart / 4;
}

/// Inserts particles where neighbours are too far apart, and cuts the line into the pieces that are in the field.
std::vector<ParticleLine> piecesOf(double begin, double end, std::size_t moments, const PlacesOf& placesOf,
                                   const StreakSettings& s, const Progress& progress) {
    const StepCells cells{s.path.cell, s.path.lattice ? &*s.path.lattice : nullptr, s.path.longestStep};
    std::vector<double> marks;
    for (int i = 0; i <= kFirstParticles; ++i)
        marks.push_back(i == kFirstParticles ? end : begin + (end - begin) * i / kFirstParticles);
    if (!(end > begin)) marks = {end};
    std::vector<Marked> line = particlesOf(marks, placesOf, progress);
    const double least = (end - begin) * kLeastGap;
    while (int(line.size()) < s.most) {
        marks.clear();
        for (std::size_t i = 0; i + 1 < line.size(); ++i)
            if (wantsAnother(line, i, least, s.apart, cells)) marks.push_back((line[i].mark + line[i + 1].mark) / 2);
        if (marks.empty()) break;
        std::vector<Marked> more = particlesOf(marks, placesOf, progress), all;
        std::merge(std::make_move_iterator(line.begin()), std::make_move_iterator(line.end()),
                   std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()), std::back_inserter(all),
                   [](const Marked& a, const Marked& b) { return a.mark < b.mark; });
        line = std::move(all);
    }
    std::vector<ParticleLine> out;
    const Marked* former = nullptr;
    for (const Marked& one : line) {
        const bool joined = former && !one.places.empty() && cellsBetween(*former, one, cells) <= kTornApart * s.apart;
        former = one.places.empty() ? nullptr : &one;
        if (!former) continue;
        if (!joined) out.push_back({{}, std::vector<std::vector<glm::dvec3>>(moments)});
        out.back().marks.push_back(one.mark);
        for (std::size_t row = 0; row < moments; ++row) out.back().rows[row].push_back(one.places[row]);
    }
    return out;
}

} // namespace

std::vector<ParticleLine> streakline(const ChangingField& field, glm::dvec3 seed, double begin, double now,
                                     const StreakSettings& settings, const Progress& progress) {
    const PlacesOf placesOf = [&](double released) -> std::vector<glm::dvec3> {
        const auto place = carried(field, seed, released, now, settings.path);
        return place ? std::vector{*place} : std::vector<glm::dvec3>{};
    };
    return piecesOf(begin, now, 1, placesOf, settings, progress);
}

std::vector<ParticleLine> timeline(const ChangingField& field, glm::dvec3 from, glm::dvec3 to, double released,
                                   const std::vector<double>& moments, const StreakSettings& settings,
                                   const Progress& progress) {
    const PlacesOf placesOf = [&](double share) {
        std::vector<glm::dvec3> places;
        glm::dvec3 place = from + (to - from) * share;
        double time = released;
        for (const double moment : moments) {
            const auto next = carried(field, place, time, moment, settings.path);
            if (!next) return std::vector<glm::dvec3>{};
            places.push_back(place = *next);
            time = moment;
        }
        return places;
    };
    return piecesOf(0, 1, moments.size(), placesOf, settings, progress);
}

} // namespace tessera::volume
