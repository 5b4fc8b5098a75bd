#include "app/importer/tables/point_table.h"
#include "volume/base/unit_conversion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <vtkDoubleArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkRectilinearGrid.h>
#include <vtkUnsignedCharArray.h>

namespace tessera::importer {

namespace {

/// Distinct values along an axis, in order.
struct Axis {
    std::vector<double> places;
    double first = 0, step = 1;
    bool even = true;

    explicit Axis(const std::vector<double>& column) {
        places = column;
        std::sort(places.begin(), places.end());
        const double slack = 1e-6 * (places.back() - places.front());
        places.erase(std::unique(places.begin(), places.end(), [&](double a, double b) { return b - a <= slack; }),
                     places.end());
        first = places.front();
        if (places.size() < 2) return;
        step = (places.back() - first) / double(places.size() - 1);
        for (std::size_t i = 0; i < places.size(); ++i)
            even = even && std::abs(places[i] - (first + step * double(i))) <= 0.01 * step;
    }
    std::size_t index(double place) const {
        const auto above = std::lower_bound(places.begin(), places.end(), place - 0.5e-6 * (places.back() - first));
        auto at = above == places.end() ? places.end() - 1 : above;
        if (at != places.begin() && std::abs(*(at - 1) - place) < std::abs(*at - place)) --at;
        return static_cast<std::size_t>(at - places.begin());
    }
};

/// Whether the rows traverse the grid in some order of axes and directions, but stop before its end.
bool stopsEarly(const std::vector<std::array<std::size_t, 3>>& nodes, const std::array<std::size_t, 3>& sizes) {
    std::array<int, 3> order{0, 1, 2};
    do {
        for (int flips = 0; flips < 8; ++flips) {
            bool inOrder = true;
            for (std::size_t row = 0; inOrder && row < nodes.size(); ++row) {
                std::size_t index = 0;
                for (int k = 2; k >= 0; --k) {
                    const auto axis = static_cast<std::size_t>(order[std::size_t(k)]);
                    const std::size_t at = nodes[row][axis];
                    index = index * sizes[axis] + ((flips >> axis & 1) != 0 ? sizes[axis] - 1 - at : at);
                }
                inOrder = index == row;
            }
            if (inOrder) return true;
        }
    } while (std::next_permutation(order.begin(), order.end()));
    return false;
}

PointTable inOrder(const PointTable& table, const std::vector<std::ptrdiff_t>& rowOf) {
    PointTable out{table.headings, {}, table.types, table.labels};
    for (const std::vector<double>& column : table.columns) {
        std::vector<double> values(rowOf.size(), 0);
        for (std::size_t i = 0; i < rowOf.size(); ++i)
            if (rowOf[i] >= 0) values[i] = column[std::size_t(rowOf[i])];
        out.columns.push_back(std::move(values));
    }
    return out;
}

/// Marks the samples that no row is for.
void markHoles(const std::vector<std::ptrdiff_t>& rowOf, vtkDataSetAttributes* points) {
    if (std::ranges::find(rowOf, -1) == rowOf.end()) return;
    vtkNew<vtkUnsignedCharArray> valid;
    valid->SetName("vtkValidPointMask");
    for (const std::ptrdiff_t row : rowOf) valid->InsertNextValue(row >= 0 ? 1 : 0);
    points->AddArray(valid);
}

vtkSmartPointer<vtkDataSet> image(const PointTable& table, const std::array<std::size_t, 3>& sizes,
                                  const std::array<double, 3>& origin, const std::array<double, 3>& step,
                                  const std::vector<std::ptrdiff_t>& rowOf, Source& source) {
    vtkNew<vtkImageData> grid;
    grid->SetDimensions(int(sizes[0]), int(sizes[1]), int(sizes[2]));
    grid->SetOrigin(origin.data());
    grid->SetSpacing(step.data());
    addColumns(inOrder(table, rowOf), grid->GetPointData(), source);
    markHoles(rowOf, grid->GetPointData());
    return grid;
}

/// The sizes of a grid over a box with about as many samples as there are points, and steps as equal as can be. An axis
/// thinner than a step gets two samples, and the others share out the points left: steps as small as its extent would
/// make millions of samples of a few points that are far apart.
std::array<std::size_t, 3> sizesFor(const std::array<double, 3>& extent, double points) {
    std::array<std::size_t, 3> sizes{1, 1, 1};
    std::vector<std::size_t> axes; // the thinnest last
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (extent[axis] > 0) axes.push_back(axis);
    std::ranges::sort(axes, std::ranges::greater(), [&](std::size_t axis) { return extent[axis]; });
    const auto steps = [&](std::size_t axis) { // by logarithms, since volumes may over- and underflow
        double volume = 0;
        for (const std::size_t each : axes) volume += std::log(extent[each]);
        return std::exp(std::log(extent[axis]) - (volume - std::log(points)) / double(axes.size()));
    };
    for (; axes.size() > 1 && steps(axes.back()) < 1; axes.pop_back()) {
        sizes[axes.back()] = 2;
        points = std::max(1.0, points / 2);
    }
    for (const std::size_t axis : axes)
        sizes[axis] = static_cast<std::size_t>(std::clamp(std::round(steps(axis)), 1.0, 1023.0)) + 1;
    return sizes;
}

vtkSmartPointer<vtkDataSet> scattered(const PointTable& table, const std::array<std::vector<double>, 3>& places,
                                      Source& source) {
    std::array<double, 3> lo{}, step{1, 1, 1};
    std::array<double, 3> extent{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto [least, most] = std::minmax_element(places[axis].begin(), places[axis].end());
        lo[axis] = *least;
        extent[axis] = *most - *least;
    }
    if (extent == std::array<double, 3>{}) throw std::runtime_error("holds a single point");
    const std::array<std::size_t, 3> sizes = sizesFor(extent, double(table.rows()));
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (sizes[axis] > 1) step[axis] = extent[axis] / double(sizes[axis] - 1);
    const auto numberOf = [&](const std::array<std::ptrdiff_t, 3>& at) {
        return (std::size_t(at[2]) * sizes[1] + std::size_t(at[1])) * sizes[0] + std::size_t(at[0]);
    };
    std::vector<std::vector<std::size_t>> near(sizes[0] * sizes[1] * sizes[2]); // rows by the sample nearest to them
    for (std::size_t row = 0; row < table.rows(); ++row) {
        std::array<std::ptrdiff_t, 3> at{};
        for (std::size_t axis = 0; axis < 3; ++axis)
            at[axis] = std::clamp<std::ptrdiff_t>(std::lround((places[axis][row] - lo[axis]) / step[axis]), 0,
                                                  std::ptrdiff_t(sizes[axis]) - 1);
        near[numberOf(at)].push_back(row);
    }
    std::vector<std::ptrdiff_t> rowOf;
    for (std::size_t k = 0; k < sizes[2]; ++k)
        for (std::size_t j = 0; j < sizes[1]; ++j)
            for (std::size_t i = 0; i < sizes[0]; ++i) {
                const std::array<std::size_t, 3> at{i, j, k};
                double closest = 1.5 * 1.5;
                std::ptrdiff_t best = -1;
                for (int n = 0; n < 125; ++n) {
                    const std::array<std::ptrdiff_t, 3> cell{std::ptrdiff_t(i) + n % 5 - 2,
                                                             std::ptrdiff_t(j) + n / 5 % 5 - 2,
                                                             std::ptrdiff_t(k) + n / 25 - 2};
                    bool inside = true;
                    for (std::size_t axis = 0; axis < 3; ++axis)
                        inside = inside && cell[axis] >= 0 && cell[axis] < std::ptrdiff_t(sizes[axis]);
                    if (!inside) continue;
                    for (const std::size_t row : near[numberOf(cell)]) {
                        double distance = 0;
                        for (std::size_t axis = 0; axis < 3; ++axis)
                            distance += std::pow((places[axis][row] - lo[axis]) / step[axis] - double(at[axis]), 2);
                        if (distance > closest || (distance == closest && best >= 0)) continue;
                        closest = distance;
                        best = static_cast<std::ptrdiff_t>(row);
                    }
                }
                rowOf.push_back(best);
            }
    source.notes.push_back("scattered points: each sample has the values of the nearest of " +
                           std::to_string(table.rows()) + " points, and is absent where none lies within 1.5 steps");
    return image(table, sizes, lo, step, rowOf, source);
}

/// The positions of the rows along an axis, in the unit `unit`, which is set if it is "".
std::vector<double> placesOf(const PointTable& table, int axis, std::string& unit) {
    const std::ptrdiff_t column = placeColumn(table.headings, axis);
    if (column < 0) return {};
    std::vector<double> places = table.columns[std::size_t(column)];
    const std::string& own = table.headings[std::size_t(column)].unit;
    if (unit.empty()) unit = own;
    if (own.empty() || own == unit) return places;
    const auto conversion = volume::unitConversion(own, unit);
    if (!conversion) throw std::runtime_error("has positions in " + unit + " and in " + own);
    for (double& place : places) place = (*conversion)(place);
    return places;
}

} // namespace

vtkSmartPointer<vtkDataSet> gridOfPoints(const PointTable& table, Source& source) {
    std::array<std::vector<double>, 3> places;
    std::string unit;
    int missing = 0;
    for (int axis = 0; axis < 3; ++axis) {
        places[std::size_t(axis)] = placesOf(table, axis, unit);
        if (!places[std::size_t(axis)].empty()) continue;
        ++missing;
        places[std::size_t(axis)].assign(table.rows(), 0);
    }
    if (missing > 1 || table.rows() == 0) throw std::runtime_error("has no columns x and y with positions");
    if (!unit.empty()) source.lengthUnit = volume::lengthUnitNamed(unit).empty() ? unit : volume::lengthUnitNamed(unit);
    for (const std::vector<double>& column : places)
        for (const double value : column)
            if (!std::isfinite(value)) throw std::runtime_error("has a position that is not a number");
    const std::array<Axis, 3> axes{Axis(places[0]), Axis(places[1]), Axis(places[2])};
    std::array<std::size_t, 3> sizes{};
    double product = 1;
    bool even = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        sizes[axis] = axes[axis].places.size();
        product *= double(sizes[axis]);
        even = even && axes[axis].even;
    }
    const double rows = double(table.rows());
    if (product > 5 * rows) return scattered(table, places, source);
    std::vector<std::ptrdiff_t> rowOf(static_cast<std::size_t>(product), -1);
    std::vector<std::array<std::size_t, 3>> nodes;
    for (std::size_t row = 0; row < table.rows(); ++row) {
        nodes.push_back({axes[0].index(places[0][row]), axes[1].index(places[1][row]), axes[2].index(places[2][row])});
        const std::size_t at = (nodes[row][2] * sizes[1] + nodes[row][1]) * sizes[0] + nodes[row][0];
        if (rowOf[at] >= 0)
            throw std::runtime_error("has the same position in rows " + std::to_string(rowOf[at] + 1) + " and " +
                                     std::to_string(row + 1));
        rowOf[at] = static_cast<std::ptrdiff_t>(row);
    }
    if (product > rows && stopsEarly(nodes, sizes))
        throw std::runtime_error("holds " + std::to_string(table.rows()) + " of the " + std::to_string(rowOf.size()) +
                                 " points of its grid, in order: truncated");
    if (even)
        return image(table, sizes, {axes[0].first, axes[1].first, axes[2].first},
                     {axes[0].step, axes[1].step, axes[2].step}, rowOf, source);
    vtkNew<vtkRectilinearGrid> grid;
    grid->SetDimensions(int(sizes[0]), int(sizes[1]), int(sizes[2]));
    const auto coordinates = [](const Axis& axis) {
        auto array = vtkSmartPointer<vtkDoubleArray>::New();
        for (const double place : axis.places) array->InsertNextValue(place);
        return array;
    };
    grid->SetXCoordinates(coordinates(axes[0]));
    grid->SetYCoordinates(coordinates(axes[1]));
    grid->SetZCoordinates(coordinates(axes[2]));
    addColumns(inOrder(table, rowOf), grid->GetPointData(), source);
    markHoles(rowOf, grid->GetPointData());
    return grid;
}

} // namespace tessera::importer
