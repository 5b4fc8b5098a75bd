#include "vis/shapes/flow_geometry.h"

#include "volume/mesh/isosurface.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace tessera::vis {

namespace {

constexpr double kMostSamples = 3e7; ///< samples of one component: 120 MB

/// Values of the layer's channel at positions less the origin of the data; NaN if absent.
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

/// Weight 1 where the speed is visible, else 0.
Weight whereItFlows(const volume::VectorField& field, double slowest) {
    return [field, slowest](glm::dvec3 place) {
        const auto vector = field(place);
        return vector && glm::length(*vector) > slowest ? 1.0 : 0.0;
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

/// The data of a flow layer.
struct FlowData {
    int parameter = 0, level = 0;
    volume::VectorGrid grid;
    double slowest = 0;
    volume::VectorField field() const {
        return [this](glm::dvec3 place) { return grid.at(place); };
    }
};

std::optional<FlowData> readFlow(const volume::BrickSource& source, const FlowLayer& layer, int time,
                                 const Progress& progress) {
    const volume::DatasetInfo& info = source.info();
    const auto parameter = std::find_if(info.parameters.begin(), info.parameters.end(),
                                        [&](const auto& p) { return p.components == 3 && p.name == layer.vector; });
    if (parameter == info.parameters.end()) return std::nullopt;
    FlowData data;
    data.parameter = int(parameter - info.parameters.begin());
    data.level = flowLevel(source.grid(), layer.kind == FlowKind::Pathlines ? int(info.times.size()) : 1);
    data.grid = volume::readVector(source, data.parameter, time, data.level, progress);
    const auto magnitude = info.findChannel(layer.vector);
    const double fastest = magnitude ? info.channelRange(info.channel(*magnitude)).hi : 0;
    data.slowest = fastest * double(layer.minimumSpeed);
    return data;
}

/// A direction in space as it is drawn at a place: by how much longer or shorter a length is on the sheet there.
glm::dvec3 drawnDirection(const volume::Lattice& lattice, glm::dvec3 place, glm::dvec3 direction) {
    return direction * (glm::abs(lattice.spacing) / lattice.lengthsAt(place));
}

/// Lines of seeds are straight in space; other shapes are those of the drawing, in which seeds are as dense everywhere.
std::vector<glm::dvec3> seedsOf(const volume::BrickSource& source, const FlowData& data, const FlowLayer& layer,
                                int time, glm::dvec3 stretch, const Progress& progress, const DoiFunction* interest) {
    const volume::Box& bounds = source.info().bounds;
    const volume::AxisMaps axes =
        layer.seeds == volume::SeedShape::Line ? volume::AxisMaps{} : source.info().lattice.axes;
    std::vector<Weight> weights{whereItFlows(data.field(), data.slowest)};
    if (const auto channel = layer.weight.empty() ? std::nullopt : source.info().findChannel(layer.weight))
        weights.push_back(byChannel(source, *channel, time, data.level, progress));
    if (layer.seedBrushed && interest) weights.push_back(byInterest(source, *interest, time, data.level, progress));
    std::vector<glm::dvec3> seeds =
        volume::placeSeeds({.shape = layer.seeds,
                            .from = axes.toSheet(bounds.lo + bounds.size() * glm::dvec3(layer.from)),
                            .to = axes.toSheet(bounds.lo + bounds.size() * glm::dvec3(layer.to)),
                            .proportions = stretch,
                            .count = layer.count,
                            .random = std::uint32_t(layer.random)},
                           [&](glm::dvec3 sheet) {
                               const glm::dvec3 place = axes.toSpace(sheet);
                               double product = 1;
                               for (const Weight& weight : weights)
                                   if (product > 0) product *= weight(place);
                               return product;
                           });
    for (glm::dvec3& seed : seeds) seed = axes.toSpace(seed);
    return seeds;
}

/// Particle paths through all times, coloured by the channel at the time of passage.
LineSet particleWays(const volume::BrickSource& source, const FlowLayer& layer, int parameter, int time, int level,
                     std::span<const glm::dvec3> seeds, const volume::StreamlineSettings& settings,
                     const Progress& progress) {
    const std::vector<double>& times = source.info().times;
    const volume::VectorSeries series(source, parameter, level);
    const volume::ChangingField field = [&](glm::dvec3 place, double when) -> std::optional<glm::dvec3> {
        const auto vector = series.at(place, when);
        if (!vector) return std::nullopt;
        return *vector * double(layer.speed);
    };
    LineSet lines{.positions = {}, .scalars = {}, .ends = {}, .origin = volume::originFor(source.info().bounds)};
    const volume::AxisMaps& axes = source.info().lattice.axes;
    std::vector<glm::vec3> inSpace;
    std::vector<double> moments;
    for (const volume::Pathline& line : volume::pathlines(field, seeds, times[std::size_t(time)], times.front(),
                                                          times.back(), settings, progress.part(0, 0.8))) {
        if (line.places.size() < 2) continue;
        for (const glm::dvec3& place : line.places) {
            inSpace.emplace_back(place - lines.origin);
            lines.positions.emplace_back(axes.toSheet(place) - lines.origin);
        }
        moments.insert(moments.end(), line.times.begin(), line.times.end());
        lines.ends.push_back(std::uint32_t(lines.positions.size()));
    }
    // Group vertices by the stored time before them and interpolate between both neighbours.
    lines.scalars.resize(lines.positions.size());
    for (std::size_t before = 0; before < times.size(); ++before) {
        const double next = before + 1 < times.size() ? times[before + 1] : std::numeric_limits<double>::infinity();
        std::vector<std::size_t> vertices;
        std::vector<glm::vec3> places;
        for (std::size_t v = 0; v < moments.size(); ++v)
            if (moments[v] >= times[before] && moments[v] < next) {
                vertices.push_back(v);
                places.push_back(inSpace[v]);
            }
        if (vertices.empty()) continue;
        const auto a = valuesAt(source, layer.channel, int(before), level, places, progress.part(0.8, 1));
        const auto b = before + 1 < times.size()
                           ? valuesAt(source, layer.channel, int(before) + 1, level, places, progress.part(0.8, 1))
                           : a;
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const double share =
                before + 1 < times.size() ? (moments[vertices[i]] - times[before]) / (next - times[before]) : 0;
            lines.scalars[vertices[i]] = float(a[i] * (1 - share) + b[i] * share);
        }
    }
    return lines;
}

} // namespace

int flowLevel(const volume::BrickGrid& grid, int times) {
    return grid.levelWithin(kMostSamples / times);
}

std::vector<glm::dvec3> flowSeeds(const volume::BrickSource& source, const FlowLayer& layer, int time,
                                  glm::dvec3 stretch, const Progress& progress, const DoiFunction* interest) {
    const std::optional<FlowData> data = readFlow(source, layer, time, progress.part(0, 0.7));
    if (!data) return {};
    return seedsOf(source, *data, layer, time, stretch, progress.part(0.7, 1), interest);
}

std::shared_ptr<const Geometry> makeFlow(const volume::BrickSource& source, const FlowLayer& layer, int time,
                                         glm::dvec3 stretch, const Progress& progress, const DoiFunction* interest) {
    const std::optional<FlowData> data = readFlow(source, layer, time, progress.part(0, 0.3));
    if (!data) return nullptr;
    const int level = data->level, index = data->parameter;
    const volume::VectorField field = data->field();
    const glm::dvec3 size = source.info().bounds.size();
    const double longest = std::max({size.x, size.y, size.z});
    const glm::dvec3 drawn = size * stretch;
    const double longestDrawn = std::max({drawn.x, drawn.y, drawn.z});
    const std::vector<glm::dvec3> seeds =
        seedsOf(source, *data, layer, time, stretch, progress.part(0.3, 0.4), interest);
    const glm::dvec3 origin = volume::originFor(source.info().bounds);
    const volume::Lattice& lattice = source.info().lattice;
    auto out = std::make_shared<Geometry>();
    if (followsFlow(layer.kind)) {
        LineSet lines{.positions = {}, .scalars = {}, .ends = {}, .origin = origin};
        const volume::StreamlineSettings settings{
            .lattice = data->grid.x.lattice, .longest = double(layer.length) * longest, .slowest = data->slowest};
        if (layer.kind == FlowKind::Pathlines) {
            volume::StreamlineSettings particles = settings;
            particles.slowest *= double(layer.speed);
            out->mesh = tubes(particleWays(source, layer, index, time, level, seeds, particles, progress.part(0.4, 1)),
                              double(layer.radius) * longestDrawn, stretch);
            return out;
        }
        std::vector<glm::vec3> inSpace;
        for (const auto& line : volume::streamlines(field, seeds, settings, progress.part(0.4, 0.8))) {
            if (line.size() < 2) continue;
            for (const glm::dvec3& place : line) {
                inSpace.emplace_back(place - origin);
                lines.positions.emplace_back(lattice.axes.toSheet(place) - origin);
            }
            lines.ends.push_back(std::uint32_t(lines.positions.size()));
        }
        lines.scalars = valuesAt(source, layer.channel, time, level, std::move(inSpace), progress.part(0.8, 1));
        if (layer.kind == FlowKind::Tubes)
            out->mesh = tubes(lines, double(layer.radius) * longestDrawn, stretch);
        else
            out->lines = std::move(lines);
        return out;
    }
    std::vector<glm::vec3> places;
    for (const glm::dvec3& seed : seeds) places.emplace_back(seed - origin);
    const std::vector<float> scalars = valuesAt(source, layer.channel, time, level, places, progress.part(0.4, 1));
    double greatest = 0; // largest of those drawn, which gets the wanted length
    for (const glm::dvec3& seed : seeds) greatest = std::max(greatest, glm::length(*field(seed)));
    std::vector<Glyph> glyphs;
    for (std::size_t i = 0; i < seeds.size(); ++i) {
        const glm::dvec3 vector = *field(seeds[i]); // not zero: seeds lie where it flows
        const double share = layer.scaled ? glm::length(vector) / greatest : 1;
        const glm::dvec3 drawnWay = glm::normalize(drawnDirection(lattice, seeds[i], vector) * stretch);
        glyphs.push_back({lattice.axes.toSheet(seeds[i]) - origin,
                          drawnWay * (share * double(layer.size) * longestDrawn), scalars[i]});
    }
    if (layer.kind == FlowKind::Arrows) out->mesh = arrows(glyphs, stretch);
    if (layer.kind == FlowKind::Cones) out->mesh = cones(glyphs, stretch);
    out->mesh.origin = out->lines.origin = origin;
    if (layer.kind == FlowKind::Hedgehogs)
        for (const Glyph& glyph : glyphs) {
            for (const glm::dvec3 end : {glyph.place, glyph.place + glyph.vector / stretch})
                out->lines.positions.emplace_back(end);
            out->lines.scalars.insert(out->lines.scalars.end(), 2, glyph.scalar);
            out->lines.ends.push_back(std::uint32_t(out->lines.positions.size()));
        }
    return out;
}

} // namespace tessera::vis
