#include "volume/synthetic/fuel_cell_solver.h"

#include "volume/synthetic/fuel_cell_properties.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tessera::volume::cell {

namespace {

// Divides n cells into layers of these thicknesses, each at least one cell. Returns the first cell of each layer, then
// n.
template <std::size_t N> std::array<int, N + 1> cut(int n, const std::array<double, N>& thickness) {
    const double total = std::accumulate(thickness.begin(), thickness.end(), 0.0);
    std::array<int, N + 1> begin{};
    double sum = 0;
    for (std::size_t layer = 0; layer < N; ++layer) {
        sum += thickness[layer];
        begin[layer + 1] = int(std::lround(n * sum / total));
    }
    for (std::size_t layer = 1; layer <= N; ++layer) begin[layer] = std::max(begin[layer], begin[layer - 1] + 1);
    begin[N] = n;
    for (std::size_t layer = N; layer-- > 1;) begin[layer] = std::min(begin[layer], begin[layer + 1] - 1);
    return begin;
}

} // namespace

CellGrid::CellGrid(int cellsX, int cellsY, int cellsZ)
    : nx(cellsX), ny(cellsY), nz(cellsZ), dx((2 * kLandWidth + kChannelWidth) / cellsX),
      dy((2 * kChannelHeight + 2 * kGdlThickness + kMeaThickness) / cellsY), dz(kLength / cellsZ) {
    const auto columns = cut<3>(nx, {kLandWidth, kChannelWidth, kLandWidth});
    channelBegin = columns[1], channelEnd = columns[2];
    rows = cut<5>(ny, {kChannelHeight, kGdlThickness, kMeaThickness, kGdlThickness, kChannelHeight});
}

CellRegion CellGrid::region(int x, int y) const {
    int layer = 0;
    while (layer < 4 && y >= rows[std::size_t(layer + 1)]) ++layer;
    const bool channel = x >= channelBegin && x < channelEnd;
    if ((layer == 0 || layer == 4) && !channel) return CellRegion::Land;
    return CellRegion(layer + 1);
}

double GasSpace::divergence(const CellGrid& g, int x, int row, int z) const {
    const std::size_t section = std::size_t(x + g.nx * row), plane = std::size_t(g.nx * rows);
    const std::size_t p = section + plane * std::size_t(z);
    double sum = fluxX[p] + fluxY[p] + fluxZ[p];
    if (x > 0) sum -= fluxX[p - 1];
    if (row > 0) sum -= fluxY[p - std::size_t(g.nx)];
    if (z > 0) sum -= fluxZ[p - plane];
    if (z == (air ? 0 : g.nz - 1)) sum -= inlet[section];
    if (z == (air ? g.nz - 1 : 0)) sum += outlet[section];
    if (row == wallRow()) sum -= wall[std::size_t(x + g.nx * z)];
    return sum;
}

std::array<double, 3> GasSpace::velocity(const CellGrid& g, int x, int row, int z) const {
    const std::size_t section = std::size_t(x + g.nx * row), plane = std::size_t(g.nx * rows);
    const std::size_t p = section + plane * std::size_t(z);
    const double flow = air ? 1 : -1;
    const bool atInlet = z == (air ? 0 : g.nz - 1), atOutlet = z == (air ? g.nz - 1 : 0);
    const double ends = (atInlet ? flow * inlet[section] : 0.0) + (atOutlet ? flow * outlet[section] : 0.0);
    const double fromWall = row == wallRow() ? (air ? 1 : -1) * wall[std::size_t(x + g.nx * z)] : 0.0;
    return {0.5 * (fluxX[p] + (x > 0 ? fluxX[p - 1] : 0.0)) / (g.dy * g.dz),
            0.5 * (fluxY[p] + (row > 0 ? fluxY[p - std::size_t(g.nx)] : 0.0) + fromWall) / (g.dx * g.dz),
            0.5 * (fluxZ[p] + (z > 0 ? fluxZ[p - plane] : 0.0) + ends) / (g.dx * g.dy)};
}

} // namespace tessera::volume::cell
