#pragma once

#include "app/session/figure_settings.h"
#include "volume/base/describe.h"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

/// Number formatting for axes, legends and read-outs: tick positions and texts. Does not use ImGui.
namespace tessera::app {

/// The smallest of 1, 2, 5 times a power of ten that divides `span` into at most `most` steps; 0 for an empty span.
double niceStep(double span, int most);

/// Multiples of niceStep inside the range (ends included within rounding), at most `most` + 1 of them, rising. One
/// value for an empty range, none for one that is not finite or runs backwards.
std::vector<double> niceTicks(Range range, int most);

/// `value` with the digits that tell it from a value `resolution` away: formatNumber(435.1234, 0.01) = "435.12".
/// Exponents only for the very large and very small. Resolution 0: six significant digits. NaN gives "absent".
std::string formatNumber(double value, double resolution = 0);

/// A number and its unit, e.g. "435.12 K"; the unit as prettyUnit writes it.
std::string formatQuantity(double value, std::string_view unit, double resolution = 0);

/// Typography for units: "mol/m3" becomes "mol/m³", "um" becomes "µm", "degC" "°C". Only glyphs of Latin-1.
std::string prettyUnit(std::string_view unit);

/// "T [K]", or just the title where there is no unit.
std::string titleWithUnit(std::string_view title, std::string_view unit);

/// A whole number with thin groups: 1234567 becomes "1 234 567".
std::string formatCount(double count);

/// A share of 0..1 in per cent with sensible digits: "0.03 %", "4.2 %", "58 %", never "0 %" or "100 %" of a part.
std::string formatShare(double share);

/// Ticks with their texts. Where values would need more than `maxDigits` digits, or are very large or small, the texts
/// are shortened by a common offset and power of ten: value = (number in text) * 10^exponent + offset. `note` says so
/// ("+ 100000", "x 1e-6"), to be written beside the axis title.
struct TickLabels {
    std::vector<double> values;
    std::vector<std::string> texts;
    std::string note;
};
TickLabels tickLabels(Range range, int most, int maxDigits = 6);
/// The same with numbers in full, for axes beside which no note has a place.
TickLabels fullTickLabels(Range range, int most);
/// The same as the user sets numbers: as tickLabels or, without `noted`, fullTickLabels, or in full with the decimals
/// or exponents that are set.
TickLabels styledTickLabels(Range range, int most, bool noted, const TickStyle& style);

/// As many ticks as fit on an axis of this length with a gap between their texts, as tickLabels or, without `noted`,
/// fullTickLabels has them, or fewer and otherwise as the user sets them. `extent`: of a text along the axis.
TickLabels fittingTicks(Range range, double length, double gap, bool noted,
                        const std::function<double(const std::string&)>& extent, const TickStyle& style = {});

/// A length unit that suits a box of this size: the name and how many of it make one of `unit` (m, cm, mm, um and nm
/// are known; others stay as they are).
struct LengthUnit {
    std::string name;
    double perUnit = 1;
};
LengthUnit suitableLength(std::string_view unit, double size);

/// A volume in cubes of `unit` as text in cubes of a unit that suits it: "0.268 mm3" for 2.68e-10 of "m".
std::string formatVolume(double volume, std::string_view unit);

} // namespace tessera::app
