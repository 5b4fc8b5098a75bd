#include "volume/import/common_grid.h"

#include "volume/base/error.h"
#include "volume/field/own_axes.h"
#include "volume/import/mesh_planes.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <iterator>
#include <limits>
#include <map>
#include <set>

namespace tessera::volume {

namespace {

std::string words(glm::ivec3 size) {
    return std::to_string(size.x) + " x " + std::to_string(size.y) + " x " + std::to_string(size.z);
}

bool sameLattice(const Lattice& a, const Lattice& b) {
    if (a.size != b.size) return false;
    constexpr double kShare = 1e-4; // of a cell
    for (int axis = 0; axis < 3; ++axis) {
        if (!samePlanes(a.axes[axis], b.axes[axis], kShare)) return false;
        const double tolerance = kShare * a.spacing[axis];
        if (std::abs(a.spacing[axis] - b.spacing[axis]) * std::max(a.size[axis] - 1, 1) > tolerance ||
            std::abs(a.origin[axis] - b.origin[axis]) > tolerance)
            return false;
    }
    return true;
}

/// What is known of the meshes of all files together.
struct Meshes {
    Box box{glm::dvec3(std::numeric_limits<double>::max()), glm::dvec3(std::numeric_limits<double>::lowest())};
    glm::dvec3 perLength{0}; ///< sum over the cells of 1 / extent
    double cells = 0;
    bool cellData = true;
    bool cellArrays = false;
    bool moves = false; ///< then samples lie in cells, so that there are as many at each time
    std::vector<const FileBlock*> blocks;
    double blocksOfFirst = 0, cellsOfFirst = 0; ///< of the meshes of the first file of each group
};

/// Samples per axis: about one per cell of harmonic-mean extent, at most 1024 an axis and 16 M in all, and not more
/// than 16 per cell, so that a small region of small cells does not ask for samples everywhere. Within that, a block
/// thinner than the samples are apart gets as many as it has cells.
glm::dvec3 samplesForMesh(const Meshes& meshes) {
    constexpr double kMostPerAxis = 1024;
    const double most = std::min(16e6, std::max(16 * meshes.cells, 50e3));
    const glm::dvec3 extent = meshes.box.size();
    const double largest = std::max({extent.x, extent.y, extent.z});
    const auto samples = [&](int axis, double cellSize) {
        if (!(extent[axis] > 1e-9 * largest && cellSize > 0)) return 1.0;
        return std::clamp(std::round(extent[axis] / cellSize), 1.0, kMostPerAxis);
    };
    glm::dvec3 n(1);
    for (int axis = 0; axis < 3; ++axis) n[axis] = samples(axis, meshes.cells / meshes.perLength[axis]);
    const double total = n.x * n.y * n.z;
    if (total > most)
        for (int axis = 0; axis < 3; ++axis) n[axis] = std::max(1.0, std::floor(n[axis] * std::cbrt(most / total)));
    for (const FileBlock* block : meshes.blocks)
        for (int axis = 0; axis < 3; ++axis) {
            const double thick = block->box.size()[axis], wanted = samples(axis, block->cellSize[axis]);
            const bool thin = block->mesh && thick > 0 && thick < 1.5 * extent[axis] / n[axis];
            if (thin && wanted > n[axis] && n.x * n.y * n.z / n[axis] * wanted <= most) n[axis] = wanted;
        }
    return n;
}

/// The box of a block: that of its cells, or from its first sample to its last.
Box extentOf(const FileBlock& block) {
    const Lattice& own = block.lattice;
    return block.mesh || block.cellData ? block.box : Box{own.origin, own.position(own.size - 1)};
}

/// The events of a block; a grid's cells lie between its samples, or around them for values of cells.
std::array<AxisEvents, 3> eventsOf(const FileBlock& block) {
    if (block.mesh) return block.events;
    const Lattice& own = block.lattice;
    const int more = block.cellData ? 1 : 0; // borders than samples
    std::array<AxisEvents, 3> events;
    for (int axis = 0; axis < 3; ++axis) {
        if (own.size[axis] + more < 2) continue;
        std::vector<double> borders;
        for (int i = 0; i < own.size[axis] + more; ++i)
            borders.push_back(own.axes.toSpace(axis, own.origin[axis] + own.spacing[axis] * (i - 0.5 * more)));
        const int right = (axis + 1) % 3, up = (axis + 2) % 3;
        const glm::dvec3 size = glm::max(extentOf(block).size(), 1e-300);
        events[std::size_t(axis)] =
            eventsOfGrid(borders, double(own.size[right]) * own.size[up], size[right] * size[up]);
    }
    return events;
}

/// The even grid a mesh is sampled on: in the middle of cells for cell data, else from border to border.
Lattice evenGridForMesh(const Meshes& meshes, glm::ivec3 wanted) {
    const Box& box = meshes.box;
    const bool cellData = meshes.cellData;
    const glm::dvec3 extent = box.size(), n = samplesForMesh(meshes);
    const double largest = std::max({extent.x, extent.y, extent.z});
    Lattice grid;
    for (int axis = 0; axis < 3; ++axis) {
        const bool flat = !(extent[axis] > 1e-9 * largest);
        int samples = static_cast<int>(n[axis]) + (cellData || flat ? 0 : 1);
        if (wanted[axis] > 0) samples = wanted[axis];
        grid.size[axis] = samples;
        if (flat) {
            grid.spacing[axis] = largest > 0 ? largest / std::max(n.x, std::max(n.y, n.z)) : 1;
            grid.origin[axis] = box.lo[axis];
        } else if (cellData || samples == 1) {
            grid.spacing[axis] = extent[axis] / samples;
            grid.origin[axis] = box.lo[axis] + grid.spacing[axis] * 0.5;
        } else {
            grid.spacing[axis] = extent[axis] / (samples - 1);
            grid.origin[axis] = box.lo[axis];
        }
    }
    return grid;
}

/// Whether all lengths between planes are the same, to 1e-3.
bool areEven(const std::vector<double>& planes) {
    const double step = (planes.back() - planes.front()) / double(planes.size() - 1);
    for (std::size_t i = 1; i < planes.size(); ++i)
        if (!(std::abs(planes[i] - planes[i - 1] - step) <= 1e-3 * step)) return false;
    return true;
}

/// The grid between the planes of a mesh: samples in the middle of cells where there are arrays of cells or several
/// blocks, else on the planes. An axis whose planes are even, or not known, is as that of the even grid.
ChosenGrid planeGridForMesh(const Meshes& meshes, std::vector<std::string>& notes) {
    PlanesOfMesh asked;
    asked.box = meshes.box;
    const bool ofCells = meshes.cellData || meshes.cellArrays || meshes.blocksOfFirst > 1;
    asked.mostSamplesOfAll = std::min(16e6, std::max(16 * meshes.cells, 50e3));
    const glm::dvec3 extent = meshes.box.size();
    const double largest = std::max({extent.x, extent.y, extent.z});
    bool areBoxes = true;
    std::array<bool, 3> known{true, true, true};
    for (const FileBlock* block : meshes.blocks) {
        const Box own = extentOf(*block);
        areBoxes = areBoxes && (block->boxes || !block->mesh);
        std::array<AxisEvents, 3> events = eventsOf(*block);
        for (int axis = 0; axis < 3; ++axis) {
            const auto a = std::size_t(axis);
            known[a] = known[a] && (events[a].size() >= 2 || !(own.size()[axis] > 1e-9 * largest));
            asked.ends[a].insert(asked.ends[a].end(), {own.lo[axis], own.hi[axis]});
            std::ranges::move(events[a], std::back_inserter(asked.events[a]));
        }
    }
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = std::size_t(axis);
        std::ranges::sort(asked.ends[a]);
        asked.events[a] = known[a] ? joinedEvents(std::move(asked.events[a])) : AxisEvents{};
        if (!known[a])
            notes.push_back(std::string("at even distances across ") + "xyz"[axis] +
                            ", since cells of the mesh begin at too many places, or move");
    }
    const std::array<AxisPlanes, 3> planes = planesOfMesh(asked, notes);
    Meshes even = meshes;
    even.cellData = ofCells;
    ChosenGrid out{.lattice = evenGridForMesh(even, glm::ivec3(0)), .aligned = true, .onePerCell = meshes.cellData};
    AxisMaps axes;
    for (int axis = 0; axis < 3; ++axis) {
        const AxisPlanes& own = planes[std::size_t(axis)];
        if (!(extent[axis] > 1e-9 * largest)) continue;
        out.onePerCell = out.onePerCell && own.onePerCell;
        out.aligned = out.aligned && own.aligned;
        if (own.planes.size() < 2) continue;
        const auto intervals = int(own.planes.size()) - 1;
        const bool inCells = ofCells || intervals == 1;
        if (!areEven(own.planes)) {
            axes.of[std::size_t(axis)] =
                std::make_shared<const AxisMap>(inCells ? AxisMap::Of::Cells : AxisMap::Of::Points, own.planes);
            continue;
        }
        out.lattice.size[axis] = intervals + (inCells ? 0 : 1);
        out.lattice.spacing[axis] = extent[axis] / intervals;
        out.lattice.origin[axis] = meshes.box.lo[axis] + (inCells ? out.lattice.spacing[axis] * 0.5 : 0);
    }
    out.lattice = withAxes(out.lattice, std::move(axes));
    out.onePerCell = out.onePerCell && areBoxes;
    return out;
}

bool sameBox(const Box& a, const Box& b) {
    const double tolerance = 1e-6 * glm::length(a.size());
    return glm::length(a.lo - b.lo) <= tolerance && glm::length(a.hi - b.hi) <= tolerance;
}

/// Throws Error if a file whose samples cannot be interpolated lies on another grid than the others.
void checkGrids(const std::vector<OpenedFile>& files) {
    const FileBlock* fixed = nullptr;
    for (const OpenedFile& file : files)
        for (const FileBlock& block : file.blocks)
            if (!block.resamples && !fixed) fixed = &block;
    if (!fixed) return;
    const Lattice& grid = fixed->lattice;
    for (const OpenedFile& file : files)
        for (const FileBlock& block : file.blocks) {
            if (!block.mesh && sameLattice(grid, block.lattice)) continue;
            std::string how = "a mesh";
            if (!block.mesh)
                how = block.lattice.size == grid.size
                          ? "as many samples, but another place or spacing"
                          : words(block.lattice.size) + " samples against " + words(grid.size);
            throw Error("does not lie on the grid of " + fixed->file + " (" + how +
                            "); files that are opened together make one data set",
                        block.file);
        }
}

} // namespace

