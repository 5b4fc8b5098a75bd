#include "vis/glyphs/glyph_parts.h"
#include "vis/glyphs/make_glyphs.h"
#include "volume/base/parallel.h"
#include "volume/flow/flow_channels.h"
#include "volume/mesh/isosurface.h"
#include "volume/mesh/region_surface.h"
#include "volume/reconstruct/probe.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

namespace tessera::vis {

namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr double kSurfaceSamples = 3e7; ///< of the finest level that a surface to stand on is made of
constexpr float kAtCursor = 3;          ///< times as large as many is one alone

/// Values of channels at places. Places are read brick by brick, so that each brick is read about once.
class PlaceSampler {
public:
    PlaceSampler(const volume::BrickSource& source, int time, std::vector<glm::dvec3> places, const Progress& progress)
        : source_(source), time_(time), places_(std::move(places)), progress_(progress), order_(places_.size()) {
        const volume::Lattice& lattice = source.grid().lattice;
        std::vector<std::int64_t> brick(places_.size());
        for (std::size_t i = 0; i < places_.size(); ++i) {
            const glm::ivec3 at = lattice.nearest(places_[i]) / source.grid().brickSize;
            brick[i] = (std::int64_t(at.z) * 4096 + at.y) * 4096 + at.x;
        }
        std::iota(order_.begin(), order_.end(), std::size_t(0));
        std::ranges::stable_sort(order_, {}, [&](std::size_t i) { return brick[i]; });
    }

