#include "app/importer/arrays/conventions.h"

#include "volume/base/trimmed.h"
#include "volume/base/unit_conversion.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <limits>
#include <sstream>
#include <vtkDataArray.h>

namespace tessera::importer {

namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

struct NamedKind {
    AxisKind kind;
    /// Whole names, and beginnings of names (after "^"), in small letters.
    std::string_view names;
};
constexpr NamedKind kNamedKinds[] = {
    {AxisKind::Time, "t time times date datetime nt xtime ocean_time record rec step steps iteration ^time"},
    {AxisKind::Other, "nv nb bnds bounds nbnd nbnds tbnd vertex vertices nvertex axis_nbounds member members number "
                      "realization band bands channel channels c wavelength frequency species category categories "
                      "component components comp vector strlen datestrlen charlen ^ens ^string ^char"},
    {AxisKind::X, "x nx lon long longitude rlon nlon i ni xi width col cols column columns easting dimx dim_x xdim "
                  "x_dim grid_xt grid_xu xaxis_1 ^x_ ^xi_ ^xt ^xu ^xc ^xh ^xq ^lon_ ^longitude ^west_east"},
    {AxisKind::Y, "y ny lat latitude rlat nlat j nj eta row rows northing dimy dim_y ydim y_dim grid_yt grid_yu "
                  "yaxis_1 ^y_ ^eta_ ^yt ^yu ^yc ^yh ^yq ^lat_ ^latitude ^south_north"},
    {AxisKind::Z,
     "z nz k nk lev level levels layer layers depth height altitude alt elevation plev pressure sigma "
     "hybrid slice slices dimz dim_z zdim z_dim zaxis_1 s_rho s_w ^z_ ^zt ^zu ^zc ^zh ^zl ^zi ^zw ^lev ^depth "
     "^height ^altitude ^isobaric ^sigma ^hybrid ^bottom_top ^soil_layers"}};

bool startsWithAny(std::string_view text, std::initializer_list<std::string_view> beginnings) {
    return std::ranges::any_of(beginnings, [&](std::string_view one) { return text.starts_with(one); });
}

AxisKind kindByStandardName(std::string_view name) {
    if (name.empty()) return AxisKind::Unknown;
    if (name == "longitude" || name == "grid_longitude" || name.starts_with("projection_x_") || name == "geospatial_x")
        return AxisKind::X;
    if (name == "latitude" || name == "grid_latitude" || name.starts_with("projection_y_")) return AxisKind::Y;
    if (name == "time" || name.starts_with("forecast_") || name == "model_time") return AxisKind::Time;
    if (name == "realization") return AxisKind::Other;
    if (startsWithAny(name, {"height", "altitude", "depth", "air_pressure", "atmosphere_", "ocean_s", "ocean_z",
                             "ocean_double", "model_level", "sea_water_pressure", "geopotential_height"}))
        return AxisKind::Z;
    return AxisKind::Unknown;
}

AxisKind kindByUnit(const std::string& unit) {
    const std::string word = lowered(unit);
    if (word.find(" since ") != std::string::npos) return AxisKind::Time;
    // degrees_north, degree_N, degreesN, degN
    if (word.starts_with("deg")) {
        const char last = word.back();
        const bool named = word.ends_with("_north") || word.ends_with("_east");
        if (named) return word.ends_with("_east") ? AxisKind::X : AxisKind::Y;
        if (startsWithAny(word, {"degree", "degrees"}) && (last == 'e' || last == 'n') && word != "degree")
            return last == 'e' ? AxisKind::X : AxisKind::Y;
        return AxisKind::Unknown;
    }
    if (word == "level" || word == "layer" || word == "sigma_level" || volume::unitConversion(unit, "Pa") ||
        word == "millibar" || word == "millibars" || word == "mb")
        return AxisKind::Z;
    return AxisKind::Unknown;
}

/// A number of an attribute as a stored number of this type would be.
double asStored(double value, int vtkType) {
    return vtkType == VTK_FLOAT ? double(float(value)) : value;
}

bool isFloating(int vtkType) {
    return vtkType == VTK_FLOAT || vtkType == VTK_DOUBLE;
}

/// Stored numbers that an attribute means. One with a fraction beside packed whole numbers is a value.
std::vector<double> storedNumbers(const Attributes& attributes, const char* name, int vtkType, const StoredForm& form) {
    const auto at = attributes.find(name);
    if (at == attributes.end()) return {};
    std::vector<double> out;
    const double least = isFloating(vtkType) ? 0 : vtkDataArray::GetDataTypeMin(vtkType);
    const double most = isFloating(vtkType) ? 0 : vtkDataArray::GetDataTypeMax(vtkType);
    for (const double number : at->second.numbers) {
        double meant = number;
        if (at->second.floating && !isFloating(vtkType) && form.scales()) {
            const double packed = (number - form.offset) / form.scale;
            const bool raw = number == std::floor(number) && number >= least && number <= most;
            const bool fits = packed >= least - 1 && packed <= most + 1;
            if (fits || !raw) meant = std::abs(packed) < 1e15 ? std::round(packed * 1e6) / 1e6 : packed;
            if (std::string_view(name) == "missing_value" || std::string_view(name) == "_FillValue")
                meant = std::round(meant);
        }
        out.push_back(asStored(meant, vtkType));
    }
    return out;
}

/// Days from 1970-01-01 in the Gregorian calendar.
double daysTo(long year, long month, long day) {
    if (month <= 2) --year;
    const long era = (year >= 0 ? year : year - 399) / 400, yearOfEra = year - era * 400;
    const long dayOfYear = (153 * (month + (month > 2 ? -3 : 9)) + 2) / 5 + day - 1;
    return double(era * 146097 + yearOfEra * 365 + yearOfEra / 4 - yearOfEra / 100 + dayOfYear - 719468);
}

} // namespace

