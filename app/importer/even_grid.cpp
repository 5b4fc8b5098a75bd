#include "app/importer/even_grid.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vtkCellData.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkRectilinearGrid.h>
#include <vtkStructuredGrid.h>

namespace tessera::importer {

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
    double origin[3], step[3] = {1, 1, 1}, last[3];
    data->GetPoint(0, origin);
    data->GetPoint(count - 1, last);
    for (int axis = 0; axis < 3; ++axis)
        if (size[axis] > 1) step[axis] = (last[axis] - origin[axis]) / (size[axis] - 1);
    if (!(step[0] > 0 && step[1] > 0 && step[2] > 0)) return data;
    double coarsest = 0;
    for (int axis = 0; axis < 3; ++axis)
        if (size[axis] > 1) coarsest = std::max(coarsest, step[axis]);
    for (vtkIdType n = 0; n < count; ++n) {
        double place[3];
        data->GetPoint(n, place);
        for (int axis = 0; axis < 3; ++axis) {
            const double wanted = origin[axis] + step[axis] * double(n / stride[axis] % size[axis]);
            if (!(std::abs(place[axis] - wanted) <= 1e-3 * (size[axis] > 1 ? step[axis] : coarsest))) return data;
        }
    }
    vtkNew<vtkImageData> image;
    image->SetDimensions(size);
    image->SetOrigin(origin);
    image->SetSpacing(step);
    image->GetPointData()->ShallowCopy(data->GetPointData());
    image->GetCellData()->ShallowCopy(data->GetCellData());
    image->GetFieldData()->ShallowCopy(data->GetFieldData());
    return image;
}

} // namespace tessera::importer
