#include "app/pane/plot.h"
#include "app/pane/shown_plane.h"
#include "app/pane/view_parts.h"
#include "app/ui/fitted_text.h"
#include "app/ui/number_field.h"
#include "app/ui/ticks.h"
#include "app/ui/time_text.h"
#include "app/ui/widgets.h"
#include "app/views/timeline/keyframes.h"
#include "app/views/timeline/playback.h"
#include "volume/field/time_pair.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace tessera::app {

namespace {

constexpr float kTrack = 1.4f;       ///< em: least height of the track
constexpr float kNumbersFrom = 2.6f; ///< em: height of the track that has room for numbers below

struct TimelineCache : ViewCache {
    Playback playback;
    bool dragging = false;
};

void drawButtons(ViewContext& context, ToolRow& tools, const std::vector<double>& times, int index) {
    Session& session = context.session;
    const int last = static_cast<int>(times.size()) - 1;
    const bool many = last > 0;
    const float near = em() * 0.15f;
    const auto go = [&](int to) { session.time = times[static_cast<std::size_t>(std::clamp(to, 0, last))]; };
    const auto button = [&](const char* id, Icon icon, const char* help, bool enabled, bool lit = false,
                            float gap = 0) {
        return tools.next(iconButtonWidth(context, icon), gap) && iconButton(context, id, icon, help, enabled, lit);
    };
    if (button("first", icons::kFirst, "First time (Home)", many)) go(0);
    if (button("back", icons::kStepBack, "One step back (Left)", many, false, near)) go(index - 1);
    const bool playable = many || !session.animation.tracks.empty();
    const bool playing = session.animation.playing && playable;
    if (button("play", playing ? icons::kPause : icons::kPlay, playing ? "Pause (Space)" : "Play (Space)", playable,
               playing, near)) {
        session.animation.playing = !playing;
        // Play at the end of a single run starts it again.
        if (!playing && session.animation.loop == Loop::Once && index == last) go(0);
    }
    if (button("forward", icons::kStepForward, "One step forward (Right)", many, false, near)) go(index + 1);
    if (button("last", icons::kLast, "Last time (End)", many, false, near)) go(last);
}

/// Whether playing repeats, and how fast it is.
void drawPlaying(ViewContext& context, ToolRow& tools, bool many) {
    Animation& animation = context.session.animation;
    static constexpr Icon kLoopIcons[] = {icons::kOnce, icons::kRepeat, icons::kPingPong};
    static constexpr const char* kLoopHelp[] = {"Stops at the last time. Click to repeat.",
                                                "Repeats from the first time. Click to play back and forth.",
                                                "Plays back and forth. Click to stop at the last time."};
    const auto loop = static_cast<std::size_t>(animation.loop);
    if (tools.next(iconButtonWidth(context, kLoopIcons[loop]), em() * 0.8f) &&
        iconButton(context, "loop", kLoopIcons[loop], kLoopHelp[loop], many))
        animation.loop = static_cast<Loop>((loop + 1) % 3);
    if (!tools.next(em() * 7, em() * 0.15f)) return;
    ImGui::BeginDisabled(!many);
    ImGui::SetNextItemWidth(em() * 7);
    slider("##speed", animation.speed, 0.1f, 60, "%.3g steps/s", ImGuiSliderFlags_Logarithmic);
    ImGui::EndDisabled();
    if (ImGui::IsItemHovered()) tooltip("Stored times shown per second while playing");
}

/// The time under the mouse: any between the first and the last, but near a mark that stored time.
double timeUnder(const PlotFrame& frame, const std::vector<double>& times, ImVec2 mouse) {
    const double at = std::clamp(frame.data(mouse).x, times.front(), times.back());
    const volume::TimePair pair = volume::timesAround(times, at);
    const double nearest = times[static_cast<std::size_t>(pair.nearest())];
    return std::abs(frame.pixel(nearest, 0).x - mouse.x) < em() * 0.35f ? nearest : at;
}

/// "3 of 24", or "between 3 and 4 of 24".
std::string placeText(const std::vector<double>& times, double time) {
    const volume::TimePair pair = volume::timesAround(times, time);
    const std::string count = " of " + std::to_string(times.size());
    if (!pair.between()) return std::to_string(pair.earlier + 1) + count;
    return "between " + std::to_string(pair.earlier + 1) + " and " + std::to_string(pair.later + 1) + count;
}

/// Chooses the time axis: that of the data, or a quantity over time.
void chooseAxis(ViewContext& context, ToolRow& tools, const volume::DatasetInfo& info) {
    std::string& axis = context.session.data.axis;
    if (info.quantities.empty() && axis.empty()) return;
    if (!tools.next(em() * 7, em())) return;
    ImGui::SetNextItemWidth(em() * 7);
    if (ImGui::BeginCombo("##axis", axis.empty() ? "by time" : ("by " + axis).c_str())) {
        if (ImGui::Selectable(axis.empty() ? ("by " + info.timeName).c_str() : "as stored", axis.empty())) axis.clear();
        for (const volume::Quantity& quantity : info.quantities)
            if (ImGui::Selectable(("by " + quantity.name).c_str(), quantity.name == axis)) axis = quantity.name;
        ImGui::EndCombo();
    } else if (ImGui::IsItemHovered()) {
        tooltip("Time axis: a quantity that rises or falls throughout replaces the times; any other is listed first");
    }
}

/// Where a plane in space and time lies, and its angle. Of one that an equation says there is nothing to slide.
void drawPlace(Session& session, ToolRow& tools) {
    volume::TimeAxis& along = *session.data.timeAxis;
    if (along.equation) return;
    const std::string axis(volume::kSpaceAxisNames[std::size_t(along.axis)]);
    const auto share = [&](const char* id, double& value, const std::string& format, const char* tip) {
        if (!tools.next(em() * 11, em())) return;
        auto percent = static_cast<float>(value * 100);
        ImGui::SetNextItemWidth(em() * 11);
        if (slider(id, percent, 0, 100, format.c_str())) value = static_cast<double>(percent) / 100;
        if (ImGui::IsItemHovered()) tooltip(tip);
    };
    if (tools.next(em() * 11, em())) {
        auto degrees = static_cast<float>(along.degrees);
        ImGui::SetNextItemWidth(em() * 11);
        if (slider("##angle", degrees, -90, 90, (axis + " for time by %.0f\u00b0").c_str()))
            along.degrees = std::round(static_cast<double>(degrees));
        if (ImGui::IsItemHovered())
            tooltip("How far the axis is exchanged for time: 0 shows one time, 90 one place at all times; the data are "
                    "read again when you release the mouse");
    }
    share("##place", along.place, "plane at %.1f %% of " + axis,
          "Position of the plane along the axis; the data are read again when you release the mouse");
    if (std::abs(along.degrees) != 90)
        share("##time", along.time, "at %.1f %% of time", "When the plane is there, from the first time to the last");
}

/// The line of a track of this size. One without room for numbers below has the first and the last time beside it.
PlotFrame trackFrame(const volume::DatasetInfo& info, ImVec2 origin, ImVec2 size) {
    const bool low = size.y < em() * kNumbersFrom;
    const float pad = em() * 0.8f, y = std::round(origin.y + (low ? size.y / 2 : pad));
    PlotFrame frame{{origin.x + pad, y - em() * 0.5f},
                    {origin.x + size.x - pad, y + em() * 0.45f},
                    paddedRange({info.times.front(), info.times.back()}),
                    {0, 1}};
    const std::string first = timeValueText(info, info.times.front()), last = timeValueText(info, info.times.back());
    const float left = ImGui::CalcTextSize(first.c_str()).x, right = ImGui::CalcTextSize(last.c_str()).x;
    if (!low || frame.width() - left - right < em() * 5) return frame;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float top = std::round(y - em() / 2);
    draw.AddText({origin.x, top}, plotColors().faint, first.c_str());
    draw.AddText({std::round(origin.x + size.x - right), top}, plotColors().faint, last.c_str());
    frame.min.x += left;
    frame.max.x -= right;
    return frame;
}

/// The track: one mark per stored time, the knob at the time shown, physical time below or beside it.
void drawTrack(ViewContext& context, TimelineCache& cache, const volume::DatasetInfo& info, ImVec2 size) {
    Session& session = context.session;
    const std::vector<double>& times = info.times;
    const ImVec2 origin = ImGui::GetCursorScreenPos();
    if (size.x < em() * 4) return;
    mouseArea("track", size);
    const bool hovered = ImGui::IsItemHovered(), held = ImGui::IsItemActive();
    const PlotFrame frame = trackFrame(info, origin, size);
    const float y = frame.min.y + em() * 0.5f;
    if (held && times.size() > 1) {
        session.time = timeUnder(frame, times, ImGui::GetIO().MousePos);
        session.animation.playing = false;
        context.interacting = true;
    }
    if (hovered && ImGui::GetIO().MouseWheel != 0) {
        const int to = info.nearestTime(session.time) + (ImGui::GetIO().MouseWheel < 0 ? 1 : -1);
        session.time = times[static_cast<std::size_t>(std::clamp(to, 0, static_cast<int>(times.size()) - 1))];
    }
    cache.dragging = held;

    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const PlotColors colors = plotColors();
    const float knob = frame.pixel(std::clamp(session.time, times.front(), times.back()), 0).x;
    const float thick = em() * 0.2f;
    draw.AddRectFilled({frame.min.x, y - thick / 2}, {frame.max.x, y + thick / 2}, colors.grid, thick / 2);
    draw.AddRectFilled({frame.min.x, y - thick / 2}, {frame.max.x, y + thick / 2}, colors.frame, thick / 2);
    draw.AddRectFilled({frame.min.x, y - thick / 2}, {knob, y + thick / 2}, colors.cursor, thick / 2);
    // Marks closer than three pixels would be a grey bar.
    float previous = -1e9f;
    for (double time : times) {
        const float x = std::round(frame.pixel(time, 0).x) + 0.5f;
        if (x < previous + 3) continue;
        draw.AddLine({x, y - em() * 0.28f}, {x, y + em() * 0.28f}, colors.faint);
        previous = x;
    }
    draw.AddCircleFilled({knob, y}, em() * (hovered || held ? 0.48f : 0.4f), colors.cursor, 24);
    if (size.y >= em() * kNumbersFrom) drawAxis(draw, frame, AxisSide::Bottom, "", "", origin.x, origin.x + size.x);
    if (hovered && !held) {
        const double under = timeUnder(frame, times, ImGui::GetIO().MousePos);
        ImGui::SetTooltip("%s  (%s)", stateText(info, under, session.data.axis).c_str(),
                          placeText(times, under).c_str());
    }
}

/// A text among the tools.
void drawText(ToolRow& tools, const std::string& text, bool faint) {
    const float whole = ImGui::CalcTextSize(text.c_str()).x, least = std::min(whole, em() * 8);
    if (!tools.nextText(least, em())) return;
    ImGui::AlignTextToFramePadding();
    if (faint) ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    fittedText(text, tools.grow(least, whole) + 1);
    if (faint) ImGui::PopStyleColor();
}

/// The time shown, with quantities at that time. `track`: draws what comes before these.
void drawNow(Session& session, const volume::DatasetInfo& info, ToolRow& tools, const std::function<void()>& track) {
    if (info.times.size() > 1) {
        const double now = std::clamp(session.time, info.times.front(), info.times.back());
        drawText(tools, timeText(info, now), false);
        track();
        if (const std::string quantities = quantitiesText(info, now, session.data.axis); !quantities.empty())
            drawText(tools, quantities, false);
        drawText(tools, placeText(info.times, now), true);
    } else if (session.data.timeAxis) {
        if (const auto axis = info.timeAxis())
            drawText(tools, "Time runs along " + std::string(volume::kSpaceAxisNames[std::size_t(*axis)]) + ".", true);
        drawPlace(session, tools);
        if (info.plane) drawText(tools, planeText(info, *info.plane), true);
    } else {
        drawText(tools, "These data have only one time.", true);
    }
}

} // namespace

