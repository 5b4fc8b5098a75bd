#pragma once

#include "app/pane/legend.h"
#include "app/session/session.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

/// Legends in a corner of a picture, where and in the form in which they leave its object in sight.
namespace tessera::app {

enum class LegendForm { Whole, Lines, Names }; ///< with ticks; one line each; all in one line, without numbers
enum class LegendCorner { BottomRight, TopRight, TopLeft };

struct LegendPlace {
    LegendForm form = LegendForm::Whole;
    LegendCorner corner = LegendCorner::BottomRight;
    float most = 0.6f; ///< of the height of the picture
};

/// The picture that legends lie in, pixels. `top`: what stands above them at its upper edge.
struct LegendRoom {
    ImVec2 min, max;
    float top = 0;
};

struct LegendArea {
    ImVec2 min, max;
};

/// Whether legends that would be `height` pixels high together are one line each, since a picture of `room` pixels has
/// little room.
bool legendsAsLines(float height, float room);

/// The share of a rectangle that something covers.
using CoveredShare = std::function<double(ImVec2 min, ImVec2 max)>;

/// What legends shall leave in sight.
struct LegendSurroundings {
    CoveredShare object;
    CoveredShare numbers = {}; ///< beside it, which matter where the object is left in sight anyway; or nothing
};

/// The corner and the most telling form in which legends cover nothing of the object; where there is none, the form
/// that suits the size of the picture, in the corner where it covers least. `figure`: with numbers at any size, as
/// nobody can point at it; by itself whole where that covers nothing or is a small part.
LegendPlace placeLegends(const std::vector<LegendEntry>& entries, const LegendRoom& room,
                         const LegendSurroundings& covered, std::optional<FigureLegends> figure = {});

/// The pixels that drawLegends() covers.
LegendArea legendArea(const std::vector<LegendEntry>& entries, const LegendRoom& room, LegendPlace place);

/// As many of them as fit. Those that are not whole are so in a tooltip.
LegendArea drawLegends(ImDrawList& draw, const std::vector<LegendEntry>& entries, const LegendRoom& room,
                       LegendPlace place);

} // namespace tessera::app