std::string textOf(const Attributes& attributes, const std::string& name) {
    const auto at = attributes.find(name);
    return at == attributes.end() ? std::string() : std::string(volume::trimmed(at->second.text));
}

std::string lowered(std::string_view text) {
    std::string out(text);
    std::ranges::transform(out, out.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return out;
}

std::string leafOf(const std::string& path) {
    return path.substr(path.rfind('/') == std::string::npos ? 0 : path.rfind('/') + 1);
}

AxisKind kindByName(std::string_view name) {
    const std::string word = leafOf(lowered(name));
    if (word.empty()) return AxisKind::Unknown;
    for (const NamedKind& named : kNamedKinds) {
        std::istringstream names{std::string(named.names)};
        for (std::string one; names >> one;)
            if (one.front() == '^' ? word.starts_with(std::string_view(one).substr(1)) : word == one) return named.kind;
    }
    if (word.ends_with("strlen")) return AxisKind::Other;
    for (const auto& [end, kind] : {std::pair("_x", AxisKind::X), {"_y", AxisKind::Y}, {"_z", AxisKind::Z}})
        if (word.ends_with(end)) return kind;
    return AxisKind::Unknown;
}

AxisKind kindByAttributes(const Attributes& attributes) {
    const std::string axis = lowered(textOf(attributes, "axis"));
    if (axis.size() == 1) {
        const std::size_t at = std::string_view("xyzt").find(axis[0]);
        constexpr AxisKind kKinds[] = {AxisKind::X, AxisKind::Y, AxisKind::Z, AxisKind::Time};
        if (at != std::string_view::npos) return kKinds[at];
    }
    AxisKind kind = kindByStandardName(lowered(textOf(attributes, "standard_name")));
    if (kind != AxisKind::Unknown) return kind;
    const std::string type = lowered(textOf(attributes, "_CoordinateAxisType"));
    if (type == "lon" || type == "geox") return AxisKind::X;
    if (type == "lat" || type == "geoy") return AxisKind::Y;
    if (type == "height" || type == "pressure" || type == "geoz") return AxisKind::Z;
    if (type == "time") return AxisKind::Time;
    const std::string positive = lowered(textOf(attributes, "positive"));
    if (positive == "up" || positive == "down") return AxisKind::Z;
    return kindByUnit(textOf(attributes, "units"));
}

void describeAxis(StoredAxis& axis, const Attributes& attributes) {
    const AxisKind stated = kindByAttributes(attributes), named = kindByName(axis.name);
    if (stated != AxisKind::Unknown)
        axis.kind = stated;
    else if (named != AxisKind::Unknown)
        axis.kind = named;
    else
        axis.kind = kindByName(textOf(attributes, "long_name"));
    axis.unit = textOf(attributes, "units");
    const std::string seconds = timeUnitOf(axis.unit).unit;
    if (axis.kind == AxisKind::Unknown && !axis.unit.empty() && volume::unitConversion(seconds, "s"))
        axis.kind = AxisKind::Time;
    axis.down = axis.kind == AxisKind::Z && lowered(textOf(attributes, "positive")) == "down";
}

StoredForm formBy(const Attributes& attributes, int vtkType) {
    StoredForm form;
    const auto number = [&](const char* name, double otherwise) {
        const auto at = attributes.find(name);
        if (at == attributes.end() || at->second.numbers.empty()) return otherwise;
        const double value = at->second.numbers.front();
        return std::isfinite(value) ? value : otherwise;
    };
    form.scale = number("scale_factor", 1);
    form.offset = number("add_offset", 0);
    if (form.scale == 0) form.scale = 1;
    const StoredForm packed = form;
    for (const char* name : {"_FillValue", "missing_value"})
        for (const double value : storedNumbers(attributes, name, vtkType, packed))
            if (!std::isnan(value)) form.fill.push_back(value);
    std::vector<double> range = storedNumbers(attributes, "valid_range", vtkType, packed);
    const std::vector<double> least = storedNumbers(attributes, "valid_min", vtkType, packed);
    const std::vector<double> most = storedNumbers(attributes, "valid_max", vtkType, packed);
    if (range.size() == 2 && range[0] > range[1]) std::swap(range[0], range[1]); // of values, by a negative scale
    if (range.size() == 2) form.lowest = range[0];
    if (range.size() == 2) form.highest = range[1];
    if (least.size() == 1) form.lowest = least[0];
    if (most.size() == 1) form.highest = most[0];
    if (form.lowest > form.highest) std::swap(form.lowest, form.highest);
    if (std::isnan(form.lowest)) form.lowest = StoredForm{}.lowest;
    if (std::isnan(form.highest)) form.highest = StoredForm{}.highest;
    return form;
}

std::string shownUnit(const std::string& unit) {
    return unit == "1" || unit == "-" || lowered(unit) == "none" || lowered(unit) == "unitless" ? std::string() : unit;
}

std::vector<double> valuesBy(const StoredForm& form, std::vector<double> stored) {
    for (double& number : stored) {
        const bool present = !form.masks() || form.isValue(number);
        number = present ? form.offset + form.scale * number : kNoNumber;
    }
    return stored;
}

std::string wordsOfFlags(const Attributes& attributes) {
    const auto values = attributes.find("flag_values");
    if (values == attributes.end() || attributes.contains("flag_masks")) return {};
    std::istringstream meanings(textOf(attributes, "flag_meanings"));
    std::string words, meaning;
    for (const double value : values->second.numbers) {
        if (!(meanings >> meaning) || value != std::floor(value) || std::abs(value) > 1e9) return {};
        std::ranges::replace(meaning, ';', ',');
        words += (words.empty() ? "" : "; ") + std::to_string(long(value)) + " " + meaning;
    }
    return words;
}

std::optional<double> secondsTo(std::string_view date) {
    const std::string text(date);
    long year = 0, month = 0, day = 0, hour = 0, minute = 0;
    double second = 0;
    int used = 0;
    if (std::sscanf(text.c_str(), "%ld-%ld-%ld%n", &year, &month, &day, &used) != 3) return std::nullopt;
    if (month < 1 || month > 12 || day < 1 || day > 31 || std::abs(year) > 100000) return std::nullopt;
    const char* rest = text.c_str() + used;
    if (*rest == 'T' || *rest == '_' || *rest == ' ') ++rest;
    std::sscanf(rest, "%ld:%ld:%lf", &hour, &minute, &second);
    return daysTo(year, month, day) * 86400 + double(hour) * 3600 + double(minute) * 60 + second;
}

TimeUnit timeUnitOf(const std::string& unit) {
    static constexpr std::pair<std::string_view, std::string_view> kWords[] = {
        {"second", "s"},  {"sec", "s"},          {"minute", "min"},     {"mins", "min"},    {"hour", "h"},
        {"hr", "h"},      {"day", "d"},          {"millisecond", "ms"}, {"millisec", "ms"}, {"msec", "ms"},
        {"week", "week"}, {"microsecond", "us"}, {"nanosecond", "ns"},  {"month", "month"}, {"year", "year"}};
    TimeUnit out;
    const std::string low = lowered(unit);
    std::size_t since = low.find(" since ");
    if (since != std::string::npos) {
        out.since = std::string(volume::trimmed(std::string_view(unit).substr(since + 7)));
        out.epoch = secondsTo(out.since);
    } else {
        since = low.size();
    }
    std::string word(volume::trimmed(std::string_view(low).substr(0, since)));
    out.unit = std::string(volume::trimmed(std::string_view(unit).substr(0, since)));
    for (const auto& [known, shown] : kWords)
        if (word == known || word == std::string(known) + "s") out.unit = shown;
    return out;
}

} // namespace tessera::importer
