#include "app/importer/even_grid.h"

#include "volume/import/files/upright.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>
#include <vector>
#include <vtkCellData.h>
#include <vtkDataArray.h>
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

} // namespace

vtkSmartPointer<vtkDataSet> asEvenGrid(vtkSmartPointer<vtkDataSet> data) {
    int extent[6] = {};
    if (auto* structured = vtkStructuredGrid::SafeDownCast(data))
        structured->GetExtent(extent);
    else if (auto* rectilinear = vtkRectilinearGrid::SafeDownCast(data))
        rectilinear->GetExtent(extent);
    else
        return data;
    // Point and cell values would need different images.
    if (data->GetPointData()->GetNumberOfArrays() > 0 && data->GetCellData()->GetNumberOfArrays() > 0) return data;
    int size[3];
    vtkIdType stride[3], count = 1;
    for (int axis = 0; axis < 3; ++axis) {
        size[axis] = extent[2 * axis + 1] - extent[2 * axis] + 1;
        stride[axis] = count;
        count *= size[axis];
    }
    if (count != data->GetNumberOfPoints() || count < 2) return data;
    double first[3];
    data->GetPoint(0, first);
    volume::StoredGrid grid{{size[0], size[1], size[2]}, {first[0], first[1], first[2]}, glm::dmat3(0)};
    double coarsest = 0;
    for (int axis = 0; axis < 3; ++axis) {
        if (size[axis] < 2) continue;
        double last[3];
        data->GetPoint(stride[axis] * (size[axis] - 1), last);
        grid.steps[axis] = (glm::dvec3(last[0], last[1], last[2]) - grid.origin) / double(size[axis] - 1);
        if (!(glm::length(grid.steps[axis]) > 0)) return data;
        coarsest = std::max(coarsest, glm::length(grid.steps[axis]));
    }
    const volume::UprightGrid straight = volume::upright(withoutFlatAxes(grid));
    if (!straight.note.empty()) return data; // it is sampled where it lies
    for (vtkIdType n = 0; n < count; ++n) {
        double place[3];
        data->GetPoint(n, place);
        glm::dvec3 wanted = grid.origin;
        for (int axis = 0; axis < 3; ++axis) wanted += grid.steps[axis] * double(n / stride[axis] % size[axis]);
        for (int axis = 0; axis < 3; ++axis) {
            const double step = straight.lattice.size[axis] > 1 ? straight.lattice.spacing[axis] : coarsest;
            if (!(std::abs(place[axis] - wanted[axis]) <= 1e-3 * step)) return data;
        }
    }
    vtkNew<vtkImageData> image;
    const glm::dmat3 steps = withoutFlatAxes(grid).steps;
    image->SetDimensions(size);
    image->SetOrigin(first);
    for (int axis = 0; axis < 3; ++axis)
        for (int row = 0; row < 3; ++row)
            image->GetDirectionMatrix()->SetElement(row, axis, steps[axis][row] / glm::length(steps[axis]));
    image->SetSpacing(glm::length(steps[0]), glm::length(steps[1]), glm::length(steps[2]));
    image->GetPointData()->ShallowCopy(data->GetPointData());
    image->GetCellData()->ShallowCopy(data->GetCellData());
    image->GetFieldData()->ShallowCopy(data->GetFieldData());
    return image;
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
    volume::StoredGrid inner = points; // of cells: an axis with one layer of points has one layer of cells
    for (int axis = 0; axis < 3; ++axis) inner.size[axis] = std::max(1, points.size[axis] - 1);
    const volume::UprightGrid cells = volume::upright(inner);
    vtkNew<vtkImageData> out;
    const volume::Lattice& lattice = grid.lattice;
    out->SetDimensions(lattice.size.x, lattice.size.y, lattice.size.z);
    out->SetOrigin(lattice.origin.x, lattice.origin.y, lattice.origin.z);
    out->SetSpacing(lattice.spacing.x, lattice.spacing.y, lattice.spacing.z);
    out->GetFieldData()->ShallowCopy(image->GetFieldData());
    if (grid.asStored()) {
        out->GetPointData()->ShallowCopy(image->GetPointData());
        out->GetCellData()->ShallowCopy(image->GetCellData());
        return out;
    }
    const auto turn = [](vtkDataSetAttributes* from, vtkDataSetAttributes* to, const volume::UprightGrid& by) {
        for (int i = 0; i < from->GetNumberOfArrays(); ++i)
            if (vtkDataArray* array = from->GetArray(i))
                if (std::size_t(array->GetNumberOfTuples()) == by.lattice.count()) to->AddArray(inOrder(array, by));
    };
    turn(image->GetPointData(), out->GetPointData(), grid);
    turn(image->GetCellData(), out->GetCellData(), cells);
    return out;
}

} // namespace tessera::importer
