#include "vis/shapes/flow_data.h"

#include "vis/scene/geometry.h"
#include "volume/field/time_pair.h"
#include "volume/flow/flow_channels.h"
#include "volume/flow/paths.h"
#include "volume/mesh/isosurface.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace tessera::vis {

namespace {

constexpr double kMostSamples = 3e7; ///< samples of one component: 120 MB

/// Values of a channel at places less the origin of the data; NaN if absent.
std::vector<float> valuesAt(const volume::BrickSource& source, const std::string& channel, int time, int level,
                            std::vector<glm::vec3> places, const Progress& progress) {
    volume::SurfaceMesh points;
    points.positions = std::move(places);
    points.origin = volume::originFor(source.info().bounds);
    const std::optional<int> index = source.info().findChannel(channel);
    if (!index) return std::vector<float>(points.positions.size(), std::numeric_limits<float>::quiet_NaN());
    volume::sampleAtVertices(points, source, *index, time, level, progress);
    return std::move(points.scalars);
}

using Weight = std::function<double(glm::dvec3)>;

/// Weight 1 where the speed is visible, now or, for particles, at some time; else 0.
Weight whereItFlows(const FlowData& data, const std::vector<double>& times) {
    return [&data, &times](glm::dvec3 place) {
        const auto vector = data.field(place);
        if (!vector) return 0.0;
        if (glm::length(*vector) > data.slowest) return 1.0;
        if (!data.series) return 0.0;
        return std::ranges::any_of(times,
                                   [&](double time) {
                                       const auto then = data.series->at(place, time);
                                       return then && glm::length(*then) > data.slowest;
                                   })
                   ? 1.0
                   : 0.0;
    };
}

/// Weight by a channel's value relative to its range, 0 where absent.
Weight byChannel(const volume::BrickSource& source, int channel, int time, int level, const Progress& progress) {
    const Range range = source.info().channelRange(source.info().channel(channel));
    const auto samples =
        std::make_shared<const volume::SampleGrid>(volume::readSamples(source, channel, time, level, progress));
    return [samples, range](glm::dvec3 place) {
        const std::optional<double> value = volume::valueAt(*samples, place);
        if (!value) return 0.0;
        return range.hi > range.lo ? std::clamp((*value - range.lo) / (range.hi - range.lo), 0.0, 1.0) : 1.0;
    };
}

Weight byInterest(const volume::BrickSource& source, const DoiFunction& interest, int time, int level,
                  const Progress& progress) {
    std::vector<std::shared_ptr<const volume::SampleGrid>> grids; // null: unknown
    for (const std::string& name : interest.channels()) {
        const std::optional<int> channel = source.info().findChannel(name);
        grids.push_back(channel ? std::make_shared<const volume::SampleGrid>(
                                      volume::readSamples(source, *channel, time, level, progress))
                                : nullptr);
    }
    return [grids, interest](glm::dvec3 place) {
        std::vector<double> values;
        for (const auto& grid : grids) {
            const std::optional<double> value = grid ? volume::valueAt(*grid, place) : std::nullopt;
            values.push_back(value.value_or(std::numeric_limits<double>::quiet_NaN()));
        }
        return interest(values, place);
    };
}

/// The line through a seed as it is drawn, the seed as it was given. `place`: of the seed, in space.
std::vector<glm::dvec3> drawnLine(const FlowData& data, const volume::StreamlineSettings& settings,
                                  const volume::AxisMaps& axes, glm::dvec3 stretch, glm::dvec3 seed, glm::dvec3 place) {
    std::vector<glm::dvec3> line = volume::streamline(data.field, place, settings);
    for (glm::dvec3& vertex : line) vertex = vertex == place ? seed : axes.toSheet(vertex) * stretch;
    return line;
}

} // namespace

volume::ChangingField FlowData::velocity() const {
    return [this](glm::dvec3 place, double time) -> std::optional<glm::dvec3> {
        const auto vector = series->at(place, time);
        return vector ? std::optional(*vector * perTime) : std::nullopt;
    };
}

int levelOf(const volume::BrickSource& source, const FlowLayer& layer) {
    const double times = followsParticles(layer.kind) ? double(source.info().times.size()) : 1;
    return source.grid().levelWithin(kMostSamples / times);
}

