#include "app/views/hyperslice/hyper_data.h"

#include "app/pane/view_parts.h"
#include "vis/formulas/colors.h"
#include "vis/optics/ray_setup.h"
#include "vis/scene/brush_effect.h"
#include "volume/base/parallel.h"
#include "volume/bricks/parts_bricks.h"
#include "volume/bricks/source_at_time.h"
#include "volume/reconstruct/probe.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace tessera::app {

namespace {

/// The position at a place of an axis, from that of the cross-hair; within the data, which an uneven axis may miss by
/// its last digits.
void placeAlongAxis(glm::dvec3& position, const AxisPlaces& axis, double place, const volume::DatasetInfo& info) {
    if (axis.ofTime()) return;
    const int k = axis.dimension;
    position[k] = std::clamp(axis.at(place, info.lattice.axes), info.bounds.lo[k], info.bounds.hi[k]);
}

/// Where the cross-hair is across axes.
template <class Query>
void setAcross(Query& query, std::initializer_list<const AxisPlaces*> axes, const Session& session) {
    query.cursor = session.cursor;
    query.time = session.time;
    for (const AxisPlaces* axis : axes) {
        if (axis->ofTime())
            query.time = 0;
        else
            query.cursor[axis->dimension] = 0;
    }
}

/// A colour, sRGB, and its opacity, by what brushes say of a sample.
glm::dvec4 brushedColor(const vis::Selection& selection, glm::dvec3 color, double interest,
                        const vis::DoiFunction::Holder& holder) {
    const glm::dvec3 linear = vis::linearFromSrgb(color);
    const double grey = vis::luminance(linear);
    const vis::ContextLook look{static_cast<double>(selection.contextSaturation),
                                static_cast<double>(selection.contextLightness)};
    const glm::dvec3 faded = vis::focusedColor<double>(vis::BrushEffect::Fade, look, linear, grey, interest, 1.0);
    const double tint = holder.interest * interest * static_cast<double>(selection.brushColor);
    const glm::dvec3 tinted = glm::mix(faded, vis::linearFromSrgb(glm::dvec3(holder.color)), tint);
    const double opacity =
        vis::brushedOpacity<double>(vis::BrushEffect::Fade, static_cast<double>(selection.contextOpacity), interest);
    return {vis::srgbFromLinear(tinted.x), vis::srgbFromLinear(tinted.y), vis::srgbFromLinear(tinted.z), opacity};
}

std::uint8_t panelByte(double share) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0, 1.0)));
}

/// Whether values between two stored times are those of both, mixed, and nothing else counts.
bool isMixedBetween(const volume::BrickSource& source, int channel) {
    const volume::DatasetInfo& info = source.info();
    const volume::Parameter& parameter = info.parameters[static_cast<std::size_t>(info.channel(channel).parameter)];
    return !parameter.categorical && !volume::labelChannel(info, parameter) &&
           !volume::isComputedBetween(source, channel);
}

/// A panel at one time: bands of rows at once, since every band reads its bricks.
void readInSpace(const volume::BrickSource& source, HyperValues& out, const Progress& progress) {
    const volume::DatasetInfo& info = source.info();
    const HyperQuery& query = out.query;
    const volume::TimePair time = volume::timesAround(info.times, query.time);
    const int bands = std::min(query.cells.y, 2 * mostThreads());
    std::atomic<int> done = 0;
    parallelFor(static_cast<std::size_t>(bands), [&](std::size_t band) {
        const int from = query.cells.y * static_cast<int>(band) / bands,
                  to = query.cells.y * (static_cast<int>(band) + 1) / bands;
        std::vector<glm::dvec3> places;
        for (int j = from; j < to; ++j)
            for (int i = 0; i < query.cells.x; ++i) {
                glm::dvec3& place = places.emplace_back(query.cursor);
                placeAlongAxis(place, query.axes[0], cellMiddle(query.shown[0], i, query.cells.x), info);
                placeAlongAxis(place, query.axes[1], cellMiddle(query.shown[1], j, query.cells.y), info);
            }
        const auto first = static_cast<std::size_t>(from) * static_cast<std::size_t>(query.cells.x);
        for (std::size_t c = 0; c < query.channels.size(); ++c) {
            const auto found = volume::probeAlong(source, query.channels[c], places, time);
            for (std::size_t i = 0; i < found.size(); ++i)
                out.values[c][first + i] = found[i].interpolated.value_or(std::nan(""));
        }
        progress.advance(static_cast<double>(++done) / bands);
    });
}

