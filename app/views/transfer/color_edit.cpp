#include "app/views/transfer/color_edit.h"

#include "app/ui/widgets.h"
#include "vis/transfer/simplify_colors.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

float placeAt(float x, ImVec2 min, ImVec2 max) {
    return std::clamp((x - min.x) / std::max(max.x - min.x, 1.0f), 0.0f, 1.0f);
}

glm::vec3 colorAt(const std::vector<vis::ColorStop>& stops, double position) {
    vis::TransferFunction own;
    own.colors = stops;
    return glm::vec3(vis::evaluate(own, {0, 1}, position));
}

int hitStop(const std::vector<vis::ColorStop>& stops, ImVec2 min, ImVec2 max, float x) {
    int best = -1;
    float nearest = em() * 0.6f;
    for (std::size_t i = 0; i < stops.size(); ++i) {
        const float distance = std::abs(min.x + stops[i].position * (max.x - min.x) - x);
        if (distance < nearest) {
            nearest = distance;
            best = static_cast<int>(i);
        }
    }
    return best;
}

} // namespace

void reverseColors(std::vector<vis::ColorStop>& stops) {
    std::ranges::reverse(stops);
    for (vis::ColorStop& stop : stops) stop.position = 1 - stop.position;
}

std::vector<vis::ColorStop> ownColors(const vis::TransferFunction& function) {
    constexpr int kSamples = 256;
    std::vector<vis::ColorStop> sampled;
    for (int i = 0; i <= kSamples; ++i) {
        const double x = double(i) / kSamples;
        sampled.push_back({float(x), glm::vec3(vis::evaluate(function, {0, 1}, x))});
    }
    return vis::simplified(sampled, kStopsAlike);
}

bool editColors(ColorDrag& drag, std::vector<vis::ColorStop>& stops, ImVec2 min, ImVec2 max) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    ImGui::SetCursorScreenPos({min.x - em() * 0.4f, min.y});
    mouseArea("stops", {max.x - min.x + em() * 0.8f, max.y - min.y},
              ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
    const bool hovered = ImGui::IsItemHovered();
    const int under = hovered ? hitStop(stops, min, max, mouse.x) : -1;
    if (hovered && drag.stop < 0)
        ImGui::SetTooltip("%s", under >= 0 ? "Drag to move, double-click to choose the colour, right-click to remove"
                                           : "Click to add a colour here");
    if (under >= 0) ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
    if (under >= 0 && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) {
        drag = {-1, under};
        ImGui::OpenPopup("color");
    } else if (under >= 0 && ImGui::IsMouseClicked(ImGuiMouseButton_Right)) {
        if (stops.size() > 2) stops.erase(stops.begin() + under);
        drag = {};
    } else if (hovered && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
        drag.stop = under;
        if (under < 0) {
            const float place = placeAt(mouse.x, min, max);
            const auto next = std::ranges::upper_bound(stops, place, {}, &vis::ColorStop::position);
            drag.stop = int(next - stops.begin());
            stops.insert(next, {place, colorAt(stops, double(place))});
        }
    }
    if (drag.stop >= int(stops.size()) || !ImGui::IsMouseDown(ImGuiMouseButton_Left)) drag.stop = -1;
    if (drag.stop >= 0 && ImGui::IsMouseDragging(ImGuiMouseButton_Left, 2)) {
        const auto held = std::size_t(drag.stop);
        const float low = held > 0 ? stops[held - 1].position : 0;
        const float high = held + 1 < stops.size() ? stops[held + 1].position : 1;
        stops[held].position = std::clamp(placeAt(mouse.x, min, max), low, high);
    }
    if (ImGui::BeginPopup("color")) {
        if (drag.chosen >= 0 && drag.chosen < int(stops.size()))
            ImGui::ColorPicker3("##color", &stops[std::size_t(drag.chosen)].color.x,
                                ImGuiColorEditFlags_NoSidePreview | ImGuiColorEditFlags_Float);
        ImGui::EndPopup();
    }
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const PlotColors colors = plotColors();
    for (std::size_t i = 0; i < stops.size(); ++i) {
        const float x = min.x + stops[i].position * (max.x - min.x), half = em() * 0.32f;
        const bool lit = int(i) == drag.stop || (drag.stop < 0 && int(i) == under);
        const ImVec2 tip{x, min.y}, left{x - half, max.y}, right{x + half, max.y};
        draw.AddTriangleFilled(tip, right, left,
                               toColor({double(stops[i].color.r), double(stops[i].color.g), double(stops[i].color.b)}));
        draw.AddTriangle(tip, right, left, lit ? colors.focus : colors.text, lit ? 2.0f : 1.0f);
    }
    return drag.stop >= 0;
}

} // namespace tessera::app
