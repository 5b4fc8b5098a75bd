#pragma once

#include "vis/lic/line_integral.h"
#include "vis/optics/ray_setup.h"
#include "volume/bricks/brick_source.h"

#include <memory>
#include <optional>
#include <string>

/// Strokes of slices, made of data.
namespace tessera::vis {

/// Index of a vector parameter by name.
std::optional<int> vectorNamed(const volume::DatasetInfo& info, const std::string& name);

/// Where a picture of strokes lies in a plane of the stretched world.
struct StrokeRoom {
    glm::dvec3 normal{0, 0, 1}, right{1, 0, 0}, up{0, 1, 0}; ///< length 1, at right angles
    glm::dvec3 foot{0}; ///< the place of the plane nearest to the middle of the data
    glm::ivec2 first{0}, size{0};
    double texel = 1; ///< world; texel (i, j) begins at foot + (right (first.x + i) + up (first.y + j)) texel

    glm::dvec3 middleOf(glm::ivec2 at) const {
        const glm::dvec2 along = (glm::dvec2(first + at) + 0.5) * texel;
        return foot + right * along.x + up * along.y;
    }
};
/// The part of the plane in the box; size 0 where it misses the box. Texels of planes with one normal lie behind each
/// other.
StrokeRoom strokeRoom(const Plane& plane, const WorldFrame& frame, double texel);

/// What is sampled there: the vector as drawn, in the plane, and its physical speed in the plane.
struct StrokeSamples {
    PlaneField field;
    std::vector<float> speed;
};
/// `parameter`: index of DatasetInfo::parameters, with three components. Parts are those of the parameter
/// (volume/field/parts.h). Throws Error, Cancelled.
StrokeSamples sampleStrokes(const std::shared_ptr<const volume::BrickSource>& source, int parameter, int time,
                            const StrokeRoom& room, const WorldFrame& frame, const Progress& progress = {});

/// The strokes of a plane: texels of half the width of a stroke, noise that is fixed to the data. Null if the data have
/// no such vector, or the plane misses them. Throws Error, Cancelled.
std::shared_ptr<const StrokePicture> makeStrokes(const std::shared_ptr<const volume::BrickSource>& source,
                                                 const Strokes& strokes, int time, const Plane& plane,
                                                 glm::dvec3 stretch, const Progress& progress = {});

} // namespace tessera::vis
