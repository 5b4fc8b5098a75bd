#include "vis/shapes/flow_data.h"
#include "vis/shapes/flow_geometry.h"
#include "vis/shapes/line_gatherer.h"
#include "volume/base/parallel.h"
#include "volume/flow/paths.h"
#include "volume/flow/streaks.h"
#include "volume/mesh/surface_mesh.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

/// Geometry of what is made of particles: paths, streaklines, timelines, moving particles with tails.
namespace tessera::vis {

namespace {

constexpr int kBandRows = 4;        ///< of a band, behind its first edge
constexpr double kLifeShare = 0.25; ///< of the time to cross the data: that moving particles live unless it is stated
constexpr double kEver = 1e300;

/// What all these kinds are computed with.
struct ParticleWork {
    const volume::BrickSource& source;
    const FlowLayer& layer;
    const FlowData& data;
    double moment;
    glm::dvec3 stretch;
    volume::ChangingField velocity;
    volume::PathSettings path;

    const volume::DatasetInfo& info() const { return source.info(); }
    bool steady() const { return info().times.size() == 1; }
    double first() const { return steady() ? -kEver : info().times.front(); }
    double last() const { return steady() ? kEver : info().times.back(); }
    double radius() const {
        const glm::dvec3 drawn = info().bounds.size() * stretch;
        return double(layer.radius) * std::max({drawn.x, drawn.y, drawn.z});
    }
    /// FlowLayer::span where it is stated; else the time in which the fastest of those that begin at these places
    /// cross the longest edge of the data. 0 where nothing moves.
    double span(std::span<const glm::dvec3> begins) const {
        if (layer.span > 0) return layer.span;
        double fastest = 0;
        for (const glm::dvec3& place : begins)
            if (const auto vector = velocity(place, moment)) fastest = std::max(fastest, glm::length(*vector));
        if (!(fastest > 0)) fastest = data.fastest * data.perTime;
        const glm::dvec3 size = info().bounds.size();
        return fastest > 0 ? std::max({size.x, size.y, size.z}) / fastest : 0;
    }
};

/// Paths through all times of particles that are at the seeds now.
std::shared_ptr<Geometry> pathsOf(const ParticleWork& work, std::span<const glm::dvec3> seeds,
                                  const Progress& progress) {
    const glm::dvec3 size = work.info().bounds.size();
    volume::PathSettings settings = work.path;
    settings.longest = double(work.layer.length) * std::max({size.x, size.y, size.z});
    LineGatherer gatherer(work.source);
    for (const volume::Pathline& line : volume::pathlines(work.velocity, seeds, work.moment, work.first(), work.last(),
                                                          settings, progress.part(0, 0.8))) {
        for (std::size_t i = 0; i < line.places.size(); ++i) gatherer.add(line.places[i], line.times[i]);
        gatherer.endLine();
    }
    auto out = std::make_shared<Geometry>();
    out->mesh =
        tubes(gatherer.finish(work.layer.channel, work.data.level, progress.part(0.8, 1)), work.radius(), work.stretch);
    return out;
}

std::shared_ptr<Geometry> streaksOf(const ParticleWork& work, std::span<const glm::dvec3> seeds,
                                    const Progress& progress) {
    const double span = work.layer.span > 0 || work.steady() ? work.span(seeds) : kEver;
    const double begin = std::max(work.moment - span, work.first());
    const volume::StreakSettings settings{.path = work.path};
    std::vector<std::vector<volume::ParticleLine>> lines(seeds.size());
    parallelFor(seeds.size(), [&](std::size_t i) {
        lines[i] = volume::streakline(work.velocity, seeds[i], begin, work.moment, settings, progress.part(0, 0.8));
    });
    LineGatherer gatherer(work.source);
    for (const auto& pieces : lines)
        for (const volume::ParticleLine& piece : pieces) {
            for (const glm::dvec3& place : piece.rows.front()) gatherer.add(place, work.moment);
            gatherer.endLine();
        }
    auto out = std::make_shared<Geometry>();
    out->mesh =
        tubes(gatherer.finish(work.layer.channel, work.data.level, progress.part(0.8, 1)), work.radius(), work.stretch);
    return out;
}

/// A line along which particles are released together.
struct SeedLine {
    glm::dvec3 from, to;
};

/// The diagonal between the two corners; of a plane, rows on it, across the flow in its middle, as many as columns of
/// as many seeds.
std::vector<SeedLine> seedLinesOf(const ParticleWork& work) {
    const volume::Box& bounds = work.info().bounds;
    const glm::dvec3 from = bounds.lo + bounds.size() * glm::dvec3(work.layer.from);
    const glm::dvec3 to = bounds.lo + bounds.size() * glm::dvec3(work.layer.to);
    const auto inside = [&](glm::dvec3 place) { return glm::clamp(place, bounds.lo, bounds.hi); }; // despite rounding
    if (work.layer.seeds != volume::SeedShape::Plane) return {{inside(from), inside(to)}};
    const volume::AxisMaps& axes = work.info().lattice.axes;
    const glm::dvec3 lo = axes.toSheet(from), hi = axes.toSheet(to), edges = glm::abs((hi - lo) * work.stretch);
    const int across = volume::thinnestAxis(edges);
    int along = (across + 1) % 3, onward = (across + 2) % 3;
    const glm::dvec3 flow = glm::abs(work.data.field(axes.toSpace((lo + hi) * 0.5)).value_or(glm::dvec3(0)));
    if (flow[along] > flow[onward]) std::swap(along, onward);
    const int rows = std::max(1, int(std::lround(std::sqrt(double(work.layer.count)))));
    std::vector<SeedLine> out;
    for (int row = 0; row < rows; ++row) {
        glm::dvec3 begin(0.5), end(0.5);
        begin[onward] = end[onward] = (row + 0.5) / rows;
        begin[along] = 0;
        end[along] = 1;
        out.push_back({inside(axes.toSpace(glm::mix(lo, hi, begin))), inside(axes.toSpace(glm::mix(lo, hi, end)))});
    }
    return out;
}

/// When particles of a timeline are released, and when the line is drawn.
struct Release {
    double released, drawn;
};

/// Releases at even times since the first, so that lines move on while time passes; or one, drawn at later times.
std::vector<Release> releasesOf(const ParticleWork& work, double interval) {
    std::vector<Release> out;
    const double since = work.moment - work.info().times.front();
    const double turns = since / interval + (work.layer.together ? 0.0 : double(work.layer.phase));
    const double youngest = (turns - std::floor(turns)) * interval;
    for (int i = 0; i < work.layer.steps; ++i) {
        const Release one = work.layer.together ? Release{work.moment, work.moment + i * interval}
                                                : Release{work.moment - youngest - i * interval, work.moment};
        // One beyond the last time by less than rounding is that of the last time.
        const double most = work.last() + 1e-9 * interval;
        if (one.released >= work.first() && one.drawn <= most)
            out.push_back({one.released, std::min(one.drawn, work.last())});
    }
    return out;
}

std::shared_ptr<Geometry> timelinesOf(const ParticleWork& work, const Progress& progress) {
    const std::vector<SeedLine> rakes = seedLinesOf(work);
    std::vector<glm::dvec3> begins;
    for (const SeedLine& rake : rakes)
        for (int i = 0; i <= 16; ++i) begins.push_back(glm::mix(rake.from, rake.to, i / 16.0));
    const double span = work.span(begins), interval = span / std::max(1, work.layer.steps - 1);
    auto out = std::make_shared<Geometry>();
    out->mesh.origin = volume::originFor(work.info().bounds);
    if (!(interval > 0)) return out;
    const std::vector<Release> releases = releasesOf(work, interval);
    const auto momentsOf = [&](const Release& one) {
        const double begin = std::max(one.released, one.drawn - interval * double(work.layer.band));
        std::vector<double> moments;
        for (int row = 0; begin < one.drawn && row < kBandRows; ++row)
            moments.push_back(begin + (one.drawn - begin) * row / kBandRows);
        moments.push_back(one.drawn);
        return moments;
    };
    std::vector<std::vector<volume::ParticleLine>> lines(rakes.size() * releases.size());
    parallelFor(lines.size(), [&](std::size_t i) {
        const SeedLine& rake = rakes[i / releases.size()];
        const Release& one = releases[i % releases.size()];
        lines[i] = volume::timeline(work.velocity, rake.from, rake.to, one.released, momentsOf(one),
                                    {.path = work.path}, progress.part(0, 0.8));
    });
    LineGatherer fronts(work.source), bands(work.source);
    std::vector<std::size_t> columns;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const std::vector<double> moments = momentsOf(releases[i % releases.size()]);
        for (const volume::ParticleLine& piece : lines[i]) {
            for (const glm::dvec3& place : piece.rows.back()) fronts.add(place, moments.back());
            fronts.endLine();
            if (moments.size() < 2 || piece.marks.size() < 2) continue;
            for (std::size_t row = 0; row < moments.size(); ++row)
                for (const glm::dvec3& place : piece.rows[row]) bands.add(place, moments[row]);
            bands.endLine();
            columns.push_back(piece.marks.size());
        }
    }
    const LineSet strips = bands.finish(work.layer.channel, work.data.level, progress.part(0.8, 0.9));
    for (std::size_t i = 0, begin = 0; i < columns.size(); begin = strips.ends[i++]) {
        const std::size_t size = strips.ends[i] - begin;
        addBand(out->mesh, columns[i], std::span(strips.positions).subspan(begin, size),
                std::span(strips.scalars).subspan(begin, size), work.stretch);
    }
    appendMesh(out->mesh, tubes(fronts.finish(work.layer.channel, work.data.level, progress.part(0.9, 1)),
                                work.radius(), work.stretch));
    return out;
}

/// Adds where a particle has been lately: of its path what is not before `begin`.
void addTail(LineGatherer& gatherer, const volume::Pathline& path, double begin) {
    for (std::size_t i = 0; i < path.places.size(); ++i) {
        if (path.times[i] < begin) continue;
        if (i > 0 && path.times[i - 1] < begin && path.times[i] > begin) {
            const double share = (begin - path.times[i - 1]) / (path.times[i] - path.times[i - 1]);
            gatherer.add(glm::mix(path.places[i - 1], path.places[i], share), begin);
        }
        gatherer.add(path.places[i], path.times[i]);
    }
    gatherer.endLine(1);
}

/// Particles that are born at the seeds, live for a while and are born again, each seed at other times.
std::shared_ptr<Geometry> movingParticles(const ParticleWork& work, std::span<const glm::dvec3> seeds,
                                          const Progress& progress) {
    constexpr double kGolden = 0.61803398874989485; // shares of lives that spread evenly, however many they are
    const double life = work.span(seeds) * (work.layer.span > 0 ? 1 : kLifeShare);
    auto out = std::make_shared<Geometry>();
    out->mesh.origin = volume::originFor(work.info().bounds);
    if (!(life > 0)) return out;
    const double begin = std::max(work.moment - life * double(work.layer.tail), work.first());
    std::vector<volume::Pathline> paths(seeds.size());
    parallelFor(seeds.size(), [&](std::size_t i) {
        if (progress.stop.stop_requested()) throw Cancelled();
        const double turns =
            (work.moment - work.info().times.front()) / life + double(work.layer.phase) + kGolden * double(i);
        const double born = std::max(work.moment - (turns - std::floor(turns)) * life, work.first());
        paths[i] = volume::pathline(work.velocity, seeds[i], born, std::min(begin, born), work.moment, work.path);
    });
    LineGatherer gatherer(work.source);
    for (const volume::Pathline& path : paths)
        if (!path.times.empty() && path.times.back() == work.moment) addTail(gatherer, path, begin);
    out->mesh = comets(gatherer.finish(work.layer.channel, work.data.level, progress.part(0.8, 1)), work.radius(),
                       work.stretch);
    return out;
}

} // namespace

