#include "app/importer/even_grid.h"

#include "volume/import/files/upright.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <utility>
#include <vector>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkMatrix3x3.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkRectilinearGrid.h>
#include <vtkStructuredGrid.h>

namespace tessera::importer {

namespace {

/// Axes with a single sample have no step: they get one of length 1 along what is left of space.
volume::StoredGrid withoutFlatAxes(volume::StoredGrid grid) {
    for (int axis = 0; axis < 3; ++axis) {
        if (glm::length(grid.steps[axis]) > 0) continue;
        int free = axis;
        double least = 2;
        for (int n = 0; n < 3; ++n) { // the axis of space that the others run along least, its own by preference
            const int along = (axis + n) % 3;
            double most = 0;
            for (int other = 0; other < 3; ++other)
                if (const double length = glm::length(grid.steps[other]); length > 0)
                    most = std::max(most, std::abs(grid.steps[other][along]) / length);
            if (most < least - 1e-6) {
                least = most;
                free = along;
            }
        }
        grid.steps[axis][free] = 1;
    }
    return grid;
}

/// The samples of a field in the order of an upright grid.
vtkSmartPointer<vtkDataArray> inOrder(vtkDataArray* from, const volume::UprightGrid& grid) {
    const auto bytes = std::size_t(from->GetDataTypeSize() * from->GetNumberOfComponents());
    auto to = vtkSmartPointer<vtkDataArray>::Take(from->NewInstance());
    to->SetName(from->GetName());
    to->SetNumberOfComponents(from->GetNumberOfComponents());
    to->SetNumberOfTuples(from->GetNumberOfTuples());
    if (from->HasStandardMemoryLayout() && to->HasStandardMemoryLayout() && from->GetDataTypeSize() > 0) {
        const std::size_t size = bytes * std::size_t(from->GetNumberOfTuples());
        const auto* samples = static_cast<const std::byte*>(from->GetVoidPointer(0));
        const std::vector<std::byte> turned = volume::inUprightOrder({samples, size}, bytes, grid);
        std::copy(turned.begin(), turned.end(), static_cast<std::byte*>(to->GetVoidPointer(0)));
        return to;
    }
    const glm::ivec3 n = grid.lattice.size;
    for (int z = 0; z < n.z; ++z)
        for (int y = 0; y < n.y; ++y)
            for (int x = 0; x < n.x; ++x)
                to->SetTuple(vtkIdType(grid.lattice.index({x, y, z})), vtkIdType(grid.stored(x, y, z)), from);
    return to;
}

/// Values of points and cells of a grid of `points` points, in the order of an upright grid.
void turnArrays(vtkDataSet* from, vtkDataSet* to, const volume::StoredGrid& points, const volume::UprightGrid& grid) {
    volume::StoredGrid inner = points; // of cells: an axis with one layer of points has one layer of cells
    for (int axis = 0; axis < 3; ++axis) inner.size[axis] = std::max(1, points.size[axis] - 1);
    const volume::UprightGrid cells = volume::upright(inner);
    const auto turn = [](vtkDataSetAttributes* own, vtkDataSetAttributes* out, const volume::UprightGrid& by) {
        for (int i = 0; i < own->GetNumberOfArrays(); ++i)
            if (vtkDataArray* array = own->GetArray(i))
                if (std::size_t(array->GetNumberOfTuples()) == by.lattice.count()) out->AddArray(inOrder(array, by));
    };
    to->GetFieldData()->ShallowCopy(from->GetFieldData());
    if (grid.asStored()) {
        to->GetPointData()->ShallowCopy(from->GetPointData());
        to->GetCellData()->ShallowCopy(from->GetCellData());
        return;
    }
    turn(from->GetPointData(), to->GetPointData(), grid);
    turn(from->GetCellData(), to->GetCellData(), cells);
}

/// Points of a grid in the order of its axes.
struct GridPoints {
    int size[3] = {0, 0, 0};
    vtkIdType stride[3] = {0, 0, 0}, count = 1;

