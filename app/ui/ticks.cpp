#include "app/ui/ticks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

namespace tessera::app {

namespace {

/// Power of ten of the leading digit; guards against log10(1000) = 2.9999...
int leadingPower(double magnitude) {
    return static_cast<int>(std::floor(std::log10(magnitude) + 1e-9));
}

std::string print(const char* format, int digits, double value) {
    char text[64];
    std::snprintf(text, sizeof text, format, digits, value);
    return text;
}

/// "1.50e-04" -> "1.50e-4", "1e+05" -> "1e5".
std::string tidyExponent(std::string text) {
    const std::size_t e = text.find('e');
    if (e == std::string::npos) return text;
    const int power = std::stoi(text.substr(e + 1));
    return text.substr(0, e) + "e" + std::to_string(power);
}

/// Turns -0 and -0.00 into 0.
std::string withoutNegativeZero(std::string text) {
    if (text.starts_with('-') && text.find_first_of("123456789") == std::string::npos) text.erase(0, 1);
    return text;
}

} // namespace

double niceStep(double span, int most) {
    if (!(span > 0) || !std::isfinite(span) || most < 1) return 0;
    const double raw = span / most;
    const double power = std::pow(10.0, std::floor(std::log10(raw)));
    if (!(power > 0)) return 0;
    for (double factor : {1.0, 2.0, 5.0})
        if (factor * power >= raw * (1 - 1e-9)) return factor * power;
    return 10 * power;
}

std::vector<double> niceTicks(Range range, int most) {
    if (!std::isfinite(range.lo) || !std::isfinite(range.hi) || range.hi < range.lo) return {};
    const double step = niceStep(range.hi - range.lo, most);
    const double magnitude = std::max(std::abs(range.lo), std::abs(range.hi));
    // Beyond the precision of a double there are no steps to show.
    if (step <= 0 || step < magnitude * 1e-14) return {range.lo};
    const double first = std::ceil(range.lo / step - 1e-6), last = std::floor(range.hi / step + 1e-6);
    std::vector<double> ticks;
    // Dividing by a whole number keeps 0.3 at 0.3 instead of 0.30000000000000004.
    const double inverse = step < 1 ? std::round(1 / step) : 0;
    for (double i = first; i <= last && ticks.size() <= static_cast<std::size_t>(most); ++i)
        ticks.push_back(inverse > 0 ? i / inverse : i * step);
    return ticks;
}

std::string formatNumber(double value, double resolution) {
    if (std::isnan(value)) return "absent";
    if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
    if (resolution <= 0 || !std::isfinite(resolution)) return tidyExponent(print("%.*g", 6, value));
    const int step = leadingPower(resolution);
    const double magnitude = std::max(std::abs(value), resolution);
    if (magnitude >= 1e7 || magnitude < 1e-3) {
        if (value == 0 || std::abs(value) < std::pow(10.0, step) / 2) return "0";
        const int lead = leadingPower(magnitude);
        return withoutNegativeZero(tidyExponent(print("%.*e", std::clamp(lead - step, 0, 15), value)));
    }
    return withoutNegativeZero(print("%.*f", std::clamp(-step, 0, 15), value));
}

std::string formatQuantity(double value, std::string_view unit, double resolution) {
    std::string text = formatNumber(value, resolution);
    if (!unit.empty() && std::isfinite(value)) text += " " + prettyUnit(unit);
    return text;
}

std::string prettyUnit(std::string_view unit) {
    if (unit == "degC") return "\u00b0C";
    if (unit == "deg") return "\u00b0";
    const auto letter = [unit](std::size_t i) {
        return i < unit.size() && std::isalpha(static_cast<unsigned char>(unit[i]));
    };
    std::string out;
    for (std::size_t i = 0; i < unit.size(); ++i) {
        if (unit.substr(i, 2) == "um" && (i == 0 || !letter(i - 1)) && !letter(i + 2)) {
            out += "\u00b5m";
            ++i;
            continue;
        }
        const bool caret = i + 1 < unit.size() && unit[i] == '^';
        const bool exponent = i > 0 && (std::isalpha(static_cast<unsigned char>(unit[i - 1])) || unit[i - 1] == '^') &&
                              (i + 1 == unit.size() || !std::isalnum(static_cast<unsigned char>(unit[i + 1])));
        if (exponent && unit[i] == '2')
            out += "\u00b2";
        else if (exponent && unit[i] == '3')
            out += "\u00b3";
        else if (unit[i] == '*')
            out += "\u00b7";
        else if (!caret || (unit[i + 1] != '2' && unit[i + 1] != '3'))
            out += unit[i];
    }
    return out;
}

std::string titleWithUnit(std::string_view title, std::string_view unit) {
    std::string text(title);
    if (!unit.empty()) text += " [" + prettyUnit(unit) + "]";
    return text;
}

std::string formatCount(double count) {
    std::string text = print("%.*f", 0, count);
    for (int at = static_cast<int>(text.size()) - 3; at > (count < 0 ? 1 : 0); at -= 3)
        text.insert(static_cast<std::size_t>(at), " ");
    return text;
}

std::string formatShare(double share) {
    if (!std::isfinite(share)) return "-";
    const double percent = share * 100;
    if (percent <= 0) return "0 %";
    if (percent >= 100) return "100 %";
    if (percent < 0.01) return "< 0.01 %";
    if (percent > 99.9) return "> 99.9 %";
    return print("%.*f", percent < 1 ? 2 : percent < 10 || percent > 90 ? 1 : 0, percent) + " %";
}

TickLabels tickLabels(Range range, int most, int maxDigits) {
    TickLabels out{niceTicks(range, most), {}, {}};
    if (out.values.empty()) return out;
    const double span = range.hi - range.lo;
    double step = niceStep(span, most);
    double magnitude = std::max(std::abs(range.lo), std::abs(range.hi));
    if (out.values.size() == 1 && out.values[0] == range.lo && span <= magnitude * 1e-12) {
        out.texts.push_back(formatNumber(out.values[0]));
        return out;
    }
    double offset = 0;
    if (leadingPower(magnitude) - leadingPower(step) + 1 > maxDigits) {
        const double base = std::pow(10.0, std::ceil(std::log10(span) - 1e-9));
        offset = std::floor(range.lo / base) * base;
        if (offset != 0) {
            const double digits = std::pow(10.0, leadingPower(base));
            out.note =
                (offset < 0 ? "- " : "+ ") + formatNumber(std::abs(offset), std::abs(offset) >= 1e7 ? digits : base);
            magnitude = std::max(std::abs(range.lo - offset), std::abs(range.hi - offset));
        }
    }
    int exponent = 0;
    if (magnitude >= 1e6 || magnitude < 1e-2)
        exponent = 3 * static_cast<int>(std::floor(leadingPower(magnitude) / 3.0));
    if (exponent != 0) out.note = "\u00d7 1e" + std::to_string(exponent) + (out.note.empty() ? "" : " " + out.note);
    const double unit = std::pow(10.0, exponent);
    for (double value : out.values) out.texts.push_back(formatNumber((value - offset) / unit, step / unit));
    return out;
}

TickLabels fullTickLabels(Range range, int most) {
    TickLabels out{niceTicks(range, most), {}, {}};
    const double step = niceStep(range.hi - range.lo, most), largest = std::max(std::abs(range.lo), std::abs(range.hi));
    if (step <= largest * 1e-12) {
        for (const double value : out.values) out.texts.push_back(formatNumber(value));
        return out;
    }
    constexpr int kMostDecimals = 5, kMostDigits = 7;
    const int last = leadingPower(step);
    const bool fixed = last >= -kMostDecimals && leadingPower(largest) < kMostDigits;
    for (const double value : out.values) {
        const bool isZero = std::abs(value) < step / 2;
        const int power = fixed || isZero ? 0 : leadingPower(std::abs(value)), digits = std::max(0, power - last);
        char text[64];
        if (fixed)
            std::snprintf(text, sizeof text, "%.*f", std::max(0, -last), isZero ? 0.0 : value);
        else
            std::snprintf(text, sizeof text, isZero ? "0" : "%.*fe%d", digits, value / std::pow(10.0, power), power);
        out.texts.emplace_back(text);
    }
    return out;
}

TickLabels styledTickLabels(Range range, int most, bool noted, const TickStyle& style) {
    if (style.numbers == TickNumbers::Automatic) return noted ? tickLabels(range, most) : fullTickLabels(range, most);
    TickLabels out{niceTicks(range, most), {}, {}};
    const double step = niceStep(range.hi - range.lo, most);
    const char* const format = style.numbers == TickNumbers::Decimals ? "%.*f" : "%.*e";
    for (const double value : out.values) {
        const double shown = std::abs(value) < step * 1e-9 ? 0 : value;
        out.texts.push_back(withoutNegativeZero(tidyExponent(print(format, style.decimals, shown))));
    }
    return out;
}

namespace {

/// The first and the last of the coarsest ticks that have room beside each other; none where no two have.
TickLabels endTicks(Range range, double length, double gap, bool noted,
                    const std::function<double(const std::string&)>& extent, const TickStyle& style) {
    const double span = range.hi - range.lo;
    if (!(span > 0)) return {};
    for (const int most : {2, 3, 4, 5, 6, 8, 10, 15, 20}) {
        TickLabels all = styledTickLabels(range, most, noted, style);
        if (all.values.size() < 2) continue;
        const double apart = (all.values.back() - all.values.front()) / span * length;
        if (apart < (extent(all.texts.front()) + extent(all.texts.back())) / 2 + gap) continue;
        return {{all.values.front(), all.values.back()}, {all.texts.front(), all.texts.back()}, all.note};
    }
    return {};
}

} // namespace

TickLabels fittingTicks(Range range, double length, double gap, bool noted,
                        const std::function<double(const std::string&)>& extent, const TickStyle& style) {
    TickLabels ticks;
    std::vector<int> tried{10, 8, 6, 5, 4, 3, 2, 1};
    if (style.most > 0) {
        std::erase_if(tried, [&](int most) { return most >= style.most; });
        tried.insert(tried.begin(), style.most);
    }
    for (const int most : tried) {
        ticks = styledTickLabels(range, most, noted, style);
        double widest = 0;
        for (const std::string& text : ticks.texts) widest = std::max(widest, extent(text));
        const double span = range.hi - range.lo;
        const double step = ticks.values.size() > 1 ? ticks.values[1] - ticks.values[0] : span;
        if (span <= 0 || step / span * length >= widest + gap) break;
    }
    // One number says nothing of a scale: rather two round ones near the ends, where they have room.
    if (ticks.values.size() < 2)
        if (TickLabels ends = endTicks(range, length, gap, noted, extent, style); !ends.values.empty()) return ends;
    return ticks;
}

LengthUnit suitableLength(std::string_view unit, double size) {
    static constexpr std::array<std::pair<std::string_view, double>, 5> kUnits{
        {{"m", 1}, {"cm", 1e-2}, {"mm", 1e-3}, {"um", 1e-6}, {"nm", 1e-9}}};
    const auto from = std::find_if(kUnits.begin(), kUnits.end(), [&](const auto& u) { return u.first == unit; });
    if (from == kUnits.end() || !(size > 0)) return {std::string(unit), 1};
    for (const auto& [name, metres] : kUnits) {
        if (name == "cm" && unit != "cm") continue;
        // 0.8 rather than 1: "0.9 mm" reads better than "900 um".
        if (size * from->second >= 0.8 * metres) return {std::string(name), from->second / metres};
    }
    return {"nm", from->second / 1e-9};
}

std::string formatVolume(double volume, std::string_view unit) {
    // Cubes grow by 1e9 from unit to unit: rather 0.01 of the larger one than 1e7 of the smaller.
    const LengthUnit length = suitableLength(unit, std::cbrt(volume * 100));
    const double cubes = volume * std::pow(length.perUnit, 3);
    return formatQuantity(cubes, length.name.empty() ? "" : length.name + "3", cubes / 1000);
}

} // namespace tessera::app
