#pragma once

#include <string>
#include <string_view>

/// Enumerations shared with the shaders. Every shader begins with `#define PREFIX_NAME number` for each enumerator, so
/// that no number is written twice. Enumerations of the scene are declared there (RayStyle, LensShape, ClipKind,
/// BrushEffect, ToneCurve, BrushTestKind), those used only by the ray caster here.
namespace tessera::vis {

/// Classification of a composite layer: by the 1D transfer function at its value (Curve), by a 2D table over value and
/// gradient magnitude (Plane), at the surrounding samples before interpolation (Lattice), or by the pre-integration
/// table (Slab).
enum class RayLookup { Curve, Plane, Lattice, Slab };
inline constexpr std::string_view kRayLookupNames[] = {"curve", "plane", "lattice", "slab"};

/// Features of looks that need shader code; sets of them are bit masks of 1 << feature.
enum class LookFeature { Tone, Boundary, Silhouette, Distance, Cartoon, Charcoal, Wire, Smooth, Follow, Cross, Dots };
inline constexpr std::string_view kLookFeatureNames[] = {
    "tone", "boundary", "silhouette", "distance", "cartoon", "charcoal", "wire", "smooth", "follow", "cross", "dots"};
constexpr int bitOf(LookFeature feature) {
    return 1 << int(feature);
}

/// Defines for all of these enumerations, as shader source.
const std::string& shaderConstants();

} // namespace tessera::vis
