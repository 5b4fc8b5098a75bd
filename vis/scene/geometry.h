#pragma once

#include "vis/scene/brush_effect.h"
#include "vis/scene/geometry_style.h"
#include "volume/mesh/surface_mesh.h"

#include <algorithm>
#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <string>
#include <vector>

/// Triangles and lines drawn together with the volumes: iso-surfaces as polygons, and any other meshes.
///
///     auto streamlines = std::make_shared<Geometry>();
///     streamlines->lines.positions = {...};     // of the sheet: physical where axes are even
///     streamlines->lines.scalars = {...};       // e.g. the speed at each vertex
///     streamlines->lines.ends = {120, 260};     // two lines: vertices 0..119 and 120..259
///     scene.geometry.push_back({.geometry = streamlines, .style = {.lineWidth = 3}, .channel = "|U|"});
///
/// They are depth peeled before ray casting and composited along the rays (ray_setup.h), so that volumes, slices,
/// surfaces and lines occlude each other correctly.
namespace tessera::vis {

/// Open polylines.
struct LineSet {
    std::vector<glm::vec3> positions; ///< of the sheet, less the origin
    std::vector<float> scalars;       ///< one per vertex, or empty
    std::vector<std::uint32_t> ends;  ///< per line: one past its last vertex
    glm::dvec3 origin{0};             ///< as that of volume::SurfaceMesh
    bool operator==(const LineSet&) const = default;
};

/// Meshes and lines of one style, on the sheet of the data's axes (volume/field/axis_map.h), which world space is
/// affine to. Immutable once in a scene: scenes compare it by address.
struct Geometry {
    volume::SurfaceMesh mesh; ///< of the sheet; both sides of a triangle are lit
    LineSet lines;            ///< lit like thin tubes
    /// Colour (linear light) and opacity of the vertices of the mesh, or empty; red below 0: coloured by the scalar. A
    /// triangle has the tint of its last vertex. Opacities multiply that of the style.
    std::vector<glm::vec4> tints;
    bool translucent = false; ///< some tint has an opacity below 1
    /// By how much the vertices of the mesh are lighter or darker, -1..1 with mean 0 (withStrokes, vis/formulas), or
    /// empty.
    std::vector<float> strokes = {};
    std::vector<std::string> notes = {}; ///< what of it is coarser than the data, or left out, for users
};

struct GeometryLayer {
    std::shared_ptr<const Geometry> geometry;
    GeometryStyle style = {};
    std::string channel = {};  ///< its transfer function colours the scalars; "": the style's colour
    std::string lens = {};     ///< name of the lens that it is drawn in; "": everywhere
    std::string transfer = {}; ///< name of a transfer function that replaces that of `channel`
    BrushEffect brushes = BrushEffect::Fade;
    bool operator==(const GeometryLayer&) const = default;
};

/// The layers, after each one with GeometryStyle::halo its halo: a rim of a colour (sRGB) behind its lines and the
/// closed meshes of it whose normals point outwards, which hides what is farther away (line drawings that overlap come
/// apart: A. Appel, F. J. Rohlf, A. J. Stein: The haloed line effect for hidden line elimination, SIGGRAPH 1979).
std::vector<GeometryLayer> withHalos(const std::vector<GeometryLayer>& layers, glm::vec3 color);

/// A note on what is computed at a level of detail: "flow of U: from every 4th sample along each axis".
std::string coarserText(const std::string& what, int level);

/// Number of depth-peeling layers per pixel if some surfaces are translucent. Surfaces behind the last one are omitted.
inline constexpr int kPeels = 4;

} // namespace tessera::vis
