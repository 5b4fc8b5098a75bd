#include "app/views/curves/profile_data.h"

#include "app/pane/axis_label.h"
#include "app/pane/view_parts.h"
#include "app/ui/ticks.h"
#include "app/ui/time_text.h"
#include "volume/reconstruct/probe.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace tessera::app {

namespace {

/// Distances along a line at which its places are read: half of them spread evenly over its length and half over the
/// cells it runs through, so that thin cells have places too. Uneven axes only.
std::vector<double> distancesOver(const std::vector<glm::dvec3>& corners, const volume::AxisMaps& axes, int samples) {
    struct Knot {
        double distance, weight; ///< from the start
    };
    std::vector<Knot> knots{{0, 0}};
    double length = 0, drawn = 0;
    const auto eachPart = [&](const auto& use) { // between planes of the axes a line is straight in the drawing, too
        for (std::size_t i = 1; i < corners.size(); ++i) {
            const glm::dvec3 from = corners[i - 1], way = corners[i] - from;
            std::vector<double> shares{0, 1};
            for (int axis = 0; axis < 3; ++axis)
                if (axes[axis] && way[axis] != 0)
                    for (const double plane : axes[axis]->planes())
                        if (const double at = (plane - from[axis]) / way[axis]; at > 0 && at < 1) shares.push_back(at);
            std::ranges::sort(shares);
            for (std::size_t k = 1; k < shares.size(); ++k) {
                const glm::dvec3 a = from + shares[k - 1] * way, b = from + shares[k] * way;
                use(glm::distance(a, b), glm::distance(axes.toSheet(a), axes.toSheet(b)));
            }
        }
    };
    eachPart([&](double own, double onSheet) { length += own, drawn += onSheet; });
    if (!(length > 0) || !(drawn > 0)) return std::vector<double>(static_cast<std::size_t>(std::max(samples, 0)), 0.0);
    eachPart([&](double own, double onSheet) {
        knots.push_back({knots.back().distance + own, knots.back().weight + (own / length + onSheet / drawn) / 2});
    });
    std::vector<double> out;
    std::size_t next = 1;
    for (int i = 0; i < samples; ++i) {
        const double wanted = knots.back().weight * i / std::max(1, samples - 1);
        while (next + 1 < knots.size() && knots[next].weight < wanted) ++next;
        const Knot &a = knots[next - 1], &b = knots[next];
        const double share =
            b.weight > a.weight ? std::clamp((wanted - a.weight) / (b.weight - a.weight), 0.0, 1.0) : 0;
        out.push_back(i + 1 == samples && i > 0 ? length : std::lerp(a.distance, b.distance, share));
    }
    return out;
}

/// The place of a polyline at a distance from its start.
glm::dvec3 placeAlong(const std::vector<glm::dvec3>& corners, double distance) {
    for (std::size_t i = 1; i < corners.size(); ++i) {
        const double own = glm::distance(corners[i - 1], corners[i]);
        if (distance <= own && own > 0) return glm::mix(corners[i - 1], corners[i], distance / own);
        distance -= own;
    }
    return corners.back();
}

} // namespace

Profile readProfile(const volume::BrickSource& source, const ProfileQuery& query, const Progress& progress) {
    const bool line = query.over == ProfileOver::Line;
    Profile out{.query = query,
                .distance = {},
                .positions = volume::alongPolyline(query.corners, query.samples),
                .times = line ? std::vector<double>{} : source.info().times,
                .values = {}};
    for (const volume::TimePair& time : query.times)
        if (line) out.times.push_back(volume::timeAt(source.info().times, time));
    double length = 0;
    for (std::size_t i = 1; i < query.corners.size(); ++i)
        length += glm::distance(query.corners[i - 1], query.corners[i]);
    for (std::size_t i = 0; i < out.positions.size(); ++i)
        out.distance.push_back(length * static_cast<double>(i) / std::max(1, query.samples - 1));
    if (const volume::AxisMaps& axes = source.info().lattice.axes; line && !axes.isEven() && query.corners.size() > 1) {
        out.distance = distancesOver(query.corners, axes, query.samples);
        for (std::size_t i = 0; i < out.positions.size(); ++i)
            out.positions[i] = placeAlong(query.corners, out.distance[i]);
    }
    const std::size_t rows = out.times.size();
    for (const int channel : query.channels) {
        std::vector<double>& values = out.values.emplace_back();
        for (std::size_t row = 0; row < rows; ++row) {
            progress.advance((static_cast<double>(out.values.size() - 1) + static_cast<double>(row) / double(rows)) /
                             static_cast<double>(query.channels.size()));
            const int t = static_cast<int>(row);
            const volume::TimePair time = line ? query.times[row] : volume::TimePair{t, t, 0};
            for (const volume::ProbeValue& value : volume::probeAlong(source, channel, out.positions, time))
                values.push_back(value.interpolated.value_or(std::nan("")));
        }
    }
    return out;
}

