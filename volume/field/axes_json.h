#pragma once

#include "volume/field/lattice.h"

#include <string>
#include <string_view>

/// Axes of a lattice as JSON, as archives, sidecars and headers of streams have them: a list of three, x, y, z, each
/// null where the axis is even, else {"of": "cells" | "points", "planes": [rising numbers]}. Planes are numbers that
/// read back bit for bit.
namespace tessera::volume {

inline constexpr int kMostPlanes = (1 << 20) + 1; ///< of an axis

/// The list as text.
std::string axesJson(const AxisMaps& axes);

/// Axes of `size` samples (0: any number of them). Lists of another length than that are refused before memory is taken
/// for them. Throws Error naming `file` and the place below `place`, such as "axes[2].planes".
AxisMaps axesFromJson(std::string_view text, glm::ivec3 size, const std::string& file, const std::string& place);

/// Throws Error unless a CC lattice has as many samples as its axes, and its spacing and origin are those of their
/// sheet to a thousandth of a cell. Of BCC: unless its samples lie on the sheet or within a cell beyond.
void requireOfSheet(const Lattice& lattice, const std::string& file = {}, const std::string& place = {});

/// A CC grid whose header states axes: their sheet takes the place of spacing and origin, which must agree with it
/// where they are stated, too. Throws Error as above.
Lattice withStatedAxes(const Lattice& stated, bool statesSheet, std::string_view axes, const std::string& file,
                       const std::string& place);

} // namespace tessera::volume