void drawTimelineView(ViewContext& context, const std::string& pane, TimelineView&) {
    if (!context.source) {
        drawHint("No data", "Plays data with several times.");
        return;
    }
    TimelineCache& cache = cacheOf<TimelineCache>(context, pane);
    const volume::DatasetInfo& info = context.source->info();
    Session& session = context.session;
    const bool many = info.times.size() > 1;
    const bool keyed = !session.animation.tracks.empty();
    if ((many || keyed) && session.animation.playing && !context.headless) {
        playOn(cache.playback, session, info.times, double(ImGui::GetIO().DeltaTime));
        context.answers.busy = true;
    }
    // A pane without room below the tools has the track among them.
    const bool among = many && ImGui::GetContentRegionAvail().y < ImGui::GetFrameHeightWithSpacing() + kTrack * em();
    {
        ToolRow tools(context);
        drawButtons(context, tools, info.times, info.nearestTime(session.time));
        const auto track = [&] {
            const float least = em() * 9;
            if (among && tools.nextText(least, em()))
                drawTrack(context, cache, info, {tools.grow(least, tools.room()), ImGui::GetFrameHeight()});
        };
        const bool scarce = among || tools.room() < em() * 48; // then the time comes before what is rarely changed
        if (scarce) drawNow(session, info, tools, track);
        drawPlaying(context, tools, many);
        if (!scarce) drawNow(session, info, tools, track);
        if (many) chooseAxis(context, tools, info);
        drawKeyframeButtons(context, tools);
    }
    // Rows of keys come before the numbers below the track; what has no room scrolls.
    const float rows = keyed ? keyframesHeight(session) : 0;
    const ImVec2 room = ImGui::GetContentRegionAvail();
    if (many && !among)
        drawTrack(context, cache, info, {room.x, std::clamp(room.y - rows, kTrack * em(), em() * 2.9f)});
    if (keyed) drawKeyframes(context, std::clamp(ImGui::GetContentRegionAvail().y, std::min(rows, em() * 2.4f), rows));
}

} // namespace tessera::app
