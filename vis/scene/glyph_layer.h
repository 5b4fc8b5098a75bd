#pragma once

#include "vis/scene/geometry_style.h"
#include "volume/base/describe.h"

#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::vis {

enum class GlyphKind { Arrow, Cone, SixSided, Star, Bars, Pie, JumpingJack, Superquadric, Ellipsoid };
inline constexpr std::string_view kGlyphKindNames[] = {"arrow", "cone",        "sixSided",     "star",     "bars",
                                                       "pie",   "jumpingJack", "superquadric", "ellipsoid"};

/// Where glyphs stand: on a plane, along a line, in a box, on an iso-surface, or one alone at the cross-hair.
enum class GlyphPlace { Plane, Line, Box, Surface, Cursor };
inline constexpr std::string_view kGlyphPlaceNames[] = {"plane", "line", "box", "surface", "cursor"};

/// A part of a glyph that a parameter moves: its size, colour, opacity, tilt, a spoke, a side, a limb ...
struct GlyphPart {
    std::string part;    ///< one of glyphPartNames of the kind
    std::string channel; ///< "" = none: the part is at rest
    Range range{0, 0};   ///< values of the least and the most of the part; no width: the parameter's own range
    bool operator==(const GlyphPart&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.part, FieldInfo{"part", "Part of the glyph"});
        visit(self.channel,
              FieldInfo{.key = "channel", .doc = "Parameter that moves the part", .refersTo = "optionalChannel"});
        visit(self.range, FieldInfo{"range", "Values of the least and the most of the part; equal: the parameter's "
                                             "own range"});
    }
};

/// Figures whose parts are moved by many parameters at once, at points of the data (N. Roeber 2002, 5.3.6). The
/// geometry is computed outside the renderer and drawn as Scene::geometry.
struct GlyphLayer {
    static constexpr std::string_view kType = "glyphs";
    std::string channel; ///< gives the colours of kinds whose parts have none of their own
    GlyphKind kind = GlyphKind::Star;
    std::string direction = {}; ///< vector that glyphs point along; "" = they stand upright
    std::vector<GlyphPart> parts = {};
    GlyphPlace place = GlyphPlace::Plane;
    bool even = false;        ///< on a grid, else by blue noise
    glm::vec3 from{0}, to{1}; ///< corners, in fractions of the data's box
    int count = 300;
    int random = 1;
    std::string weight = {};                        ///< "" = none
    bool seedBrushed = false;                       ///< the density is proportional to the degree of interest
    std::string surface = {};                       ///< parameter of the iso-surface that they stand on
    double surfaceValue = 0.5;                      ///< physical
    float size = 0.05f;                             ///< of the largest glyph, in fractions of the longest edge as drawn
    GeometryStyle style{.color = glm::vec3(0.75f)}; ///< does not change the geometry
    bool operator==(const GlyphLayer&) const = default;
    static void describe(auto& self, auto&& visit) {
        constexpr std::string_view kPlaces = "Places", kColors = "Colours";
        visit(self.channel,
              FieldInfo{.key = "channel",
                        .doc = "Parameter that gives the colours of glyphs whose parts have none of their own",
                        .refersTo = "channel"});
        visit(self.kind, FieldInfo{.key = "kind", .doc = "Shape of the glyphs", .names = kGlyphKindNames});
        visit(self.direction, FieldInfo{.key = "direction",
                                        .doc = "Vector that the glyphs point along; empty: they stand upright",
                                        .refersTo = "optionalVector"});
        visit(self.parts, FieldInfo{"parts", "Parameters that move the parts of the glyph"});
        visit(self.place, FieldInfo{.key = "place",
                                    .doc = "Where glyphs stand: on the middle plane across the thinnest side of the "
                                           "box between the two corners, on its diagonal, in all of it, on an "
                                           "iso-surface in it, or one at the cross-hair",
                                    .names = kGlyphPlaceNames,
                                    .group = kPlaces});
        visit(self.even, FieldInfo{.key = "even",
                                   .doc = "Stand on a grid; else at random with even distances, as on a surface always",
                                   .applies = self.place != GlyphPlace::Cursor && self.place != GlyphPlace::Surface,
                                   .group = kPlaces});
        visit(self.from, FieldInfo{.key = "from",
                                   .doc = "First corner of the places, 0 to 1 along each axis of the data",
                                   .range = Range{0, 1},
                                   .applies = self.place != GlyphPlace::Cursor,
                                   .group = kPlaces});
        visit(self.to, FieldInfo{.key = "to",
                                 .doc = "Last corner of the places, 0 to 1 along each axis of the data",
                                 .range = Range{0, 1},
                                 .applies = self.place != GlyphPlace::Cursor,
                                 .group = kPlaces});
        visit(self.count, FieldInfo{.key = "count",
                                    .doc = "Number of glyphs; fewer where they would overlap",
                                    .range = Range{1, 50000},
                                    .logScale = true,
                                    .applies = self.place != GlyphPlace::Cursor});
        visit(self.random, FieldInfo{.key = "random",
                                     .doc = "Seed of the random number generator",
                                     .range = Range{0, 1000},
                                     .applies = !self.even && self.place != GlyphPlace::Cursor,
                                     .group = kPlaces});
        visit(self.weight, FieldInfo{.key = "weight",
                                     .doc = "Parameter to which the density of glyphs is proportional; empty: uniform",
                                     .refersTo = "optionalChannel",
                                     .applies = self.place != GlyphPlace::Cursor,
                                     .group = kPlaces});
        visit(self.seedBrushed, FieldInfo{.key = "seedBrushed",
                                          .doc = "Place glyphs in the selection, denser where the degree of interest "
                                                 "is higher",
                                          .applies = self.place != GlyphPlace::Cursor,
                                          .group = kPlaces});
        visit(self.surface, FieldInfo{.key = "surface",
                                      .doc = "Parameter of the iso-surface that they stand on",
                                      .refersTo = "optionalChannel",
                                      .applies = self.place == GlyphPlace::Surface,
                                      .group = kPlaces});
        visit(self.surfaceValue, FieldInfo{.key = "surfaceValue",
                                           .doc = "Value on that surface",
                                           .applies = self.place == GlyphPlace::Surface,
                                           .group = kPlaces});
        visit(self.size, FieldInfo{.key = "size",
                                   .doc = "Size of the largest glyph; longest edge as drawn = 1",
                                   .range = Range{1e-3, 1},
                                   .logScale = true});
        visit(self.style.color, FieldInfo{.key = "color",
                                          .doc = "Colour where the parameter has no value (sRGB)",
                                          .range = Range{0, 1},
                                          .group = kColors});
        visit(self.style.opacity,
              FieldInfo{.key = "opacity", .doc = "Opacity", .range = Range{0, 1}, .group = kColors});
        visit(self.style.lineWidth, FieldInfo{.key = "lineWidth",
                                              .doc = "Width of lines",
                                              .unit = "pixel",
                                              .range = Range{0.5, 20},
                                              .group = kColors});
        visit(self.style.halo, FieldInfo{.key = "halo",
                                         .doc = "Width of a rim in the colour of the ground that hides what stands "
                                                "behind; 0 = none",
                                         .unit = "pixel",
                                         .range = Range{0, 20},
                                         .group = kColors});
        visit(self.style.look, lookField());
    }
};

} // namespace tessera::vis
