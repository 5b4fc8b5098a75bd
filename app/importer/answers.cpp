#include "app/importer/describe_source.h"
#include "app/importer/node_values.h"
#include "app/importer/present.h"
#include "volume/field/axes_json.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <vtkIdList.h>
#include <vtkNew.h>

/// The messages of volume/import/files/stream.h that are JSON.
namespace tessera::importer {

std::string rangesJson(vtkDataSet* data, vtkDataArray* stored, const ArrayRef& array, bool between) {
    const int components = array.form.components;
    const bool any = stored != nullptr && stored->GetNumberOfComponents() >= array.firstComponent + components;
    const vtkSmartPointer<vtkDataArray> values = any ? valuesOf(data, stored, array) : nullptr;
    std::vector<std::uint8_t> used(any ? std::size_t(values->GetNumberOfTuples()) : 0, array.ofCells ? 1 : 0);
    if (any && !array.ofCells) {
        const std::vector<std::uint8_t> cells = presentCells(data);
        vtkNew<vtkIdList> points;
        for (vtkIdType c = 0; c < data->GetNumberOfCells(); ++c) {
            if (!volume::isPresent(cells, std::size_t(c))) continue;
            data->GetCellPoints(c, points);
            for (vtkIdType i = 0; i < points->GetNumberOfIds(); ++i) {
                const auto point = std::size_t(points->GetId(i));
                if (point < used.size()) used[point] = 1;
            }
        }
    }
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    std::vector<double> lo(std::size_t(components > 1 ? components + 1 : 1), kInfinity), hi(lo.size(), -kInfinity);
    const auto widen = [&](std::size_t i, double value) {
        lo[i] = std::min(lo[i], value);
        hi[i] = std::max(hi[i], value);
    };
    for (std::size_t i = 0; i < used.size(); ++i) {
        if (used[i] == 0) continue;
        double square = 0;
        for (int c = 0; c < components; ++c) {
            const double value = values->GetComponent(vtkIdType(i), array.firstComponent + c);
            if (std::isfinite(value)) widen(std::size_t(c), value);
            square += value * value;
        }
        if (components > 1 && std::isfinite(square)) widen(std::size_t(components), std::sqrt(square));
    }
    if (any && array.ofCells && between && array.form.type == volume::ScalarType::F32) {
        std::vector<double> squares(std::size_t(data->GetNumberOfPoints()), 0);
        for (int c = 0; c < components; ++c) {
            const std::vector<double> corners = nodeValues(data, values, array.firstComponent + c);
            for (std::size_t p = 0; p < corners.size(); ++p) {
                if (std::isfinite(corners[p])) widen(std::size_t(c), corners[p]);
                squares[p] += corners[p] * corners[p];
            }
        }
        for (const double square : squares)
            if (components > 1 && std::isfinite(square)) widen(std::size_t(components), std::sqrt(square));
    }
    nlohmann::json ranges = nlohmann::json::array();
    for (std::size_t i = 0; i < lo.size(); ++i)
        ranges.push_back(lo[i] <= hi[i] ? nlohmann::json{lo[i], hi[i]} : nlohmann::json());
    return nlohmann::json{{"ranges", ranges}}.dump();
}

namespace {

nlohmann::json eventsJson(const std::array<volume::AxisEvents, 3>& axes) {
    nlohmann::json out = nlohmann::json::array();
    for (const volume::AxisEvents& events : axes) {
        std::vector<double> numbers;
        for (const volume::AxisEvent& e : events)
            numbers.insert(numbers.end(),
                           {e.place, e.begun, e.ended, e.areaBegun, e.areaEnded, e.perLengthBegun, e.perLengthEnded});
        out.push_back(numbers);
    }
    return out;
}

} // namespace

std::string headerJson(const std::vector<BlockRef>& blocks) {
    using json = nlohmann::ordered_json;
    const auto triple = [](const auto& v) { return json::array({v.x, v.y, v.z}); };
    json out;
    out["format"] = blocks.front().block.format;
    out["blocks"] = json::array();
    for (const BlockRef& ref : blocks) {
        const volume::FileBlock& block = ref.block;
        json entry;
        entry["name"] = block.name;
        entry["mesh"] = block.mesh;
        entry["cellData"] = block.cellData;
        entry["dims"] = triple(block.lattice.size);
        entry["spacing"] = triple(block.lattice.spacing);
        entry["origin"] = triple(block.lattice.origin);
        if (!block.lattice.isEven()) entry["axes"] = json::parse(volume::axesJson(block.lattice.axes));
        if (std::ranges::any_of(block.events, [](const auto& events) { return !events.empty(); }))
            entry["events"] = eventsJson(block.events);
        entry["box"] = {block.box.lo.x, block.box.lo.y, block.box.lo.z, block.box.hi.x, block.box.hi.y, block.box.hi.z};
        entry["cells"] = {block.cells};
        entry["cellSize"] = triple(block.cellSize);
        if (block.mesh) entry["boxes"] = block.boxes;
        if (block.mesh) entry["cellArrays"] = std::ranges::any_of(ref.arrays, &ArrayRef::ofCells);
        if (block.mesh && std::isfinite(block.volume)) entry["volume"] = {block.volume};
        entry["lengthUnit"] = block.lengthUnit;
        entry["timeName"] = block.timeName;
        entry["timeUnit"] = block.timeUnit;
        if (!block.notes.empty()) entry["notes"] = block.notes;
        entry["times"] = block.times;
        entry["quantities"] = json::array();
        for (const volume::Quantity& quantity : block.quantities) {
            json values = json::array();
            for (const double value : quantity.values) values.push_back(std::isfinite(value) ? json(value) : json());
            entry["quantities"].push_back({{"name", quantity.name}, {"unit", quantity.unit}, {"values", values}});
        }
        entry["arrays"] = json::array();
        for (const ArrayRef& array : ref.arrays) {
            json words;
            words["name"] = array.form.name;
            words["unit"] = array.form.unit;
            words["components"] = array.form.components;
            words["type"] = volume::name(array.form.type);
            for (const volume::Label& label : array.form.labels)
                words["labels"][std::to_string(label.value)] = label.name;
            entry["arrays"].push_back(std::move(words));
        }
        out["blocks"].push_back(std::move(entry));
    }
    return out.dump(-1, ' ', false, json::error_handler_t::replace);
}

} // namespace tessera::importer
