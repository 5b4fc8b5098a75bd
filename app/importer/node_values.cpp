#include "app/importer/node_values.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <vtkIdList.h>
#include <vtkNew.h>

namespace tessera::importer {

namespace {

constexpr std::size_t kMostAround = 64; // cells around a point that tell of a slope, of more some

/// Cells with a value around each point: those of point p are cells[first[p] .. first[p + 1]).
struct CellsOfPoints {
    std::vector<std::size_t> first;
    std::vector<std::int32_t> cells;
};

/// A cell's value and middle, and what its neighbours say of its slope.
struct SlopedCell {
    double value = std::numeric_limits<double>::quiet_NaN();
    glm::dvec3 middle{0};
    glm::dmat3 ways{0}; ///< sum of w d d^T over neighbours at distance d, w = 1 / d^2
    glm::dvec3 rise{0}; ///< sum of w d times the difference; afterwards the slope
    double lo = 0, hi = 0;

    void add(const SlopedCell& other) {
        const glm::dvec3 d = other.middle - middle;
        const double squared = glm::dot(d, d);
        if (!(squared > 0)) return;
        for (int column = 0; column < 3; ++column) ways[column] += d * (d[column] / squared);
        rise += d * ((other.value - value) / squared);
        lo = std::min(lo, other.value);
        hi = std::max(hi, other.value);
    }
    /// Solves for the slope; directions in which no neighbour lies have none.
    void solve() {
        constexpr double kRegular = 1e-10;
        const double trace = ways[0][0] + ways[1][1] + ways[2][2];
        if (!(trace > 0)) {
            rise = glm::dvec3(0);
            return;
        }
        for (int axis = 0; axis < 3; ++axis) ways[axis][axis] += kRegular * trace;
        rise = glm::inverse(ways) * rise;
        for (int axis = 0; axis < 3; ++axis)
            if (!std::isfinite(rise[axis])) rise = glm::dvec3(0);
    }
};

std::vector<SlopedCell> cellsOf(vtkDataSet* mesh, vtkDataArray* values, int component, CellsOfPoints& around) {
    std::vector<SlopedCell> out(std::size_t(mesh->GetNumberOfCells()));
    vtkNew<vtkIdList> points;
    const auto pointCount = std::size_t(mesh->GetNumberOfPoints());
    around.first.assign(pointCount + 1, 0);
    const auto eachPoint = [&](std::size_t c, const auto& visit) {
        mesh->GetCellPoints(vtkIdType(c), points);
        for (vtkIdType i = 0; i < points->GetNumberOfIds(); ++i)
            if (const auto p = std::size_t(points->GetId(i)); p < pointCount) visit(p);
    };
    for (std::size_t c = 0; c < out.size(); ++c) {
        SlopedCell& cell = out[c];
        cell.value = cell.lo = cell.hi = values->GetComponent(vtkIdType(c), component);
        if (std::isnan(cell.value)) continue;
        double count = 0;
        eachPoint(c, [&](std::size_t p) {
            double place[3];
            mesh->GetPoint(vtkIdType(p), place);
            cell.middle += glm::dvec3(place[0], place[1], place[2]);
            ++count;
            ++around.first[p + 1];
        });
        cell.middle /= std::max(count, 1.0);
    }
    for (std::size_t p = 0; p < pointCount; ++p) around.first[p + 1] += around.first[p];
    around.cells.resize(around.first.back());
    std::vector<std::size_t> next(around.first.begin(), around.first.end() - 1);
    for (std::size_t c = 0; c < out.size(); ++c)
        if (!std::isnan(out[c].value))
            eachPoint(c, [&](std::size_t p) { around.cells[next[p]++] = static_cast<std::int32_t>(c); });
    return out;
}

} // namespace

std::vector<double> nodeValues(vtkDataSet* mesh, vtkDataArray* values, int component) {
    CellsOfPoints around;
    std::vector<SlopedCell> cells = cellsOf(mesh, values, component, around);
    const auto cellsAt = [&](std::size_t p, const auto& visit) {
        for (std::size_t i = around.first[p]; i < around.first[p + 1]; ++i) visit(cells[std::size_t(around.cells[i])]);
    };
    const std::size_t points = around.first.size() - 1;
    for (std::size_t p = 0; p < points; ++p) {
        const std::size_t first = around.first[p], count = around.first[p + 1] - first;
        const std::size_t step = std::max<std::size_t>(count / kMostAround, 1);
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t k = step; k < count; k += step)
                cells[std::size_t(around.cells[first + i])].add(
                    cells[std::size_t(around.cells[first + (i + k) % count])]);
    }
    double least = std::numeric_limits<double>::max();
    for (SlopedCell& cell : cells) {
        if (std::isnan(cell.value)) continue;
        cell.solve();
        least = std::min(least, cell.value);
    }
    std::vector<double> out(points, std::numeric_limits<double>::quiet_NaN());
    for (std::size_t p = 0; p < points; ++p) {
        double sum = 0, count = 0, place[3];
        mesh->GetPoint(vtkIdType(p), place);
        cellsAt(p, [&](const SlopedCell& cell) {
            const double range = cell.hi - cell.lo;
            const double said =
                cell.value + glm::dot(cell.rise, glm::dvec3(place[0], place[1], place[2]) - cell.middle);
            sum += std::clamp(said, std::min(cell.lo - range, cell.value), std::max(cell.hi + range, cell.value));
            ++count;
        });
        if (count > 0) out[p] = least >= 0 ? std::max(sum / count, 0.0) : sum / count;
    }
    return out;
}

} // namespace tessera::importer
