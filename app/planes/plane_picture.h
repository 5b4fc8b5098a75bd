#pragma once

#include "app/pane/axis_label.h"
#include "app/pane/oblique_plane.h"
#include "app/planes/contour_data.h"
#include "app/tools/plane_sections.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

/// A plane of the data as a value: where it lies and what its picture shows. Panes (plane_pane.h), pages and tables
/// (plane_export.h) are made of it.
namespace tessera::app {

/// What is shown in a plane.
struct PlaneContent {
    int channel = 0;            ///< of its colours: index of DatasetInfo::channels()
    ContourSettings lines = {}; ///< of contour lines
    vis::Strokes strokes = {};
    bool plain = false;   ///< without lenses, brushes, profile lines and cross-hair
    bool crossed = false; ///< a plain one with the cross-hair
};

struct PlanePicture {
    PicturePlane plane;
    volume::AxisMaps maps;           ///< from the sheet, of which the plane is and what the picture spans, to space
    std::optional<SliceAxes> axes;   ///< of the data, along the picture and across; nothing where the plane is tilted
    Range x, y;                      ///< what the picture spans: distances from the data's origin along right and up
    glm::dvec2 size{0};              ///< what that is in the stretched world (vis/scene/camera.h)
    std::vector<glm::dvec3> corners; ///< of the part in the box, in order around it; physical
    AxisLabel right, up;             ///< names and units along the picture: "u" and "v" where tilted
    AxisLabels positions;            ///< the same of the axes of the data
    std::string place;               ///< where it lies: "z = 3.1 mm", "across 0.71 x + 0.71 z at 12.3 mm"
    glm::ivec2 cells{2};             ///< rows and columns of samples in a table

    PlaneContent shows;
    volume::TimePair time;
    std::optional<double> ownTime;  ///< where it is not the session's
    vis::TransferFunction function; ///< of the colours
    Range range;                    ///< that it spans
    std::optional<int> lined;       ///< channel of the contour lines; nothing: there are none
    ContourLevels levels;           ///< of them
    std::vector<PlaneSection> sections;
    std::optional<glm::dvec2> cursor; ///< the cross-hair, along right and up

    glm::dvec2 along(glm::dvec3 physical) const { return plane.along(maps.toSheet(physical)); }
    glm::dvec3 placeAt(glm::dvec2 at) const { return maps.toSpace(plane.placeAt(at)); } ///< physical
    glm::dvec2 perUnit() const { return {right.unit.perUnit, up.unit.perUnit}; }
    /// What the picture spans, in the units of its axes.
    Range shownX() const { return {x.lo * right.unit.perUnit, x.hi * right.unit.perUnit}; }
    Range shownY() const { return {y.lo * up.unit.perUnit, y.hi * up.unit.perUnit}; }
};

/// The plane across axes.normal at a position along it, as wide as the data.
PlanePicture axisPlane(const Session& session, const volume::DatasetInfo& info, const SliceAxes& axes, double position,
                       const PlaneContent& shows);
/// The plane through the session's cursor across `normal`. Cursors in one plane have the same picture.
PlanePicture tiltedPlane(const Session& session, const volume::DatasetInfo& info, glm::dvec3 normal,
                         const PlaneContent& shows);

/// The picture at another time than the session's.
PlanePicture atTime(PlanePicture picture, const volume::DatasetInfo& info, double time);

/// The axes of a picture in words: "x", or where none of the data's runs along it "u = 0.71 x - 0.71 z".
std::array<std::string, 2> axisTexts(const PlanePicture& picture);
/// Those that are none of the data's; "" where both are.
std::string axesText(const PlanePicture& picture);

/// Which of the axes that run along the picture are drawn by cells: "z by cells"; "" where none is.
std::string unevenText(const PlanePicture& picture);

/// The contour lines of the picture.
ContourQuery contourQuery(const PlanePicture& picture);

/// What the legend says of the contour lines, unless the renderer draws them, and of strokes; "" where there are none.
std::string planeNote(const volume::DatasetInfo& info, const PlanePicture& picture);

/// The place in a plane nearest to `along` that lies in the box; physical.
glm::dvec3 nearestPlace(const PlanePicture& picture, const volume::Box& box, glm::dvec2 along);

/// Moves the session's cursor across the plane by samples: along the axis it is perpendicular to, else along its
/// normal. Stays in the box.
void stepAcross(Session& session, const volume::DatasetInfo& info, const PlanePicture& picture, double samples);

} // namespace tessera::app
