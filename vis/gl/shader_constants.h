#pragma once

#include <string>
#include <string_view>

/// Enumerations that shaders know by name. Every shader begins with a `#define PREFIX_NAME number` for each of their
/// enumerators, so that no number is written down twice. Those of scenes are defined there (RayStyle, LensShape,
/// ClipKind, BrushEffect, ToneCurve); those that only the ray caster knows are here.
namespace tessera::vis {

/// Classification of a composite layer: by the curve at its value (Curve), by a table over value and gradient (Plane),
/// by the curve at the surrounding samples (Lattice), or by the pre-integration table (Slab).
enum class RayLookup { Curve, Plane, Lattice, Slab };
inline constexpr std::string_view kRayLookupNames[] = {"curve", "plane", "lattice", "slab"};

/// What a test of a brush looks at.
enum class BrushTestKind { Always, Range, Ellipse, Lasso, Sphere, Box, Lens };
inline constexpr std::string_view kBrushTestNames[] = {"always", "range", "ellipse", "lasso", "sphere", "box", "lens"};

/// What a look does that a program needs code for; a set of them has the bit 1 << feature of each.
enum class LookFeature { Tone, Boundary, Silhouette, Distance, Cartoon, Charcoal, Wire };
inline constexpr std::string_view kLookFeatureNames[] = {"tone",    "boundary", "silhouette", "distance",
                                                         "cartoon", "charcoal", "wire"};
constexpr int bitOf(LookFeature feature) {
    return 1 << int(feature);
}

/// The defines of all of them, as shader text.
const std::string& shaderConstants();

} // namespace tessera::vis
