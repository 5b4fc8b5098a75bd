#include "volume/synthetic/fuel_cell_solver.h"

#include "volume/base/error.h"
#include "volume/synthetic/fuel_cell_properties.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tessera::volume::cell {

namespace {

// Divides n cells into layers by these weights, each at least one cell. Returns the first cell of each layer, then
// n.
template <std::size_t N> std::array<int, N + 1> cut(int n, const std::array<double, N>& weight) {
    const double total = std::accumulate(weight.begin(), weight.end(), 0.0);
    std::array<int, N + 1> begin{};
    double sum = 0;
    for (std::size_t layer = 0; layer < N; ++layer) {
        sum += weight[layer];
        begin[layer + 1] = int(std::lround(n * sum / total));
    }
    for (std::size_t layer = 1; layer <= N; ++layer) begin[layer] = std::max(begin[layer], begin[layer - 1] + 1);
    begin[N] = n;
    for (std::size_t layer = N; layer-- > 1;) begin[layer] = std::min(begin[layer], begin[layer + 1] - 1);
    return begin;
}

} // namespace

CellGrid::CellGrid(const FuelCellSettings& settings)
    : nx(settings.nx), ny(settings.ny), nz(settings.nz), dx((2 * kLandWidth + kChannelWidth) / nx), dz(kLength / nz) {
    const auto columns = cut<3>(nx, {kLandWidth, kChannelWidth, kLandWidth});
    channelBegin = columns[1], channelEnd = columns[2];
    if (settings.even) {
        const auto at = cut<5>(ny, {kChannelHeight, kGdlThickness, kMeaThickness, kGdlThickness, kChannelHeight});
        rows = {at[0], at[1], at[2], at[2], at[3], at[3], at[4], at[5]};
        height.assign(std::size_t(ny), (2 * kChannelHeight + 2 * kGdlThickness + kMeaThickness) / ny);
        return;
    }
    constexpr std::array<double, 7> kRows{3, 2, 1, 1, 1, 2, 3}; // of 13
    constexpr std::array<double, 7> kThickness{kChannelHeight,     kGdlThickness,      kCatalystThickness,
                                               kMembraneThickness, kCatalystThickness, kGdlThickness,
                                               kChannelHeight};
    if (ny < int(kRows.size()))
        throw Error(std::to_string(ny) + " rows are too few for " + std::to_string(kRows.size()) +
                        " layers; without layers of their own thickness (even=1) there may be fewer",
                    "fuel-cell", "ny");
    rows = cut<7>(ny, kRows);
    for (std::size_t layer = 0; layer < kRows.size(); ++layer) {
        const int number = rows[layer + 1] - rows[layer];
        height.insert(height.end(), std::size_t(number), kThickness[layer] / number);
    }
}

CellRegion CellGrid::region(int x, int y) const {
    constexpr std::array<CellRegion, 7> kLayers{
        CellRegion::AnodeChannel,    CellRegion::AnodeGdl,   CellRegion::AnodeCatalyst, CellRegion::Membrane,
        CellRegion::CathodeCatalyst, CellRegion::CathodeGdl, CellRegion::CathodeChannel};
    std::size_t layer = 0;
    while (layer + 1 < kLayers.size() && y >= rows[layer + 1]) ++layer;
    const bool channel = x >= channelBegin && x < channelEnd;
    if ((layer == 0 || layer + 1 == kLayers.size()) && !channel) return CellRegion::Land;
    return kLayers[layer];
}

std::vector<double> CellGrid::planes() const {
    std::vector<double> planes{0};
    for (const double row : height) planes.push_back(planes.back() + row);
    return planes;
}

std::vector<double> CellGrid::middles() const {
    std::vector<double> middles = planes();
    middles.pop_back();
    for (std::size_t row = 0; row < height.size(); ++row) middles[row] += 0.5 * height[row];
    return middles;
}

double GasSpace::gasVolume(const CellGrid& g, std::size_t section) const {
    constexpr std::array<double, 4> kPorosities{0, 1, kPorosity, kCatalystPorosity};
    return kPorosities[kind[section]] * g.dx * g.height[std::size_t(yBegin) + section / std::size_t(g.nx)] * g.dz;
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
    const double dy = g.height[std::size_t(yBegin + row)];
    const double fromWall = row == wallRow() ? (air ? 1 : -1) * wall[std::size_t(x + g.nx * z)] : 0.0;
    return {0.5 * (fluxX[p] + (x > 0 ? fluxX[p - 1] : 0.0)) / (dy * g.dz),
            0.5 * (fluxY[p] + (row > 0 ? fluxY[p - std::size_t(g.nx)] : 0.0) + fromWall) / (g.dx * g.dz),
            0.5 * (fluxZ[p] + (z > 0 ? fluxZ[p - plane] : 0.0) + ends) / (g.dx * dy)};
}

} // namespace tessera::volume::cell