LineAxis lineAxis(const Session& session, const volume::DatasetInfo& info, const Profile& profile) {
    LineAxis out{"distance", {}, profile.distance, true};
    const double length = profile.distance.empty() ? 0 : profile.distance.back();
    const std::optional<int> time = info.timeAxis();
    const int axis = time.value_or(0);
    bool alongTime = false, alongSpace = false;
    for (const glm::dvec3& at : profile.positions)
        for (int a = 0; a < 3 && time; ++a)
            if (std::abs(at[a] - profile.positions.front()[a]) > 1e-9 * info.bounds.size()[a])
                (a == axis ? alongTime : alongSpace) = true;
    if (alongTime && alongSpace) {
        out = {"share of the line", {}, {}, false};
        for (const double distance : profile.distance) out.values.push_back(length > 0 ? distance / length : 0);
    } else if (alongTime) {
        const LengthUnit unit = axisLabels(session, info)[std::size_t(axis)].unit;
        out = {timeWord(info), unit.name, {}, false};
        for (const glm::dvec3& at : profile.positions) out.values.push_back(at[axis] * unit.perUnit);
    } else {
        const LengthUnit unit = suitableLength(info.lengthUnit, length);
        out.unit = unit.name;
        for (double& distance : out.values) distance *= unit.perUnit;
    }
    return out;
}

Table profileTable(const volume::DatasetInfo& info, const Session& session, const Profile& profile) {
    const bool several = profile.query.over == ProfileOver::Line && profile.times.size() > 1;
    const bool timed = profile.query.over != ProfileOver::Line || several;
    const LineAxis along = lineAxis(session, info, profile);
    Table table;
    if (timed) table.columns.push_back({.name = info.timeName, .unit = info.timeUnit});
    table.columns.push_back(along.distance ? TableColumn{.name = "distance", .unit = info.lengthUnit}
                                           : TableColumn{.name = along.title, .unit = along.unit});
    const int axes = info.plane ? 4 : 3; // a plane in space and time has a time at each place
    for (int axis = 0; axis < axes; ++axis)
        table.columns.push_back(axis < 3 ? TableColumn{.name = std::string(1, "xyz"[axis]), .unit = info.lengthUnit}
                                         : TableColumn{.name = timeWord(info), .unit = info.timeUnit});
    const std::size_t first = table.columns.size(), places = profile.positions.size();
    const std::vector<std::string> names = stateNames(info, profile.times);
    std::vector<std::string> states;
    for (const int channel : profile.query.channels)
        table.columns.push_back({.name = info.channel(channel).name, .unit = info.channel(channel).unit});
    for (std::size_t row = 0; row < (timed ? profile.times.size() : 1); ++row)
        for (std::size_t i = 0; i < places; ++i) {
            std::size_t column = 0;
            if (several) states.push_back(names[row]);
            const auto add = [&](double value) { table.columns[column++].numbers.push_back(value); };
            if (timed) add(profile.times[row]);
            add(along.distance ? profile.distance[i] : along.values[i]);
            const glm::dvec4 point = info.pointAt(profile.positions[i], profile.times[row]);
            for (int axis = 0; axis < axes; ++axis) add(point[axis]);
            for (; column < first + profile.values.size();) add(profile.values[column - first][row * places + i]);
        }
    if (several) table.columns.insert(table.columns.begin() + 1, {.name = "state", .texts = std::move(states)});
    return table;
}

std::vector<std::uint8_t> profileImage(const volume::DatasetInfo& info, const Session& session, const Profile& profile,
                                       std::size_t channel) {
    const volume::Channel own = info.channel(profile.query.channels[channel]);
    const vis::TransferFunction& function = transferOf(session, own.name);
    const Range range = vis::effectiveRange(function, info.channelRange(own));
    const std::size_t places = profile.positions.size();
    std::vector<std::uint8_t> rgba(places * profile.times.size() * 4);
    for (std::size_t row = 0; row < profile.times.size(); ++row)
        for (std::size_t i = 0; i < places; ++i) {
            const double value = profile.values[channel][(profile.times.size() - 1 - row) * places + i];
            if (std::isnan(value)) continue;
            const glm::dvec4 color = vis::evaluate(function, range, value);
            std::uint8_t* pixel = &rgba[(row * places + i) * 4];
            for (int k = 0; k < 3; ++k)
                pixel[k] = static_cast<std::uint8_t>(std::lround(255 * std::clamp(color[k], 0.0, 1.0)));
            pixel[3] = 255;
        }
    return rgba;
}

