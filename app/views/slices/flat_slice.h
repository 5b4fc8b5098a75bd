#pragma once

#include "app/pane/figure.h"
#include "app/pane/oblique_plane.h"
#include "app/pane/plot.h"
#include "app/session/session.h"
#include "app/ui/ticks.h"
#include "volume/base/progress.h"
#include "volume/bricks/brick_source.h"

#include <string>
#include <vector>

/// The flat picture of a plane that is tilted against the axes of the data, as geometry, vector graphics and numbers.
namespace tessera::app {

struct FlatSlice {
    SpacePlane plane;
    FlatAxes axes;
    std::vector<glm::dvec3> corners; ///< of the part in the box
    Range x, y;                      ///< what the picture spans: distances from the data's origin along the axes
    LengthUnit unitX, unitY;
    std::string nameX, nameY; ///< of the axes: "x" where one runs along it, else "u" and "v"

    PicturePlane page() const { return {plane.at, axes.right, axes.up}; }
    glm::dvec2 along(glm::dvec3 place) const { return page().along(place); }
    glm::dvec3 placeAt(glm::dvec2 along) const { return page().placeAt(along); }
    glm::dvec2 perUnit() const { return {unitX.perUnit, unitY.perUnit}; }
};

/// The plane through the session's cursor across `normal`. Cursors in one plane have the same picture.
FlatSlice flatSlice(const Session& session, const volume::DatasetInfo& info, glm::dvec3 normal);

/// Where the plane lies: "across 0.71 x + 0.71 z at 12.3 mm", and what its axes are where they are none of the data's:
/// "u = 0.71 x - 0.71 z"; "" else.
std::string placeText(const FlatSlice& flat, const volume::DatasetInfo& info);
std::string axesText(const FlatSlice& flat);

/// The plane as cells in the colours of a channel, with contour lines, their values, and the outlines of lenses and
/// brushes. Throws Error, Cancelled.
VectorPage flatDrawing(const volume::BrickSource& source, const Session& session, const FlatSlice& flat,
                       const ContourSettings& lines, int channel, const Progress& progress = {});

/// Values of channels on a grid of places of the plane in the box: u and v along its axes, x, y and z, the values,
/// interpolated between the samples, as its first line says. Throws Error, Cancelled.
std::string flatCsv(const volume::BrickSource& source, const Session& session, const FlatSlice& flat,
                    const std::vector<int>& channels, const Progress& progress = {});

} // namespace tessera::app