namespace {

Meshes meshesOf(const std::vector<OpenedFile>& files) {
    Meshes meshes;
    std::set<std::string> groups;
    std::map<std::string, Box> boxes;
    for (const OpenedFile& file : files) {
        const bool firstOfGroup = groups.insert(file.entry.group).second;
        for (const FileBlock& block : file.blocks) {
            const Lattice& own = block.lattice;
            const Box extent = extentOf(block);
            const bool counted = block.mesh || block.cells > 0;
            meshes.box.lo = glm::min(meshes.box.lo, extent.lo);
            meshes.box.hi = glm::max(meshes.box.hi, extent.hi);
            const double count = counted ? block.cells : double(own.count());
            meshes.cells += count;
            meshes.perLength += count / (counted ? block.cellSize : own.spacing);
            if (firstOfGroup && block.mesh) {
                meshes.cellsOfFirst += block.cells;
                ++meshes.blocksOfFirst;
            }
            meshes.cellData = meshes.cellData && block.cellData;
            meshes.cellArrays = meshes.cellArrays || (block.mesh && block.cellArrays);
            meshes.blocks.push_back(&block);
            const auto [known, isNew] = boxes.emplace(
                file.entry.group + "\n" + std::to_string(&block - file.blocks.data()) + block.name, extent);
            meshes.moves = meshes.moves || (!isNew && block.mesh && !sameBox(known->second, extent));
        }
    }
    meshes.cellData = meshes.cellData || meshes.moves;
    return meshes;
}

} // namespace

