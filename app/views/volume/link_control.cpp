#include "app/views/volume/link_control.h"

#include "app/pane/view_parts.h"
#include "app/session/shown_scene.h"
#include "app/ui/keys.h"
#include "app/ui/number_field.h"
#include "app/ui/time_text.h"
#include "app/ui/widgets.h"

#include <algorithm>

namespace tessera::app {

namespace {

constexpr const char* kMenu = "chain";

struct OwnedWords {
    const char *name, *help;
};
constexpr OwnedWords kWords[] = {{"Camera", "On: this view turns together with the other volume views"},
                                 {"Layers", "On: this view shows the layers that the other volume views show; off: "
                                            "the pane Layers lists those of this view once it was clicked"},
                                 {"Time", "On: this view shows the time of the timeline"}};
static_assert(std::size(kWords) == std::size(kOwned));

bool ownsAny(const VolumeView& view) {
    return std::ranges::any_of(kOwned, [&](Owned what) { return owns(view, what); });
}

std::string helpOf(const VolumeView& view) {
    std::string text;
    for (const bool own : {false, true}) {
        std::string names;
        for (const Owned what : kOwned)
            if (owns(view, what) == own)
                names += (names.empty() ? "" : ", ") + std::string(kWords[std::size_t(what)].name);
        if (names.empty()) continue;
        if (!text.empty()) text += "\n";
        text += (own ? "Of this view alone: " : "Shared with other views: ") + names;
    }
    return text;
}

/// Steps and a slider through the stored times.
void drawOwnTime(ViewContext& context, double& time) {
    const volume::DatasetInfo& info = context.source->info();
    const int last = static_cast<int>(info.times.size()) - 1;
    int index = info.nearestTime(time);
    const auto go = [&](int to) { time = info.times[static_cast<std::size_t>(std::clamp(to, 0, last))]; };
    if (iconButton(context, "back", icons::kStepBack, "Previous time", index > 0)) go(index - 1);
    ImGui::SameLine(0, em() * 0.2f);
    if (iconButton(context, "on", icons::kStepForward, "Next time", index < last)) go(index + 1);
    ImGui::SameLine(0, em() * 0.4f);
    std::string format; // of ImGui: without placeholders
    for (const char c : timeText(info, time)) format += c == '%' ? "%%" : std::string(1, c);
    ImGui::SetNextItemWidth(em() * 11);
    if (slider("##time", index, 0, last, format.c_str())) go(index);
    if (ImGui::IsItemHovered()) tooltip("Time of this view alone; the timeline and all numbers stay at theirs");
}

} // namespace

LinkControl::LinkControl(const ViewContext& context, const VolumeView& view, const PictureBox& picture)
    : context_(context), view_(view) {
    const float side = std::round(em() * 1.6f), gap = std::round(em() * 0.4f);
    size_ = {side, side};
    min_ = {picture.max().x - gap - side, picture.min.y + gap};
    const bool over = ImGui::IsWindowHovered(ImGuiHoveredFlags_AllowWhenBlockedByActiveItem);
    shown_ = context.takesInput() && picture.size.x > side * 4 && picture.size.y > side * 3 &&
             (over || ownsAny(view) || volumeViews(context.session) > 1 || ImGui::IsPopupOpen(kMenu));
}

void LinkControl::take() {
    if (!shown_) return;
    const ImVec2 before = ImGui::GetCursorScreenPos();
    ImGui::SetCursorScreenPos(min_);
    if (mouseArea("chain button", size_)) ImGui::OpenPopup(kMenu);
    hovered_ = ImGui::IsItemHovered();
    if (hovered_) tooltip((helpOf(view_) + "\nClick to change").c_str());
    ImGui::SetCursorScreenPos(before);
}

std::optional<std::pair<ImVec2, ImVec2>> LinkControl::draw(ImDrawList& list) const {
    if (!shown_) return std::nullopt;
    const bool own = ownsAny(view_);
    const Icon icon = own ? icons::kChainOff : icons::kChain;
    const ImVec2 max{min_.x + size_.x, min_.y + size_.y}, glyph = iconSize(context_, icon);
    list.AddRectFilled(min_, max, plotColors().backdrop, em() * 0.25f);
    if (hovered_) list.AddRectFilled(min_, max, palette().accentSoft, em() * 0.25f);
    ImFont* font = context_.iconFont ? context_.iconFont : ImGui::GetFont();
    const ImVec2 at{std::round(min_.x + (size_.x - glyph.x) / 2), std::round(min_.y + (size_.y - glyph.y) / 2)};
    list.AddText(font, context_.iconFont ? em() * 0.95f : em(), at, own ? palette().accent : plotColors().faint,
                 context_.iconFont ? icon.glyph : icon.word);
    return std::pair{min_, max};
}

void drawLinkMenu(ViewContext& context, VolumeView& view) {
    if (!ImGui::BeginPopup(kMenu)) return;
    if (escapePressed()) ImGui::CloseCurrentPopup();
    ImGui::TextDisabled("Shared with other views");
    for (const Owned what : kOwned) {
        const bool possible = what != Owned::Time || context.source->info().times.size() > 1 || view.time;
        bool shared = !owns(view, what);
        const OwnedWords& words = kWords[std::size_t(what)];
        ImGui::BeginDisabled(!possible);
        if (ImGui::Checkbox(words.name, &shared)) setOwned(context.session, view, what, !shared);
        ImGui::EndDisabled();
        if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
            tooltip(possible ? words.help : "These data have only one time");
    }
    if (view.time && context.source->info().times.size() > 1) {
        ImGui::Separator();
        drawOwnTime(context, *view.time);
    }
    ImGui::EndPopup();
}

} // namespace tessera::app
