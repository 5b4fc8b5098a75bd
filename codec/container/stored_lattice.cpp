#include "codec/container/stored_lattice.h"

#include "volume/field/axes_json.h"
#include "volume/field/lattice4.h"

#include <cmath>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <nlohmann/json.hpp>

namespace tessera::codec {

namespace {

using nlohmann::json;
using volume::LatticeKind;

constexpr const char* kD4Name = "d4";

/// The lattice that samples of a source are stored on.
volume::Lattice storedOn(LatticeKind kind, const volume::Lattice& source, bool alternating) {
    if (alternating)
        return volume::d4For({volume::LatticeKind4::CC, glm::ivec4(source.size, 2), glm::dvec4(source.spacing, 1),
                              glm::dvec4(source.origin, 0), source.axes})
            .grid(0);
    return kind == LatticeKind::BCC && source.kind == LatticeKind::CC ? volume::bccFor(source) : source;
}

} // namespace

json vectorJson(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}
json vectorJson(const glm::ivec3& v) {
    return {v.x, v.y, v.z};
}

json latticeJson(const volume::Lattice& lattice, bool alternating) {
    return {{"kind", alternating ? kD4Name : volume::kLatticeNames[std::size_t(lattice.kind)]},
            {"size", vectorJson(lattice.size)},
            {"spacing", vectorJson(lattice.spacing)},
            {"origin", vectorJson(lattice.origin)}};
}

volume::Lattice readLattice(const Node& node, bool* alternating) {
    volume::Lattice lattice;
    const std::string kind = node["kind"].text();
    if (kind == volume::kLatticeNames[0])
        lattice.kind = LatticeKind::CC;
    else if (kind == volume::kLatticeNames[1])
        lattice.kind = LatticeKind::BCC;
    else if (alternating != nullptr && kind == kD4Name)
        *alternating = true;
    else
        node["kind"].fail("unknown lattice '" + kind + "'");
    const auto size = node["size"].items(3);
    if (size.size() != 3) node["size"].fail("not three numbers");
    constexpr int kLargest = 1 << 24;
    lattice.size = {size[0].integer(1, kLargest), size[1].integer(1, kLargest), size[2].integer(1, kLargest)};
    lattice.spacing = node["spacing"].vector();
    lattice.origin = node["origin"].vector();
    constexpr double kMost = 1e100; // so that sums and squares stay finite
    for (int axis = 0; axis < 3; ++axis) {
        if (!(lattice.spacing[axis] > 1 / kMost && lattice.spacing[axis] < kMost))
            node["spacing"].fail("not a length above 0");
        if (!(std::abs(lattice.origin[axis]) < kMost)) node["origin"].fail("not a place");
    }
    return lattice;
}

void readAxes(const Node& lattice, volume::Lattice& source, volume::Lattice& stored) {
    if (!lattice.has("axes")) return;
    const Node axes = lattice["axes"];
    const std::string text = axes.value().dump(-1, ' ', false, json::error_handler_t::replace);
    // A BCC source does not tell how many samples the grid had that its axes are of.
    const glm::ivec3 size = source.kind == LatticeKind::CC ? source.size : glm::ivec3(0);
    source.axes = volume::axesFromJson(text, size, axes.file(), axes.place());
    volume::requireOfSheet(source, axes.file(), axes.place());
    stored.axes = source.axes;
}

/// Whether stored samples can be those of a source: on its own grid, or resampled from it.
bool isOfSource(const volume::Lattice& stored, const volume::Lattice& source, bool alternating) {
    if (alternating && source.kind != LatticeKind::CC) return false;
    const volume::Lattice expected = storedOn(stored.kind, source, alternating);
    if (stored.kind != expected.kind || stored.size != expected.size || !(stored.axes == expected.axes)) return false;
    const glm::dvec3 last(stored.size - 1), slack = expected.spacing * 1e-3 + 1e-9 * glm::abs(expected.origin);
    const glm::dvec3 first = glm::abs(stored.origin - expected.origin),
                     end = glm::abs(stored.sheetOfCells(last) - expected.sheetOfCells(last));
    return glm::all(glm::lessThanEqual(first, slack)) && glm::all(glm::lessThanEqual(end, slack));
}

/// Whether bounds can be those of samples on a lattice: they begin and end within a cell of the outermost ones.
bool areOf(const volume::Box& bounds, const volume::Lattice& lattice) {
    const glm::dvec3 lo = lattice.sheetPosition({0, 0, 0}), hi = lattice.sheetPosition(lattice.size - 1);
    for (int axis = 0; axis < 3; ++axis) {
        const double slack = lattice.spacing[axis] + 1e-9 * (std::abs(lo[axis]) + std::abs(hi[axis]));
        const bool near =
            std::abs(bounds.lo[axis] - lo[axis]) <= slack && std::abs(bounds.hi[axis] - hi[axis]) <= slack;
        if (const volume::AxisMap* map = lattice.axes[axis]) { // whose box ends where its planes do
            const double rounding = 1e-9 * (map->hi() - map->lo());
            if (!(std::abs(bounds.lo[axis] - map->lo()) <= rounding &&
                  std::abs(bounds.hi[axis] - map->hi()) <= rounding))
                return false;
        }
        if (!near || !(bounds.lo[axis] <= bounds.hi[axis])) return false; // nor if one is not finite
    }
    return true;
}

} // namespace tessera::codec
