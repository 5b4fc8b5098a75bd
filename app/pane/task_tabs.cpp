#include "app/pane/task_tabs.h"

#include "app/pane/plot.h"
#include "app/ui/theme.h"
#include "app/ui/widgets.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace tessera::app {

namespace {

/// How a tab is drawn.
enum class TabFace { Name, Icon };

struct TabWidths {
    std::vector<TabFace> faces;
    std::vector<float> widths; ///< least ones, pixels
    float total() const { return std::accumulate(widths.begin(), widths.end(), 0.0f); }
};

TabWidths widthsOf(const ViewContext& context, std::span<const TaskTab> tabs, auto&& faceOf) {
    TabWidths out;
    for (std::size_t i = 0; i < tabs.size(); ++i) {
        out.faces.push_back(faceOf(i));
        const float inner =
            out.faces[i] == TabFace::Name ? ImGui::CalcTextSize(tabs[i].name).x : iconSize(context, tabs[i].icon).x;
        out.widths.push_back(std::ceil(inner + em() * 0.6f));
    }
    return out;
}

/// Names; the name of the tab in front and icons; icons alone: the first that has room in one row.
TabWidths chooseFaces(const ViewContext& context, std::span<const TaskTab> tabs, std::size_t front, float room) {
    TabWidths names = widthsOf(context, tabs, [](std::size_t) { return TabFace::Name; });
    if (!context.iconFont || names.total() <= room) return names;
    TabWidths mixed =
        widthsOf(context, tabs, [&](std::size_t i) { return i == front ? TabFace::Name : TabFace::Icon; });
    return mixed.total() <= room ? mixed : widthsOf(context, tabs, [](std::size_t) { return TabFace::Icon; });
}

/// The face of the tab, which was the last item.
void drawFace(const ViewContext& context, const TaskTab& tab, TabFace face, bool front) {
    const ImVec2 lo = ImGui::GetItemRectMin(), hi = ImGui::GetItemRectMax();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const bool icon = face == TabFace::Icon;
    ImFont* const font = icon ? context.iconFont : ImGui::GetFont();
    const char* const text = icon ? tab.icon.glyph : tab.name;
    const float height = icon ? em() * 0.95f : ImGui::GetFontSize();
    const ImVec2 size = font->CalcTextSizeA(height, 1e6f, 0, text);
    if (ImGui::IsItemHovered() && !front) list.AddRectFilled(lo, hi, ImGui::GetColorU32(ImGuiCol_TabHovered, 0.5f));
    const float line = std::max(1.0f, std::round(em() * 0.13f));
    if (front) list.AddRectFilled({lo.x, hi.y - line}, hi, palette().accent);
    const ImVec2 at{std::round((lo.x + hi.x - size.x) / 2), std::round((lo.y + hi.y - size.y) / 2)};
    list.AddText(font, height, at, front ? palette().text : palette().muted, text);
    if (tab.marked)
        list.AddCircleFilled({at.x + size.x + em() * 0.12f, at.y + em() * 0.12f}, em() * 0.14f, palette().accent);
}

} // namespace

std::optional<std::size_t> drawTaskTabs(const ViewContext& context, std::span<const TaskTab> tabs, std::size_t front) {
    const float room = ImGui::GetContentRegionAvail().x, left = ImGui::GetCursorPosX();
    const TabWidths chosen = chooseFaces(context, tabs, front, room);
    // What is left of the row makes the tabs wider, but not by much.
    const float spare = std::floor((room - chosen.total()) / static_cast<float>(tabs.size()));
    const float wider = std::clamp(spare, 0.0f, em() * 1.2f);
    std::optional<std::size_t> pressed;
    float used = 0;
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {0, 0});
    for (std::size_t i = 0; i < tabs.size(); ++i) {
        const float width = chosen.widths[i] + wider;
        if (i > 0 && used + width <= room)
            ImGui::SameLine(left + used, 0);
        else
            used = 0;
        used += width;
        if (mouseArea(tabs[i].name, {width, ImGui::GetFrameHeight()})) pressed = i;
        if (i != front && ImGui::IsItemHovered()) // it would lie over what the tab shows
            tooltip((std::string(tabs[i].name) + "\n" + tabs[i].help).c_str());
        drawFace(context, tabs[i], chosen.faces[i], i == front);
    }
    ImGui::PopStyleVar();
    const ImVec2 under = ImGui::GetCursorScreenPos();
    ImGui::GetWindowDrawList()->AddLine({under.x, under.y - 1}, {under.x + room, under.y - 1}, palette().line);
    ImGui::Dummy({0, em() * 0.1f});
    return pressed;
}

} // namespace tessera::app
