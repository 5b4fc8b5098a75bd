#pragma once

#include "volume/base/describe.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <string>
#include <vector>

/// Strokes along a vector in slices and on surfaces: made outside the renderer (vis/lic), drawn by Scene::strokes and
/// Geometry::strokes.
namespace tessera::vis {

/// How noise is weighted along a stroke. Box: evenly; Hann: most in its middle, so that strokes fade out at both ends.
enum class StrokeKernel { Box, Hann };
inline constexpr std::string_view kStrokeKernelNames[] = {"box", "hann"};

/// Fine strokes along the part of a vector that lies in a slice or a surface, by line integral convolution: they make
/// its colours lighter and darker.
struct Strokes {
    std::string vector = {}; ///< "" = no strokes
    float length = 0.08f;    ///< in fractions of the longest edge as drawn
    float width = 0.004f;    ///< the same
    StrokeKernel kernel = StrokeKernel::Hann;
    float strength = 0.7f;
    bool bySpeed = false;
    bool grey = false;
    int random = 1;
    bool operator==(const Strokes&) const = default;
    static void describe(auto& self, auto&& visit) {
        const bool any = !self.vector.empty();
        visit(self.vector,
              FieldInfo{.key = "vector",
                        .doc = "Vector whose part in the slice or surface strokes follow; empty: no strokes",
                        .refersTo = "optionalVector"});
        visit(self.length, FieldInfo{.key = "length",
                                     .doc = "Length of a stroke; longest edge as drawn = 1",
                                     .range = Range{0.002, 0.5},
                                     .logScale = true,
                                     .applies = any});
        visit(self.width, FieldInfo{.key = "width",
                                    .doc = "Width of a stroke; longest edge as drawn = 1",
                                    .range = Range{0.001, 0.05},
                                    .logScale = true,
                                    .applies = any});
        visit(self.kernel, FieldInfo{.key = "kernel",
                                     .doc = "Strokes of even weight (box), or that fade out at both ends (hann)",
                                     .names = kStrokeKernelNames,
                                     .applies = any});
        visit(self.strength, FieldInfo{.key = "strength",
                                       .doc = "By how much strokes make colours lighter and darker; their mean is the "
                                              "colour itself",
                                       .range = Range{0, 1},
                                       .applies = any});
        visit(self.bySpeed,
              FieldInfo{.key = "bySpeed",
                        .doc = "Fainter where the vector's part in the slice or surface is small; its largest "
                               "value there has full strength",
                        .applies = any});
        visit(self.grey,
              FieldInfo{.key = "grey",
                        .doc = "On grey instead of the colours of the parameter; of a slice nothing where the "
                               "vector has no value",
                        .applies = any});
        visit(self.random, FieldInfo{.key = "random",
                                     .doc = "Seed of the noise that strokes are made of",
                                     .range = Range{0, 1000},
                                     .applies = any});
    }
};
/// As a member of what draws slices.
inline FieldInfo strokesField() {
    return {.key = "strokes", .doc = "Strokes along a vector in the slice or surface"};
}

/// Strokes in a plane of the stretched world, as a picture of square texels. Immutable once in a scene: scenes compare
/// it by address.
struct StrokePicture {
    glm::ivec2 size{0};
    /// Row by row: how light, -1 .. 1 with mean 0, times whether there are strokes; and that, 0 or 1.
    std::vector<glm::vec2> texels;
    glm::dvec3 corner{0};                   ///< of the first texel, world
    glm::dvec3 right{1, 0, 0}, up{0, 1, 0}; ///< along rows and columns; length 1
    double texel = 1;                       ///< edge of a texel, world
};

/// The strokes of a slice.
struct SliceStrokes {
    int layer = 0; ///< index into Scene::layers, of a slice
    std::shared_ptr<const StrokePicture> picture;
    bool operator==(const SliceStrokes&) const = default;
};

/// What reads a picture of strokes at a place of the world: texel = (dot(across.xyz, place) + across.w, the same of
/// up); the middle of the first texel is at 0.5.
struct StrokeMap {
    glm::dvec4 across{0}, up{0};
};
StrokeMap strokeMap(const StrokePicture& picture);

/// Strokes at a place of the world: lightness times coverage, and coverage, linear between texels and constant beyond
/// the outermost ones.
glm::dvec2 sliceStrokes(const StrokePicture& picture, glm::dvec3 place);

} // namespace tessera::vis
