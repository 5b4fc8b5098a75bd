#include "app/importer/hdf/xdmf_grid.h"

#include "app/importer/hdf/xdmf_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkMatrix3x3.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkRectilinearGrid.h>
#include <vtkStructuredGrid.h>
#include <vtkUnstructuredGrid.h>

namespace tessera::importer {

namespace {

std::string topologyType(const XdmfGrid& grid) {
    return xdmfWord(xdmfAttribute(grid.topology, {"TopologyType", "Type"}));
}

std::string geometryType(const XdmfGrid& grid) {
    const std::string type = xdmfWord(xdmfAttribute(grid.geometry, {"GeometryType", "Type"}));
    return type.empty() ? "xyz" : type;
}

bool isStructured(const std::string& topology) {
    return topology.ends_with("mesh") && (topology.starts_with("2d") || topology.starts_with("3d"));
}

/// Points along x, y, z of a structured topology.
std::array<std::size_t, 3> xdmfSize(const XdmfGrid& grid, const XdmfDocument& document, const XdmfItems& items) {
    std::array<std::size_t, 3> size{1, 1, 1};
    if (geometryType(grid).starts_with("vxvy")) { // writers differ in the order of the axes in the topology
        const std::vector<pugi::xml_node> lists = document.children(grid.geometry, "DataItem");
        for (std::size_t axis = 0; axis < 3 && axis < lists.size(); ++axis) {
            size[axis] = 1;
            for (const std::size_t n : items.dims(lists[axis])) size[axis] *= n;
        }
    } else {
        const std::vector<std::size_t> dims =
            xdmfSizes(xdmfAttribute(grid.topology, {"Dimensions", "NumberOfElements"}));
        if (dims.empty() || dims.size() > 3) throw std::runtime_error("has a structured topology without dimensions");
        for (std::size_t axis = 0; axis < dims.size(); ++axis) size[dims.size() - 1 - axis] = dims[axis];
    }
    double points = 1;
    for (const std::size_t n : size) {
        if (n == 0 || n > std::size_t(std::numeric_limits<int>::max()))
            throw std::runtime_error("has an empty topology");
        points *= double(n);
    }
    if (points > 1e11) throw std::runtime_error("states a grid of more points than memory can hold");
    return size;
}

struct XdmfCounts {
    std::size_t points = 0, cells = 0;
};

XdmfCounts countsOf(const XdmfGrid& grid, const XdmfDocument& document, const XdmfItems& items) {
    XdmfCounts counts{1, 1};
    if (isStructured(topologyType(grid))) {
        for (const std::size_t n : xdmfSize(grid, document, items)) {
            counts.points *= n;
            counts.cells *= std::max<std::size_t>(n, 2) - 1;
        }
        return counts;
    }
    const std::vector<std::size_t> cells = xdmfSizes(xdmfAttribute(grid.topology, {"NumberOfElements", "Dimensions"}));
    if (!cells.empty())
        for (const std::size_t n : cells) counts.cells *= n;
    else if (const pugi::xml_node item = document.child(grid.topology, "DataItem"))
        counts.cells = items.dims(item).front();
    for (const std::size_t n : items.dims(document.child(grid.geometry, "DataItem"))) counts.points *= n;
    const std::string type = geometryType(grid);
    if (type == "xyz") counts.points /= 3;
    if (type == "xy") counts.points /= 2;
    return counts;
}

/// Numbers of x, y, z from a list in the order z, y, x, in which XDMF states origins and steps.
std::array<double, 3> turnedRound(const std::vector<double>& list, double other) {
    std::array<double, 3> out{other, other, other};
    for (std::size_t n = 0; n < list.size() && n < 3; ++n) out[std::min<std::size_t>(list.size(), 3) - 1 - n] = list[n];
    return out;
}

vtkSmartPointer<vtkDataSet> imageFrom(const XdmfGrid& grid, const XdmfDocument& document, const XdmfItems& items,
                                      const std::array<std::size_t, 3>& size) {
    const std::vector<pugi::xml_node> lists = document.children(grid.geometry, "DataItem");
    if (lists.size() < 2) throw std::runtime_error("has no origin or no steps");
    const std::array<double, 3> origin = turnedRound(items.read(lists[0]).list(), 0),
                                steps = turnedRound(items.read(lists[1]).list(), 1);
    vtkNew<vtkImageData> image;
    image->SetDimensions(int(size[0]), int(size[1]), int(size[2]));
    image->SetOrigin(origin.data());
    for (int axis = 0; axis < 3; ++axis)
        if (steps[std::size_t(axis)] < 0) image->GetDirectionMatrix()->SetElement(axis, axis, -1);
    image->SetSpacing(std::abs(steps[0]), std::abs(steps[1]), std::abs(steps[2]));
    return image;
}

vtkSmartPointer<vtkDataSet> rectilinearFrom(const XdmfGrid& grid, const XdmfDocument& document, const XdmfItems& items,
                                            const std::array<std::size_t, 3>& size) {
    const std::vector<pugi::xml_node> lists = document.children(grid.geometry, "DataItem");
    vtkNew<vtkRectilinearGrid> data;
    data->SetDimensions(int(size[0]), int(size[1]), int(size[2]));
    for (std::size_t axis = 0; axis < 3; ++axis) {
        vtkNew<vtkDoubleArray> places;
        for (const double at : axis < lists.size() ? items.read(lists[axis]).list() : std::vector<double>{0})
            places->InsertNextValue(at);
        if (std::size_t(places->GetNumberOfTuples()) != size[axis])
            throw std::runtime_error("has another number of coordinates than points along an axis");
        if (axis == 0) data->SetXCoordinates(places);
        if (axis == 1) data->SetYCoordinates(places);
        if (axis == 2) data->SetZCoordinates(places);
    }
    return data;
}

vtkSmartPointer<vtkPoints> pointsFrom(const XdmfGrid& grid, const XdmfDocument& document, const XdmfItems& items) {
    const std::string type = geometryType(grid);
    const std::vector<pugi::xml_node> lists = document.children(grid.geometry, "DataItem");
    if (lists.empty()) throw std::runtime_error("has a geometry without numbers");
    if (type == "xyz") return pointsOf(items.read(lists[0]).values);
    const bool apart = type == "x_y_z" || type == "x_y";
    if (!apart && type != "xy")
        throw std::runtime_error("has a geometry of the type " + type.substr(0, 20) + ", which is not read");
    std::vector<vtkSmartPointer<vtkDataArray>> numbers;
    for (std::size_t n = 0; n < lists.size() && n < (apart ? 3u : 1u); ++n)
        numbers.push_back(items.read(lists[n]).values);
    const vtkIdType count = apart ? numbers[0]->GetNumberOfTuples() : numbers[0]->GetNumberOfTuples() / 2;
    auto all = vtkSmartPointer<vtkDataArray>::Take(numbers[0]->NewInstance());
    all->SetNumberOfComponents(3);
    all->SetNumberOfTuples(count);
    all->Fill(0);
    for (int axis = 0; axis < (apart ? int(numbers.size()) : 2); ++axis) {
        vtkDataArray* from = numbers[apart ? std::size_t(axis) : 0];
        if (apart && from->GetNumberOfTuples() != count)
            throw std::runtime_error("has coordinates of different numbers");
        for (vtkIdType p = 0; p < count; ++p)
            all->SetComponent(p, axis, from->GetComponent(apart ? p : 2 * p + axis, 0));
    }
    auto points = vtkSmartPointer<vtkPoints>::New();
    points->SetData(all);
    return points;
}

MeshCells cellsFrom(const XdmfGrid& grid, const XdmfDocument& document, const XdmfItems& items, vtkIdType points) {
    const std::string type = topologyType(grid);
    const XdmfCellKind* kind = xdmfCellKind(type);
    const std::vector<std::size_t> nodes = xdmfSizes(xdmfAttribute(grid.topology, {"NodesPerElement"}));
    const pugi::xml_node item = document.child(grid.topology, "DataItem");
    const XdmfCounts counts = countsOf(grid, document, items);
    std::vector<std::int64_t> list;
    std::size_t perCell = nodes.empty() ? 0 : nodes[0];
    if (item) {
        const XdmfNumbers numbers = items.read(item);
        list = numbers.integers();
        if (perCell == 0 && numbers.dims.size() == 2) perCell = numbers.dims[1];
    } else { // all points in their order
        for (vtkIdType p = 0; p < points; ++p) list.push_back(p);
    }
    if (const std::vector<double> base = xdmfNumbers(xdmfAttribute(grid.topology, {"BaseOffset"})); !base.empty())
        for (std::int64_t& point : list) point -= std::int64_t(base[0]);
    if (type == "mixed") return xdmfMixed(list, counts.cells, false);
    if (type == "polyhedron") return xdmfMixed(list, counts.cells, true);
    if (kind == nullptr)
        throw std::runtime_error("has a topology of the type " + type.substr(0, 40) + ", which is not read");
    return xdmfCells(*kind, perCell, std::move(list));
}

/// "Liquid_Pressure [Pa]" is a name and a unit.
void splitUnit(XdmfField& field) {
    const std::size_t open = field.name.rfind(" [");
    if (open == std::string::npos || open == 0 || field.name.back() != ']') return;
    field.unit = field.name.substr(open + 2, field.name.size() - open - 3);
    if (field.unit == "-") field.unit.clear();
    field.name.resize(open);
}

/// Rows of a data set that a field has values for.
std::size_t xdmfRows(const XdmfField& field, const XdmfCounts& counts) {
    return field.ofGrid ? 1 : field.ofCells ? counts.cells : counts.points;
}

} // namespace

XdmfGrid openXdmfGrid(const XdmfDocument& document, pugi::xml_node node, std::vector<std::string>& notes) {
    XdmfGrid grid;
    grid.name = xdmfAttribute(node, {"Name"});
    grid.topology = document.child(node, "Topology");
    grid.geometry = document.child(node, "Geometry");
    for (const pugi::xml_node attribute : document.children(node, "Attribute")) {
        XdmfField field{xdmfAttribute(attribute, {"Name"}), "", attribute};
        if (field.name.empty()) field.name = "value";
        const std::string center = xdmfWord(xdmfAttribute(attribute, {"Center"}));
        const std::string kind = xdmfWord(xdmfAttribute(attribute, {"ItemType"}));
        field.ofCells = center == "cell";
        field.ofGrid = center == "grid";
        const std::string label = "attribute \"" + field.name + "\" left out: it ";
        if (kind == "finiteelementfunction")
            notes.push_back(label + "is a function of finite elements by its degrees of freedom: write its values "
                                    "(XDMFFile.write instead of write_checkpoint)");
        else if (!center.empty() && center != "node" && !field.ofCells && !field.ofGrid)
            notes.push_back(label + "has values at each " + center.substr(0, 20) + ", neither points nor cells");
        else {
            splitUnit(field);
            for (const pugi::xml_node about : document.children(attribute, "Information"))
                if (const std::string name = xdmfWord(xdmfAttribute(about, {"Name"}));
                    name == "unit" || name == "units")
                    field.unit = xdmfAttribute(about, {"Value"});
            grid.fields.push_back(std::move(field));
        }
    }
    return grid;
}

int cellDimension(const XdmfGrid& grid) {
    const std::string type = topologyType(grid);
    if (type == "mixed") return 3;
    if (isStructured(type)) return type[0] - '0';
    const XdmfCellKind* kind = xdmfCellKind(type);
    return kind != nullptr ? kind->dimension : -1;
}

std::string xdmfFault(const XdmfDocument& document, const XdmfItems& items, const XdmfGrid& grid,
                      const XdmfField& field) {
    try {
        const pugi::xml_node item = document.child(field.attribute, "DataItem");
        items.check(item);
        std::size_t count = 1;
        for (const std::size_t n : items.dims(item)) count *= n;
        const std::size_t rows = xdmfRows(field, countsOf(grid, document, items));
        if (rows == 0 || count == 0 || count % rows != 0) return "has another size than its grid";
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "";
}

vtkSmartPointer<vtkDataSet> readXdmfMesh(const XdmfDocument& document, const XdmfItems& items, const XdmfGrid& grid) {
    const std::string type = topologyType(grid), places = geometryType(grid);
    if (!grid.topology || !grid.geometry) throw std::runtime_error("has a grid without topology or geometry");
    if (!isStructured(type)) {
        const vtkSmartPointer<vtkPoints> points = pointsFrom(grid, document, items);
        return meshOf(points, cellsFrom(grid, document, items, points->GetNumberOfPoints()));
    }
    const std::array<std::size_t, 3> size = xdmfSize(grid, document, items);
    if (places.starts_with("origin_")) return imageFrom(grid, document, items, size);
    if (places.starts_with("vxvy")) return rectilinearFrom(grid, document, items, size);
    const vtkSmartPointer<vtkPoints> points = pointsFrom(grid, document, items);
    if (std::size_t(points->GetNumberOfPoints()) != size[0] * size[1] * size[2])
        throw std::runtime_error("has another number of points than its topology");
    vtkNew<vtkStructuredGrid> data;
    data->SetDimensions(int(size[0]), int(size[1]), int(size[2]));
    data->SetPoints(points);
    return data;
}

void addXdmfField(const XdmfDocument& document, const XdmfItems& items, const XdmfField& field, vtkDataSet& data) {
    const vtkIdType rows = field.ofGrid ? 1 : field.ofCells ? data.GetNumberOfCells() : data.GetNumberOfPoints();
    vtkSmartPointer<vtkDataArray> values = items.read(document.child(field.attribute, "DataItem")).values;
    const vtkIdType count = values->GetNumberOfValues();
    if (rows == 0 || count == 0 || count % rows != 0)
        throw std::runtime_error("attribute \"" + field.name + "\" has another size than its grid");
    values->SetNumberOfComponents(int(std::min<vtkIdType>(count / rows, std::numeric_limits<int>::max())));
    const std::string kind = xdmfWord(xdmfAttribute(field.attribute, {"AttributeType", "Type"}));
    if (kind == "vector" && values->GetNumberOfComponents() == 2) { // in a plane
        auto whole = vtkSmartPointer<vtkDataArray>::Take(values->NewInstance());
        whole->SetNumberOfComponents(3);
        whole->SetNumberOfTuples(rows);
        whole->Fill(0);
        for (int axis = 0; axis < 2; ++axis) whole->CopyComponent(axis, values, axis);
        values = whole;
    }
    values->SetName(field.name.c_str());
    vtkFieldData* to = data.GetPointData();
    if (field.ofCells) to = data.GetCellData();
    if (field.ofGrid) to = data.GetFieldData();
    to->AddArray(values);
}

} // namespace tessera::importer
