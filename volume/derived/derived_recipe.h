#pragma once

#include "volume/base/describe.h"
#include "volume/derived/other_time.h"
#include "volume/pieces/find_pieces.h"

#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>

/// How parameters are computed from others. A new way is a struct here, with its kind and its description, and how its
/// bricks are made (volume/derived/derived_bricks.cpp).
namespace tessera::volume {

/// The unit that a derived parameter has at first.
enum class DerivedUnit { OfInput, InputPerLength, Length, Time, None };

/// What is said of a way to compute parameters.
struct DerivedKind {
    std::string_view title;  ///< in menus
    std::string_view doc;    ///< a sentence for the documentation
    std::string_view words;  ///< by which its command is found; "": it has commands of its own
    std::string_view prefix; ///< of the name at first, before that of its input
    int components = 1;      ///< 3: a vector, with magnitude
    DerivedUnit unit = DerivedUnit::OfInput;
    bool categorical = false; ///< a label: whole numbers of regions, never mixed
    /// Whether the parameter between two stored times is that of both times mixed, where its inputs are.
    bool linear = true;
};

/// A formula over channels, position and time, point by point: "O2 / (O2 + H2O)", "T - at(T, first)". See Expression.
struct ExpressionRecipe {
    static constexpr std::string_view kType = "expression";
    static constexpr DerivedKind kKind{.title = "Formula",
                                       .doc = "A formula.",
                                       .words = "expression equation function",
                                       .prefix = "new ",
                                       .linear = false};
    std::string formula;
    bool operator==(const ExpressionRecipe&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(
            self.formula,
            FieldInfo{"formula",
                      "Formula of parameters, the position x y z and the time t, e.g. O2/(O2+H2O), T - at(T, first)"});
    }
};

/// sqrt(x^2 + y^2 + z^2) of three channels.
struct MagnitudeRecipe {
    static constexpr std::string_view kType = "magnitude";
    static constexpr DerivedKind kKind{.title = "Magnitude",
                                       .doc = "The length of a vector of three parameters.",
                                       .words = "length norm absolute",
                                       .prefix = "magnitude",
                                       .linear = false};
    std::string x, y, z;
    bool operator==(const MagnitudeRecipe&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.x, FieldInfo{.key = "x", .doc = "First component", .refersTo = "channel"});
        visit(self.y, FieldInfo{.key = "y", .doc = "Second component", .refersTo = "channel"});
        visit(self.z, FieldInfo{.key = "z", .doc = "Third component", .refersTo = "channel"});
    }
};

inline constexpr FieldInfo kDerivedFrom{.key = "channel", .doc = "Parameter to compute from", .refersTo = "channel"};

/// A vector, with magnitude: central differences within each sublattice, one-sided beside absent samples and borders.
struct GradientRecipe {
    static constexpr std::string_view kType = "gradient";
    static constexpr DerivedKind kKind{.title = "Gradient",
                                       .doc = "A vector.",
                                       .words = "grad derivative slope",
                                       .prefix = "grad ",
                                       .components = 3,
                                       .unit = DerivedUnit::InputPerLength};
    std::string channel;
    bool operator==(const GradientRecipe&) const = default;
    static void describe(auto& self, auto&& visit) { visit(self.channel, kDerivedFrom); }
};

inline constexpr FieldInfo kDerivedVector{.key = "vector", .doc = "Vector to compute from", .refersTo = "vector"};

struct DivergenceRecipe {
    static constexpr std::string_view kType = "divergence";
    static constexpr DerivedKind kKind{.title = "Divergence",
                                       .doc = "The divergence of a vector.",
                                       .words = "div sources",
                                       .prefix = "div ",
                                       .unit = DerivedUnit::InputPerLength};
    std::string vector;
    bool operator==(const DivergenceRecipe&) const = default;
    static void describe(auto& self, auto&& visit) { visit(self.vector, kDerivedVector); }
};

