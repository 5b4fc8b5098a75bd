#pragma once

#include "app/pane/plot.h"
#include "vis/transfer/transfer_function.h"

#include <vector>

/// The colours of a transfer function as stops that the mouse moves.
namespace tessera::app {

/// What the mouse holds, and whose colour is being chosen; one per view.
struct ColorDrag {
    int stop = -1, chosen = -1;
};

/// Greatest difference of a component of the colour, 0..1, between a map and the few stops that stand for it.
inline constexpr double kStopsAlike = 0.03;

/// The colour map in use as stops of one's own, as it runs now: few of them (vis::simplified()), within kStopsAlike.
std::vector<vis::ColorStop> ownColors(const vis::TransferFunction& function);

/// The same colours from the other end.
void reverseColors(std::vector<vis::ColorStop>& stops);

/// Stops as handles in a row from `min` to `max` that stands for 0..1: dragging moves one between its neighbours, a
/// click elsewhere adds one of the colour there, a double click chooses its colour, a right click removes it (two
/// always stay). Returns true while one is held.
bool editColors(ColorDrag& drag, std::vector<vis::ColorStop>& stops, ImVec2 min, ImVec2 max);

} // namespace tessera::app
