#include "app/views/hyperslice/hyper_data.h"

#include "app/pane/view_parts.h"
#include "vis/formulas/colors.h"
#include "vis/optics/ray_setup.h"
#include "vis/scene/brush_effect.h"
#include "volume/base/parallel.h"
#include "volume/bricks/parts_bricks.h"
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

std::uint8_t byteOf(double share) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0, 1.0)));
}

} // namespace

double middleOf(Range range, int cell, int cells) {
    return std::lerp(range.lo, range.hi, (cell + 0.5) / cells);
}

glm::dvec3 HyperValues::positionOf(glm::ivec2 cell, const volume::AxisMaps& maps) const {
    glm::dvec3 position = query.cursor;
    for (int k = 0; k < 2; ++k) {
        const AxisPlaces& axis = query.axes[static_cast<std::size_t>(k)];
        if (!axis.ofTime())
            position[axis.dimension] =
                axis.at(middleOf(query.shown[static_cast<std::size_t>(k)], cell[k], query.cells[k]), maps);
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
    const volume::DatasetInfo& info = source.info();
    HyperValues out{query, {}};
    const auto [columns, rows] =
        std::pair{static_cast<std::size_t>(query.cells.x), static_cast<std::size_t>(query.cells.y)};
    out.values.assign(query.channels.size(), std::vector<double>(columns * rows, std::nan("")));
    // A line is of one time: along the axis of time there are as many lines as cells.
    const bool upright = query.axes[0].ofTime();
    const std::size_t line = upright ? 0 : 1, across = 1 - line;
    const int lines = query.cells[static_cast<int>(line)], length = query.cells[static_cast<int>(across)];
    std::atomic<int> done = 0;
    parallelFor(static_cast<std::size_t>(lines), [&](std::size_t k) {
        const double place = middleOf(query.shown[line], static_cast<int>(k), lines);
        glm::dvec3 start = query.cursor;
        placeAlongAxis(start, query.axes[line], place, info);
        const double time = query.axes[line].ofTime() ? query.axes[line].at(place, info.lattice.axes) : query.time;
        std::vector<glm::dvec3> places(static_cast<std::size_t>(length), start);
        for (int i = 0; i < length; ++i)
            placeAlongAxis(places[static_cast<std::size_t>(i)], query.axes[across],
                           middleOf(query.shown[across], i, length), info);
        for (std::size_t c = 0; c < query.channels.size(); ++c) {
            const auto found =
                volume::probeAlong(source, query.channels[c], places, volume::timesAround(info.times, time));
            for (std::size_t i = 0; i < found.size(); ++i)
                out.values[c][upright ? i * columns + k : k * columns + i] =
                    found[i].interpolated.value_or(std::nan(""));
        }
        progress.advance(static_cast<double>(++done) / lines);
    });
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
            for (int k = 0; k < 4; ++k) pixel[k] = byteOf(color[k]);
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

} // namespace tessera::app