/// The curl of a vector: a vector, with magnitude.
struct VorticityRecipe {
    static constexpr std::string_view kType = "vorticity";
    static constexpr DerivedKind kKind{.title = "Vorticity",
                                       .doc = "The curl of a vector: a vector.",
                                       .words = "curl rotation",
                                       .prefix = "curl ",
                                       .components = 3,
                                       .unit = DerivedUnit::InputPerLength};
    std::string vector;
    bool operator==(const VorticityRecipe&) const = default;
    static void describe(auto& self, auto&& visit) { visit(self.vector, kDerivedVector); }
};

enum class TimeMeasure { FromMean, StandardDeviation };
inline constexpr std::string_view kTimeMeasureNames[] = {"fromMean", "standardDeviation"};

/// Difference of a channel, at every point, from its mean over all times at which it is present.
struct DeviationRecipe {
    static constexpr std::string_view kType = "deviation";
    static constexpr DerivedKind kKind{.title = "Deviation over time",
                                       .doc = "Deviation from the mean over time.",
                                       .words = "fluctuation mean variance",
                                       .prefix = "deviation "};
    std::string channel;
    TimeMeasure measure = TimeMeasure::FromMean;
    bool operator==(const DeviationRecipe&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.channel, kDerivedFrom);
        visit(self.measure, FieldInfo{.key = "measure",
                                      .doc = "Difference from the mean over time, or the standard deviation",
                                      .names = kTimeMeasureNames});
    }
};

/// A Gaussian over present samples of the same sublattice, cut at three widths.
struct SmoothRecipe {
    static constexpr std::string_view kType = "smooth";
    static constexpr DerivedKind kKind{.title = "Smoothed",
                                       .doc = "A copy smoothed by a Gaussian.",
                                       .words = "smooth filter blur gaussian average",
                                       .prefix = "smooth "};
    std::string channel;
    double width = 1; ///< cells
    bool operator==(const SmoothRecipe&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.channel, kDerivedFrom);
        visit(self.width, FieldInfo{.key = "width",
                                    .doc = "Standard deviation of the Gaussian",
                                    .unit = "cell",
                                    .range = Range{0.1, 16},
                                    .logScale = true});
    }
};

/// The position of a sample: a vector "name.x", "name.y", "name.z" in the data's length unit.
struct PositionRecipe {
    static constexpr std::string_view kType = "position";
    static constexpr DerivedKind kKind{.title = "Position",
                                       .doc = "The position of a sample: a vector.",
                                       .words = "coordinates xyz",
                                       .prefix = "position",
                                       .components = 3,
                                       .unit = DerivedUnit::Length};
    bool operator==(const PositionRecipe&) const = default;
    static void describe(auto&, auto&&) {}
};

/// The time of a sample, the same everywhere.
struct TimeRecipe {
    static constexpr std::string_view kType = "time";
    static constexpr DerivedKind kKind{
        .title = "Time", .doc = "The time of a sample.", .words = "clock", .prefix = "time", .unit = DerivedUnit::Time};
    bool operator==(const TimeRecipe&) const = default;
    static void describe(auto&, auto&&) {}
};

/// A channel minus itself at another time, or in the other data set (volume/derived/other_source.h); absent where
/// either is.
struct DifferenceRecipe {
    static constexpr std::string_view kType = "difference";
    static constexpr DerivedKind kKind{.title = "Difference from another time",
                                       .doc = "A parameter minus itself at another time or in other data.",
                                       .words = "",
                                       .prefix = ""};
    std::string channel;
    OtherTime from = OtherTime::First;
    double time = 0; ///< of OtherTime::Time
    bool operator==(const DifferenceRecipe&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.channel, kDerivedFrom);
        visit(self.from, FieldInfo{.key = "from",
                                   .doc = "What to subtract: the values at the first, last, previous, next or a stated "
                                          "time, or those of the other data set",
                                   .names = kOtherTimeNames});
        visit(self.time,
              FieldInfo{.key = "time",
                        .doc = "Stated time, in the unit of the times of the data; interpolated between stored times",
                        .applies = self.from == OtherTime::Time});
    }
    TimeReference reference() const { return {from, time}; }
};

