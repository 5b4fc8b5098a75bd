#include "app/importer/sampler.h"

#include "app/importer/node_values.h"
#include "app/importer/present.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vtkCell.h>
#include <vtkCellType.h>
#include <vtkGenericCell.h>
#include <vtkNew.h>
#include <vtkPoints.h>

namespace tessera::importer {

namespace {

// Directions that no mesh is aligned with.
constexpr double kAside[3] = {0.31e-5, 0.47e-5, 0.59e-5};
constexpr double kSlack = 3e-5; // cells, more than kAside

/// A place in space as cells of a lattice along an axis, and back.
double cellsAt(const volume::Lattice& lattice, int axis, double place) {
    return (lattice.axes.toSheet(axis, place) - lattice.origin[axis]) / lattice.spacing[axis];
}
double placeAt(const volume::Lattice& lattice, int axis, double cells) {
    return lattice.axes.toSpace(axis, lattice.origin[axis] + lattice.spacing[axis] * cells);
}

/// A coordinate within a cell; that of a border or the middle where the sample lies there, as it was looked up beside
/// it (kAside).
double asMeant(double pcoord) {
    const double meant = std::round(2 * pcoord) / 2;
    return std::abs(pcoord - meant) < kSlack ? meant : pcoord;
}

/// Weights of the corners of a cell at a place in its own coordinates. Those of a polyhedron and a polygon are by
/// InterpolateFunctions only at places of space.
void weightsAt(vtkGenericCell* cell, const double pcoords[3], double* weights) {
    const int type = cell->GetCellType();
    if (type != VTK_POLYHEDRON && type != VTK_POLYGON) {
        cell->InterpolateFunctions(pcoords, weights);
        return;
    }
    int part = 0;
    double place[3];
    cell->EvaluateLocation(part, pcoords, place, weights);
}

} // namespace

std::shared_ptr<const Sampling> makeSampling(vtkDataSet* mesh, const volume::Lattice& lattice,
                                             const volume::Box& border) {
    auto sampling = std::make_shared<Sampling>();
    sampling->lattice = lattice;
    sampling->cells.assign(lattice.count(), -1);
    sampling->pcoords.assign(lattice.count() * 3, 0.0f);
    if (mesh->GetNumberOfCells() > 0x7fffffff) throw std::runtime_error("has more than 2^31 cells");
    vtkNew<vtkGenericCell> cell;
    std::vector<double> weights(64);
    const double* box = mesh->GetBounds();
    double largest = 0;
    for (int axis = 0; axis < 3; ++axis) largest = std::max(largest, box[2 * axis + 1] - box[2 * axis]);
    const std::vector<std::uint8_t> present = presentCells(mesh);
    std::vector<double> lookedUp[3]; // where samples are looked up along each axis
    for (int axis = 0; axis < 3; ++axis)
        for (int i = 0; i < lattice.size[axis]; ++i) {
            const double place = placeAt(lattice, axis, i);
            const bool last = i == lattice.size[axis] - 1 && lattice.size[axis] > 1 &&
                              std::abs(place - border.hi[axis]) < 1e-3 * (place - placeAt(lattice, axis, i - 1));
            const bool flat = !(box[2 * axis + 1] - box[2 * axis] > 1e-9 * largest);
            lookedUp[axis].push_back(placeAt(lattice, axis, i + (flat ? 0 : last ? -1 : 1) * kAside[axis]));
        }
    for (vtkIdType c = 0; c < mesh->GetNumberOfCells(); ++c) {
        if (!volume::isPresent(present, std::size_t(c))) continue;
        double bounds[6];
        mesh->GetCellBounds(c, bounds);
        int begin[3], end[3];
        bool any = true;
        for (int axis = 0; axis < 3; ++axis) {
            const bool flat = !(box[2 * axis + 1] - box[2 * axis] > 1e-9 * largest);
            if (flat) {
                begin[axis] = 0;
                end[axis] = lattice.size[axis];
                continue;
            }
            const double lo = cellsAt(lattice, axis, bounds[2 * axis]);
            const double hi = cellsAt(lattice, axis, bounds[2 * axis + 1]);
            const double size = lattice.size[axis];
            begin[axis] = static_cast<int>(std::clamp(std::ceil(lo - kSlack), 0.0, size));
            end[axis] = static_cast<int>(std::clamp(std::floor(hi + kSlack) + 1, 0.0, size));
            any = any && begin[axis] < end[axis];
        }
        if (!any) continue;
        mesh->GetCell(c, cell);
        const auto points = static_cast<std::size_t>(cell->GetNumberOfPoints());
        if (weights.size() < points) weights.resize(points);
        for (int k = begin[2]; k < end[2]; ++k)
            for (int j = begin[1]; j < end[1]; ++j)
                for (int i = begin[0]; i < end[0]; ++i) {
                    const std::size_t at = lattice.index({i, j, k});
                    if (sampling->cells[at] >= 0) continue;
                    const int index[3] = {i, j, k};
                    double x[3], closest[3], pcoords[3], distance2 = 0;
                    for (int axis = 0; axis < 3; ++axis) x[axis] = lookedUp[axis][std::size_t(index[axis])];
                    int subId = 0;
                    const int inside = cell->EvaluatePosition(x, closest, subId, pcoords, distance2, weights.data());
                    if (inside != 1 || (cell->GetCellDimension() < 3 && !(distance2 <= 1e-18 * largest * largest)))
                        continue;
                    sampling->cells[at] = static_cast<std::int32_t>(c);
                    for (std::size_t axis = 0; axis < 3; ++axis)
                        sampling->pcoords[at * 3 + axis] = static_cast<float>(asMeant(pcoords[axis]));
                }
    }
    return sampling;
}

void sampleArray(vtkDataSet* mesh, const Sampling& sampling, vtkDataArray* array, bool ofCells, int component,
                 volume::ScalarType type, void* out, std::vector<std::uint8_t>& mask) {
    vtkNew<vtkGenericCell> cell;
    std::vector<double> weights(64);
    std::int32_t loaded = -1;
    volume::dispatch(type, [&]<class T>(T) {
        T* values = static_cast<T*>(out);
        for (std::size_t at = 0; at < sampling.cells.size(); ++at) {
            const std::int32_t c = sampling.cells[at];
            values[at] = T{};
            if (c < 0) continue;
            if (ofCells) {
                const double value = array->GetComponent(c, component);
                if (std::isnan(value))
                    mask[at] = 0;
                else
                    values[at] = static_cast<T>(value);
                continue;
            }
            if (c != loaded) mesh->GetCell(loaded = c, cell);
            const auto points = static_cast<std::size_t>(cell->GetNumberOfPoints());
            if (weights.size() < points) weights.resize(points);
            const double pcoords[3] = {sampling.pcoords[at * 3], sampling.pcoords[at * 3 + 1],
                                       sampling.pcoords[at * 3 + 2]};
            weightsAt(cell, pcoords, weights.data());
            const auto corner = [&](std::size_t p) { return array->GetComponent(cell->GetPointId(int(p)), component); };
            const auto nearest = std::max_element(weights.begin(), weights.begin() + std::ptrdiff_t(points));
            const double own = corner(std::size_t(nearest - weights.begin()));
            if (std::isnan(own)) {
                mask[at] = 0;
                continue;
            }
            if constexpr (std::is_floating_point_v<T>) {
                double sum = 0, missing = 0;
                for (std::size_t p = 0; p < points; ++p) {
                    const double value = corner(p);
                    if (std::isnan(value))
                        missing += weights[p];
                    else
                        sum += weights[p] * value;
                }
                values[at] = static_cast<T>(missing != 0 ? sum / (1 - missing) : sum);
            } else {
                values[at] = static_cast<T>(own);
            }
        }
    });
}

namespace {

/// Whether a sample lies in the middle of its cell. One there was looked up slightly beside it (kAside).
bool isInMiddle(const double pcoords[3], const double middle[3]) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(std::abs(pcoords[axis] - middle[axis]) < kSlack)) return false;
    return true;
}

} // namespace

