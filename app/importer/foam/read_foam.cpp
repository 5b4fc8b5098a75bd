#include "app/importer/foam/foam_series.h"
#include "app/importer/readers/read_files.h"

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <vtkCellData.h>
#include <vtkCompositeDataSet.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkStringArray.h>

namespace tessera::importer {

namespace {

/// The ending of each component of a field: those of tensors are parameters of their own.
std::vector<std::string> partsOfTensor(std::size_t components) {
    if (components == 6) return {".xx", ".xy", ".xz", ".yy", ".yz", ".zz"};
    if (components == 9) return {".xx", ".xy", ".xz", ".yx", ".yy", ".yz", ".zx", ".zy", ".zz"};
    return {""};
}

/// Adds the values of a field: scalars and vectors as they are, tensors component by component.
void addFoamArray(vtkDataSetAttributes* to, const std::string& name, const std::vector<double>& values,
                  std::size_t components) {
    const std::vector<std::string> parts = partsOfTensor(components);
    const std::size_t each = components / parts.size(), count = values.size() / components;
    for (std::size_t p = 0; p < parts.size(); ++p) {
        vtkNew<vtkDoubleArray> array;
        array->SetName((name + parts[p]).c_str());
        array->SetNumberOfComponents(static_cast<int>(each));
        array->SetNumberOfTuples(vtkIdType(count));
        double* out = array->GetPointer(0);
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t c = 0; c < each; ++c) out[i * each + c] = values[i * components + p * each + c];
        to->AddArray(array);
    }
}

/// The values of a field of all pieces, in the order of the joined mesh. Empty where a piece lacks the field.
std::vector<double> joinedValues(const FoamSeries& series, const FoamSeries::Mesh& mesh, const std::string& region,
                                 std::size_t time, const std::string& name, const FoamKind& kind) {
    const FoamCase& foam = series.foam;
    const std::vector<FoamPiece> pieces = foam.piecesAt(time);
    std::vector<double> all;
    for (std::size_t p = 0; p < pieces.size(); ++p) {
        const FoamPlace place = foamPlace(foam.fieldFolder(pieces[p], region, time), name, pieces[p].part, foam.root);
        if (place.path.empty()) return {};
        const std::vector<double> values = readFoamValues(place, foam.root, mesh.sizes[p][kind.ofPoints ? 1 : 0]);
        all.insert(all.end(), values.begin(), values.end());
    }
    if (!kind.ofPoints || mesh.pointOf.empty()) return all;
    std::vector<double> joined(mesh.grid.ownPoints * kind.components);
    for (std::size_t i = 0; i < mesh.pointOf.size(); ++i)
        for (std::size_t c = 0; c < kind.components; ++c)
            joined[std::size_t(mesh.pointOf[i]) * kind.components + c] = all[i * kind.components + c];
    return joined;
}

/// Adds the zones of cells as a label, where they tell cells apart.
void addZones(const FoamSeries::Mesh& mesh, vtkUnstructuredGrid* grid) {
    if (mesh.zone.empty() || std::ranges::count(mesh.zone, mesh.zone.front()) == std::ptrdiff_t(mesh.zone.size()))
        return;
    const std::vector<double> values =
        toGridCells(mesh.grid, std::vector<double>(mesh.zone.begin(), mesh.zone.end()), 1);
    vtkNew<vtkIntArray> array;
    array->SetName("zone");
    array->SetNumberOfTuples(vtkIdType(values.size()));
    for (std::size_t i = 0; i < values.size(); ++i) array->SetValue(vtkIdType(i), int(values[i]));
    grid->GetCellData()->AddArray(array);
    std::string words = "zone 0 no zone";
    for (std::size_t z = 0; z < mesh.zones.size(); ++z)
        words += "; zone " + std::to_string(z + 1) + " " + mesh.zones[z];
    vtkNew<vtkStringArray> labels;
    labels->SetName("labels");
    labels->InsertNextValue(words);
    grid->GetFieldData()->AddArray(labels);
}

vtkSmartPointer<vtkUnstructuredGrid> readRegion(FoamSeries& series, const std::string& region, std::size_t time) {
    const FoamSeries::Mesh& mesh = series.meshAt(region, time);
    auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
    grid->CopyStructure(mesh.grid.grid);
    const auto& fields = series.fields[time];
    if (const auto known = fields.find(region); known != fields.end())
        for (const auto& [name, field] : known->second) {
            const FoamKind kind = *foamKind(field.kind);
            std::vector<double> values = joinedValues(series, mesh, region, time, name, kind);
            if (values.empty()) continue;
            values = kind.ofPoints ? toGridPoints(mesh.grid, std::move(values), kind.components)
                                   : toGridCells(mesh.grid, std::move(values), kind.components);
            vtkDataSetAttributes* to = grid->GetCellData();
            if (kind.ofPoints) to = grid->GetPointData();
            addFoamArray(to, name, values, kind.components);
        }
    if (series.foam.regions.size() == 1 && grid->GetCellData()->GetArray("zone") == nullptr) addZones(mesh, grid);
    return grid;
}

} // namespace

vtkSmartPointer<vtkMultiBlockDataSet> readFoamTime(FoamSeries& series, std::size_t time) {
    auto all = vtkSmartPointer<vtkMultiBlockDataSet>::New();
    unsigned count = 0;
    for (const std::string& region : series.foam.regions) {
        if (!series.foam.hasMeshAt(region, time)) continue;
        all->SetBlock(count, readRegion(series, region, time));
        const bool several = series.foam.regions.size() > 1;
        const std::string name = region.empty() && several ? "defaultRegion" : region;
        all->GetMetaData(count)->Set(vtkCompositeDataSet::NAME(), name.c_str());
        ++count;
    }
    return all;
}

void openFoam(Source& source) {
    const auto series = std::make_shared<FoamSeries>(seriesOfFoam(findFoamCase(source.path)));
    for (const FoamTime& time : series->foam.times) source.times.push_back(time.value);
    const FoamClock clock = clockOfFoam(series->foam);
    source.timeUnit = clock.unit;
    source.timeName = clock.name;
    source.notes = series->notes;
    source.shownAt = series->shownAt;
    std::map<std::string, std::size_t> components;
    for (const auto& time : series->fields)
        for (const auto& [region, fields] : time)
            for (const auto& [name, field] : fields) components[name] = foamKind(field.kind)->components;
    for (const auto& [name, unit] : series->units)
        for (const std::string& part : partsOfTensor(components[name])) source.units[name + part] = unit;
    source.read = [series](std::size_t time) -> vtkSmartPointer<vtkDataObject> { return readFoamTime(*series, time); };
}

} // namespace tessera::importer
