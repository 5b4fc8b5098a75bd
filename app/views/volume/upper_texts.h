#pragma once

#include <cstddef>
#include <string>
#include <vector>

/// Texts at the upper edge of a picture in space, of which none lies over another.
namespace tessera::app {

inline constexpr float kUpperLine = 1.3f; ///< em from one line to the next

struct UpperTexts {
    std::vector<std::string> left; ///< lines
    std::size_t faintFrom = 0;     ///< lines from here on are of the stretch
    std::string right;             ///< in the first line
};

/// The state shown in lines at the left, and the stretch at the right or, where both have no room in one line, below.
/// `room`: width in pixels.
UpperTexts upperTextsOf(const std::string& state, const std::string& stretch, float room);

} // namespace tessera::app
