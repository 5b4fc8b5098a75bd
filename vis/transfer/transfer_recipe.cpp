#include "vis/transfer/transfer_recipe.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <glm/common.hpp>

namespace tessera::vis {

namespace {

constexpr double kSamePlace = 0.002; ///< quantiles that are taken as one

/// Values of places, for one recipe and one channel.
class Places {
public:
    Places(const ValueDistribution& values, bool aboutZero, const std::string& unit)
        : values_(aboutZero ? magnitudesOf(values) : values), aboutZero_(aboutZero), hounsfield_(unit == "HU"),
          base_(aboutZero ? Range{-values_.range.hi, values_.range.hi} : values.range) {}

    Range base() const { return base_; }

    double valueOf(const RecipePlace& at) const {
        if (hounsfield_ && at.hounsfield) return *at.hounsfield;
        if (at.share) {
            const double value = glm::mix(base_.lo, base_.hi, *at.share);
            if (std::abs(placeOf(value) - at.place) < kSamePlace) return value;
        }
        if (!aboutZero_) return valueAtPlace(values_, at.place);
        return std::copysign(valueAtPlace(values_, std::abs(at.place)), at.place);
    }
    RecipePlace of(double value) const {
        const double width = base_.hi - base_.lo;
        RecipePlace at;
        at.place = placeOf(value);
        at.share = width > 0 ? (value - base_.lo) / width : 0.0;
        return at;
    }

private:
    double placeOf(double value) const {
        return aboutZero_ ? std::copysign(placeOfValue(values_, std::abs(value)), value) : placeOfValue(values_, value);
    }

    ValueDistribution values_;
    bool aboutZero_, hounsfield_;
    Range base_;
};

/// A curve cut off at 0 and 1, with a point at either; its positions may fall a little by rounding.
std::vector<glm::vec2> cutOff(std::vector<glm::vec2> curve) {
    for (std::size_t i = 1; i < curve.size(); ++i) curve[i].x = std::max(curve[i].x, curve[i - 1].x);
    std::vector<glm::vec2> out;
    for (const glm::vec2 point : curve)
        if (point.x >= 0 && point.x <= 1) out.push_back(point);
    if (out.empty() || out.front().x > 0) out.insert(out.begin(), {0.0f, float(curveAt(curve, 0))});
    if (out.back().x < 1) out.emplace_back(1.0f, float(curveAt(curve, 1)));
    return out;
}

std::vector<ColorStop> cutOff(std::vector<ColorStop> stops) {
    if (stops.empty()) return stops;
    for (std::size_t i = 1; i < stops.size(); ++i)
        stops[i].position = std::max(stops[i].position, stops[i - 1].position);
    TransferFunction whole;
    whole.colors = stops;
    std::vector<ColorStop> out;
    for (const ColorStop& stop : stops)
        if (stop.position >= 0 && stop.position <= 1) out.push_back(stop);
    if (out.empty() || out.front().position > 0) out.insert(out.begin(), {0, glm::vec3(evaluate(whole, {0, 1}, 0))});
    if (out.back().position < 1) out.push_back({1, glm::vec3(evaluate(whole, {0, 1}, 1))});
    return out;
}

} // namespace

TransferFunction madeFrom(const TransferRecipe& recipe, const ValueDistribution& values, const std::string& unit) {
    const Places places(values, recipe.aboutZero, unit);
    TransferFunction out;
    out.colormap = recipe.colormap;
    out.reversed = recipe.reversed;
    out.aboutZero = recipe.aboutZero;
    Range range = places.base();
    if (recipe.range) {
        const Range stated{places.valueOf(recipe.range->lo), places.valueOf(recipe.range->hi)};
        if (stated.hi > stated.lo) {
            range = out.range = stated;
            out.autoRange = false;
        }
    }
    const double width = range.hi > range.lo ? range.hi - range.lo : 1;
    const auto position = [&](const RecipePlace& at) { return float((places.valueOf(at) - range.lo) / width); };
    std::vector<glm::vec2> curve;
    for (const RecipePoint& point : recipe.opacity) curve.emplace_back(position(point.at), point.opacity);
    if (!curve.empty()) out.opacity = cutOff(std::move(curve));
    std::vector<ColorStop> stops;
    for (const RecipeColor& each : recipe.colors) stops.push_back({position(each.at), each.color});
    out.colors = cutOff(std::move(stops));
    out.kind = recipe.kind;
    out.regions = recipe.regions;
    out.gradientTop = recipe.gradientTop;
    out.emphasis = recipe.emphasis;
    return out;
}

TransferRecipe recipeOf(const std::string& name, const TransferFunction& function, const ValueDistribution& values) {
    TransferRecipe out;
    out.name = name;
    out.aboutZero = function.autoRange && function.aboutZero;
    const Places places(values, out.aboutZero, {});
    const Range range = effectiveRange(function, values.range);
    const auto at = [&](float x) { return places.of(glm::mix(range.lo, range.hi, double(x))); };
    if (!function.autoRange) out.range = RecipeRange{places.of(range.lo), places.of(range.hi)};
    out.colormap = function.colormap;
    for (const glm::vec2 point : function.opacity) out.opacity.push_back({at(point.x), point.y});
    if (function.colors.empty()) out.reversed = function.reversed;
    for (std::size_t i = 0; i < function.colors.size(); ++i) { // colours of one's own are stored as they run
        const ColorStop& stop =
            function.reversed ? function.colors[function.colors.size() - 1 - i] : function.colors[i];
        out.colors.push_back({at(function.reversed ? 1 - stop.position : stop.position), stop.color});
    }
    out.kind = function.kind;
    out.regions = function.regions;
    out.gradientTop = function.gradientTop;
    out.emphasis = function.emphasis;
    return out;
}

bool suits(const TransferRecipe& recipe, Range range) {
    return !recipe.aboutZero || (range.lo < 0 && range.hi > 0);
}

bool sameName(std::string_view a, std::string_view b) {
    const auto letters = [](std::string_view text) {
        std::string out;
        for (const char c : text) {
            const auto byte = static_cast<unsigned char>(c);
            if (std::isalnum(byte) != 0 || byte >= 0x80) out += char(std::tolower(byte));
        }
        return out;
    };
    const std::string left = letters(a);
    return left.empty() ? a == b : left == letters(b);
}

std::string quotedName(const TransferRecipe& recipe) {
    return recipe.name.find(',') == std::string::npos ? recipe.name : "\"" + recipe.name + "\"";
}

} // namespace tessera::vis
