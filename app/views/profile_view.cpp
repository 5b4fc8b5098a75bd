#include "app/views/brush_edit.h"
#include "app/views/figure.h"
#include "app/views/profile_line.h"
#include "app/views/ticks.h"
#include "app/views/view_parts.h"
#include "volume/error.h"
#include "volume/probe.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tessera::app {

namespace {

constexpr std::size_t kMostPlots = 8; ///< where the user has not chosen

/// What is asked for; equal wishes have equal answers.
struct Wish {
    std::vector<int> channels;
    std::vector<glm::dvec3> corners;
    int samples = 0;
    volume::TimePair time;
    bool operator==(const Wish&) const = default;
};

struct Profile {
    Wish wish;
    std::vector<double> distance; ///< along the line, in the data's length unit
    std::vector<glm::dvec3> positions;
    std::vector<std::vector<double>> values; ///< by channel; NaN where absent
};

Profile compute(const volume::BrickSource& source, const Wish& wish, const Progress& progress) {
    Profile out{wish, {}, volume::alongPolyline(wish.corners, wish.samples), {}};
    double length = 0;
    for (std::size_t i = 1; i < wish.corners.size(); ++i) length += glm::distance(wish.corners[i - 1], wish.corners[i]);
    for (std::size_t i = 0; i < out.positions.size(); ++i)
        out.distance.push_back(length * static_cast<double>(i) / std::max(1, wish.samples - 1));
    for (const int channel : wish.channels) {
        progress.advance(static_cast<double>(out.values.size()) / static_cast<double>(wish.channels.size()));
        std::vector<double>& values = out.values.emplace_back();
        for (const volume::ProbeValue& value : volume::probeAlong(source, channel, out.positions, wish.time))
            values.push_back(value.interpolated.value_or(std::nan("")));
    }
    return out;
}

struct ProfileCache : ViewCache {
    std::shared_ptr<const Profile> profile;
    std::optional<Wish> running, failed;
};

/// The profile as wished, or the last one while it is computed.
void update(ViewContext& context, ProfileCache& cache, const std::string& pane, const Wish& wish) {
    if ((cache.profile && cache.profile->wish == wish) || cache.failed == wish) return;
    if (context.headless) {
        try {
            cache.profile = std::make_shared<const Profile>(compute(*context.source, wish, {}));
        } catch (const Error&) {
            cache.failed = wish;
        }
        return;
    }
    context.busy = true;
    const std::string key = "profile " + pane;
    if (cache.running && context.jobs.running(key)) return; // the next one when this is here: a drag shows all the time
    cache.running = wish;
    context.jobs.start(
        key, "Line profile",
        [&context = context.caches, source = context.source, pane, wish](const Progress& progress) -> Jobs::Finish {
            std::shared_ptr<const Profile> made;
            std::string failure;
            try {
                made = std::make_shared<const Profile>(compute(*source, wish, progress));
            } catch (const Error& error) {
                failure = error.what();
            }
            return [&context, pane, made, wish, failure] {
                const auto found = context.find(pane);
                auto* own = found == context.end() ? nullptr : dynamic_cast<ProfileCache*>(found->second.get());
                if (!own) return;
                own->running.reset();
                if (made) {
                    own->profile = made;
                    return;
                }
                own->failed = wish; // not tried again every frame
                throw Error(failure);
            };
        },
        true);
}

std::string profileCsv(const volume::DatasetInfo& info, const Profile& profile) {
    const std::vector<volume::Channel> channels = info.channels();
    std::string csv = "distance [" + info.lengthUnit + "],x,y,z";
    for (const int channel : profile.wish.channels) {
        const volume::Channel& own = channels[static_cast<std::size_t>(channel)];
        csv += "," + csvField(titleWithUnit(own.name, own.unit));
    }
    csv += "\n";
    for (std::size_t i = 0; i < profile.distance.size(); ++i) {
        csv += csvNumber(profile.distance[i]);
        for (int axis = 0; axis < 3; ++axis) csv += "," + csvNumber(profile.positions[i][axis]);
        for (const std::vector<double>& values : profile.values) csv += "," + csvNumber(values[i]);
        csv += "\n";
    }
    return csv;
}

std::string profileSvg(const volume::DatasetInfo& info, const Profile& profile) {
    const std::vector<volume::Channel> channels = info.channels();
    const LengthUnit unit = suitableLength(info.lengthUnit, profile.distance.back());
    std::vector<FigurePanel> panels;
    for (std::size_t c = 0; c < profile.values.size(); ++c) {
        const volume::Channel& own = channels[static_cast<std::size_t>(profile.wish.channels[c])];
        FigurePanel panel;
        panel.x = {"distance [" + unit.name + "]", {0, profile.distance.back() * unit.perUnit}};
        panel.y = {titleWithUnit(own.name, own.unit), paddedRange(info.channelRange(own), 0.03)};
        FigureSeries line{own.name, {}, {0.1f, 0.36f, 0.62f}};
        for (std::size_t i = 0; i < profile.distance.size(); ++i)
            line.points.push_back({profile.distance[i] * unit.perUnit, profile.values[c][i]});
        panel.series.push_back(std::move(line));
        panels.push_back(std::move(panel));
    }
    return figureSvg(panels, 2);
}

void drawToolbar(ViewContext& context, ProfileCache& cache, ProfileView& view, const std::vector<int>& shown) {
    Session& session = context.session;
    const volume::DatasetInfo& info = context.source->info();
    chooseChannels(info, view.channels, shown);
    ImGui::SameLine();
    if (ImGui::Button("Corner at cursor")) {
        view.points.push_back(session.cursor);
    }
    if (ImGui::IsItemHovered())
        tooltip(
            "Adds a corner of the line at the linked cursor; double-click in the volume or drag in a slice moves it");
    ImGui::SameLine();
    if (ImGui::Button("Axis")) ImGui::OpenPopup("axis");
    if (ImGui::IsItemHovered()) tooltip("A straight line along an axis through the cursor");
    if (ImGui::BeginPopup("axis")) {
        for (int axis = 0; axis < 3; ++axis) {
            const char name[] = {"xyz"[axis], 0};
            if (!ImGui::MenuItem(name)) continue;
            view.points = {session.cursor, session.cursor};
            view.points[0][axis] = info.bounds.lo[axis];
            view.points[1][axis] = info.bounds.hi[axis];
        }
        ImGui::EndPopup();
    }
    ImGui::SameLine();
    if (iconButton(context, "clear", icons::kTrash, "Follow the cursor along the longest axis again",
                   !view.points.empty()))
        view.points.clear();
    if (cache.profile && cache.profile->distance.size() > 1) {
        ImGui::SameLine();
        const auto profile = cache.profile;
        exportMenu(
            context, "profile", [info, profile](const Progress&) { return profileSvg(info, *profile); },
            [info, profile](const Progress&) { return profileCsv(info, *profile); });
    }
    if (view.points.size() == 1) {
        ImGui::SameLine();
        ImGui::TextDisabled("one corner more");
    }
}

/// One parameter along the line.
void drawLine(ViewContext& context, const volume::Channel& channel, Range range, const Profile& profile, std::size_t c,
              const PlotFrame& frame, std::optional<std::size_t> marked) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const PlotColors colors = plotColors();
    const LengthUnit unit = suitableLength(context.source->info().lengthUnit, profile.distance.back());
    const std::vector<double>& values = profile.values[c];
    draw.PushClipRect(frame.min, frame.max, true);
    std::vector<ImVec2> run;
    const auto flush = [&] {
        if (run.size() > 1)
            draw.AddPolyline(run.data(), static_cast<int>(run.size()), focusColor({}), 0, std::max(1.2f, em() * 0.11f));
        else if (run.size() == 1)
            draw.AddCircleFilled(run.front(), em() * 0.12f, focusColor({}));
        run.clear();
    };
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (std::isnan(values[i]))
            flush();
        else
            run.push_back(frame.pixel(profile.distance[i] * unit.perUnit, values[i]));
    }
    flush();
    if (marked) drawCrosshair(draw, frame, profile.distance[*marked] * unit.perUnit, values[*marked]);
    draw.PopClipRect();
    draw.AddRect(frame.min, frame.max, colors.frame);
    drawAxis(draw, frame, AxisSide::Left, "", "", frame.min.y - em() * 0.3f, frame.max.y + em() * 0.3f);
    std::string title = titleWithUnit(channel.name, channel.unit);
    if (marked) title += "  " + formatNumber(values[*marked], (range.hi - range.lo) / 1000);
    addTextWithBackdrop(draw, {frame.min.x + em() * 0.4f, frame.min.y + em() * 0.2f}, {0, 0}, colors.text,
                        fitText(title, frame.width() - em()).c_str());
}

} // namespace