/// The values of a line at stored times, each read once, from which those between are mixed as probeAlong() does.
class LineOverTimes {
public:
    LineOverTimes(const volume::BrickSource& source, int channel, const std::vector<glm::dvec3>& places,
                  const std::vector<volume::TimePair>& wanted, const Progress& progress)
        : lines_(source.info().times.size()) {
        std::vector<bool> needed(lines_.size());
        for (const volume::TimePair& time : wanted)
            needed[static_cast<std::size_t>(time.earlier)] = needed[static_cast<std::size_t>(time.later)] = true;
        parallelFor(lines_.size(), [&](std::size_t time) {
            progress.advance(0);
            if (!needed[time]) return;
            for (const volume::ProbeValue& value : volume::probeAlong(source, channel, places, static_cast<int>(time)))
                lines_[time].push_back(value.interpolated.value_or(std::nan("")));
        });
    }
    double at(const volume::TimePair& time, std::size_t place) const {
        const double a = lines_[static_cast<std::size_t>(time.earlier)][place],
                     b = lines_[static_cast<std::size_t>(time.later)][place];
        if (!time.between()) return a;
        if (std::isnan(a) || std::isnan(b)) return time.weight >= 0.5 ? b : a;
        return (1 - time.weight) * a + time.weight * b;
    }

private:
    std::vector<std::vector<double>> lines_; ///< by time, then by place
};

/// A panel with an axis of time: the same line at other times.
void readOverTime(const volume::BrickSource& source, HyperValues& out, const Progress& progress) {
    const volume::DatasetInfo& info = source.info();
    const HyperQuery& query = out.query;
    const std::size_t own = query.axes[0].ofTime() ? 0 : 1, across = 1 - own;
    const int times = query.cells[static_cast<int>(own)], length = query.cells[static_cast<int>(across)];
    std::vector<volume::TimePair> pairs;
    for (int k = 0; k < times; ++k)
        pairs.push_back(volume::timesAround(
            info.times, query.axes[own].at(cellMiddle(query.shown[own], k, times), info.lattice.axes)));
    std::vector<glm::dvec3> places(static_cast<std::size_t>(length), query.cursor);
    for (int i = 0; i < length; ++i)
        placeAlongAxis(places[static_cast<std::size_t>(i)], query.axes[across],
                       cellMiddle(query.shown[across], i, length), info);
    const auto columns = static_cast<std::size_t>(query.cells.x);
    for (std::size_t c = 0; c < query.channels.size(); ++c) {
        const auto store = [&](std::size_t k, std::size_t i, double value) {
            out.values[c][own == 0 ? i * columns + k : k * columns + i] = value;
        };
        if (isMixedBetween(source, query.channels[c])) {
            const LineOverTimes line(source, query.channels[c], places, pairs, progress);
            for (std::size_t k = 0; k < pairs.size(); ++k)
                for (std::size_t i = 0; i < places.size(); ++i) store(k, i, line.at(pairs[k], i));
            continue;
        }
        parallelFor(pairs.size(), [&](std::size_t k) {
            progress.advance(static_cast<double>(c) / static_cast<double>(query.channels.size()));
            const auto found = volume::probeAlong(source, query.channels[c], places, pairs[k]);
            for (std::size_t i = 0; i < found.size(); ++i) store(k, i, found[i].interpolated.value_or(std::nan("")));
        });
    }
}

} // namespace

double cellMiddle(Range range, int cell, int cells) {
    return std::lerp(range.lo, range.hi, (cell + 0.5) / cells);
}

glm::dvec3 HyperValues::positionOf(glm::ivec2 cell, const volume::AxisMaps& maps) const {
    glm::dvec3 position = query.cursor;
    for (int k = 0; k < 2; ++k) {
        const AxisPlaces& axis = query.axes[static_cast<std::size_t>(k)];
        if (!axis.ofTime())
            position[axis.dimension] =
                axis.at(cellMiddle(query.shown[static_cast<std::size_t>(k)], cell[k], query.cells[k]), maps);
    }
    return position;
}

double HyperValues::at(std::size_t channel, glm::ivec2 cell) const {
    return values[channel][static_cast<std::size_t>(cell.y) * static_cast<std::size_t>(query.cells.x) +
                           static_cast<std::size_t>(cell.x)];
}

