#pragma once

#include "vis/glyphs/glyph_mesh.h"
#include "vis/scene/glyph_layer.h"

#include <cstdint>
#include <glm/mat3x3.hpp>

/// Glyphs as meshes, moved by the values of their parts.
///
/// References: J. Siegel et al., The surgical implications of physiologic patterns, 1971 (stars); R. M. Pickett,
/// G. Grinstein, Iconographic displays for visualizing multidimensional data, 1988 (stick figures); G. Kindlmann,
/// Superquadric tensor glyphs, 2004.
namespace tessera::vis {

/// Value of a part that no parameter moves. NaN: its parameter is absent.
inline constexpr double kPartAtRest = -10;

/// Share of the most of a part that its least has: a least value can be told from one that is absent.
inline constexpr double kLeastPart = 0.15;
inline double partLength(double value) {
    return kLeastPart + (1 - kLeastPart) * value;
}

/// Sets `shape` to a glyph. `values`: one for each of glyphPartNames(), in 0..1, of tensors in -1..1; NaN where absent:
/// the part is left out, or the whole shape where isWholeGlyph(). Size, colour, opacity and tilt are left to the
/// caller. `sides`: of what is round, at least 3; figures of rods have fewer triangles below 8, and no back
/// below 6.
///
/// - arrow, cone: length and width are partLength(value) of the most; at rest the most.
/// - six-sided cone: side i, counter-clockwise seen from the tip, is filled from its base up to partLength(value) of
///   its height.
/// - star, bars, pie: those parts that are not at rest, clockwise from above, or from the left; a spoke ends at
///   partLength(value) of the radius; a bar has that share of its height; a slice has that share of its area.
/// - jumping jack: an arm turns by 140 degrees from hanging, a leg by 65 from standing; head and body grow.
/// - superquadric: its exponents are partLength(alpha) and partLength(beta), 1 at rest: a sphere; its radii the others.
/// - ellipsoid: its axes are the eigenvectors of the symmetric tensor, its radii the magnitudes of the eigenvalues, 1
///   being the radius of the ball; components at rest are 0, all of them: a sphere.
void makeGlyphShape(GlyphKind kind, std::span<const double> values, int sides, GlyphShape& shape);

/// Eigenvalues of a symmetric matrix, and unit eigenvectors as columns, right-handed, by rotations of Jacobi.
struct Eigen3 {
    glm::dvec3 values{0};
    glm::dmat3 vectors{1};
};
Eigen3 eigenOf(glm::dmat3 symmetric);

} // namespace tessera::vis