    explicit GridPoints(const int extent[6]) {
        for (int axis = 0; axis < 3; ++axis) {
            size[axis] = extent[2 * axis + 1] - extent[2 * axis] + 1;
            stride[axis] = count;
            count *= size[axis];
        }
    }
    int along(int axis, vtkIdType point) const { return int(point / stride[axis] % size[axis]); }
};

glm::dvec3 placeOf(vtkDataSet* data, vtkIdType point) {
    double place[3];
    data->GetPoint(point, place);
    return {place[0], place[1], place[2]};
}

/// The even grid that points lie on, to 0.1 % of a step; nothing if they do not.
std::optional<volume::StoredGrid> evenGridOf(vtkDataSet* data, const GridPoints& points) {
    volume::StoredGrid grid{{points.size[0], points.size[1], points.size[2]}, placeOf(data, 0), glm::dmat3(0)};
    double coarsest = 0;
    for (int axis = 0; axis < 3; ++axis) {
        if (points.size[axis] < 2) continue;
        const glm::dvec3 last = placeOf(data, points.stride[axis] * (points.size[axis] - 1));
        grid.steps[axis] = (last - grid.origin) / double(points.size[axis] - 1);
        if (!(glm::length(grid.steps[axis]) > 0)) return std::nullopt;
        coarsest = std::max(coarsest, glm::length(grid.steps[axis]));
    }
    const volume::UprightGrid straight = volume::upright(withoutFlatAxes(grid));
    if (!straight.note.empty()) return std::nullopt; // it is sampled where it lies
    for (vtkIdType n = 0; n < points.count; ++n) {
        const glm::dvec3 place = placeOf(data, n);
        glm::dvec3 wanted = grid.origin;
        for (int axis = 0; axis < 3; ++axis) wanted += grid.steps[axis] * double(points.along(axis, n));
        for (int axis = 0; axis < 3; ++axis) {
            const double step = straight.lattice.size[axis] > 1 ? straight.lattice.spacing[axis] : coarsest;
            if (!(std::abs(place[axis] - wanted[axis]) <= 1e-3 * step)) return std::nullopt;
        }
    }
    return withoutFlatAxes(grid);
}

vtkSmartPointer<vtkDataSet> evenImage(vtkDataSet* data, const volume::StoredGrid& grid) {
    vtkNew<vtkImageData> image;
    image->SetDimensions(grid.size.x, grid.size.y, grid.size.z);
    image->SetOrigin(grid.origin.x, grid.origin.y, grid.origin.z);
    for (int axis = 0; axis < 3; ++axis)
        for (int row = 0; row < 3; ++row)
            image->GetDirectionMatrix()->SetElement(row, axis, grid.steps[axis][row] / glm::length(grid.steps[axis]));
    image->SetSpacing(glm::length(grid.steps[0]), glm::length(grid.steps[1]), glm::length(grid.steps[2]));
    image->GetPointData()->ShallowCopy(data->GetPointData());
    image->GetCellData()->ShallowCopy(data->GetCellData());
    image->GetFieldData()->ShallowCopy(data->GetFieldData());
    return image;
}

/// The grid with axes of space that rise; null where its points lie on none, to 0.1 % of the least step beside a point.
vtkSmartPointer<vtkDataSet> unevenGrid(vtkDataSet* data, const GridPoints& points) {
    // Which axis of space each axis runs along, and in which sense: steps of one as if it were even.
    volume::StoredGrid sense{{points.size[0], points.size[1], points.size[2]}, {}, glm::dmat3(0)};
    const glm::dvec3 first = placeOf(data, 0);
    for (int axis = 0; axis < 3; ++axis) {
        if (points.size[axis] < 2) continue;
        const glm::dvec3 way = placeOf(data, points.stride[axis] * (points.size[axis] - 1)) - first;
        if (!(glm::length(way) > 0)) return nullptr;
        sense.steps[axis] = way / glm::length(way);
    }
    sense = withoutFlatAxes(sense);
    const volume::UprightGrid turned = volume::upright(sense);
    if (!turned.note.empty()) return nullptr;
    std::array<std::vector<double>, 3> places;
    for (int space = 0; space < 3; ++space) {
        const int own = turned.from[std::size_t(space)];
        for (int i = 0; i < points.size[own]; ++i)
            places[std::size_t(space)].push_back(placeOf(data, points.stride[own] * i)[space]);
        if (turned.turned[std::size_t(space)]) std::ranges::reverse(places[std::size_t(space)]);
        if (!std::ranges::is_sorted(places[std::size_t(space)], std::ranges::less_equal{})) return nullptr;
    }
    for (vtkIdType n = 0; n < points.count; ++n) {
        const glm::dvec3 place = placeOf(data, n);
        for (int space = 0; space < 3; ++space) {
            const std::vector<double>& own = places[std::size_t(space)];
            const auto last = own.size() - 1;
            auto i = std::size_t(points.along(turned.from[std::size_t(space)], n));
            if (turned.turned[std::size_t(space)]) i = last - i;
            double step = last == 0 ? std::numeric_limits<double>::max() : own[last] - own[0];
            if (i > 0) step = std::min(step, own[i] - own[i - 1]);
            if (i < last) step = std::min(step, own[i + 1] - own[i]);
            if (!(std::abs(place[space] - own[i]) <= 1e-3 * step)) return nullptr;
        }
    }
    auto grid = vtkSmartPointer<vtkRectilinearGrid>::New();
    grid->SetDimensions(turned.lattice.size.x, turned.lattice.size.y, turned.lattice.size.z);
    vtkNew<vtkDoubleArray> coordinates[3];
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const double place : places[axis]) coordinates[axis]->InsertNextValue(place);
    grid->SetXCoordinates(coordinates[0]);
    grid->SetYCoordinates(coordinates[1]);
    grid->SetZCoordinates(coordinates[2]);
    turnArrays(data, grid, sense, turned);
    return grid;
}

/// Values of points and of cells, which would need different grids.
bool hasBoth(vtkDataSet* data) {
    return data->GetPointData()->GetNumberOfArrays() > 0 && data->GetCellData()->GetNumberOfArrays() > 0;
}

} // namespace