std::shared_ptr<const Geometry> makeParticles(const volume::BrickSource& source, const FlowLayer& layer, double moment,
                                              glm::dvec3 stretch, const Progress& progress,
                                              const DoiFunction* interest) {
    const std::optional<FlowData> data = readFlow(source, layer, moment, progress.part(0, 0.2));
    if (!data) return nullptr;
    assert(data->series && "a kind that follows particles");
    const std::vector<double>& times = source.info().times;
    ParticleWork work{source, layer, *data, moment, stretch, data->velocity(), {}};
    work.path.lattice = data->lattice;
    if (times.size() > 1) work.path.times = times;
    const Progress rest = progress.part(0.3, 1);
    work.path.stopped = data->stopped.get();
    std::shared_ptr<Geometry> out;
    if (layer.kind == FlowKind::Timelines) {
        out = timelinesOf(work, rest);
    } else {
        const std::vector<glm::dvec3> seeds =
            seedsOf(source, *data, layer, moment, stretch, progress.part(0.2, 0.3), interest).places;
        out = layer.kind == FlowKind::Streaklines  ? streaksOf(work, seeds, rest)
              : layer.kind == FlowKind::Speedlines ? movingParticles(work, seeds, rest)
                                                   : pathsOf(work, seeds, rest);
    }
    out->notes = flowNotes(source.info(), layer, *data);
    return out;
}

} // namespace tessera::vis