/// The number of the piece that a sample belongs to (volume/pieces/find_pieces.h), 0 in none: a label. Between stored
/// times that of the nearer one.
struct PiecesRecipe {
    static constexpr std::string_view kType = "pieces";
    static constexpr DerivedKind kKind{.title = "Pieces",
                                       .doc = "The number of the connected piece above or below a value that a sample "
                                              "belongs to, the same over time; 0 in none: a label.",
                                       .words = "connected components blobs track label regions",
                                       .prefix = "pieces of ",
                                       .unit = DerivedUnit::None,
                                       .categorical = true};
    std::string channel;
    double value = 0;
    PieceSide side = PieceSide::Above;
    double leastVolume = 0;
    bool operator==(const PiecesRecipe&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.channel, kDerivedFrom);
        visit(self.value, FieldInfo{"value", "Value that samples of pieces reach, in the unit of the parameter"});
        visit(self.side, FieldInfo{.key = "side",
                                   .doc = "Pieces of what is at least the value (above), or at most (below)",
                                   .names = kPieceSideNames});
        visit(self.leastVolume,
              FieldInfo{.key = "leastVolume",
                        .doc = "Volume that a piece has when it is largest, in cubes of the unit of lengths; smaller "
                               "ones are left out",
                        .range = Range{0, 1e30}});
    }
};

/// How far a stored sample may be from the one that was packed: the same wherever the channel is present.
struct UncertaintyRecipe {
    static constexpr std::string_view kType = "uncertainty";
    static constexpr DerivedKind kKind{.title = "Uncertainty of packing",
                                       .doc = "How far a sample may be from the one that was packed: the bound that "
                                              "the archive keeps, or the largest error measured when it was packed.",
                                       .words = "error bound accuracy precision archive",
                                       .prefix = "uncertainty "};
    std::string channel;
    /// In the unit of the channel: from where the data are opened, which alone knows it. Nothing: not known, and absent
    /// everywhere.
    std::optional<double> bound = {};
    bool operator==(const UncertaintyRecipe&) const = default;
    static void describe(auto& self, auto&& visit) { visit(self.channel, kDerivedFrom); }
};

using DerivedRecipe =
    std::variant<ExpressionRecipe, MagnitudeRecipe, GradientRecipe, DivergenceRecipe, VorticityRecipe, DeviationRecipe,
                 SmoothRecipe, PositionRecipe, TimeRecipe, DifferenceRecipe, PiecesRecipe, UncertaintyRecipe>;

inline constexpr std::size_t kDerivedKinds = std::variant_size_v<DerivedRecipe>;

/// Calls visit(name, whether it is that of a vector) for each parameter that a recipe names, but for those in formulas.
void forEachInput(auto& recipe, auto&& visit) {
    std::remove_cvref_t<decltype(recipe)>::describe(recipe, [&](auto& value, const FieldInfo& info) {
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(value)>, std::string>)
            if (!info.refersTo.empty()) visit(value, info.refersTo == "vector");
    });
}

inline const DerivedKind& kindOf(const DerivedRecipe& recipe) {
    return std::visit([](const auto& own) -> const DerivedKind& { return own.kKind; }, recipe);
}

/// A recipe of the kind with that index, which names no parameter yet.
DerivedRecipe recipeOfKind(std::size_t kind);

struct DerivedParameter {
    std::string name, unit;
    DerivedRecipe recipe;
    bool operator==(const DerivedParameter&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.name, FieldInfo{"name", "Name of the derived parameter"});
        visit(self.unit, FieldInfo{"unit", "Unit of its values"});
        visit(self.recipe, FieldInfo{"recipe", "How the parameter is computed"});
    }
};

} // namespace tessera::volume