std::optional<FlowData> readFlow(const volume::BrickSource& source, const FlowLayer& layer, double moment,
                                 const Progress& progress) {
    const volume::DatasetInfo& info = source.info();
    const auto parameter = std::find_if(info.parameters.begin(), info.parameters.end(),
                                        [&](const auto& p) { return p.components == 3 && p.name == layer.vector; });
    if (parameter == info.parameters.end()) return std::nullopt;
    FlowData data;
    data.parameter = int(parameter - info.parameters.begin());
    data.level = levelOf(source, layer);
    const volume::TimePair shown = volume::timesAround(info.times, moment);
    if (followsParticles(layer.kind)) {
        data.series = std::make_shared<const volume::VectorSeries>(source, data.parameter, data.level);
        data.lattice = data.series->frame(std::size_t(shown.nearest())).x.lattice;
        const double time = volume::timeAt(info.times, shown);
        data.field = [series = data.series, time](glm::dvec3 place) { return series->at(place, time); };
    } else {
        const auto grid = std::make_shared<const volume::VectorGrid>(
            volume::readVector(source, data.parameter, shown.nearest(), data.level, progress));
        data.lattice = grid->x.lattice;
        data.field = [grid](glm::dvec3 place) { return grid->at(place); };
    }
    const auto magnitude = info.findChannel(layer.vector);
    data.fastest = magnitude ? info.channelRange(info.channel(*magnitude)).hi : 0;
    data.slowest = data.fastest * double(layer.minimumSpeed);
    data.perTime = double(layer.speed) * (layer.ignoreUnits ? 1 : volume::flowUnits(info, *parameter).perTime);
    progress.advance(1);
    return data;
}

std::function<double(glm::dvec3 place)> widthsOf(const volume::BrickSource& source, const FlowData& data,
                                                 const FlowLayer& layer, double moment, const DoiFunction* interest,
                                                 const Progress& progress) {
    if (!interest || layer.contextWidth >= 1) return {};
    const int time = volume::timesAround(source.info().times, moment).nearest();
    return [weight = byInterest(source, *interest, time, data.level, progress),
            least = double(layer.contextWidth)](glm::dvec3 place) { return std::lerp(least, 1.0, weight(place)); };
}

volume::StreamlineSettings streamlinesOf(const volume::BrickSource& source, const FlowData& data,
                                         const FlowLayer& layer) {
    const glm::dvec3 size = source.info().bounds.size();
    return {.lattice = data.lattice,
            .longest = double(layer.length) * std::max({size.x, size.y, size.z}),
            .slowest = data.slowest,
            .stopped = data.stopped.get()};
}

std::vector<std::string> flowNotes(const volume::DatasetInfo& info, const FlowLayer& layer, const FlowData& data) {
    const std::string what = "flow of " + layer.vector;
    std::vector<std::string> notes;
    if (data.level > 0) notes.push_back(coarserText(what, data.level));
    if (const std::size_t stopped = *data.stopped; stopped > 0) {
        const bool particles = followsParticles(layer.kind), one = stopped == 1;
        const int steps = particles ? volume::PathSettings().mostSteps : volume::StreamlineSettings().mostSteps;
        notes.push_back(what + ": " + std::to_string(stopped) +
                        (particles ? one ? " particle stops" : " particles stop"
                         : one     ? " end of a line lies"
                                   : " ends of lines lie") +
                        (particles ? " early, after " : " where they were cut off, after ") + std::to_string(steps) +
                        " steps");
    }
    const bool tilted = info.plane && !info.plane->hasTimeAxis() && glm::dvec3(info.plane->normal) != glm::dvec3(0);
    if (tilted) notes.push_back(what + ": vectors of several times, since t differs over the plane");
    return notes;
}