HyperQuery panelQuery(const HyperAxis& across, const HyperAxis& up, std::vector<int> channels, glm::ivec2 cells,
                      const Session& session, const volume::DatasetInfo& info) {
    HyperQuery query{.axes = {across.along, up.along},
                     .shown = {across.shown, up.shown},
                     .cells = glm::max(cells, 1),
                     .channels = std::move(channels)};
    setAcross(query, {&across.along, &up.along}, session);
    query.cursor = glm::clamp(query.cursor, info.bounds.lo, info.bounds.hi);
    for (const AxisPlaces& axis : query.axes)
        if (!axis.ofTime()) query.cursor[axis.dimension] = 0;
    return query;
}

HyperValues readPanel(const volume::BrickSource& source, const HyperQuery& query, const Progress& progress) {
    HyperValues out{query, {}};
    out.values.assign(query.channels.size(), std::vector<double>(static_cast<std::size_t>(query.cells.x) *
                                                                     static_cast<std::size_t>(query.cells.y),
                                                                 std::nan("")));
    const bool overTime = query.axes[0].ofTime() || query.axes[1].ofTime();
    overTime ? readOverTime(source, out, progress) : readInSpace(source, out, progress);
    return out;
}

ProfileAlongQuery profileAlongQuery(const HyperAxis& axis, int channel, int count, const Session& session,
                                    const volume::DatasetInfo& info) {
    ProfileAlongQuery query{.along = axis.along, .shown = axis.shown, .count = std::max(count, 2), .channel = channel};
    setAcross(query, {&axis.along}, session);
    query.cursor = glm::clamp(query.cursor, info.bounds.lo, info.bounds.hi);
    if (!axis.along.ofTime()) query.cursor[axis.along.dimension] = 0;
    return query;
}

ProfileAlong readProfileAlong(const volume::BrickSource& source, const ProfileAlongQuery& query,
                              const Progress& progress) {
    const volume::DatasetInfo& info = source.info();
    ProfileAlong out{query, {}};
    const auto& [lo, hi] = query.shown;
    if (query.along.ofTime()) {
        out.points.push_back({lo, 0});
        for (const double place : query.along.places)
            if (place > lo && place < hi) out.points.push_back({place, 0});
        out.points.push_back({hi, 0});
        for (std::size_t i = 0; i < out.points.size(); ++i) {
            progress.advance(static_cast<double>(i) / static_cast<double>(out.points.size()));
            const double time = query.along.at(out.points[i].x, info.lattice.axes);
            const auto value =
                volume::probeAlong(source, query.channel, {&query.cursor, 1}, volume::timesAround(info.times, time));
            out.points[i].y = value.front().interpolated.value_or(std::nan(""));
        }
        return out;
    }
    std::vector<glm::dvec3> places;
    for (int i = 0; i < query.count; ++i) {
        out.points.push_back({std::lerp(lo, hi, static_cast<double>(i) / (query.count - 1)), 0});
        placeAlongAxis(places.emplace_back(query.cursor), query.along, out.points.back().x, info);
    }
    const auto values = volume::probeAlong(source, query.channel, places, volume::timesAround(info.times, query.time));
    for (std::size_t i = 0; i < values.size(); ++i) out.points[i].y = values[i].interpolated.value_or(std::nan(""));
    return out;
}

std::size_t HyperContent::place(int of) const {
    return static_cast<std::size_t>(std::ranges::find(channels, of) - channels.begin());
}

HyperContent hyperContent(const HyperSliceView& view, int channel, const Session& session,
                          const volume::DatasetInfo& info) {
    HyperContent out{.channel = channel, .channels = {channel}, .lined = {}, .levels = {}, .label = {}};
    const auto add = [&](int own) {
        if (std::ranges::find(out.channels, own) == out.channels.end()) out.channels.push_back(own);
    };
    ContourSettings lines = view.lines;
    if (lines.count > 0 && !info.parameters[static_cast<std::size_t>(info.channel(channel).parameter)].categorical &&
        lines.channel.empty())
        lines.channel = info.channel(channel).name; // these panels are not the renderer's: all lines are drawn here
    if (lines.count > 0) out.lined = contourChannel(info, lines, channel);
    if (out.lined) {
        add(*out.lined);
        out.levels = contourLevels(session, info, *out.lined, lines.count);
        out.label =
            volume::labelChannel(info, info.parameters[static_cast<std::size_t>(info.channel(*out.lined).parameter)]);
        if (out.label) add(*out.label);
    }
    if (session.selection.active())
        for (const std::string& name : vis::selectedChannels(session.selection))
            if (const auto own = info.findChannel(name)) add(*own);
    return out;
}

