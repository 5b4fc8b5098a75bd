#pragma once

#include "vis/scene/brush_effect.h"
#include "vis/scene/geometry_style.h"
#include "volume/mesh/surface_mesh.h"

#include <algorithm>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <string>
#include <vector>

/// Triangles and lines to be drawn among the volumes: iso-surfaces as polygons, and whatever else has vertices.
///
///     auto streamlines = std::make_shared<Geometry>();
///     streamlines->lines.positions = {...};     // physical
///     streamlines->lines.scalars = {...};       // e.g. the speed at each vertex
///     streamlines->lines.ends = {120, 260};     // two lines: vertices 0..119 and 120..259
///     scene.geometry.push_back({.geometry = streamlines, .style = {.lineWidth = 3}, .channel = "|U|"});
///
/// They are rasterised before the rays, nearest first, and composited where the rays meet them (ray_setup.h), so that
/// volumes, slices, surfaces and lines cover each other as they lie in space.
namespace tessera::vis {

/// Open polylines.
struct LineSet {
    std::vector<glm::vec3> positions; ///< physical
    std::vector<float> scalars;       ///< one per vertex, or empty
    std::vector<std::uint32_t> ends;  ///< of each line: one beyond its last vertex
    bool operator==(const LineSet&) const = default;
};

/// What can be drawn with one style. Never changed once it is in a scene: scenes compare it by address.
struct Geometry {
    volume::SurfaceMesh mesh; ///< physical; both sides of a triangle are lit
    LineSet lines;            ///< lit like thin tubes
};

struct GeometryLayer {
    std::shared_ptr<const Geometry> geometry;
    GeometryStyle style = {};
    std::string channel = {};  ///< its transfer function colours the scalars; "" = the style's colour
    std::string lens = {};     ///< name of the lens that it is drawn in alone; "" = everywhere
    std::string transfer = {}; ///< name of a transfer function other than that of `channel`
    BrushEffect brushes = BrushEffect::Fade;
    bool operator==(const GeometryLayer&) const = default;
};

/// How many surfaces, one behind the other, are kept for each pixel where some are translucent. What lies behind the
/// last one is left out.
inline constexpr int kPeels = 4;

} // namespace tessera::vis
