#pragma once

#include "vis/scene/scene.h"

#include <cstddef>
#include <string>
#include <vector>

/// Texts at the upper edge of a picture in space, of which none lies over another.
namespace tessera::app {

inline constexpr float kUpperLine = 1.3f; ///< em from one line to the next

struct UpperTexts {
    std::vector<std::string> left; ///< lines
    std::size_t faintFrom = 0;     ///< lines from here on are of the stretch, and notes
    std::string right;             ///< in the first line
};

/// The state shown in lines at the left, and the stretch at the right or, where both have no room in one line, below;
/// then the notes. `room`: width in pixels.
UpperTexts upperTextsOf(const std::string& state, const std::string& stretch, const std::vector<std::string>& notes,
                        float room);

/// What users have to know of the geometry of a scene (vis::Geometry::notes), each once.
std::vector<std::string> geometryNotes(const vis::Scene& scene);

} // namespace tessera::app