namespace {

constexpr int kLeastRows = 256; ///< of a figure over time: as even as a line's samples

/// The picture of a parameter along the line at every time, each as high as the time axis has it: half way to the times
/// before and after it.
PlotImage imageOverTime(const volume::DatasetInfo& info, const Session& session, const Profile& profile,
                        std::size_t channel) {
    const std::vector<std::uint8_t> rows = profileImage(info, session, profile, channel);
    const std::vector<double>& times = profile.times;
    const std::size_t bytes = profile.positions.size() * 4;
    PlotImage image{
        static_cast<int>(profile.positions.size()), std::max(kLeastRows, static_cast<int>(times.size())), {}};
    for (int row = 0; row < image.height; ++row) {
        const double time = std::lerp(times.back(), times.front(), (row + 0.5) / image.height);
        const std::size_t stored = times.size() - 1 - static_cast<std::size_t>(info.nearestTime(time));
        const auto from = rows.begin() + static_cast<std::ptrdiff_t>(stored * bytes);
        image.rgba.insert(image.rgba.end(), from, from + static_cast<std::ptrdiff_t>(bytes));
    }
    return image;
}

} // namespace

std::vector<Plot> profilePlots(const volume::DatasetInfo& info, const Session& session, const Profile& profile,
                               bool dark) {
    const ProfileOver over = profile.query.over;
    const LineAxis along = lineAxis(session, info, profile);
    const auto [least, most] = std::ranges::minmax(along.values);
    const PlotAxis distance{.title = along.title, .range = {least, most}, .unit = along.unit};
    const PlotAxis time{
        .title = timeWord(info), .range = {info.times.front(), info.times.back()}, .unit = info.timeUnit};
    const std::vector<std::string> names = stateNames(info, profile.times);
    std::vector<Plot> plots;
    for (std::size_t c = 0; c < profile.values.size(); ++c) {
        const volume::Channel own = info.channel(profile.query.channels[c]);
        Plot& plot = plots.emplace_back();
        plot.x = over == ProfileOver::Time ? time : distance;
        if (over == ProfileOver::LineAndTime) {
            plot.title = titleWithUnit(own.name, own.unit);
            plot.y = time;
            continue;
        }
        plot.y = {.title = own.name, .range = paddedRange(info.channelRange(own), 0.05), .unit = own.unit};
        if (over == ProfileOver::Time) {
            PlotSeries& line = plot.series.emplace_back(PlotSeries{own.name, {}, plotInk(0, dark)});
            for (std::size_t i = 0; i < profile.times.size(); ++i)
                line.points.push_back({profile.times[i], profile.values[c][i]});
            continue;
        }
        const std::size_t count = profile.times.size(), places = along.values.size();
        for (std::size_t row = 0; row < count; ++row) {
            PlotSeries& line = plot.series.emplace_back(PlotSeries{
                count > 1 ? names[row] : own.name, {}, count > 1 ? stateInk(row, count, dark) : plotInk(0, dark)});
            for (std::size_t i = 0; i < places; ++i)
                line.points.push_back({along.values[i], profile.values[c][row * places + i]});
        }
    }
    return plots;
}

std::optional<std::size_t> markedPlace(const volume::DatasetInfo& info, const Session& session,
                                       const Profile& profile) {
    if (profile.query.over == ProfileOver::Time) return static_cast<std::size_t>(info.nearestTime(session.time));
    std::optional<std::size_t> place;
    double nearest = profile.distance.back() / static_cast<double>(profile.distance.size());
    for (std::size_t i = 0; i < profile.positions.size(); ++i)
        if (const double away = glm::distance(profile.positions[i], session.cursor); away <= nearest) {
            nearest = away;
            place = i;
        }
    return place;
}

void markPlots(std::vector<Plot>& plots, const volume::DatasetInfo& info, const Session& session,
               const Profile& profile, std::optional<std::size_t> place) {
    for (Plot& plot : plots) {
        const bool picture = plot.series.empty();
        if (picture) plot.cursorY = session.time;
        if (!place) continue;
        if (picture) {
            plot.cursorX = lineAxis(session, info, profile).values[*place];
            continue;
        }
        for (PlotSeries& line : plot.series) {
            const glm::dvec2 at = line.points[*place];
            plot.cursorX = at.x;
            if (plot.series.size() == 1) plot.cursorY = at.y;
            line.value = formatNumber(at.y, (plot.y.range.hi - plot.y.range.lo) / 1100);
        }
    }
}

VectorPage profileDrawing(const volume::DatasetInfo& info, const Session& session, const Profile& profile,
                          const PageForm& form) {
    std::vector<Plot> plots = profilePlots(info, session, profile, form.dark);
    for (std::size_t c = 0; c < plots.size() && profile.query.over == ProfileOver::LineAndTime; ++c) {
        plots[c].image = imageOverTime(info, session, profile, c);
        const LegendEntry legend = legendOf(session, info, profile.query.channels[c]);
        plots[c].key = colorKey(legend.function, legend.range);
    }
    markPlots(plots, info, session, profile, markedPlace(info, session, profile));
    return plotPage(plots, 0, form);
}

} // namespace tessera::app