bool isAligned(vtkRectilinearGrid* grid) {
    if (hasBoth(grid)) return false;
    for (vtkDataArray* places : {grid->GetXCoordinates(), grid->GetYCoordinates(), grid->GetZCoordinates()})
        for (vtkIdType i = 1; i < places->GetNumberOfTuples(); ++i)
            if (!(places->GetComponent(i, 0) > places->GetComponent(i - 1, 0))) return false;
    return true;
}

bool isEven(const std::vector<double>& places) {
    if (places.size() < 3) return true;
    const double step = (places.back() - places.front()) / double(places.size() - 1);
    for (std::size_t i = 0; i < places.size(); ++i)
        if (!(std::abs(places[i] - (places.front() + step * double(i))) <= 1e-3 * step)) return false;
    return true;
}

vtkSmartPointer<vtkDataSet> asAlignedGrid(vtkSmartPointer<vtkDataSet> data) {
    int extent[6] = {};
    if (auto* structured = vtkStructuredGrid::SafeDownCast(data))
        structured->GetExtent(extent);
    else if (auto* rectilinear = vtkRectilinearGrid::SafeDownCast(data))
        rectilinear->GetExtent(extent);
    else
        return data;
    if (hasBoth(data)) return data;
    const GridPoints points(extent);
    if (points.count != data->GetNumberOfPoints() || points.count < 2) return data;
    if (const std::optional<volume::StoredGrid> grid = evenGridOf(data, points)) return evenImage(data, *grid);
    const vtkSmartPointer<vtkDataSet> grid = unevenGrid(data, points);
    return grid != nullptr ? grid : data;
}

vtkSmartPointer<vtkDataSet> uprightImage(vtkImageData* image, std::string& note) {
    int extent[6];
    image->GetExtent(extent);
    const double* spacing = image->GetSpacing();
    const vtkMatrix3x3* direction = image->GetDirectionMatrix();
    volume::StoredGrid points{glm::ivec3(1), {}, glm::dmat3(1)};
    const double* origin = image->GetOrigin();
    points.origin = {origin[0], origin[1], origin[2]};
    for (int axis = 0; axis < 3; ++axis) {
        points.size[axis] = extent[2 * axis + 1] - extent[2 * axis] + 1;
        if (points.size[axis] < 1) return image;
        const double step = std::isfinite(spacing[axis]) && spacing[axis] != 0 ? spacing[axis] : 1;
        for (int row = 0; row < 3; ++row) points.steps[axis][row] = step * direction->GetElement(row, axis);
    }
    for (int axis = 0; axis < 3; ++axis) points.origin += points.steps[axis] * double(extent[2 * axis]);
    const volume::UprightGrid grid = volume::upright(points);
    note = grid.note;
    vtkNew<vtkImageData> out;
    const volume::Lattice& lattice = grid.lattice;
    out->SetDimensions(lattice.size.x, lattice.size.y, lattice.size.z);
    out->SetOrigin(lattice.origin.x, lattice.origin.y, lattice.origin.z);
    out->SetSpacing(lattice.spacing.x, lattice.spacing.y, lattice.spacing.z);
    turnArrays(image, out, points, grid);
    return out;
}

} // namespace tessera::importer