void drawProfileView(ViewContext& context, const std::string& pane, ProfileView& view) {
    if (!context.source) {
        drawHint("No data", "Parameters along a line in space appear here.");
        return;
    }
    const volume::DatasetInfo& info = context.source->info();
    ProfileCache& cache = cacheOf<ProfileCache>(context, pane);
    const std::vector<int> shown = chosenChannels(info, view.channels, kMostPlots);
    drawToolbar(context, cache, view, shown);
    if (shown.empty()) return drawHint("No parameters", "This data set holds only labels.");
    const Wish wish{shown, profileCorners(view, context.session, info.bounds), std::clamp(view.samples, 2, 4096),
                    volume::timesAround(info.times, context.session.time)};
    update(context, cache, pane, wish);
    if (!cache.profile || cache.profile->distance.size() < 2 || !(cache.profile->distance.back() > 0)) {
        drawHint(cache.failed ? "The data cannot be read here" : "The line has no length",
                 "Place a corner, move the cursor, and place another.");
        return;
    }
    const Profile& profile = *cache.profile;
    const LengthUnit unit = suitableLength(info.lengthUnit, profile.distance.back());
    const Range along{0, profile.distance.back() * unit.perUnit};
    const ImVec2 origin = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
    const std::vector<volume::Channel> channels = info.channels();
    float left = 0;
    for (const int channel : profile.wish.channels)
        left = std::max(
            left, axisRoom(AxisSide::Left,
                           paddedRange(info.channelRange(channels[static_cast<std::size_t>(channel)]), 0.06), false));
    const float bottom = axisRoom(AxisSide::Bottom, along, true);
    const auto plots = static_cast<float>(profile.values.size());
    const float height = (room.y - bottom - em() * 0.4f) / std::max(1.0f, plots);
    if (height < em() * 1.6f || room.x - left < em() * 4) {
        drawHint("Not enough room", "Enlarge the pane or choose fewer parameters.");
        return;
    }
    // The place under the mouse, or that of the cursor where it lies near the line.
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const float x0 = origin.x + left, x1 = origin.x + room.x - em() * 0.6f;
    const bool over = ImGui::IsWindowHovered() && mouse.x >= x0 && mouse.x < x1 && mouse.y >= origin.y &&
                      mouse.y < origin.y + room.y - bottom;
    std::optional<std::size_t> marked;
    if (over) {
        const double share = static_cast<double>((mouse.x - x0) / (x1 - x0));
        marked = static_cast<std::size_t>(std::lround(share * static_cast<double>(profile.distance.size() - 1)));
        if (ImGui::IsMouseClicked(ImGuiMouseButton_Left)) context.session.cursor = profile.positions[*marked];
    } else {
        double nearest = profile.distance.back() / static_cast<double>(profile.distance.size());
        for (std::size_t i = 0; i < profile.positions.size(); ++i)
            if (const double away = glm::distance(profile.positions[i], context.session.cursor); away <= nearest) {
                nearest = away;
                marked = i;
            }
    }
    for (std::size_t c = 0; c < profile.values.size(); ++c) {
        const volume::Channel& channel = channels[static_cast<std::size_t>(profile.wish.channels[c])];
        const Range range = info.channelRange(channel);
        const float top = origin.y + em() * 0.2f + height * static_cast<float>(c);
        const PlotFrame frame{
            {x0, std::round(top)}, {x1, std::round(top + height - em() * 0.4f)}, along, paddedRange(range, 0.06)};
        drawLine(context, channel, range, profile, c, frame, marked);
        if (c + 1 == profile.values.size())
            drawAxis(*ImGui::GetWindowDrawList(), frame, AxisSide::Bottom, "distance", unit.name, origin.x,
                     origin.x + room.x);
    }
}

} // namespace tessera::app
