#include "volume/field/axes_json.h"

#include "volume/base/error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace tessera::volume {

namespace {

using nlohmann::json;

constexpr const char *kOfCells = "cells", *kOfPoints = "points";

AxisMap axisFromJson(const json& value, int samples, const std::string& file, const std::string& place) {
    if (!value.is_object()) throw Error("must be null, or an object of \"of\" and \"planes\"", file, place);
    const auto of = value.find("of"), planes = value.find("planes");
    const bool cells = of != value.end() && *of == kOfCells;
    if (!cells && (of == value.end() || *of != kOfPoints))
        throw Error("must be \"cells\" or \"points\"", file, place + ".of");
    const std::string at = place + ".planes";
    if (planes == value.end() || !planes->is_array()) throw Error("must be a list of numbers", file, at);
    const std::size_t wanted = samples > 0 ? std::size_t(samples) + (cells ? 1 : 0) : planes->size();
    if (planes->size() > std::size_t(kMostPlanes))
        throw Error("holds " + std::to_string(planes->size()) + " numbers, more than " + std::to_string(kMostPlanes),
                    file, at);
    if (planes->size() != wanted)
        throw Error("holds " + std::to_string(planes->size()) + " numbers, but " + std::to_string(samples) +
                        " samples need " + std::to_string(wanted),
                    file, at);
    std::vector<double> numbers;
    numbers.reserve(wanted);
    for (std::size_t i = 0; i < wanted; ++i) {
        if (!(*planes)[i].is_number()) throw Error("must be a number", file, at + "[" + std::to_string(i) + "]");
        numbers.push_back((*planes)[i].get<double>());
    }
    try {
        return {cells ? AxisMap::Of::Cells : AxisMap::Of::Points, std::move(numbers)};
    } catch (const Error& error) {
        throw Error(error.reason(), file, at);
    }
}

} // namespace

std::string axesJson(const AxisMaps& axes) {
    json out = json::array();
    for (int axis = 0; axis < 3; ++axis) {
        const AxisMap* map = axes[axis];
        out.push_back(
            map ? json{{"of", map->of() == AxisMap::Of::Cells ? kOfCells : kOfPoints}, {"planes", map->planes()}}
                : json());
    }
    return out.dump();
}

AxisMaps axesFromJson(std::string_view text, glm::ivec3 size, const std::string& file, const std::string& place) {
    const json value = json::parse(text, nullptr, false);
    if (!value.is_array() || value.size() != 3) throw Error("must be a list of three, of x, y and z", file, place);
    AxisMaps axes;
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = std::size_t(axis);
        if (value[a].is_null()) continue;
        const std::string at = place + "[" + std::to_string(axis) + "]";
        axes.of[a] = std::make_shared<const AxisMap>(axisFromJson(value[a], size[axis], file, at));
    }
    return axes;
}

void requireOfSheet(const Lattice& lattice, const std::string& file, const std::string& place) {
    constexpr double kSlack = 1e-3; // of a cell
    for (int axis = 0; axis < 3; ++axis) {
        const AxisMap* map = lattice.axes[axis];
        if (!map) continue;
        const auto refuse = [&](const std::string& what) {
            throw Error(what + " the planes of its axis " + "xyz"[axis], file, place);
        };
        const double spacing = lattice.spacing[axis], origin = lattice.origin[axis];
        const double rounding =
            8 * std::numeric_limits<double>::epsilon() * std::max(std::abs(map->lo()), std::abs(map->hi()));
        if (lattice.kind != LatticeKind::CC) {
            const double last = lattice.sheetPosition(lattice.size - 1)[axis], slack = spacing + rounding;
            if (!(origin >= map->lo() - slack && last <= map->hi() + slack)) refuse("the samples do not lie between");
            continue;
        }
        if (map->samples() != lattice.size[axis])
            refuse(std::to_string(lattice.size[axis]) + " samples are not those of");
        const double slack = kSlack * map->spacing() + rounding;
        if (!(std::abs(spacing - map->spacing()) * lattice.size[axis] <= slack &&
              std::abs(origin - map->origin()) <= slack))
            refuse("spacing and origin are not those of");
    }
}

Lattice withStatedAxes(const Lattice& stated, bool statesSheet, std::string_view axes, const std::string& file,
                       const std::string& place) {
    const Lattice out = withAxes(stated, axesFromJson(axes, stated.size, file, place));
    Lattice compared = statesSheet ? stated : out;
    compared.axes = out.axes;
    requireOfSheet(compared, file, place);
    return out;
}

} // namespace tessera::volume
