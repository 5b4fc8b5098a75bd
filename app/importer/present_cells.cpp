#include "app/importer/present_cells.h"

#include <algorithm>
#include <array>
#include <vtkCellData.h>
#include <vtkCellTypes.h>
#include <vtkDataArray.h>
#include <vtkGenericCell.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkStructuredGrid.h>

namespace tessera::importer {

namespace {

/// Without std::fill, of which gcc 14 believes that it may run beyond the vector.
std::vector<std::uint8_t> allPresent(std::size_t count) {
    std::vector<std::uint8_t> flags(count);
    for (std::uint8_t& flag : flags) flag = 1;
    return flags;
}

/// Clears the flags of points or cells that have one of the bits.
void clearGhosts(vtkDataSetAttributes* attributes, int bits, std::size_t count, std::vector<std::uint8_t>& flags) {
    vtkDataArray* ghosts = attributes->GetArray("vtkGhostType");
    if (ghosts == nullptr || std::size_t(ghosts->GetNumberOfTuples()) != count) return;
    for (std::size_t i = 0; i < count; ++i) {
        if ((int(ghosts->GetComponent(vtkIdType(i), 0)) & bits) == 0) continue;
        if (flags.empty()) flags = allPresent(count);
        flags[i] = 0;
    }
}

/// 0 to 3; found once for each type.
int dimensionOfCell(int type) {
    static std::array<int, 256> known = [] {
        std::array<int, 256> none{};
        none.fill(-1);
        return none;
    }();
    if (type < 0 || type >= int(known.size())) return 0;
    int& dimension = known[std::size_t(type)];
    if (dimension < 0) {
        vtkNew<vtkGenericCell> cell;
        cell->SetCellType(type);
        dimension = cell->GetCellDimension();
    }
    return dimension;
}

} // namespace

int dimensionOf(vtkDataSet* data) {
    const int type = data->GetDataObjectType();
    if (type == VTK_IMAGE_DATA || type == VTK_UNIFORM_GRID || type == VTK_RECTILINEAR_GRID) return 3;
    if (auto* grid = vtkStructuredGrid::SafeDownCast(data)) return grid->GetDataDimension(); // its cells may be hidden
    vtkNew<vtkCellTypes> types;
    data->GetCellTypes(types);
    int most = 0;
    for (vtkIdType i = 0; i < types->GetNumberOfTypes(); ++i)
        most = std::max(most, dimensionOfCell(types->GetCellType(i)));
    return most;
}

std::vector<std::uint8_t> presentCells(vtkDataSet* data) {
    constexpr int kNoData = int(vtkDataSetAttributes::DUPLICATECELL) | int(vtkDataSetAttributes::REFINEDCELL) |
                            int(vtkDataSetAttributes::HIDDENCELL);
    std::vector<std::uint8_t> flags;
    const auto count = std::size_t(data->GetNumberOfCells());
    clearGhosts(data->GetCellData(), kNoData, count, flags);
    if (data->GetDataObjectType() != VTK_UNSTRUCTURED_GRID) return flags;
    const int most = dimensionOf(data);
    for (std::size_t c = 0; c < count; ++c) {
        if (dimensionOfCell(data->GetCellType(vtkIdType(c))) == most) continue;
        if (flags.empty()) flags = allPresent(count);
        flags[c] = 0;
    }
    return flags;
}

std::vector<std::uint8_t> presentPoints(vtkDataSet* data) {
    const auto count = std::size_t(data->GetNumberOfPoints());
    std::vector<std::uint8_t> flags;
    vtkDataArray* valid = data->GetPointData()->GetArray("vtkValidPointMask");
    if (valid != nullptr && std::size_t(valid->GetNumberOfTuples()) == count) {
        flags.resize(count);
        for (std::size_t i = 0; i < count; ++i) flags[i] = valid->GetComponent(vtkIdType(i), 0) != 0 ? 1 : 0;
    }
    clearGhosts(data->GetPointData(), vtkDataSetAttributes::HIDDENPOINT, count, flags);
    return flags;
}

} // namespace tessera::importer
