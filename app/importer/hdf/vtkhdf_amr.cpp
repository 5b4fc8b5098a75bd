// OverlappingAMR of VTKHDF files: boxes of cells in several levels of detail.
#include "app/importer/hdf/vtkhdf_leaf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <stdexcept>
#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkUnsignedCharArray.h>

namespace tessera::importer {

namespace {

struct AmrBox {
    std::array<std::int64_t, 3> low{}, high{}; ///< of its cells, in cells of its level

    std::size_t cells() const {
        return std::size_t((high[0] - low[0] + 1) * (high[1] - low[1] + 1) * (high[2] - low[2] + 1));
    }
};

struct AmrLevel {
    std::int64_t ratio = 1; ///< cells along an edge of a cell of level 0
    std::vector<AmrBox> boxes;
    std::size_t firstBox = 0, firstCell = 0;
};

std::string levelGroup(const std::string& group, std::size_t level) {
    return group + "/Level" + std::to_string(level);
}

AmrBox boxFrom(const std::vector<std::int64_t>& numbers, std::size_t at) {
    AmrBox box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        box.low[axis] = numbers[at + 2 * axis];
        box.high[axis] = std::max(numbers[at + 2 * axis + 1], box.low[axis]); // flat along this axis
        constexpr std::int64_t kMost = 1 << 24;
        if (std::abs(box.low[axis]) > kMost || std::abs(box.high[axis]) > kMost)
            throw std::runtime_error("is damaged: it has a box beyond all bounds");
    }
    return box;
}

std::vector<AmrLevel> levelsAt(const HdfFile& file, const std::string& group, std::size_t step) {
    std::vector<AmrLevel> levels;
    std::vector<double> coarse;
    for (std::size_t l = 0; file.isGroup(levelGroup(group, l)); ++l) {
        const std::string own = levelGroup(group, l), steady = group + "/Steps/Level" + std::to_string(l);
        const std::vector<double> spacing = file.attribute(own, "Spacing");
        const std::optional<HdfShape> shape = file.shape(own + "/AMRBox");
        if (spacing.size() != 3 || !shape || shape->dims.size() != 2 || shape->dims[1] != 6)
            throw std::runtime_error("is damaged: its level " + std::to_string(l) + " has no spacing or no boxes");
        if (l == 0) coarse = spacing;
        AmrLevel level;
        level.ratio = std::llround(coarse[0] / spacing[0]);
        for (int axis = 0; axis < 3; ++axis)
            if (level.ratio < 1 || level.ratio > 4096 ||
                std::abs(spacing[std::size_t(axis)] * double(level.ratio) - coarse[std::size_t(axis)]) >
                    1e-6 * std::abs(coarse[std::size_t(axis)]))
                throw std::runtime_error(
                    "refines by a number that is not whole or differs along the axes, which is not "
                    "read: write it as an image from ParaView (Resample To Image)");
        const std::vector<std::int64_t> begins = file.integers(steady + "/AMRBoxOffsets"),
                                        counts = file.integers(steady + "/NumberOfAMRBoxes");
        level.firstBox = step < begins.size() ? std::size_t(std::max<std::int64_t>(begins[step], 0)) : 0;
        const std::size_t count =
            step < counts.size() ? std::size_t(std::max<std::int64_t>(counts[step], 0)) : shape->dims[0];
        const std::vector<std::int64_t> all = file.integers(own + "/AMRBox", 0, shape->dims[0]);
        if (level.firstBox > shape->dims[0] || count > shape->dims[0] - level.firstBox)
            throw std::runtime_error("is damaged: a step has boxes that are not there");
        for (std::size_t b = 0; b < level.firstBox; ++b) level.firstCell += boxFrom(all, 6 * b).cells();
        for (std::size_t b = 0; b < count; ++b) level.boxes.push_back(boxFrom(all, 6 * (level.firstBox + b)));
        levels.push_back(std::move(level));
    }
    if (levels.empty() || levels[0].boxes.empty()) throw std::runtime_error("holds no level of detail");
    return levels;
}

/// The box of level 0, and how many levels are drawn on its finest grid.
struct AmrGrid {
    AmrBox coarse;
    std::size_t levels = 1;
    std::int64_t ratio = 1;
};
AmrGrid amrGrid(const std::vector<AmrLevel>& levels) {
    AmrGrid grid{levels[0].boxes.front(), 1, 1};
    for (const AmrBox& box : levels[0].boxes)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            grid.coarse.low[axis] = std::min(grid.coarse.low[axis], box.low[axis]);
            grid.coarse.high[axis] = std::max(grid.coarse.high[axis], box.high[axis]);
        }
    constexpr double kMostCells = double(1 << 26);
    double cells = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) cells *= double(grid.coarse.high[axis] - grid.coarse.low[axis] + 1);
    if (cells > kMostCells) throw std::runtime_error("states a coarsest level of more cells than are read");
    for (std::size_t l = 1; l < levels.size(); ++l) {
        if (cells * std::pow(double(levels[l].ratio), 3) > kMostCells) break;
        grid.levels = l + 1;
        grid.ratio = levels[l].ratio;
    }
    return grid;
}

