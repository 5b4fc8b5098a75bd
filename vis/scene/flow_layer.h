#pragma once

#include "vis/scene/geometry_style.h"
#include "volume/base/data_units.h"
#include "volume/base/describe.h"
#include "volume/flow/seeds.h"

#include <glm/vec3.hpp>
#include <string>

namespace tessera::vis {

enum class FlowKind {
    Streamlines,
    Tubes,
    Hedgehogs,
    Arrows,
    Cones,
    Pathlines,
    Streaklines,
    Timelines,
    Speedlines,
    BentArrows,
};
inline constexpr std::string_view kFlowKindNames[] = {"streamlines", "tubes",     "hedgehogs",   "arrows",
                                                      "cones",       "pathlines", "streaklines", "timelines",
                                                      "speedlines",  "bentArrows"};
/// Lines along the flow at one time.
inline bool followsFlow(FlowKind kind) {
    return kind == FlowKind::Streamlines || kind == FlowKind::Tubes || kind == FlowKind::BentArrows;
}
/// Made of particles that move while time passes.
inline bool followsParticles(FlowKind kind) {
    return kind == FlowKind::Pathlines || kind == FlowKind::Streaklines || kind == FlowKind::Timelines ||
           kind == FlowKind::Speedlines;
}
inline bool isFlowGlyph(FlowKind kind) {
    return !followsFlow(kind) && !followsParticles(kind);
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
    float separation = 0.08f;   ///< of even seeds, in fractions of the longest edge as drawn
    std::string weight = {};    ///< "" = none
    bool seedBrushed = false;   ///< seeding density is proportional to the degree of interest
    float length = 2;           ///< of a line in each direction, in fractions of the data's longest edge
    float speed = 1;            ///< factor on the speed of particles; 1: true to the units
    bool ignoreUnits = false;   ///< a vector of 1 moves 1 length per time, whatever the units
    double span = 0;            ///< unit of the times of the data, 0: chosen, as its help says
    int steps = 8;              ///< timelines of each line of seeds
    bool together = false;      ///< timelines are released at the time shown; else one after another until then
    float band = 0;             ///< width of timelines, in shares of the time between two
    float tail = 0.5f;          ///< of a particle, in shares of its life
    float phase = 0;            ///< of the life of particles
    bool flat = false;          ///< bent arrows are ribbons
    float minimumSpeed = 1e-4f; ///< in fractions of the largest speed
    float radius = 0.004f;      ///< of a tube, in fractions of the longest edge as drawn
    float contextWidth = 1;     ///< of tubes and glyphs at degree of interest 0, as a share of that at 1
    float size = 0.05f;         ///< of the longest glyph, in fractions of the longest edge as drawn
    int blur = 0;               ///< fading copies behind each arrow or cone
    bool scaled = true;         ///< glyph length proportional to the vector, else constant
    GeometryStyle style{.color = glm::vec3(0.75f)}; ///< does not change the geometry
    bool operator==(const FlowLayer&) const = default;
    static void describe(auto& self, auto&& visit) {
        constexpr std::string_view kSeeds = "Seed points", kSizes = "Length and width", kColors = "Colours",
                                   kParticles = "Particles";
        const bool particles = followsParticles(self.kind);
        visit(self.vector, FieldInfo{.key = "vector", .doc = "Vector shown", .refersTo = "vector"});
        visit(self.channel,
              FieldInfo{.key = "channel", .doc = "Parameter that gives the colours", .refersTo = "channel"});
        visit(self.kind,
              FieldInfo{.key = "kind",
                        .doc = "Streamlines, tubes or bent arrows along the flow at the time shown; lines, arrows or "
                               "cones at the seed points; paths through all times of particles that are at the seed "
                               "points now; streaklines of all particles that have been released there; timelines of "
                               "particles released together along a line; or moving particles with a tail",
                        .names = kFlowKindNames});
        visit(self.seeds,
              FieldInfo{.key = "seeds",
                        .doc = "Arrangement of the seed points between the two corners: along the diagonal, on the "
                               "middle plane across the thinnest side, at random in the ball or the box, or with "
                               "even distances between the lines. Timelines begin on the rows of a plane, else on "
                               "the diagonal",
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
              FieldInfo{
                  .key = "count",
                  .doc = "Number of seed points, at most that of even ones; timelines on a plane have its root as rows",
                  .range = Range{1, 20000},
                  .logScale = true});
        visit(self.random,
              FieldInfo{.key = "random",
                        .doc = "Seed of the random number generator for random seed points",
                        .range = Range{0, 1000},
                        .applies = self.seeds == volume::SeedShape::Sphere || self.seeds == volume::SeedShape::Random,
                        .group = kSeeds});
        visit(self.separation,
              FieldInfo{.key = "separation",
                        .doc = "Distance between even seed points and the lines of others; longest edge as drawn = 1",
                        .range = Range{0.005, 1},
                        .logScale = true,
                        .applies = self.seeds == volume::SeedShape::Even,
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
                                     .applies = followsFlow(self.kind) || self.kind == FlowKind::Pathlines,
                                     .group = kSizes});
        visit(self.speed, FieldInfo{.key = "speed",
                                    .doc = "Factor on the speed of particles; 1 = true to the units of the data",
                                    .range = Range{1e-9, 1e9},
                                    .logScale = true,
                                    .applies = particles,
                                    .group = kParticles});
        visit(self.ignoreUnits,
              FieldInfo{.key = "ignoreUnits",
                        .doc = "Let a vector of 1 move a particle by 1 length of the data in 1 unit of time, whatever "
                               "their units are",
                        .applies = particles,
                        .group = kParticles});
        visit(self.span,
              FieldInfo{.key = "span",
                        .doc = "Time since the first release of streaklines, between the first and the last timeline, "
                               "or that moving particles live; 0 = streaklines: all since the first time; timelines: "
                               "in which the fastest cross the longest edge of the data; particles: a quarter of that",
                        .unit = kUnitOfTimes,
                        .range = Range{0, 1e12},
                        .applies = particles && self.kind != FlowKind::Pathlines,
                        .group = kParticles});
        visit(self.steps, FieldInfo{.key = "steps",
                                    .doc = "Timelines of each line of seed points",
                                    .range = Range{1, 200},
                                    .applies = self.kind == FlowKind::Timelines,
                                    .group = kParticles});
        visit(self.together,
              FieldInfo{.key = "together",
                        .doc = "Release all particles at the time shown and draw where they are later; else a line of "
                               "them is released again and again until now and drawn where it is now",
                        .applies = self.kind == FlowKind::Timelines,
                        .group = kParticles});
        visit(self.band, FieldInfo{.key = "band",
                                   .doc = "Width of timelines as bands: the share of the time between two of them that "
                                          "the band covers; 0 = lines",
                                   .range = Range{0, 1},
                                   .applies = self.kind == FlowKind::Timelines,
                                   .group = kParticles});
        visit(self.tail, FieldInfo{.key = "tail",
                                   .doc = "Length of the tail of a moving particle, as a share of the time it lives",
                                   .range = Range{0, 1},
                                   .applies = self.kind == FlowKind::Speedlines,
                                   .group = kParticles});
        visit(self.phase,
              FieldInfo{.key = "phase",
                        .doc = "Share of a life, or of the time between two lines, by which moving particles and "
                               "timelines are ahead: 0 to 1 moves them where time stands still",
                        .range = Range{0, 1},
                        .applies =
                            self.kind == FlowKind::Speedlines || (self.kind == FlowKind::Timelines && !self.together),
                        .group = kParticles});
        visit(self.minimumSpeed,
              FieldInfo{.key = "minimumSpeed",
                        .doc = "Share of the greatest speed below which nothing is drawn; particles begin where it "
                               "flows faster at some time",
                        .range = Range{0, 1},
                        .group = kSizes});
        visit(self.radius,
              FieldInfo{.key = "radius",
                        .doc = "Radius of tubes, particles and the shafts of bent arrows; longest edge as drawn = 1",
                        .range = Range{1e-4, 0.1},
                        .logScale = true,
                        .applies = particles || (followsFlow(self.kind) && self.kind != FlowKind::Streamlines),
                        .group = kSizes});
        visit(self.flat, FieldInfo{.key = "flat",
                                   .doc = "Draw bent arrows as flat ribbons",
                                   .applies = self.kind == FlowKind::BentArrows,
                                   .group = kSizes});
        visit(self.contextWidth,
              FieldInfo{.key = "contextWidth",
                        .doc = "Width of tubes, and length of glyphs, where the brushes select nothing, as a share of "
                               "that in the selection; 1: the same",
                        .range = Range{0, 1},
                        .applies = self.kind == FlowKind::Tubes || isFlowGlyph(self.kind),
                        .group = kSizes});
        visit(self.size, FieldInfo{.key = "size",
                                   .doc = "Length of the longest glyph; longest edge as drawn = 1",
                                   .range = Range{1e-3, 1},
                                   .logScale = true,
                                   .applies = isFlowGlyph(self.kind),
                                   .group = kSizes});
        visit(self.scaled,
              FieldInfo{.key = "scaled",
                        .doc = "Make the length of glyphs proportional to the vector; else all have the same length",
                        .applies = isFlowGlyph(self.kind),
                        .group = kSizes});
        visit(self.blur,
              FieldInfo{.key = "blur",
                        .doc = "Motion blur: so many fading copies of each arrow or cone where it came from, the last "
                               "where the fastest was one length of it before",
                        .range = Range{0, 12},
                        .applies = self.kind == FlowKind::Arrows || self.kind == FlowKind::Cones,
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
