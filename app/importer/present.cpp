#include "app/importer/present.h"

#include <limits>
#include <vtkDoubleArray.h>

namespace tessera::importer {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

} // namespace

std::vector<std::uint8_t> presentValues(vtkDataSet* data, vtkDataArray* from, const ArrayRef& array, int component) {
    std::vector<std::uint8_t> flags = array.ofCells ? presentCells(data) : presentPoints(data);
    if (from == nullptr || !array.stored.masks()) return flags;
    const auto count = std::size_t(from->GetNumberOfTuples());
    if (flags.empty()) flags.assign(count, 1);
    for (std::size_t i = 0; i < count && i < flags.size(); ++i)
        if (!array.stored.isValue(from->GetComponent(vtkIdType(i), component))) flags[i] = 0;
    return flags;
}

vtkSmartPointer<vtkDataArray> valuesOf(vtkDataSet* data, vtkDataArray* from, const ArrayRef& array) {
    const std::vector<std::uint8_t> flags = array.ofCells ? presentCells(data) : presentPoints(data);
    const StoredForm& form = array.stored;
    if (flags.empty() && !form.masks() && !form.scales()) return from;
    auto values = vtkSmartPointer<vtkDoubleArray>::New();
    values->SetNumberOfComponents(from->GetNumberOfComponents());
    values->SetNumberOfTuples(from->GetNumberOfTuples());
    for (vtkIdType i = 0; i < from->GetNumberOfTuples(); ++i)
        for (int c = 0; c < from->GetNumberOfComponents(); ++c) {
            const double stored = from->GetComponent(i, c);
            const bool present = (std::size_t(i) >= flags.size() || flags[std::size_t(i)] != 0) &&
                                 (!form.masks() || form.isValue(stored));
            values->SetComponent(i, c, present ? form.offset + form.scale * stored : kNaN);
        }
    return values;
}

} // namespace tessera::importer
