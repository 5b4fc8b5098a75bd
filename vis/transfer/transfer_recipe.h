#pragma once

#include "vis/transfer/transfer_function.h"
#include "vis/transfer/value_distribution.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Transfer functions that fit other data: their points lie at quantiles of the values instead of values.
namespace tessera::vis {

/// A value of any data. The first of these that applies counts: `hounsfield` in data of that unit, `share` where it is
/// at `place` in these data too (so that a function comes back unchanged to the data it was made for), `place`.
struct RecipePlace {
    double place = 0;                 ///< see valueAtPlace(); about zero: quantile of the magnitudes, with the sign
    std::optional<double> share = {}; ///< of the range; about zero: of the range that is symmetric about 0
    std::optional<double> hounsfield = {};
    bool operator==(const RecipePlace&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.place,
              FieldInfo{.key = "place",
                        .doc = "Quantile of the values above the background; below 0: within the background",
                        .range = Range{-1, 1}});
        visit(self.share, FieldInfo{.key = "share",
                                    .doc = "Share of the range, where it is at this quantile",
                                    .range = Range{-1e6, 1e6}});
        visit(self.hounsfield, FieldInfo{.key = "hounsfield",
                                         .doc = "Value in scans that state Hounsfield units",
                                         .unit = "HU",
                                         .range = Range{-1e5, 1e5}});
    }
};

struct RecipePoint {
    RecipePlace at;
    float opacity = 0;
    bool operator==(const RecipePoint&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.at, FieldInfo{"at", "Value"});
        visit(self.opacity, FieldInfo{.key = "opacity", .doc = "Opacity at the value", .range = Range{0, 1}});
    }
};

struct RecipeColor {
    RecipePlace at;
    glm::vec3 color{1}; ///< sRGB
    bool operator==(const RecipeColor&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.at, FieldInfo{"at", "Value"});
        visit(self.color, FieldInfo{.key = "color", .doc = "Colour at the value (sRGB)", .range = Range{0, 1}});
    }
};

/// Values at the ends of the colours.
struct RecipeRange {
    RecipePlace lo, hi;
    bool operator==(const RecipeRange&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.lo, FieldInfo{"lo", "Value at the lower end of the colours"});
        visit(self.hi, FieldInfo{"hi", "Value at the upper end of the colours"});
    }
};

/// A transfer function for any data. Points are sorted by place.
struct TransferRecipe {
    std::string name = {}, help = {};
    bool scan = false;      ///< for scans rather than computed fields
    bool aboutZero = false; ///< of signed values: places are quantiles of magnitudes, the range is symmetric about 0
    std::string colormap = "viridis"; ///< without `colors`
    bool reversed = false;
    std::vector<RecipePoint> opacity = {};
    std::vector<RecipeColor> colors = {};
    std::optional<RecipeRange> range = {}; ///< else that of the data
    TransferKind kind = TransferKind::Curve;
    std::vector<TransferRegion> regions = {}; ///< as they are: their places are shares of the range
    float gradientTop = TransferFunction{}.gradientTop;
    std::vector<glm::vec2> emphasis = TransferFunction{}.emphasis;
    bool operator==(const TransferRecipe&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.name, FieldInfo{"name", "Name in the library"});
        visit(self.help, FieldInfo{"help", "What it shows"});
        visit(self.scan, FieldInfo{"scan", "For scans rather than computed fields"});
        visit(self.aboutZero, FieldInfo{"aboutZero", "For signed values, symmetric about 0"});
        visit(self.colormap, FieldInfo{.key = "colormap", .doc = "Colour map", .refersTo = "colormap"});
        visit(self.reversed, FieldInfo{"reversed", "Reverse the colour map"});
        visit(self.opacity, FieldInfo{"opacity", "Points of the opacity curve"});
        visit(self.colors, FieldInfo{"colors", "Colours, instead of the colour map"});
        visit(self.range, FieldInfo{"range", "Ends of the colours; without: those of the data"});
        visit(self.kind, FieldInfo{.key = "kind", .doc = "Source of opacity", .names = kTransferKindNames});
        visit(self.regions, FieldInfo{"regions", "Regions of value and gradient magnitude"});
        visit(self.gradientTop, FieldInfo{.key = "gradientTop",
                                          .doc = "Gradient magnitude at the top of the plane of regions",
                                          .unit = "ranges/cell",
                                          .range = Range{1e-4, 2}});
        visit(self.emphasis, FieldInfo{"emphasis", "Emphasis of boundaries"});
    }
};

/// The function of a recipe for a channel with these values and unit. Points outside the range are cut off; the curve
/// has a point at either end.
TransferFunction madeFrom(const TransferRecipe& recipe, const ValueDistribution& values, const std::string& unit);

/// The recipe of a function in use on a channel with these values: madeFrom() it and the same values gives a function
/// that draws the same.
TransferRecipe recipeOf(const std::string& name, const TransferFunction& function, const ValueDistribution& values);

/// The recipes that ship with the program.
std::span<const TransferRecipe> transferLibrary();

/// Whether a recipe says something of data with this range: not those about zero if the values have one sign.
bool suits(const TransferRecipe& recipe, Range range);

/// Names are equal but for case, blanks and signs: "CT bone" is "ct-bone".
bool sameName(std::string_view a, std::string_view b);

/// The name for a list of them: in quotes where it contains a comma.
std::string quotedName(const TransferRecipe& recipe);

} // namespace tessera::vis
