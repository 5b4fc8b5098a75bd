#include "app/views/timeline/keyframes.h"

#include "app/history/animated_session.h"
#include "app/history/edit_titles.h"
#include "app/history/parameter_path.h"
#include "app/pane/plot.h"
#include "app/pane/view_parts.h"
#include "app/session/session_json.h"
#include "app/session/shown_scene.h"
#include "app/ui/ticks.h"
#include "app/ui/widgets.h"
#include "codec/container/json_text.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tessera::app {

namespace {

constexpr const char* kCameraPaths[] = {"/camera/orientation", "/camera/target", "/camera/distance"};

float rowHeight() {
    return std::round(em() * 1.5f);
}

void moveTo(Session& session, double at) {
    session.animation.position = std::clamp(at, 0.0, session.animation.duration);
    session.animation.playing = false;
    applyTracks(session, session.animation.position);
}

std::string trackTitle(const Session& session, const std::string& path) {
    if (path == "/time") return "time of the data";
    std::string title = pathTitle(session, path);
    if (path.starts_with("/camera/")) title = "camera: " + path.substr(8);
    return title;
}

struct Row {
    float left, right, y; ///< pixels
    double duration;
    float x(double at) const { return left + static_cast<float>(at / duration) * (right - left); }
    double at(float pixel) const { return double((pixel - left) / std::max(1.0f, right - left)) * duration; }
};

void drawKeyMenu(Session& session, std::size_t track, std::size_t key, bool& removed) {
    Keyframe& frame = session.animation.tracks[track].keys[key];
    static constexpr const char* kNames[] = {"Constant until the next key", "Straight", "Slow start", "Slow end",
                                             "Slow start and end"};
    for (std::size_t i = 0; i < std::size(kNames); ++i)
        if (ImGui::MenuItem(kNames[i], nullptr, frame.easing == static_cast<Easing>(i)))
            frame.easing = static_cast<Easing>(i);
    ImGui::Separator();
    if (ImGui::MenuItem("Set to the current value"))
        frame.value = numbersAt(session, session.animation.tracks[track].path);
    if (ImGui::MenuItem("Go there")) moveTo(session, frame.at);
    removed = ImGui::MenuItem("Remove");
}

/// One parameter's keys.
void drawTrack(ViewContext& context, std::size_t index, const Row& row) {
    Session& session = context.session;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const PlotColors colors = plotColors();
    draw.AddLine({row.left, row.y}, {row.right, row.y}, colors.grid);
    std::size_t moved = 0, removedKey = 0;
    std::optional<double> movedTo; ///< also before the beginning, where the mouse is left of the row
    bool remove = false;
    const std::vector<Keyframe>& keys = session.animation.tracks[index].keys;
    for (std::size_t k = 0; k + 1 < keys.size(); ++k)
        if (keys[k].value != keys[k + 1].value)
            draw.AddLine({row.x(keys[k].at), row.y}, {row.x(keys[k + 1].at), row.y}, colors.faint, em() * 0.12f);
    for (std::size_t k = 0; k < keys.size(); ++k) {
        ImGui::PushID(static_cast<int>(k));
        const float x = row.x(keys[k].at), r = em() * 0.42f;
        ImGui::SetCursorScreenPos({x - r, row.y - r});
        mouseArea("key", {2 * r, 2 * r});
        const bool hovered = ImGui::IsItemHovered(), held = ImGui::IsItemActive();
        if (held && ImGui::IsMouseDragging(ImGuiMouseButton_Left, 2)) {
            moved = k;
            movedTo = row.at(ImGui::GetIO().MousePos.x);
            context.interacting = true;
        }
        if (hovered && !held) {
            std::string text = formatQuantity(keys[k].at, "s", 0.01) + ":";
            for (const double value : keys[k].value) text += " " + formatNumber(value);
            ImGui::SetTooltip("%s", text.c_str());
        }
        const float side = hovered || held ? r * 1.15f : r * 0.9f;
        const ImVec2 points[] = {{x, row.y - side}, {x + side, row.y}, {x, row.y + side}, {x - side, row.y}};
        draw.AddConvexPolyFilled(points, 4, keys[k].easing == Easing::Step ? colors.faint : colors.cursor);
        if (ImGui::BeginPopupContextItem("key menu")) {
            bool removed = false;
            drawKeyMenu(session, index, k, removed);
            if (removed) remove = true, removedKey = k;
            ImGui::EndPopup();
        }
        ImGui::PopID();
    }
    if (movedTo) {
        // A key cannot pass another one: the mouse would then hold the wrong one.
        const double gap = session.animation.duration * 1e-3;
        const double lo = moved > 0 ? keys[moved - 1].at + gap : 0,
                     hi = moved + 1 < keys.size() ? keys[moved + 1].at - gap : session.animation.duration;
        if (lo <= hi) moveKey(session.animation, index, moved, std::clamp(*movedTo, lo, hi));
    }
    if (remove) removeKey(session.animation, index, removedKey);
}

void addVariant(ViewContext& context, const std::string& path) {
    Session& session = context.session;
    const Json value = toJson(session)[Json::json_pointer(path)];
    CompareVariant variant;
    variant.changes[path] = value.is_string() ? value.get<std::string>() : jsonText(value);
    for (auto& [pane, view] : session.views)
        if (auto* compare = std::get_if<CompareView>(&view)) {
            if (compare->variants.empty()) compare->variants.emplace_back();
            compare->variants.push_back(variant);
            return;
        }
    CompareView compare;
    compare.variants = {{}, variant};
    addView(session, compare);
}

} // namespace

