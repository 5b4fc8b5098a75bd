#pragma once

#include "vis/scene/geometry_style.h"
#include "volume/base/describe.h"
#include "volume/flow/seeds.h"

#include <glm/vec3.hpp>
#include <string>

namespace tessera::vis {

enum class FlowKind { Streamlines, Tubes, Hedgehogs, Arrows, Cones, Pathlines };
inline constexpr std::string_view kFlowKindNames[] = {"streamlines", "tubes", "hedgehogs",
                                                      "arrows",      "cones", "pathlines"};
inline bool followsFlow(FlowKind kind) {
    return kind == FlowKind::Streamlines || kind == FlowKind::Tubes || kind == FlowKind::Pathlines;
}

/// A vector field as lines along it, or as glyphs at the seeds. The geometry is computed outside the renderer
/// (flow_geometry.h) and drawn as Scene::geometry.
struct FlowLayer {
    static constexpr std::string_view kType = "flow";
    std::string vector;
    std::string channel; ///< gives the colours
    FlowKind kind = FlowKind::Tubes;
    volume::SeedShape seeds = volume::SeedShape::Random;
    glm::vec3 from{0}, to{1}; ///< corners of the seeding box, in fractions of the data's box
    int count = 60;
    int random = 1;
    std::string weight = {};    ///< "" = none
    bool seedBrushed = false;   ///< seeding density is proportional to the degree of interest
    float length = 2;           ///< of a line in each direction, in fractions of the data's longest edge
    float speed = 1;            ///< of particles: lengths of the data during its whole time range
    float minimumSpeed = 1e-4f; ///< in fractions of the largest speed
    float radius = 0.004f;      ///< of a tube, in fractions of the longest edge as drawn
    float size = 0.05f;         ///< of the longest glyph, in fractions of the longest edge as drawn
    bool scaled = true;         ///< glyph length proportional to the vector, else constant
    GeometryStyle style{.color = glm::vec3(0.75f)}; ///< does not change the geometry
    bool operator==(const FlowLayer&) const = default;
    static void describe(auto& self, auto&& visit) {
        constexpr std::string_view kSeeds = "Seed points", kSizes = "Length and width", kColors = "Colours";
        visit(self.vector, FieldInfo{.key = "vector", .doc = "Vector shown", .refersTo = "vector"});
        visit(self.channel,
              FieldInfo{.key = "channel", .doc = "Parameter that gives the colours", .refersTo = "channel"});
        visit(self.kind,
              FieldInfo{.key = "kind",
                        .doc = "Streamlines or tubes along the flow at the time shown, lines, arrows or cones at the "
                               "seed points, or paths through all times of particles that are at the seed points now",
                        .names = kFlowKindNames});
        visit(self.seeds,
              FieldInfo{.key = "seeds",
                        .doc = "Arrangement of the seed points between the two corners: along the diagonal, on the "
                               "middle plane across the thinnest side, at random in the ball or the box",
                        .names = volume::kSeedShapeNames,
                        .group = kSeeds});
        visit(self.from, FieldInfo{.key = "from",
                                   .doc = "First corner of the seed points, 0 to 1 along each axis of the data",
                                   .range = Range{0, 1},
                                   .group = kSeeds});
        visit(self.to, FieldInfo{.key = "to",
                                 .doc = "Last corner of the seed points, 0 to 1 along each axis of the data",
                                 .range = Range{0, 1},
                                 .group = kSeeds});
        visit(self.count,
              FieldInfo{.key = "count", .doc = "Number of seed points", .range = Range{1, 20000}, .logScale = true});
        visit(self.random,
              FieldInfo{.key = "random",
                        .doc = "Seed of the random number generator for random seed points",
                        .range = Range{0, 1000},
                        .applies = self.seeds == volume::SeedShape::Sphere || self.seeds == volume::SeedShape::Random,
                        .group = kSeeds});
        visit(self.weight,
              FieldInfo{.key = "weight",
                        .doc = "Parameter to which the density of random seed points is proportional; empty: uniform",
                        .refersTo = "optionalChannel",
                        .group = kSeeds});
        visit(self.seedBrushed, FieldInfo{.key = "seedBrushed",
                                          .doc = "Place seed points in the selection; the density of random ones is "
                                                 "proportional to the degree of interest",
                                          .group = kSeeds});
        visit(self.length, FieldInfo{.key = "length",
                                     .doc = "Greatest length of a line in each direction; longest edge of the data = 1",
                                     .range = Range{0.001, 100},
                                     .logScale = true,
                                     .applies = followsFlow(self.kind),
                                     .group = kSizes});
        visit(self.speed, FieldInfo{.key = "speed",
                                    .doc = "Paths: distance, in the length unit of the data, that a vector of 1 covers "
                                           "in one unit of time; 1 for m, s and m/s",
                                    .range = Range{1e-9, 1e9},
                                    .logScale = true,
                                    .applies = self.kind == FlowKind::Pathlines,
                                    .group = kSizes});
        visit(self.minimumSpeed, FieldInfo{.key = "minimumSpeed",
                                           .doc = "Share of the greatest speed below which nothing is drawn",
                                           .range = Range{0, 1},
                                           .group = kSizes});
        visit(self.radius, FieldInfo{.key = "radius",
                                     .doc = "Radius of tubes; longest edge as drawn = 1",
                                     .range = Range{1e-4, 0.1},
                                     .logScale = true,
                                     .applies = self.kind == FlowKind::Tubes || self.kind == FlowKind::Pathlines,
                                     .group = kSizes});
        visit(self.size, FieldInfo{.key = "size",
                                   .doc = "Length of the longest glyph; longest edge as drawn = 1",
                                   .range = Range{1e-3, 1},
                                   .logScale = true,
                                   .applies = !followsFlow(self.kind),
                                   .group = kSizes});
        visit(self.scaled,
              FieldInfo{.key = "scaled",
                        .doc = "Make the length of glyphs proportional to the vector; else all have the same length",
                        .applies = !followsFlow(self.kind),
                        .group = kSizes});
        visit(self.style.lineWidth,
              FieldInfo{.key = "lineWidth",
                        .doc = "Width of lines and hedgehogs",
                        .unit = "pixel",
                        .range = Range{0.5, 20},
                        .applies = self.kind == FlowKind::Streamlines || self.kind == FlowKind::Hedgehogs,
                        .group = kSizes});
        visit(self.style.halo, FieldInfo{.key = "halo",
                                         .doc = "Width of a rim in the colour of the ground that hides what runs "
                                                "behind; 0 = none",
                                         .unit = "pixel",
                                         .range = Range{0, 20},
                                         .group = kSizes});
        visit(self.style.color, FieldInfo{.key = "color",
                                          .doc = "Colour where the parameter has no value (sRGB)",
                                          .range = Range{0, 1},
                                          .group = kColors});
        visit(self.style.opacity,
              FieldInfo{.key = "opacity", .doc = "Opacity", .range = Range{0, 1}, .group = kColors});
        visit(self.style.look, lookField());
    }
};

} // namespace tessera::vis