std::vector<std::uint8_t> panelImage(const volume::DatasetInfo& info, const Session& session,
                                     const HyperContent& content, const HyperValues& values) {
    const volume::Channel own = info.channel(content.channel);
    const vis::TransferFunction& function = transferOf(session, own.name);
    const Range range = vis::effectiveRange(function, info.channelRange(own));
    const vis::DoiFunction interest(session.selection, brushSpace(session, info));
    const bool brushed = session.selection.active();
    std::vector<std::optional<std::size_t>> asked; // of the answers, by what brushes ask for
    for (const std::string& name : interest.channels()) {
        const auto channel = info.findChannel(name);
        const std::size_t place = channel ? content.place(*channel) : values.values.size();
        asked.push_back(place < values.values.size() ? std::optional(place) : std::nullopt);
    }
    const glm::ivec2 cells = values.query.cells;
    std::vector<std::uint8_t> rgba(static_cast<std::size_t>(cells.x) * static_cast<std::size_t>(cells.y) * 4);
    parallelFor(static_cast<std::size_t>(cells.y), [&](std::size_t row) {
        const int j = cells.y - 1 - static_cast<int>(row);
        std::vector<double> of(asked.size());
        for (int i = 0; i < cells.x; ++i) {
            const double value = values.at(0, {i, j});
            if (std::isnan(value)) continue;
            glm::dvec4 color(glm::dvec3(vis::evaluate(function, range, value)), 1);
            if (brushed) {
                for (std::size_t k = 0; k < asked.size(); ++k)
                    of[k] = asked[k] ? values.at(*asked[k], {i, j}) : std::nan("");
                const glm::dvec3 position = values.positionOf({i, j}, info.lattice.axes);
                color = brushedColor(session.selection, glm::dvec3(color), interest(of, position),
                                     interest.holder(of, position));
            }
            std::uint8_t* pixel = &rgba[(row * static_cast<std::size_t>(cells.x) + static_cast<std::size_t>(i)) * 4];
            for (int k = 0; k < 4; ++k) pixel[k] = panelByte(color[k]);
        }
    });
    return rgba;
}

std::vector<volume::ContourLine> panelLines(const volume::DatasetInfo& info, const HyperContent& content,
                                            const HyperValues& values) {
    if (!content.lined || content.place(*content.lined) >= values.values.size()) return {};
    volume::PlaneValues plane{values.query.cells, values.values[content.place(*content.lined)], {}};
    if (content.label && content.place(*content.label) < values.values.size()) {
        const volume::Parts& parts =
            info.parameters[static_cast<std::size_t>(info.channel(*content.lined).parameter)].parts;
        for (const double label : values.values[content.place(*content.label)])
            plane.parts.push_back(
                std::isnan(label) ? 0 : static_cast<int>(parts.partOf(static_cast<int>(std::lround(label)))));
    }
    std::vector<volume::ContourLine> lines = volume::contourLines(plane, content.levels.values);
    for (volume::ContourLine& line : lines)
        for (glm::dvec2& point : line.points)
            for (int k = 0; k < 2; ++k) {
                const Range& shown = values.query.shown[static_cast<std::size_t>(k)];
                point[k] = std::lerp(shown.lo, shown.hi, (point[k] + 0.5) / values.query.cells[k]);
            }
    return lines;
}

PicturePlane planeOfPanel(const Session& session, const volume::DatasetInfo& info, const AxisPlaces& across,
                          const AxisPlaces& up) {
    const int normal = 3 - across.dimension - up.dimension;
    return planeAcross(across.dimension, up.dimension, normal,
                       info.lattice.axes.toSheet(normal, session.cursor[normal]));
}

std::vector<PlaneSection> panelSections(const Session& session, const volume::DatasetInfo& info,
                                        const AxisPlaces& across, const AxisPlaces& up) {
    if (across.ofTime() || up.ofTime()) return {};
    return planeSections(session, info, planeOfPanel(session, info, across, up));
}

} // namespace tessera::app
