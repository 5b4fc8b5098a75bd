#include "app/views/curves/profile_data.h"

#include "app/pane/axis_label.h"
#include "app/pane/figure.h"
#include "app/pane/view_parts.h"
#include "app/ui/ticks.h"
#include "app/ui/time_text.h"
#include "volume/reconstruct/probe.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace tessera::app {

Profile readProfile(const volume::BrickSource& source, const ProfileQuery& query, const Progress& progress) {
    const bool line = query.over == ProfileOver::Line;
    Profile out{.query = query,
                .distance = {},
                .positions = volume::alongPolyline(query.corners, query.samples),
                .times = line ? std::vector<double>{} : source.info().times,
                .values = {}};
    double length = 0;
    for (std::size_t i = 1; i < query.corners.size(); ++i)
        length += glm::distance(query.corners[i - 1], query.corners[i]);
    for (std::size_t i = 0; i < out.positions.size(); ++i)
        out.distance.push_back(length * static_cast<double>(i) / std::max(1, query.samples - 1));
    const std::size_t rows = line ? 1 : out.times.size();
    for (const int channel : query.channels) {
        std::vector<double>& values = out.values.emplace_back();
        for (std::size_t row = 0; row < rows; ++row) {
            progress.advance((static_cast<double>(out.values.size() - 1) + static_cast<double>(row) / double(rows)) /
                             static_cast<double>(query.channels.size()));
            const int t = static_cast<int>(row);
            const volume::TimePair time = line ? query.time : volume::TimePair{t, t, 0};
            for (const volume::ProbeValue& value : volume::probeAlong(source, channel, out.positions, time))
                values.push_back(value.interpolated.value_or(std::nan("")));
        }
    }
    return out;
}

LineAxis lineAxis(const Session& session, const volume::DatasetInfo& info, const Profile& profile) {
    LineAxis out{"distance", {}, profile.distance, true};
    const double length = profile.distance.empty() ? 0 : profile.distance.back();
    const auto& time = session.data.timeAxis;
    const int axis = time ? static_cast<int>(time->axis) : 0;
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

std::string profileCsv(const volume::DatasetInfo& info, const Session& session, const Profile& profile) {
    const std::vector<volume::Channel> channels = info.channels();
    const bool timed = profile.query.over != ProfileOver::Line;
    const LineAxis along = lineAxis(session, info, profile);
    std::string csv = timed ? csvField(titleWithUnit(info.timeName, info.timeUnit)) + "," : std::string();
    csv += along.distance ? csvField(titleWithUnit("distance", info.lengthUnit))
                          : csvField(titleWithUnit(along.title, along.unit));
    glm::dvec3 perUnit(1); // shown in the unit of the data, times as times
    for (int axis = 0; axis < 3; ++axis) {
        const bool time = session.data.timeAxis && static_cast<int>(session.data.timeAxis->axis) == axis;
        const AxisLabel label = time ? axisLabels(session, info)[std::size_t(axis)] : AxisLabel{};
        if (time) perUnit[axis] = label.unit.perUnit;
        csv += "," + (time ? csvField(titleWithUnit(label.name, label.unit.name)) : std::string(1, "xyz"[axis]));
    }
    for (const int channel : profile.query.channels) {
        const volume::Channel& own = channels[static_cast<std::size_t>(channel)];
        csv += "," + csvField(titleWithUnit(own.name, own.unit));
    }
    csv += "\n";
    const std::size_t places = profile.positions.size(), rows = timed ? profile.times.size() : 1;
    for (std::size_t row = 0; row < rows; ++row)
        for (std::size_t i = 0; i < places; ++i) {
            if (timed) csv += csvNumber(profile.times[row]) + ",";
            csv += csvNumber(along.distance ? profile.distance[i] : along.values[i]);
            for (int axis = 0; axis < 3; ++axis) csv += "," + csvNumber(profile.positions[i][axis] * perUnit[axis]);
            for (const std::vector<double>& values : profile.values) csv += "," + csvNumber(values[row * places + i]);
            csv += "\n";
        }
    return csv;
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
FigureImage imageOverTime(const volume::DatasetInfo& info, const Session& session, const Profile& profile,
                          std::size_t channel) {
    const std::vector<std::uint8_t> rows = profileImage(info, session, profile, channel);
    const std::vector<double>& times = profile.times;
    const std::size_t bytes = profile.positions.size() * 4;
    FigureImage image{
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

VectorPage profileDrawing(const volume::DatasetInfo& info, const Session& session, const Profile& profile) {
    const std::vector<volume::Channel> channels = info.channels();
    const bool overTime = profile.query.over == ProfileOver::Time;
    const LineAxis along = lineAxis(session, info, profile);
    const auto [least, most] = std::ranges::minmax(along.values);
    const FigureAxis distance{titleWithUnit(along.title, along.unit), {least, most}};
    const auto timeAxis = [&] { return FigureAxis{timeTitle(info), {info.times.front(), info.times.back()}}; };
    std::vector<FigurePanel> panels;
    for (std::size_t c = 0; c < profile.values.size(); ++c) {
        const volume::Channel& own = channels[static_cast<std::size_t>(profile.query.channels[c])];
        const Range range = info.channelRange(own);
        FigurePanel panel;
        panel.x = overTime ? timeAxis() : distance;
        if (profile.query.over == ProfileOver::LineAndTime) {
            panel.title = titleWithUnit(own.name, own.unit);
            panel.y = timeAxis();
            panel.image = imageOverTime(info, session, profile, c);
        } else {
            panel.y = {titleWithUnit(own.name, own.unit), paddedRange(range, 0.03)};
            FigureSeries line{own.name, {}, {0.1f, 0.36f, 0.62f}};
            const std::vector<double>& across = profile.across();
            for (std::size_t i = 0; i < across.size(); ++i)
                line.points.push_back({overTime ? across[i] : along.values[i], profile.values[c][i]});
            panel.series.push_back(std::move(line));
        }
        panels.push_back(std::move(panel));
    }
    return drawingOf(panels, 2);
}

ImVec2 freeCorner(const PlotFrame& frame, ImVec2 size, const std::vector<ImVec2>& line) {
    ImVec2 best{0, 0};
    std::ptrdiff_t least = std::numeric_limits<std::ptrdiff_t>::max();
    for (const ImVec2 corner : {ImVec2{0, 0}, {0, 1}, {1, 0}, {1, 1}}) {
        const ImVec2 lo{frame.min.x + (frame.width() - size.x) * corner.x,
                        frame.min.y + (frame.height() - size.y) * corner.y};
        const auto hidden = std::ranges::count_if(line, [&](ImVec2 at) {
            return at.x >= lo.x && at.y >= lo.y && at.x <= lo.x + size.x && at.y <= lo.y + size.y;
        });
        if (hidden >= least) continue;
        least = hidden;
        best = corner;
    }
    return best;
}

} // namespace tessera::app
