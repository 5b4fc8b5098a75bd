// gmsh: physical groups as blocks, views as arrays over time.
#include "app/importer/meshes/gmsh_file.h"
#include "app/importer/readers/check_file.h"
#include "app/importer/readers/read_files.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <set>
#include <stdexcept>
#include <unordered_map>
#include <vtkCellData.h>
#include <vtkCompositeDataSet.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkIntArray.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>

namespace tessera::importer {

namespace {

/// The cells of a physical group, and which points and cells of the file they are.
struct GmshBlock {
    std::string name;
    vtkSmartPointer<vtkUnstructuredGrid> grid;
    std::vector<std::int64_t> pointIds, cellIds;
};

struct OpenedGmsh {
    std::vector<GmshBlock> blocks;
    std::vector<GmshValues> values;
    std::vector<double> times;
};

std::set<int> groupsOf(const GmshMesh& mesh) {
    std::set<int> groups;
    for (const GmshCell& cell : mesh.cells) groups.insert(cell.group);
    return groups;
}

std::string nameOfGroup(const GmshMesh& mesh, int group) {
    if (const auto name = mesh.groups.find(group); name != mesh.groups.end()) return name->second;
    return group == 0 ? std::string("rest") : "group " + std::to_string(group);
}

GmshBlock blockOfGroup(const GmshMesh& mesh, int group,
                       const std::unordered_map<std::int64_t, std::size_t>& pointOfId) {
    GmshBlock block;
    block.grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    vtkNew<vtkIntArray> groups;
    groups->SetName("physical group");
    std::unordered_map<std::int64_t, vtkIdType> used;
    for (const GmshCell& cell : mesh.cells) {
        if (cell.group != group) continue;
        std::vector<vtkIdType> corners;
        for (const std::int64_t id : cell.corners) {
            const auto place = pointOfId.find(id);
            if (place == pointOfId.end()) throw std::runtime_error("has a cell with a corner that is not there");
            const auto [at, isNew] = used.emplace(id, vtkIdType(used.size()));
            if (isNew) {
                points->InsertNextPoint(mesh.places.data() + 3 * place->second);
                block.pointIds.push_back(id);
            }
            corners.push_back(at->second);
        }
        block.grid->InsertNextCell(cell.vtkType, vtkIdType(corners.size()), corners.data());
        block.cellIds.push_back(cell.id);
        groups->InsertNextValue(group);
    }
    block.grid->SetPoints(points);
    block.name = nameOfGroup(mesh, group);
    if (mesh.values.empty()) {
        block.grid->GetCellData()->AddArray(groups);
        std::string text; // of all groups, since blocks have one array in common
        for (const int any : groupsOf(mesh))
            text +=
                (text.empty() ? "" : "; ") + ("physical%20group " + std::to_string(any)) + " " + nameOfGroup(mesh, any);
        vtkNew<vtkStringArray> labels;
        labels->SetName("labels");
        labels->InsertNextValue(text);
        block.grid->GetFieldData()->AddArray(labels);
    }
    return block;
}

/// The values of the points or cells of a block; null if it has none.
vtkSmartPointer<vtkDoubleArray> arrayOfIds(const GmshValues& values, const std::vector<std::int64_t>& ids) {
    std::unordered_map<std::int64_t, std::size_t> place;
    for (std::size_t n = 0; n < values.ids.size(); ++n) place.emplace(values.ids[n], n);
    auto array = vtkSmartPointer<vtkDoubleArray>::New();
    array->SetName(values.name.c_str());
    array->SetNumberOfComponents(int(values.components));
    array->SetNumberOfTuples(vtkIdType(ids.size()));
    array->Fill(std::numeric_limits<double>::quiet_NaN());
    bool any = false;
    for (std::size_t n = 0; n < ids.size(); ++n) {
        const auto at = place.find(ids[n]);
        if (at == place.end()) continue;
        any = true;
        array->SetTuple(vtkIdType(n), values.values.data() + at->second * values.components);
    }
    return any ? array : nullptr;
}

vtkSmartPointer<vtkDataObject> gmshAt(const OpenedGmsh& opened, std::size_t time) {
    auto out = vtkSmartPointer<vtkMultiBlockDataSet>::New();
    for (const GmshBlock& block : opened.blocks) {
        vtkNew<vtkUnstructuredGrid> grid;
        grid->ShallowCopy(block.grid);
        for (const GmshValues& values : opened.values) {
            if (opened.times.size() > 1 && values.time != opened.times.at(time)) continue;
            vtkDataSetAttributes* to = grid->GetPointData();
            if (values.ofCells) to = grid->GetCellData();
            if (const auto array = arrayOfIds(values, values.ofCells ? block.cellIds : block.pointIds))
                to->AddArray(array);
        }
        const unsigned b = out->GetNumberOfBlocks();
        out->SetBlock(b, grid);
        out->GetMetaData(b)->Set(vtkCompositeDataSet::NAME(), opened.blocks.size() == 1 ? "" : block.name);
    }
    return out;
}

} // namespace

void openGmsh(Source& source) {
    if (readPart(source.path, 0, 11) != "$MeshFormat") throw std::runtime_error("does not begin with $MeshFormat");
    source.format = "gmsh";
    GmshMesh mesh = readGmshMesh(source.path);
    const auto opened = std::make_shared<OpenedGmsh>();
    std::unordered_map<std::int64_t, std::size_t> pointOfId;
    for (std::size_t n = 0; n < mesh.pointIds.size(); ++n) pointOfId.emplace(mesh.pointIds[n], n);
    for (const int group : groupsOf(mesh)) opened->blocks.push_back(blockOfGroup(mesh, group, pointOfId));
    source.notes = mesh.notes;
    if (mesh.values.empty()) source.notes.push_back("holds no values: physical groups are shown as labels");
    std::set<double> times;
    std::set<std::string> names;
    for (const GmshValues& values : mesh.values) times.insert(values.time);
    opened->times.assign(times.begin(), times.end());
    source.times = opened->times;
    std::set<std::size_t> shown{0};
    for (const GmshValues& values : mesh.values)
        if (names.insert(values.name).second)
            shown.insert(std::size_t(std::distance(times.begin(), times.find(values.time))));
    source.shownAt.assign(shown.begin(), shown.end());
    opened->values = std::move(mesh.values);
    source.read = [opened](std::size_t time) { return gmshAt(*opened, time); };
}

} // namespace tessera::importer
