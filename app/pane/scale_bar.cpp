#include "app/pane/scale_bar.h"

#include "app/ui/ticks.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tessera::app {

ScaleBar scaleBar(const vis::Camera& camera, const vis::WorldFrame& world, glm::dvec3 stretch,
                  const std::string& lengthUnit, float heightPixels, float mostPixels) {
    const double height = 2 * double(camera.distance) * std::tan(double(camera.fieldOfView) * std::numbers::pi / 360);
    const double worldPerPixel = height / std::max(1.0f, heightPixels);
    const glm::vec3 across = glm::inverse(camera.orientation) * glm::vec3(1, 0, 0);
    int axis = 0;
    for (int i = 1; i < 3; ++i)
        if (std::abs(across[i]) > std::abs(across[axis])) axis = i;
    if (world.axes[axis]) return {};
    const double perPixel = worldPerPixel / std::abs(world.scale[axis]), most = perPixel * double(mostPixels);
    if (!(most > 0) || !std::isfinite(most)) return {};
    const LengthUnit unit = suitableLength(lengthUnit, most);
    const double shown = most * unit.perUnit, decade = std::pow(10, std::floor(std::log10(shown)));
    const double round = (shown >= 5 * decade ? 5 : shown >= 2 * decade ? 2 : 1) * decade;
    ScaleBar bar;
    bar.pixels = float(round / unit.perUnit / perPixel);
    bar.text = (camera.projection == vis::Projection::Perspective ? "~" : "") + formatQuantity(round, unit.name);
    const bool even = stretch.x == stretch.y && stretch.y == stretch.z && world.axes.isEven();
    if (!even) bar.text += std::string(" along ") + "xyz"[axis];
    if (stretch[axis] != 1) bar.text += ", stretched " + formatQuantity(stretch[axis], "times");
    return bar;
}

std::pair<ImVec2, ImVec2> drawScaleBar(ImDrawList& draw, ImVec2 at, const ScaleBar& bar) {
    const PlotColors colors = plotColors();
    const ImVec2 size = ImGui::CalcTextSize(bar.text.c_str());
    const float end = em() * 0.3f, thick = std::max(1.5f, em() * 0.11f);
    const ImVec2 left{std::round(at.x), std::round(at.y - end)}, right{std::round(at.x + bar.pixels), left.y};
    addTextWithBackdrop(draw, {left.x, left.y - end - size.y}, {0, 0}, colors.text, bar.text.c_str());
    for (const auto& [color, width] : {std::pair{colors.backdrop, thick + 2}, std::pair{colors.text, thick}}) {
        draw.AddLine(left, right, color, width);
        draw.AddLine({left.x, left.y - end}, {left.x, left.y + end}, color, width);
        draw.AddLine({right.x, right.y - end}, {right.x, right.y + end}, color, width);
    }
    return {{left.x, left.y - end - size.y}, {std::max(right.x, left.x + size.x), at.y}};
}

} // namespace tessera::app