void drawKeyframeButtons(ViewContext& context, ToolRow& tools) {
    Session& session = context.session;
    Animation& animation = session.animation;
    const std::string pane = volumePane(session);
    const VolumeView* view = volumeView(session, pane);
    const bool own = view && view->camera;
    const std::string owner = own ? detail::joinPointer("/views", pane) : std::string();
    const std::string whose = own ? " of " + paneTitle(session, pane) : std::string();
    if (tools.next(buttonWidth("Set camera key"), em() * 1.5f)) {
        if (ImGui::Button("Set camera key"))
            for (const char* path : kCameraPaths) setKey(session, owner + path);
        if (ImGui::IsItemHovered())
            tooltip(("Set keyframes for the camera" + whose + " at the current time of the animation").c_str());
    }
    if (tools.next(buttonWidth("Set time key"), em() * 0.2f)) {
        if (ImGui::Button("Set time key")) setKey(session, "/time");
        if (ImGui::IsItemHovered())
            tooltip("Set a keyframe for the time shown; for other settings right-click their name");
    }
    if (animation.tracks.empty() || !tools.next(em() * 10.2f, em() * 0.8f)) return;
    ImGui::SetNextItemWidth(em() * 5);
    float position = static_cast<float>(animation.position), duration = static_cast<float>(animation.duration);
    if (ImGui::DragFloat("##position", &position, 0.02f, 0, duration, "at %.2f s", ImGuiSliderFlags_AlwaysClamp))
        moveTo(session, double(position));
    ImGui::SameLine(0, em() * 0.2f);
    ImGui::SetNextItemWidth(em() * 5);
    if (ImGui::DragFloat("##duration", &duration, 0.05f, 0.1f, 3600, "of %.2f s", ImGuiSliderFlags_AlwaysClamp))
        animation.duration = std::clamp(double(duration), 0.1, 3600.0);
}

float keyframesHeight(const Session& session) {
    return rowHeight() * static_cast<float>(session.animation.tracks.size() + 1) + em() * 0.5f;
}

void drawKeyframes(ViewContext& context, float height) {
    Session& session = context.session;
    ImGui::BeginChild("keyframes", {0, height});
    const ImVec2 origin = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x, names = std::min(em() * 12, width * 0.35f);
    Row row{origin.x + names + em(), origin.x + width - em(), origin.y + rowHeight() / 2, session.animation.duration};
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const PlotColors colors = plotColors();
    if (row.right - row.left > em() * 4) {
        // The ruler.
        ImGui::SetCursorScreenPos({row.left - em() * 0.5f, origin.y});
        mouseArea("ruler", {row.right - row.left + em(), rowHeight()});
        if (ImGui::IsItemActive()) {
            moveTo(session, row.at(ImGui::GetIO().MousePos.x));
            context.interacting = true;
        }
        const TickLabels ticks = tickLabels({0, session.animation.duration}, 8);
        for (std::size_t i = 0; i < ticks.values.size(); ++i) {
            const float x = row.x(ticks.values[i]);
            draw.AddLine({x, row.y + em() * 0.2f}, {x, row.y + em() * 0.6f}, colors.faint);
            const std::string text = ticks.texts[i] + (i + 1 == ticks.values.size() ? " s" : "");
            const float half = ImGui::CalcTextSize(text.c_str()).x / 2;
            draw.AddText({std::min(x - half, origin.x + width - 2 * half), row.y - em() * 0.8f}, colors.faint,
                         text.c_str());
        }
        const std::size_t count = session.animation.tracks.size();
        for (std::size_t i = 0; i < count && i < session.animation.tracks.size(); ++i) {
            row.y += rowHeight();
            ImGui::PushID(session.animation.tracks[i].path.c_str());
            const std::string title = trackTitle(session, session.animation.tracks[i].path);
            addFittedText(draw, {origin.x + em() * 0.4f, row.y - em() * 0.5f}, colors.text, title, names);
            drawTrack(context, i, row);
            ImGui::PopID();
        }
        const float x = row.x(session.animation.position);
        draw.AddLine({x, origin.y + em() * 0.6f}, {x, row.y + rowHeight() / 2}, colors.cursor, 1.5f);
        draw.AddTriangleFilled({x - em() * 0.35f, origin.y + em() * 0.3f}, {x + em() * 0.35f, origin.y + em() * 0.3f},
                               {x, origin.y + em() * 0.85f}, colors.cursor);
        ImGui::SetCursorScreenPos({origin.x, row.y + rowHeight() / 2});
        ImGui::Dummy({1, 1});
    }
    ImGui::EndChild();
}

std::function<void(const std::string&)> parameterMenu(ViewContext& context) {
    return [&context](const std::string& path) {
        Session& session = context.session;
        ImGui::TextDisabled("%s", path.c_str());
        ImGui::Separator();
        const bool keyable = !numbersAt(session, path).empty();
        const std::string at = formatQuantity(session.animation.position, "s", 0.01);
        if (ImGui::MenuItem(("Set a key at " + at).c_str(), nullptr, false, keyable)) setKey(session, path);
        auto& tracks = session.animation.tracks;
        const auto own =
            std::find_if(tracks.begin(), tracks.end(), [&](const Track& each) { return each.path == path; });
        if (ImGui::MenuItem("Remove its keys", nullptr, false, own != tracks.end())) tracks.erase(own);
        // A comparison shows what is shared.
        if (ImGui::MenuItem("Compare with another value", nullptr, false, !path.starts_with("/views/")))
            addVariant(context, path);
    };
}

} // namespace tessera::app
