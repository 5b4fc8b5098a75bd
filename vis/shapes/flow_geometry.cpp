#include "vis/shapes/flow_geometry.h"

#include "volume/mesh/isosurface.h"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

namespace tessera::vis {

namespace {

constexpr int kSides = 12;
constexpr double kMostSamples = 3e7; ///< samples of one component: 120 MB

struct Frame {
    glm::dvec3 along, u, v; ///< right-handed, length 1
};

Frame frameAlong(glm::dvec3 direction) {
    const glm::dvec3 along = glm::normalize(direction);
    const glm::dvec3 other = std::abs(along.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
    const glm::dvec3 u = glm::normalize(glm::cross(other, along));
    return {along, u, glm::cross(along, u)};
}

/// Builds meshes from rings of vertices around an axis, in stretched space.
class Rings {
public:
    explicit Rings(glm::dvec3 stretch) : stretch_(stretch) {}
    /// Adds a ring; `lean`: axial component of its normals per unit of radial component.
    void add(glm::dvec3 centre, const Frame& frame, double radius, double lean, double outwards, float scalar) {
        for (int i = 0; i < kSides; ++i) {
            const double angle = 2 * std::numbers::pi * i / kSides;
            const glm::dvec3 out = frame.u * std::cos(angle) + frame.v * std::sin(angle);
            mesh.positions.emplace_back((centre + out * radius) / stretch_);
            // Normals transform with the inverse transpose.
            mesh.normals.emplace_back(glm::normalize((out * outwards + frame.along * lean) * stretch_));
            mesh.scalars.push_back(scalar);
        }
    }
    /// Adds triangles between the last two rings.
    void connect() {
        const auto first = std::uint32_t(mesh.positions.size()) - 2 * kSides;
        for (std::uint32_t i = 0; i < kSides; ++i) {
            const std::uint32_t next = (i + 1) % kSides;
            const std::uint32_t a = first + i, b = first + next, c = a + kSides, d = b + kSides;
            mesh.triangles.push_back({a, b, d});
            mesh.triangles.push_back({a, d, c});
        }
    }
    /// Adds the lateral surface of a truncated cone between two positions on an axis.
    void face(glm::dvec3 from, glm::dvec3 to, const Frame& frame, double radiusFrom, double radiusTo, float scalar) {
        const double rise = glm::dot(to - from, frame.along), fall = radiusFrom - radiusTo;
        add(from, frame, radiusFrom, fall, rise, scalar);
        add(to, frame, radiusTo, fall, rise, scalar);
        connect();
    }
    volume::SurfaceMesh mesh;

private:
    glm::dvec3 stretch_;
};

/// The vertices of a line, in stretched space.
struct Course {
    std::vector<glm::dvec3> places;
    std::vector<float> scalars;
};

/// Removes vertices as long as positions stay within `apart` of the polyline and scalars within `step` of linear
/// interpolation. (Douglas and Peucker, Algorithms for the reduction of the number of points, 1973.)
Course simplified(const Course& course, double apart, double step) {
    const std::size_t n = course.places.size();
    if (n < 3) return course;
    std::vector<bool> kept(n, false);
    kept.front() = kept.back() = true;
    std::vector<std::pair<std::size_t, std::size_t>> parts{{0, n - 1}};
    while (!parts.empty()) {
        const auto [first, last] = parts.back();
        parts.pop_back();
        const glm::dvec3 from = course.places[first], way = course.places[last] - from;
        const double length2 = glm::dot(way, way);
        double worst = 1;
        std::size_t at = first;
        for (std::size_t i = first + 1; i < last; ++i) {
            const glm::dvec3 to = course.places[i] - from;
            const double t = length2 > 0 ? std::clamp(glm::dot(to, way) / length2, 0.0, 1.0) : 0;
            const double even = (1 - t) * double(course.scalars[first]) + t * double(course.scalars[last]);
            const double colour = std::abs(double(course.scalars[i]) - even);
            double error = glm::length(to - t * way) / apart;
            if (step > 0 && colour > error * step) error = colour / step;
            if (error > worst) worst = error, at = i;
        }
        if (at == first) continue;
        kept[at] = true;
        parts.emplace_back(first, at);
        parts.emplace_back(at, last);
    }
    Course out;
    for (std::size_t i = 0; i < n; ++i) {
        if (!kept[i]) continue;
        out.places.push_back(course.places[i]);
        out.scalars.push_back(course.scalars[i]);
    }
    return out;
}

/// A line of a set, without coincident vertices.
Course courseOf(const LineSet& lines, std::uint32_t begin, std::uint32_t end, double apart, glm::dvec3 stretch) {
    Course out;
    for (std::uint32_t i = begin; i < end; ++i) {
        const glm::dvec3 place = glm::dvec3(lines.positions[i]) * stretch;
        if (!out.places.empty() && glm::distance(place, out.places.back()) <= apart) continue;
        out.places.push_back(place);
        out.scalars.push_back(lines.scalars.empty() ? 0 : lines.scalars[i]);
    }
    return out;
}

volume::SurfaceMesh glyphMesh(std::span<const Glyph> glyphs, glm::dvec3 stretch, bool shafts) {
    Rings rings(stretch);
    for (const Glyph& glyph : glyphs) {
        const double length = glm::length(glyph.vector);
        if (!(length > 0)) continue;
        const Frame frame = frameAlong(glyph.vector);
        const double neck = shafts ? 0.62 : 0, head = length * (shafts ? 0.14 : 0.22);
        const glm::dvec3 foot = glyph.place * stretch - glyph.vector * (shafts ? 0.0 : 0.5);
        const glm::dvec3 at = foot + glyph.vector * neck, tip = foot + glyph.vector;
        const double shaft = shafts ? length * 0.045 : 0;
        if (shafts) {
            rings.face(foot, foot, frame, 0, shaft, glyph.scalar);
            rings.face(foot, at, frame, shaft, shaft, glyph.scalar);
        }
        rings.face(at, at, frame, shaft, head, glyph.scalar);
        rings.face(at, tip, frame, head, 0, glyph.scalar);
    }
    return std::move(rings.mesh);
}

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
        return value ? std::clamp((*value - range.lo) / (range.hi - range.lo), 0.0, 1.0) : 0.0;
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

std::vector<glm::dvec3> seedsOf(const volume::BrickSource& source, const FlowData& data, const FlowLayer& layer,
                                int time, glm::dvec3 stretch, const Progress& progress, const DoiFunction* interest) {
    const volume::Box& bounds = source.info().bounds;
    std::vector<Weight> weights{whereItFlows(data.field(), data.slowest)};
    if (const auto channel = layer.weight.empty() ? std::nullopt : source.info().findChannel(layer.weight))
        weights.push_back(byChannel(source, *channel, time, data.level, progress));
    if (layer.seedBrushed && interest) weights.push_back(byInterest(source, *interest, time, data.level, progress));
    return volume::placeSeeds({.shape = layer.seeds,
                               .from = bounds.lo + bounds.size() * glm::dvec3(layer.from),
                               .to = bounds.lo + bounds.size() * glm::dvec3(layer.to),
                               .proportions = stretch,
                               .count = layer.count,
                               .random = std::uint32_t(layer.random)},
                              [&](glm::dvec3 place) {
                                  double product = 1;
                                  for (const Weight& weight : weights)
                                      if (product > 0) product *= weight(place);
                                  return product;
                              });
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
    std::vector<double> moments;
    for (const volume::Pathline& line : volume::pathlines(field, seeds, times[std::size_t(time)], times.front(),
                                                          times.back(), settings, progress.part(0, 0.8))) {
        if (line.places.size() < 2) continue;
        for (const glm::dvec3& place : line.places) lines.positions.emplace_back(place - lines.origin);
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
                places.push_back(lines.positions[v]);
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

volume::SurfaceMesh tubes(const LineSet& lines, double radius, glm::dvec3 stretch) {
    constexpr double kColorSteps = 250; // distinguishable colours over the range
    const auto [least, most] = std::minmax_element(lines.scalars.begin(), lines.scalars.end());
    const double step = lines.scalars.empty() ? 0 : double(*most - *least) / kColorSteps;
    Rings rings(stretch);
    rings.mesh.origin = lines.origin;
    std::uint32_t begin = 0;
    for (const std::uint32_t end : lines.ends) {
        const Course course = simplified(courseOf(lines, begin, end, radius * 0.05, stretch), radius * 0.05, step);
        begin = end;
        const std::size_t n = course.places.size();
        if (n < 2) continue;
        Frame frame = frameAlong(course.places[1] - course.places[0]);
        rings.face(course.places[0], course.places[0], frame, 0, radius, course.scalars[0]);
        for (std::size_t i = 0; i < n; ++i) {
            // Rotation-minimising frame: the former frame, rotated only as far as the new direction requires.
            const glm::dvec3 way = course.places[std::min(i + 1, n - 1)] - course.places[i > 0 ? i - 1 : 0];
            if (glm::length(way) > 0) frame.along = glm::normalize(way);
            const glm::dvec3 u = frame.u - frame.along * glm::dot(frame.u, frame.along);
            frame.u = glm::length(u) > 1e-6 ? glm::normalize(u) : frameAlong(frame.along).u;
            frame.v = glm::cross(frame.along, frame.u);
            rings.add(course.places[i], frame, radius, 0, 1, course.scalars[i]);
            if (i > 0) rings.connect();
        }
        rings.face(course.places[n - 1], course.places[n - 1], frame, radius, 0, course.scalars[n - 1]);
    }
    return std::move(rings.mesh);
}

volume::SurfaceMesh arrows(std::span<const Glyph> glyphs, glm::dvec3 stretch) {
    return glyphMesh(glyphs, stretch, true);
}

volume::SurfaceMesh cones(std::span<const Glyph> glyphs, glm::dvec3 stretch) {
    return glyphMesh(glyphs, stretch, false);
}

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
        for (const auto& line : volume::streamlines(field, seeds, settings, progress.part(0.4, 0.8))) {
            if (line.size() < 2) continue;
            for (const glm::dvec3& place : line) lines.positions.emplace_back(place - origin);
            lines.ends.push_back(std::uint32_t(lines.positions.size()));
        }
        lines.scalars = valuesAt(source, layer.channel, time, level, lines.positions, progress.part(0.8, 1));
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
        glyphs.push_back({seeds[i] - origin,
                          glm::normalize(vector * stretch) * (share * double(layer.size) * longestDrawn), scalars[i]});
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