ChosenGrid chooseGrid(const std::vector<OpenedFile>& files, const ImportOptions& options, Box& bounds,
                      std::vector<std::string>& notes) {
    const FileBlock& first = files.front().blocks.front();
    bool equalGrids = true, anyMesh = false, anyUneven = false;
    for (const OpenedFile& file : files)
        for (const FileBlock& block : file.blocks) {
            anyMesh = anyMesh || block.mesh;
            anyUneven = anyUneven || !block.lattice.isEven();
            equalGrids = equalGrids && !block.mesh && !first.mesh && sameLattice(first.lattice, block.lattice);
        }
    const bool wantsEven = options.grid == GridChoice::Even || options.gridSize != glm::ivec3(0);
    if (equalGrids && (first.lattice.isEven() || !wantsEven)) {
        if (options.gridSize != glm::ivec3(0) && options.gridSize != first.lattice.size)
            notes.push_back("already on a grid of " + words(first.lattice.size) + ": the requested grid is not used");
        bounds = extentOf(first);
        return {first.lattice};
    }
    checkGrids(files);
    const Meshes meshes = meshesOf(files);
    ChosenGrid chosen;
    // What moves has other planes at each time; grids alone that differ are resampled evenly.
    if (wantsEven || meshes.moves || !(anyMesh || anyUneven))
        chosen.lattice = evenGridForMesh(meshes, options.gridSize);
    else
        chosen = planeGridForMesh(meshes, notes);
    const Lattice& grid = chosen.lattice;
    const Box& box = meshes.box;
    bounds = box;
    for (int axis = 0; axis < 3; ++axis) // an axis without extent gets one layer of samples, or the requested number
        if (!(box.size()[axis] > 0)) bounds.hi[axis] = grid.position(grid.size - 1)[axis];
    const auto cells = static_cast<long long>(meshes.cellsOfFirst);
    std::string note = anyMesh      ? "mesh of " + std::to_string(cells) + " cells"
                       : equalGrids ? "a grid with uneven spacing"
                                    : "several different grids";
    if (meshes.moves && !wantsEven) notes.emplace_back("a mesh that moves: at even distances, as many as cells");
    if (meshes.blocksOfFirst > 1) note += " in " + std::to_string(int(meshes.blocksOfFirst)) + " blocks";
    note += ", sampled on " + words(grid.size);
    if (chosen.onePerCell) note += ", one sample for each cell";
    notes.push_back(note);
    return chosen;
}

} // namespace tessera::volume
