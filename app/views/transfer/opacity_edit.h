#pragma once

#include "app/pane/plot.h"
#include "app/views/transfer/opacity_snap.h"
#include "vis/transfer/transfer_function.h"

#include <span>
#include <string_view>
#include <vector>

/// The opacity curve of a transfer function as points that the mouse moves.
namespace tessera::app {

/// What the mouse holds; one per view.
struct OpacityDrag {
    int point = -1;
    double left = 0, right = 1; ///< values the held point may have: its neighbours
    Snap snap;                  ///< where it was put last
};

/// Curves to begin with.
enum class OpacityPreset { Ramp, Tent, Step, Constant };
inline constexpr std::string_view kOpacityPresetNames[] = {"ramp", "tent", "step", "constant"};
std::vector<glm::vec2> opacityPreset(OpacityPreset preset);

/// Point of the curve under a pixel, -1 if none. `range`: physical values at the ends of the curve.
int hitPoint(const std::vector<glm::vec2>& curve, const PlotFrame& frame, Range range, ImVec2 at);

/// Mouse on the plot whose InvisibleButton (left and right) was the last item: dragging moves a point between its
/// neighbours, a click elsewhere adds one, a right or double click on a point removes it (two always stay). New and
/// dragged points snap (snapLines()) to what lies within a few pixels, also to `peaks`, positions 0..1; not with Ctrl
/// or Alt. Returns true when the curve changed.
bool editOpacity(OpacityDrag& drag, std::vector<glm::vec2>& curve, const PlotFrame& frame, Range range,
                 std::span<const double> peaks = {});

/// Thin lines through the held point along which it has snapped.
void drawSnapLines(ImDrawList& draw, const OpacityDrag& drag, const PlotFrame& frame, Range range);

void drawOpacity(ImDrawList& draw, const std::vector<glm::vec2>& curve, const PlotFrame& frame, Range range, int lit);

} // namespace tessera::app