void sampleCells(vtkDataSet* mesh, const Sampling& sampling, vtkDataArray* cells, int component, float* out,
                 std::vector<std::uint8_t>& mask) {
    std::vector<double> smoothed; // at points, once a sample needs them
    const auto atPoint = [&](vtkIdType p) { return std::size_t(p) < smoothed.size() ? smoothed[std::size_t(p)] : 0; };
    vtkNew<vtkGenericCell> cell;
    std::vector<double> weights(64);
    std::int32_t loaded = -1;
    bool isSloped = false;
    double own = 0, atMiddle = 0, least = 0, most = 0, middle[3] = {};
    std::size_t points = 0;
    const auto interpolated = [&](const double pcoords[3]) {
        weightsAt(cell, pcoords, weights.data());
        double sum = 0;
        for (std::size_t p = 0; p < points; ++p) sum += weights[p] * atPoint(cell->GetPointId(int(p)));
        return sum;
    };
    for (std::size_t at = 0; at < sampling.cells.size(); ++at) {
        const std::int32_t c = sampling.cells[at];
        out[at] = 0;
        if (c < 0) continue;
        if (c != loaded) {
            mesh->GetCell(loaded = c, cell);
            cell->GetParametricCenter(middle);
            points = static_cast<std::size_t>(cell->GetNumberOfPoints());
            if (weights.size() < points) weights.resize(points);
            own = cells->GetComponent(c, component);
            isSloped = false;
        }
        if (std::isnan(own)) {
            mask[at] = 0;
            continue;
        }
        out[at] = static_cast<float>(own);
        const double pcoords[3] = {sampling.pcoords[at * 3], sampling.pcoords[at * 3 + 1],
                                   sampling.pcoords[at * 3 + 2]};
        if (isInMiddle(pcoords, middle)) continue;
        if (smoothed.empty()) smoothed = nodeValues(mesh, cells, component);
        if (!isSloped) {
            isSloped = true;
            least = most = own;
            for (std::size_t p = 0; p < points; ++p) {
                const double value = atPoint(cell->GetPointId(int(p)));
                least = std::min(least, value);
                most = std::max(most, value);
            }
            atMiddle = interpolated(middle);
        }
        const double value = own + interpolated(pcoords) - atMiddle;
        out[at] = static_cast<float>(std::clamp(value, least, most));
    }
}

} // namespace tessera::importer