    /// Those of all places; NaN where absent, and everywhere without such a channel.
    std::vector<double> operator()(const std::string& name) const { return of(name, order_); }
    /// Of some, by index in the order of bricks; NaN elsewhere.
    std::vector<double> of(const std::string& name, const std::vector<std::size_t>& some) const {
        constexpr std::size_t kAtOnce = 1024;
        std::vector<double> out(places_.size(), kNothing);
        const std::optional<int> channel = source_.info().findChannel(name);
        if (!channel || name.empty()) return out;
        parallelFor((some.size() + kAtOnce - 1) / kAtOnce, [&](std::size_t piece) {
            if (progress_.stop.stop_requested()) throw Cancelled();
            const std::size_t begin = piece * kAtOnce, end = std::min(begin + kAtOnce, some.size());
            std::vector<glm::dvec3> at;
            for (std::size_t i = begin; i < end; ++i) at.push_back(places_[some[i]]);
            const auto values = volume::probeAlong(source_, *channel, at, time_);
            for (std::size_t i = begin; i < end; ++i)
                if (values[i - begin].interpolated) out[some[i]] = *values[i - begin].interpolated;
        });
        return out;
    }
    /// Whether a place has a value of any of the channels.
    std::vector<bool> present(const std::vector<std::string>& channels) const {
        std::vector<bool> out(places_.size(), false);
        std::vector<std::size_t> left = order_;
        for (const std::string& name : channels) {
            const std::vector<double> values = of(name, left);
            std::erase_if(left, [&](std::size_t i) {
                out[i] = !std::isnan(values[i]);
                return bool(out[i]);
            });
        }
        return out;
    }
    std::vector<double> interest(const DoiFunction& function) const {
        std::vector<std::vector<double>> values;
        for (const std::string& name : function.channels()) values.push_back((*this)(name));
        std::vector<double> out(places_.size()), here(values.size());
        for (std::size_t i = 0; i < places_.size(); ++i) {
            for (std::size_t c = 0; c < values.size(); ++c) here[c] = values[c][i];
            out[i] = function(here, places_[i]);
        }
        return out;
    }

private:
    const volume::BrickSource& source_;
    int time_;
    std::vector<glm::dvec3> places_;
    const Progress& progress_;
    std::vector<std::size_t> order_;
};

/// Places of the data; rounding puts none of its border outside.
std::vector<glm::dvec3> inSpace(std::span<const GlyphStand> stands, const volume::DatasetInfo& info) {
    const volume::Box& box = info.bounds;
    const double slack = 1e-9 * glm::length(box.size());
    std::vector<glm::dvec3> out;
    for (const GlyphStand& stand : stands) {
        const glm::dvec3 place = info.lattice.axes.toSpace(stand.place), inside = glm::clamp(place, box.lo, box.hi);
        out.push_back(glm::distance(place, inside) <= slack ? inside : place);
    }
    return out;
}

/// The channels of which a glyph needs one to stand anywhere.
std::vector<std::string> neededChannels(const GlyphLayer& layer) {
    std::vector<std::string> out;
    for (const GlyphPart& part : layer.parts)
        if (!part.channel.empty() && findGlyphPart(layer.kind, part.part) &&
            std::ranges::find(out, part.channel) == out.end())
            out.push_back(part.channel);
    if (out.empty()) out.push_back(layer.channel);
    return out;
}

std::vector<double> weightsOf(const volume::BrickSource& source, const GlyphLayer& layer, const GlyphMoment& moment,
                              std::span<const GlyphStand> stands, const Progress& progress) {
    const volume::DatasetInfo& info = source.info();
    const PlaceSampler sample(source, moment.time, inSpace(stands, info), progress);
    const std::vector<bool> present = sample.present(neededChannels(layer));
    std::vector<double> out(stands.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = present[i];
    if (layer.place == GlyphPlace::Cursor) return out; // it stands where it is put
    if (const auto channel = layer.weight.empty() ? std::nullopt : info.findChannel(layer.weight)) {
        const Range range = info.channelRange(info.channel(*channel));
        const std::vector<double> values = sample(layer.weight);
        const double width = range.hi - range.lo;
        const auto share = [&](double value) {
            return width > 0 ? std::clamp((value - range.lo) / width, 0.0, 1.0) : 1;
        };
        for (std::size_t i = 0; i < out.size(); ++i) out[i] *= std::isnan(values[i]) ? 0 : share(values[i]);
    }
    if (layer.seedBrushed && moment.interest) {
        const std::vector<double> interest = sample.interest(*moment.interest);
        for (std::size_t i = 0; i < out.size(); ++i) out[i] *= interest[i];
    }
    return out;
}

/// The surface that a layer stands on, on the sheet.
volume::SurfaceMesh surfaceToStandOn(const volume::BrickSource& source, const GlyphLayer& layer, int time,
                                     const Progress& progress) {
    const std::string& name = layer.surface.empty() ? layer.channel : layer.surface;
    const std::optional<int> channel = source.info().findChannel(name);
    if (!channel) return {};
    const int level = source.grid().levelWithin(kSurfaceSamples);
    volume::SurfaceMesh mesh =
        volume::parameterOf(source.info(), *channel).categorical
            ? volume::extractRegionSurface(source, *channel, time, int(std::lround(layer.surfaceValue)), level,
                                           progress)
            : volume::extractIsosurface(source, *channel, time, layer.surfaceValue, level, progress);
    const volume::AxisMaps& axes = source.info().lattice.axes;
    if (!axes.isEven())
        for (glm::vec3& at : mesh.positions) at = glm::vec3(axes.toSheet(mesh.origin + glm::dvec3(at)) - mesh.origin);
    return mesh;
}

/// Directions of a vector as they are drawn; 0 where it has none.
std::vector<glm::dvec3> directionsOf(const volume::BrickSource& source, const std::string& vector,
                                     const std::vector<glm::dvec3>& places, const PlaceSampler& sample,
                                     glm::dvec3 stretch) {
    const volume::DatasetInfo& info = source.info();
    std::vector<glm::dvec3> out(places.size(), glm::dvec3(0));
    for (std::size_t p = 0; p < info.parameters.size(); ++p) {
        if (info.parameters[p].components != 3 || info.parameters[p].name != vector) continue;
        std::array<std::vector<double>, 3> components;
        for (int c = 0; c < 3; ++c)
            components[std::size_t(c)] = sample(info.channel(info.channelIndex(int(p), c)).name);
        for (std::size_t i = 0; i < places.size(); ++i) {
            const glm::dvec3 here{components[0][i], components[1][i], components[2][i]};
            // By how much longer or shorter a length is on the sheet there.
            const glm::dvec3 drawn =
                here * (glm::abs(info.lattice.spacing) / info.lattice.lengthsAt(places[i])) * stretch;
            if (glm::length(drawn) > 0) out[i] = glm::normalize(drawn);
        }
    }
    return out;
}

GlyphSpace spaceOf(const volume::DatasetInfo& info, const GlyphLayer& layer, const GlyphMoment& moment, double size) {
    const volume::AxisMaps& axes = info.lattice.axes;
    const glm::dvec3 lo = info.bounds.lo, edges = info.bounds.size();
    return {.place = layer.place,
            .even = layer.even,
            .from = axes.toSheet(lo + edges * glm::dvec3(layer.from)),
            .to = axes.toSheet(lo + edges * glm::dvec3(layer.to)),
            .stretch = moment.stretch,
            .count = layer.count,
            .random = std::uint32_t(layer.random),
            .apart = size,
            .cursor = axes.toSheet(moment.cursor)};
}

} // namespace

GlyphSamples sampleGlyphs(const volume::BrickSource& source, const GlyphLayer& layer, const GlyphMoment& moment,
                          const Progress& progress) {
    const volume::DatasetInfo& info = source.info();
    const glm::dvec3 edges = info.bounds.size() * moment.stretch;
    const bool alone = layer.place == GlyphPlace::Cursor;
    GlyphSamples out;
    out.size = double(layer.size) * std::max({edges.x, edges.y, edges.z}) * double(alone ? kAtCursor : 1);
    GlyphSpace space = spaceOf(info, layer, moment, out.size);
    volume::SurfaceMesh surface;
    if (layer.place == GlyphPlace::Surface) {
        surface = surfaceToStandOn(source, layer, moment.time, progress.part(0, 0.3));
        space.surface = &surface;
    }
    const int across = thinnestAxis(alone ? edges : glm::abs(space.to - space.from) * moment.stretch);
    out.facing = glm::dvec3(0);
    out.facing[across] = across == 0 ? -1 : 1; // so that x or z is at the right and y above
    out.stands = placeGlyphs(
        space, [&](std::span<const GlyphStand> stands) { return weightsOf(source, layer, moment, stands, progress); });
    const std::vector<glm::dvec3> places = inSpace(out.stands, info);
    const PlaceSampler sample(source, moment.time, places, progress);
    for (const GlyphPart& part : layer.parts) out.values.push_back(sample(part.channel));
    const std::string neutral; // of which there are no values
    for (const double value : sample(glyphShowsColor(layer) ? glyphColorChannel(layer) : neutral))
        out.colors.push_back(float(value));
    if (!layer.direction.empty())
        out.directions = directionsOf(source, layer.direction, places, sample, moment.stretch);
    if (moment.interest) out.interest = sample.interest(*moment.interest);
    progress.advance(1);
    return out;
}

} // namespace tessera::vis
