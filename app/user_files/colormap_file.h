#pragma once

#include "vis/transfer/transfer_function.h"

#include <string>
#include <string_view>
#include <vector>

/// Colour maps in files of other programs and of one's own.
namespace tessera::app {

/// The colours of a map in JSON text, sorted, positions scaled to 0..1:
///     {"colors": [{"position": 0, "color": [r, g, b]}, ...]}     as in a session's transfer function, or
///     [{"RGBPoints": [x, r, g, b, x, r, g, b, ...], ...}]         as ParaView exports them (the first map is taken)
/// with components 0..1, sRGB. Throws Error naming `file` and the place when it is neither, or has fewer than two
/// colours or no extent.
std::vector<vis::ColorStop> parseColormap(std::string_view text, const std::string& file);

/// The same of a file.
std::vector<vis::ColorStop> readColormap(const std::string& path);

} // namespace tessera::app