/// Copies the cells of a box, each as often as fine cells lie in it.
void drawBox(const AmrBox& box, std::int64_t repeat, const AmrGrid& grid, const char* from, std::size_t bytes, char* to,
             const std::array<std::int64_t, 3>& size) {
    for (std::int64_t k = box.low[2]; k <= box.high[2]; ++k)
        for (std::int64_t j = box.low[1]; j <= box.high[1]; ++j)
            for (std::int64_t i = box.low[0]; i <= box.high[0]; ++i, from += bytes) {
                const std::array<std::int64_t, 3> cell = {i, j, k};
                std::array<std::int64_t, 3> begin{}, end{};
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    begin[axis] = cell[axis] * repeat - grid.coarse.low[axis] * grid.ratio;
                    end[axis] = std::min(begin[axis] + repeat, size[axis]);
                    begin[axis] = std::max<std::int64_t>(begin[axis], 0);
                }
                for (std::int64_t z = begin[2]; z < end[2]; ++z)
                    for (std::int64_t y = begin[1]; y < end[1]; ++y)
                        for (std::int64_t x = begin[0]; x < end[0]; ++x)
                            std::memcpy(to + std::size_t((z * size[1] + y) * size[0] + x) * bytes, from, bytes);
            }
}

} // namespace

VtkHdfLeaf openVtkHdfAmr(const HdfFile& file, const std::string& group, const std::string& name,
                         std::vector<std::string>& notes) {
    VtkHdfLeaf leaf{name, group, "OverlappingAMR", {}, {}, {}, false};
    if (!file.attribute(group + "/Steps", "NSteps").empty()) leaf.times = file.doubles(group + "/Steps/Values");
    const std::vector<AmrLevel> levels = levelsAt(file, group, 0);
    const AmrGrid grid = amrGrid(levels);
    for (const std::string& member : file.members(levelGroup(group, 0) + "/CellData"))
        leaf.arrays.push_back({member, "CellData/" + member, true, false, {}, {}});
    for (const std::string& member : file.members(levelGroup(group, 0) + "/PointData"))
        notes.push_back("array \"" + member + "\" left out: values at points of several levels of detail are not read");
    if (levels.size() > 1)
        notes.push_back(
            "cells of " + std::to_string(grid.levels) + " levels of detail shown on the grid of the finest" +
            (grid.levels < levels.size() ? "; " + std::to_string(levels.size() - grid.levels) + " finer levels left out"
                                         : std::string()));
    return leaf;
}

vtkSmartPointer<vtkDataSet> readVtkHdfAmr(const HdfFile& file, const VtkHdfLeaf& leaf, std::size_t step) {
    const std::vector<AmrLevel> levels = levelsAt(file, leaf.group, step);
    const AmrGrid grid = amrGrid(levels);
    const std::vector<double> origin = file.attribute(leaf.group, "Origin"),
                              spacing = file.attribute(levelGroup(leaf.group, 0), "Spacing");
    std::array<std::int64_t, 3> size{};
    vtkNew<vtkImageData> image;
    double first[3] = {}, step3[3] = {};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        size[axis] = (grid.coarse.high[axis] - grid.coarse.low[axis] + 1) * grid.ratio;
        step3[axis] = spacing[axis] / double(grid.ratio);
        first[axis] = (axis < origin.size() ? origin[axis] : 0) + spacing[axis] * double(grid.coarse.low[axis]);
    }
    image->SetDimensions(int(size[0]) + 1, int(size[1]) + 1, int(size[2]) + 1);
    image->SetOrigin(first);
    image->SetSpacing(step3);
    const vtkIdType count = vtkIdType(size[0] * size[1] * size[2]);
    vtkNew<vtkUnsignedCharArray> hidden;
    hidden->SetName("vtkGhostType");
    hidden->SetNumberOfTuples(count);
    hidden->Fill(vtkDataSetAttributes::HIDDENCELL);
    for (const AmrBox& box : levels[0].boxes) { // finer ones lie in them
        const std::vector<char> shown(box.cells(), 0);
        drawBox(box, grid.ratio, grid, shown.data(), 1, reinterpret_cast<char*>(hidden->GetPointer(0)), size);
    }
    image->GetCellData()->AddArray(hidden);
    for (const VtkHdfArray& array : leaf.arrays) {
        vtkSmartPointer<vtkDataArray> out;
        std::size_t bytes = 0;
        for (std::size_t l = 0; l < grid.levels; ++l) {
            const AmrLevel& level = levels[l];
            const std::string path = levelGroup(leaf.group, l) + "/" + array.path;
            const std::optional<HdfShape> shape = file.shape(path);
            if (!shape || !shape->numbers || shape->dims.empty()) continue;
            const std::vector<std::int64_t> begins =
                file.integers(leaf.group + "/Steps/Level" + std::to_string(l) + "/CellDataOffsets/" + array.name);
            std::size_t row =
                step < begins.size() ? std::size_t(std::max<std::int64_t>(begins[step], 0)) : level.firstCell;
            std::size_t rows = 0;
            for (const AmrBox& box : level.boxes) rows += box.cells();
            const auto values = file.rows(path, row, rows);
            std::size_t components = 1;
            for (std::size_t axis = 1; axis < shape->dims.size(); ++axis) components *= shape->dims[axis];
            if (out == nullptr) {
                out = vtkSmartPointer<vtkDataArray>::Take(values->NewInstance());
                out->SetName(array.name.c_str());
                out->SetNumberOfComponents(int(components));
                out->SetNumberOfTuples(count);
                out->Fill(0);
                bytes = components * std::size_t(out->GetDataTypeSize());
            }
            if (values->GetDataType() != out->GetDataType() || components != std::size_t(out->GetNumberOfComponents()))
                throw std::runtime_error("array \"" + array.name + "\" has another type in a level of detail");
            const char* from = static_cast<const char*>(values->GetVoidPointer(0));
            for (const AmrBox& box : level.boxes) {
                drawBox(box, grid.ratio / level.ratio, grid, from, bytes, static_cast<char*>(out->GetVoidPointer(0)),
                        size);
                from += box.cells() * bytes;
            }
        }
        if (out != nullptr) image->GetCellData()->AddArray(out);
    }
    return image;
}

} // namespace tessera::importer
