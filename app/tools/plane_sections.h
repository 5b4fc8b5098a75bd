#pragma once

#include "app/pane/oblique_plane.h"
#include "app/pane/plot.h"
#include "app/session/session.h"
#include "volume/field/dataset.h"

#include <glm/vec4.hpp>
#include <optional>
#include <vector>

/// Lenses and brushes in space where they cross a plane: the outlines that slices and their figures show.
namespace tessera::app {

struct PlaneSection {
    std::vector<glm::dvec2> outline; ///< closed, in order; distances along the plane's directions (PicturePlane)
    glm::vec3 color{0};
    bool faint = false;                    ///< of a brush that is switched off
    bool dashed = false;                   ///< of a lens
    std::optional<glm::dvec2> middle = {}; ///< of a lens, also where it is before or behind the plane
};

/// Where a plane cuts a ball of three radii, in order around it, on the sheet; none where it misses the ball.
std::vector<glm::dvec3> ballSection(const vis::SheetBox& ball, const PicturePlane& plane);

/// The outline of a lens in a plane through `at`, around the place where the lens is deepest: world points, none where
/// the plane misses it. `right` and `up` (world, length 1) are at right angles.
std::vector<glm::dvec3> lensSection(const vis::PlacedLens& lens, glm::dvec3 at, glm::dvec3 right, glm::dvec3 up);

/// Sections of the brushes in space, then of the enabled lenses.
std::vector<PlaneSection> planeSections(const Session& session, const volume::DatasetInfo& info,
                                        const PicturePlane& plane);

void drawPlaneSections(ImDrawList& draw, const PlaneFrame& frame, const std::vector<PlaneSection>& sections);

} // namespace tessera::app