FlowSeeds seedsOf(const volume::BrickSource& source, const FlowData& data, const FlowLayer& layer, double moment,
                  glm::dvec3 stretch, const Progress& progress, const DoiFunction* interest) {
    const volume::DatasetInfo& info = source.info();
    const int time = volume::timesAround(info.times, moment).nearest();
    const bool straight = layer.seeds == volume::SeedShape::Line;
    const volume::AxisMaps axes = straight ? volume::AxisMaps{} : info.lattice.axes;
    std::vector<Weight> weights{whereItFlows(data, info.times)};
    if (const auto channel = layer.weight.empty() ? std::nullopt : info.findChannel(layer.weight))
        weights.push_back(byChannel(source, *channel, time, data.level, progress));
    if (layer.seedBrushed && interest) weights.push_back(byInterest(source, *interest, time, data.level, progress));
    // Seeds of flat data, and at a border, may lie outside by the rounding of the stretch.
    const auto placeOf = [&](glm::dvec3 sheet) {
        return glm::clamp(axes.toSpace(sheet), info.bounds.lo, info.bounds.hi);
    };
    const auto weightAt = [&](glm::dvec3 sheet) {
        const glm::dvec3 place = placeOf(sheet);
        double product = 1;
        for (const Weight& weight : weights)
            if (product > 0) product *= weight(place);
        return product;
    };
    const glm::dvec3 drawn = info.bounds.size() * stretch;
    volume::SeedSettings settings{.shape = layer.seeds,
                                  .from = axes.toSheet(info.bounds.lo + info.bounds.size() * glm::dvec3(layer.from)),
                                  .to = axes.toSheet(info.bounds.lo + info.bounds.size() * glm::dvec3(layer.to)),
                                  .proportions = stretch,
                                  .count = layer.count,
                                  .separation = double(layer.separation) * std::max({drawn.x, drawn.y, drawn.z}),
                                  .random = std::uint32_t(layer.random)};
    FlowSeeds out;
    if (layer.seeds == volume::SeedShape::Even && followsFlow(layer.kind)) {
        const volume::StreamlineSettings lines = streamlinesOf(source, data, layer);
        volume::EvenLines even = volume::evenLines(
            [&](glm::dvec3 seed) {
                progress.advance(0);
                return drawnLine(data, lines, axes, stretch, seed, placeOf(seed / stretch));
            },
            [&](glm::dvec3 place) { return weightAt(place / stretch) > 0; },
            {.from = settings.from * stretch,
             .to = settings.to * stretch,
             .separation = settings.separation,
             .most = layer.count});
        out = {std::move(even.seeds), std::move(even.lines)};
        for (auto& line : out.lines)
            for (glm::dvec3& vertex : line) vertex = axes.toSpace(vertex / stretch);
        for (glm::dvec3& seed : out.places) seed = placeOf(seed / stretch);
        return out;
    }
    out.places = volume::placeSeeds(settings, weightAt);
    for (glm::dvec3& seed : out.places) seed = placeOf(seed);
    return out;
}

std::vector<float> valuesOver(const volume::BrickSource& source, const std::string& channel, int level,
                              const std::vector<glm::vec3>& places, const std::vector<double>& moments,
                              const Progress& progress) {
    const std::vector<double>& times = source.info().times;
    // Vertices by the stored time before them.
    std::vector<std::vector<std::size_t>> groups(times.size());
    for (std::size_t v = 0; v < places.size(); ++v)
        groups[std::size_t(volume::timesAround(times, moments[v]).earlier)].push_back(v);
    std::vector<float> out(places.size());
    for (std::size_t before = 0; before < times.size(); ++before) {
        const std::vector<std::size_t>& vertices = groups[before];
        if (vertices.empty()) continue;
        std::vector<glm::vec3> own;
        bool between = false;
        for (const std::size_t v : vertices) {
            own.push_back(places[v]);
            between = between || volume::timesAround(times, moments[v]).between();
        }
        const Progress part =
            progress.part(double(before) / double(times.size()), double(before + 1) / double(times.size()));
        const std::vector<float> a = valuesAt(source, channel, int(before), level, own, part);
        const std::vector<float> b =
            between ? valuesAt(source, channel, int(before) + 1, level, own, part) : std::vector<float>();
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const double share = volume::timesAround(times, moments[vertices[i]]).weight;
            out[vertices[i]] = share > 0 ? float(double(a[i]) * (1 - share) + double(b[i]) * share) : a[i];
        }
    }
    return out;
}

} // namespace tessera::vis
