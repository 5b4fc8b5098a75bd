#include "app/ui/choose_colormap.h"

#include "app/ui/fitted_text.h"
#include "app/ui/keys.h"
#include "app/ui/theme.h"
#include "app/ui/widgets.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <imgui.h>
#include <imgui_stdlib.h>
#include <sstream>

namespace tessera::app {

namespace {

/// What is typed and marked in the list that is open; ImGui opens one at a time.
struct ColormapSearch {
    std::string text;
    int marked = 0;
};
ColormapSearch& colormapSearch() {
    static ColormapSearch search;
    return search;
}

std::string lowerCase(std::string_view text) {
    std::string out(text);
    for (char& c : out) c = char(std::tolower(static_cast<unsigned char>(c)));
    return out;
}

void drawPreview(ImVec2 lo, ImVec2 hi, std::string_view map, bool reversed) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const int parts = 24;
    const auto at = [&](int i) {
        const double x = double(i) / parts;
        const glm::dvec3 color = vis::colormapColor(map, reversed ? 1 - x : x);
        return ImGui::ColorConvertFloat4ToU32({float(color.r), float(color.g), float(color.b), 1});
    };
    for (int i = 0; i < parts; ++i) {
        const float x0 = lo.x + (hi.x - lo.x) * float(i) / parts, x1 = lo.x + (hi.x - lo.x) * float(i + 1) / parts;
        const ImU32 left = at(i), right = at(i + 1);
        list.AddRectFilledMultiColor({x0, lo.y}, {x1, hi.y}, left, right, right, left);
    }
}

/// A row of the list: a strip of the map and its name. True when it was clicked.
bool drawMapRow(const vis::ColormapInfo& map, bool marked, bool reversed, float height) {
    const float inset = std::round(height * 0.2f), preview = height * 4;
    ImGui::PushID(map.name.data(), map.name.data() + map.name.size());
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const bool clicked = ImGui::Selectable("##map", marked, 0, {0, height});
    drawPreview({at.x + inset, at.y + inset}, {at.x + preview, at.y + height - inset}, map.name, reversed);
    ImGui::GetWindowDrawList()->AddText({at.x + preview + inset * 2, at.y + (height - ImGui::GetFontSize()) / 2},
                                        palette().text, map.name.data(), map.name.data() + map.name.size());
    ImGui::PopID();
    return clicked;
}

/// The open list: a field that searches, the maps that match, arrows and Enter. True when one was picked into `value`.
bool drawColormapList(std::string& value, bool reversed, float height) {
    ColormapSearch& search = colormapSearch();
    if (ImGui::IsWindowAppearing()) {
        const auto maps = vis::colormaps();
        const auto shown = std::ranges::find_if(maps, [&](const auto& map) { return map.name == value; });
        search = {"", shown == maps.end() ? 0 : int(shown - maps.begin())};
        ImGui::SetKeyboardFocusHere();
    }
    ImGui::SetNextItemWidth(std::max(height * 9, ImGui::GetContentRegionAvail().x));
    const bool enter =
        ImGui::InputTextWithHint("##search", "Search colour maps", &search.text, ImGuiInputTextFlags_EnterReturnsTrue);
    if (ImGui::IsItemEdited()) search.marked = 0;
    const std::vector<vis::ColormapInfo> maps = matchingColormaps(search.text);
    const bool moved = keyPressed(key::kDown, true) || keyPressed(key::kUp, true);
    if (keyPressed(key::kDown, true)) ++search.marked;
    if (keyPressed(key::kUp, true)) --search.marked;
    search.marked = std::clamp(search.marked, 0, std::max(0, int(maps.size()) - 1));
    std::string picked;
    std::string_view kind;
    for (std::size_t i = 0; i < maps.size(); ++i) {
        if (maps[i].kind != kind && search.text.empty()) ImGui::TextDisabled("%s", labelOf(maps[i].kind).c_str());
        kind = maps[i].kind;
        const bool marked = int(i) == search.marked;
        if (drawMapRow(maps[i], marked, reversed, height)) picked = maps[i].name;
        if (marked && moved) ImGui::SetScrollHereY(0.5f);
    }
    if (maps.empty()) ImGui::TextDisabled("No such colour map");
    if (enter && !maps.empty()) picked = maps[std::size_t(search.marked)].name;
    if (enter || pressed({.key = key::kEscape})) ImGui::CloseCurrentPopup();
    if (picked.empty() || picked == value) return false;
    value = picked;
    return true;
}

} // namespace

std::vector<vis::ColormapInfo> matchingColormaps(std::string_view text) {
    std::vector<vis::ColormapInfo> out;
    for (const vis::ColormapInfo& map : vis::colormaps()) {
        const std::string name = lowerCase(map.name) + " " + lowerCase(map.kind);
        std::istringstream words(lowerCase(text));
        bool all = true;
        for (std::string word; words >> word;) all = all && name.find(word) != std::string::npos;
        if (all) out.push_back(map);
    }
    return out;
}

bool chooseColormap(const char* id, std::string& value, bool reversed) {
    const float height = ImGui::GetFrameHeight();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float width = ImGui::CalcItemWidth();
    const float inset = std::round(height * 0.2f);
    bool changed = false;
    if (ImGui::BeginCombo(id, "", ImGuiComboFlags_HeightLarge)) {
        changed = drawColormapList(value, reversed, height);
        ImGui::EndCombo();
    }
    const float right = corner.x + width - height;
    const float text = ImGui::CalcTextSize(value.c_str()).x + inset * 3;
    // Where the strip has no room, the name begins at the left like that of any list.
    const bool strip = right - text > corner.x + height;
    const float split = strip ? right - text : corner.x + ImGui::GetStyle().FramePadding.x - inset;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    if (strip)
        drawPreview({corner.x + inset, corner.y + inset}, {split - inset, corner.y + height - inset}, value, reversed);
    const ImVec2 at{split + inset, corner.y + (height - ImGui::GetFontSize()) / 2};
    list.AddText(at, palette().text, fitText(value, right - at.x).c_str());
    return changed;
}

} // namespace tessera::app
