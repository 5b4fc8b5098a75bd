#include "app/views/transfer/region_edit.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace tessera::app {

namespace {

constexpr float kThinnestRegion = 0.01f;

int edgesAt(const vis::TransferRegion& region, glm::vec2 place, glm::vec2 reach) {
    const glm::vec2 lo = region.centre - 0.5f * region.size, hi = region.centre + 0.5f * region.size;
    // On small regions the middle third still moves all of it.
    const glm::vec2 near = glm::min(reach, region.size / 3.0f);
    return (std::abs(place.x - lo.x) <= near.x ? kRegionLeft : 0) |
           (std::abs(place.x - hi.x) <= near.x ? kRegionRight : 0) |
           (std::abs(place.y - lo.y) <= near.y ? kRegionLow : 0) |
           (std::abs(place.y - hi.y) <= near.y ? kRegionHigh : 0);
}

bool covers(const vis::TransferRegion& region, glm::vec2 place, glm::vec2 reach) {
    const glm::vec2 away = glm::abs(place - region.centre), half = 0.5f * region.size + 0.5f * reach;
    return away.x <= half.x && away.y <= half.y;
}

} // namespace

RegionHit hitRegion(const std::vector<vis::TransferRegion>& regions, glm::vec2 place, glm::vec2 reach, int selected) {
    const int count = static_cast<int>(regions.size());
    const auto at = [&](int i) { return covers(regions[static_cast<std::size_t>(i)], place, reach); };
    int found = -1;
    if (selected >= 0 && selected < count && at(selected)) found = selected;
    for (int i = count - 1; i >= 0 && found < 0; --i)
        if (at(i)) found = i;
    return found < 0 ? RegionHit{} : RegionHit{found, edgesAt(regions[static_cast<std::size_t>(found)], place, reach)};
}

vis::TransferRegion draggedRegion(const vis::TransferRegion& original, int edges, glm::vec2 by) {
    vis::TransferRegion region = original;
    if (edges == 0) {
        region.centre = glm::clamp(original.centre + by, 0.0f, 1.0f);
        return region;
    }
    glm::vec2 lo = original.centre - 0.5f * original.size, hi = original.centre + 0.5f * original.size;
    if (edges & kRegionLeft) lo.x = std::min(lo.x + by.x, hi.x - kThinnestRegion);
    if (edges & kRegionRight) hi.x = std::max(hi.x + by.x, lo.x + kThinnestRegion);
    if (edges & kRegionLow) lo.y = std::min(lo.y + by.y, hi.y - kThinnestRegion);
    if (edges & kRegionHigh) hi.y = std::max(hi.y + by.y, lo.y + kThinnestRegion);
    region.centre = 0.5f * (lo + hi);
    region.size = hi - lo;
    return region;
}

bool editRegions(RegionDrag& drag, std::vector<vis::TransferRegion>& regions, const PlotFrame& plane) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const glm::vec2 place(plane.data(mouse));
    const glm::vec2 reach = em() * 0.5f * glm::vec2(plane.perPixelX(), plane.perPixelY());
    const bool hovered = ImGui::IsItemHovered();
    if (drag.selected >= static_cast<int>(regions.size())) drag = {};
    const RegionHit under = hovered ? hitRegion(regions, place, reach, drag.selected) : RegionHit{};
    const int edges = drag.active ? drag.edges : under.edges;
    if (drag.active || under.region >= 0) {
        const bool across = edges & (kRegionLeft | kRegionRight), along = edges & (kRegionLow | kRegionHigh);
        ImGui::SetMouseCursor(across && along ? ImGuiMouseCursor_ResizeAll
                              : across        ? ImGuiMouseCursor_ResizeEW
                              : along         ? ImGuiMouseCursor_ResizeNS
                                              : ImGuiMouseCursor_Hand);
    }
    if (under.region >= 0 && ImGui::IsMouseClicked(ImGuiMouseButton_Right)) {
        regions.erase(regions.begin() + under.region);
        drag = {};
        return true;
    }
    if (hovered && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
        drag.selected = under.region;
        drag.active = true;
        drag.edges = under.edges;
        drag.start = place;
        if (under.region >= 0) drag.original = regions[static_cast<std::size_t>(under.region)];
    }
    if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) drag.active = false;
    if (!drag.active || !ImGui::IsMouseDragging(ImGuiMouseButton_Left, 3)) return false;
    if (drag.selected < 0) { // a new one from here, held by the corner that the mouse drags
        drag.original = {};
        drag.original.size = glm::vec2(kThinnestRegion);
        const glm::vec2 way = place - drag.start;
        drag.edges = (way.x < 0 ? kRegionLeft : kRegionRight) | (way.y < 0 ? kRegionLow : kRegionHigh);
        drag.original.centre = drag.start;
        drag.selected = static_cast<int>(regions.size());
        regions.push_back(drag.original);
    }
    vis::TransferRegion& held = regions[static_cast<std::size_t>(drag.selected)];
    const vis::TransferRegion moved = draggedRegion(drag.original, drag.edges, place - drag.start);
    const bool changed = moved != held;
    held = moved;
    return changed;
}

void drawRegions(ImDrawList& draw, const vis::TransferFunction& function, const PlotFrame& plane, int selected) {
    const PlotColors colors = plotColors();
    for (std::size_t i = 0; i < function.regions.size(); ++i) {
        const vis::TransferRegion& region = function.regions[i];
        const glm::dvec3 shown = region.ownColor ? glm::dvec3(region.color)
                                                 : glm::dvec3(vis::evaluate(function, {0, 1}, double(region.centre.x)));
        const auto shade = [&](double alpha) { return toColor({shown.r, shown.g, shown.b}, alpha); };
        const glm::dvec2 lo(region.centre - 0.5f * region.size), hi(region.centre + 0.5f * region.size);
        const ImVec2 a = plane.pixel(lo.x, hi.y), b = plane.pixel(hi.x, lo.y);
        std::vector<ImVec2> outline;
        switch (region.shape) {
        case vis::RegionShape::Rectangle:
            outline = {a, {b.x, a.y}, b, {a.x, b.y}};
            break;
        case vis::RegionShape::Triangle:
            outline = {a, {b.x, a.y}, {(a.x + b.x) / 2, b.y}};
            break;
        case vis::RegionShape::Gaussian:
            for (int k = 0; k < 48; ++k) {
                const double turn = k * 2 * 3.14159265358979 / 48;
                outline.push_back(plane.pixel(double(region.centre.x) + 0.5 * double(region.size.x) * std::cos(turn),
                                              double(region.centre.y) + 0.5 * double(region.size.y) * std::sin(turn)));
            }
            break;
        }
        const int count = static_cast<int>(outline.size());
        const bool lit = static_cast<int>(i) == selected;
        draw.AddConvexPolyFilled(outline.data(), count, shade(0.12 + 0.45 * double(region.opacity)));
        draw.AddPolyline(outline.data(), count, colors.backdrop, ImDrawFlags_Closed, em() * 0.3f);
        draw.AddPolyline(outline.data(), count, shade(1), ImDrawFlags_Closed, em() * (lit ? 0.2f : 0.12f));
        if (!lit) continue;
        for (const ImVec2 corner : {a, ImVec2{b.x, a.y}, b, ImVec2{a.x, b.y}}) {
            const float half = em() * 0.22f;
            draw.AddRectFilled({corner.x - half, corner.y - half}, {corner.x + half, corner.y + half}, colors.text);
            draw.AddRect({corner.x - half, corner.y - half}, {corner.x + half, corner.y + half}, colors.backdrop);
        }
    }
}

} // namespace tessera::app
