#include "app/importer/tables/point_table.h"

#include "volume/base/trimmed.h"
#include "volume/base/unit_conversion.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <vtkDataArray.h>
#include <vtkFloatArray.h>

namespace tessera::importer {

namespace {

std::string lower(std::string_view text) {
    std::string out(text);
    std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return out;
}

/// Whether a text is surely a unit: what measures the same as one of those that tables of solvers have.
bool isUnit(const std::string& text) {
    static constexpr std::array<const char*, 32> kUnits = {
        "m",  "K",  "Pa",   "m/s",  "kg/m3",    "mol/m3",  "s",     "V",     "A",    "A/m2",      "A/m3",
        "W",  "J",  "W/m2", "W/m3", "S/m",      "m2/s",    "m2/s2", "kg",    "N",    "mol",       "J/kg",
        "m2", "m3", "1/s",  "Pa s", "J/(kg K)", "W/(m K)", "V/m",   "m2/s3", "kg/s", "mol/(m2 s)"};
    return text == "%" || std::ranges::any_of(
                              kUnits, [&](const char* unit) { return volume::unitConversion(text, unit).has_value(); });
}

/// "mean(T)" is a function of T.
bool isFunction(std::string_view name) {
    static constexpr std::array<std::string_view, 12> kNames = {"max", "min", "mean", "avg", "sum",  "abs",
                                                                "log", "ln",  "mag",  "rms", "sqrt", "grad"};
    return std::ranges::find(kNames, lower(name)) != kNames.end();
}

/// Whether brackets hold the name of a component: "Velocity[i]".
bool isComponent(std::string_view inside) {
    return inside.size() == 1 && std::string_view("ijkxyzXYZ0123456789").find(inside[0]) != std::string_view::npos;
}

} // namespace

Heading parseHeading(std::string_view text) {
    const std::string all(volume::trimmed(text));
    for (const char* pair : {"[]", "()"}) {
        if (all.size() < 3 || all.back() != pair[1]) continue;
        std::size_t open = all.size() - 1; // of the pair that ends the text: "(J/(kg K))"
        for (int depth = 0; open != std::string::npos; --open) {
            depth += all[open] == pair[1] ? 1 : all[open] == pair[0] ? -1 : 0;
            if (depth == 0 || open == 0) break;
        }
        if (open == 0 || all[open] != pair[0]) continue;
        const std::string name(volume::trimmed(std::string_view(all).substr(0, open)));
        std::string unit(volume::trimmed(std::string_view(all).substr(open + 1, all.size() - open - 2)));
        const bool apart = all[open - 1] == ' ';
        if (!apart && (pair[0] == '[' ? isComponent(unit) : !isUnit(unit) || isFunction(name))) continue;
        if (unit == "-" || unit == "1") unit.clear();
        return {name, unit};
    }
    const std::size_t slash = all.find(" / ");
    if (slash != std::string::npos && isUnit(all.substr(slash + 3)))
        return {all.substr(0, slash), all.substr(slash + 3)};
    return {all, {}};
}

int axisOf(std::string_view name) {
    std::string word;
    for (const char c : lower(name))
        if (std::string_view(" _-:.[]").find(c) == std::string_view::npos) word += c;
    static constexpr std::array<std::string_view, 15> kNames = {
        "coordinate", "coordinates", "coord",       "coords",     "position",     "pos",    "point", "points",
        "centroid",   "cellcenter",  "cellcenters", "cellcentre", "cellcentroid", "center", "centre"};
    for (int axis = 0; axis < 3; ++axis) {
        const char letter = char('x' + axis), digit = char('0' + axis);
        if (word == std::string(1, letter)) return axis;
        if (word.size() < 2 || word.size() > 20) continue;
        const auto isName = [&](std::string_view base) { return std::ranges::find(kNames, base) != kNames.end(); };
        const std::string_view view = word;
        if (view.back() == letter || view.back() == digit) {
            // "pos1" may be anything, "Points:1" is a component.
            const bool plural = view.back() == letter || view.ends_with(std::string("s") + digit) ||
                                name.find_first_of("_:[") != std::string_view::npos;
            if (plural && isName(view.substr(0, view.size() - 1))) return axis;
        }
        if (view.front() == letter && isName(view.substr(1))) return axis;
    }
    return -1;
}

std::ptrdiff_t placeColumn(const std::vector<Heading>& headings, int axis) {
    const auto find = [&](const auto& is) {
        const auto at = std::ranges::find_if(headings, [&](const Heading& heading) { return is(heading.name); });
        return at == headings.end() ? std::ptrdiff_t(-1) : at - headings.begin();
    };
    const std::ptrdiff_t own = find([&](const std::string& name) { return axisOf(name) == axis; });
    if (own >= 0 || axis != 0) return own;
    // Of an axisymmetric model, r and z.
    const bool plane = find([](const std::string& name) { return axisOf(name) == 1; }) < 0 &&
                       find([](const std::string& name) { return axisOf(name) == 2; }) >= 0 &&
                       find([](const std::string& name) {
                           const std::string word = lower(name);
                           return word == "phi" || word == "theta";
                       }) < 0;
    return plane ? find([](const std::string& name) { return lower(name) == "r"; }) : -1;
}

bool hasPlaces(const std::vector<Heading>& headings) {
    int found = 0;
    for (int axis = 0; axis < 3; ++axis) found += placeColumn(headings, axis) >= 0 ? 1 : 0;
    return found >= 2;
}

void addColumns(const PointTable& table, vtkDataSetAttributes* to, Source& source) {
    const std::ptrdiff_t radius = placeColumn(table.headings, 0);
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
        const Heading& heading = table.headings[c];
        if (axisOf(heading.name) >= 0 || std::ptrdiff_t(c) == radius) continue;
        const int type = table.types.empty() ? VTK_FLOAT : table.types[c];
        const auto array = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
        array->SetName(heading.name.c_str());
        array->SetNumberOfTuples(vtkIdType(table.rows()));
        if (auto* floats = vtkFloatArray::SafeDownCast(array))
            for (std::size_t row = 0; row < table.rows(); ++row)
                floats->SetValue(vtkIdType(row), float(table.columns[c][row]));
        else
            for (std::size_t row = 0; row < table.rows(); ++row)
                array->SetComponent(vtkIdType(row), 0, table.columns[c][row]);
        if (!heading.unit.empty()) source.units[heading.name] = heading.unit;
        if (c < table.labels.size() && !table.labels[c].empty()) source.labels[heading.name] = table.labels[c];
        to->AddArray(array);
    }
}

} // namespace tessera::importer
