#pragma once

#include "vis/scene/look.h"
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

/// A vector parameter as lines that follow it, or as glyphs where they begin; made outside of the renderer
/// (flow_geometry.h) and drawn as Scene::geometry.
struct FlowLayer {
    static constexpr std::string_view kType = "flow";
    std::string vector;
    std::string channel; ///< colours
    FlowKind kind = FlowKind::Tubes;
    volume::SeedShape seeds = volume::SeedShape::Random;
    glm::vec3 from{0}, to{1}; ///< corners of the seeds' box, parts of the data's
    int count = 60;
    int random = 1;
    std::string weight = {};    ///< "" = none
    bool seedBrushed = false;   ///< as dense as the degree of interest is high
    float length = 2;           ///< of a line each way, parts of the data's longest edge
    float speed = 1;            ///< of particles: lengths of the data over its times
    float minimumSpeed = 1e-4f; ///< parts of the greatest
    float radius = 0.004f;      ///< of a tube, parts of the longest edge as drawn
    float size = 0.05f;         ///< of the longest glyph, parts of the longest edge as drawn
    bool scaled = true;         ///< glyphs as long as the vector, else all alike
    float lineWidth = 2;        ///< pixels
    glm::vec3 color{0.75f};     ///< sRGB
    float opacity = 1;
    Look look = {};
    bool operator==(const FlowLayer&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.vector, FieldInfo{.key = "vector", .unit = "", .doc = "Vector shown", .refersTo = "vector"});
        visit(
            self.channel,
            FieldInfo{.key = "channel", .unit = "", .doc = "Parameter whose colours are shown", .refersTo = "channel"});
        visit(self.kind,
              FieldInfo{.key = "kind",
                        .unit = "",
                        .doc =
                            "Lines or tubes along the flow of this moment, lines, arrows or cones where they begin, or "
                            "the ways of particles that are there now, through all times",
                        .names = kFlowKindNames});
        visit(self.seeds, FieldInfo{.key = "seeds",
                                    .unit = "",
                                    .doc = "How beginnings are spread from corner to corner: along the diagonal, on "
                                           "the middle plane of the thinnest side, at random in the ball or the box",
                                    .names = volume::kSeedShapeNames});
        visit(self.from, FieldInfo{.key = "from",
                                   .unit = "",
                                   .doc = "First corner of the beginnings, 0 to 1 through the data",
                                   .range = Range{0, 1}});
        visit(self.to, FieldInfo{.key = "to",
                                 .unit = "",
                                 .doc = "Last corner of the beginnings, 0 to 1 through the data",
                                 .range = Range{0, 1}});
        visit(
            self.count,
            FieldInfo{
                .key = "count", .unit = "", .doc = "Number of beginnings", .range = Range{1, 20000}, .logScale = true});
        visit(self.random,
              FieldInfo{.key = "random",
                        .unit = "",
                        .doc = "Another number spreads random beginnings otherwise",
                        .range = Range{0, 1000},
                        .applies = self.seeds == volume::SeedShape::Sphere || self.seeds == volume::SeedShape::Random});
        visit(self.weight, FieldInfo{.key = "weight",
                                     .unit = "",
                                     .doc = "Random beginnings are as dense as this parameter is high; none = evenly",
                                     .refersTo = "optionalChannel"});
        visit(self.seedBrushed,
              FieldInfo{.key = "seedBrushed",
                        .unit = "",
                        .doc = "Beginnings lie where is brushed; random ones are as dense as the interest is high"});
        visit(self.length, FieldInfo{.key = "length",
                                     .unit = "",
                                     .doc = "Greatest length of a line each way, in longest edges of the data",
                                     .range = Range{0.001, 100},
                                     .logScale = true,
                                     .applies = followsFlow(self.kind)});
        visit(self.speed, FieldInfo{.key = "speed",
                                    .unit = "",
                                    .doc = "Pathlines: lengths of the data's unit that a vector of 1 goes in its unit "
                                           "of time; 1 = m, s and m/s",
                                    .range = Range{1e-9, 1e9},
                                    .logScale = true,
                                    .applies = self.kind == FlowKind::Pathlines});
        visit(self.minimumSpeed, FieldInfo{.key = "minimumSpeed",
                                           .unit = "",
                                           .doc = "Share of the greatest speed below which nothing is drawn",
                                           .range = Range{0, 1}});
        visit(self.radius, FieldInfo{.key = "radius",
                                     .unit = "",
                                     .doc = "Radius of tubes, in longest edges as drawn",
                                     .range = Range{1e-4, 0.1},
                                     .logScale = true,
                                     .applies = self.kind == FlowKind::Tubes || self.kind == FlowKind::Pathlines});
        visit(self.size, FieldInfo{.key = "size",
                                   .unit = "",
                                   .doc = "Length of the longest glyph, in longest edges as drawn",
                                   .range = Range{1e-3, 1},
                                   .logScale = true,
                                   .applies = !followsFlow(self.kind)});
        visit(self.scaled, FieldInfo{.key = "scaled",
                                     .unit = "",
                                     .doc = "Glyphs as long as the vector; else all of one length",
                                     .applies = !followsFlow(self.kind)});
        visit(self.lineWidth,
              FieldInfo{.key = "lineWidth",
                        .unit = "pixel",
                        .doc = "Width of streamlines and hedgehogs",
                        .range = Range{0.5, 20},
                        .applies = self.kind == FlowKind::Streamlines || self.kind == FlowKind::Hedgehogs});
        visit(self.color, FieldInfo{.key = "color",
                                    .unit = "",
                                    .doc = "Colour where the parameter has no value (sRGB)",
                                    .range = Range{0, 1}});
        visit(self.opacity, FieldInfo{.key = "opacity", .unit = "", .doc = "Opacity", .range = Range{0, 1}});
        visit(self.look, lookField());
    }
};

} // namespace tessera::vis
