#include "volume/synthetic/fuel_cell_solver.h"

#include "volume/synthetic/fuel_cell_properties.h"

#include <algorithm>
#include <cmath>

namespace tessera::volume::cell {

namespace {

struct Material {
    double inPlane, through, capacity;
};

Material materialOf(CellRegion region, double gasCapacity) {
    switch (region) {
    case CellRegion::Land:
        return {kConductivityLand, kConductivityLand, kHeatCapacityLand};
    case CellRegion::AnodeChannel:
        return {kConductivityHydrogen, kConductivityHydrogen, gasCapacity};
    case CellRegion::CathodeChannel:
        return {kConductivityAir, kConductivityAir, gasCapacity};
    case CellRegion::Membrane:
        return {kConductivityMembrane, kConductivityMembrane, kHeatCapacityMembrane};
    case CellRegion::AnodeCatalyst:
    case CellRegion::CathodeCatalyst:
        return {kConductivityCatalyst, kConductivityCatalyst, kHeatCapacityCatalyst};
    default:
        return {kConductivityGdlInPlane, kConductivityGdl, kHeatCapacityGdl};
    }
}

} // namespace

void FuelCellSolver::carryHeat(const GasSpace& space, double gasCapacity) {
    const CellGrid& g = grid_;
    StencilSystem& a = heat_;
    const std::size_t row = std::size_t(g.nx), plane = a.plane();
    const std::size_t section = row * std::size_t(space.rows), shift = row * std::size_t(space.yBegin);
    for (int z = 0; z < g.nz; ++z)
        for (std::size_t s = 0; s < section; ++s) {
            if (space.kind[s] == 0) continue;
            const std::size_t q = s + section * std::size_t(z), p = s + shift + plane * std::size_t(z);
            const auto carry = [&](double flux, std::vector<double>& next, std::vector<double>& back,
                                   std::size_t step) {
                const double heat = gasCapacity * std::abs(flux);
                if (flux > 0)
                    a.diag[p + step] += heat, back[p + step] += heat;
                else
                    a.diag[p] += heat, next[p] += heat;
            };
            if (s % row + 1 < row) carry(space.fluxX[q], a.east, a.west, 1);
            if (s + row < section) carry(space.fluxY[q], a.north, a.south, row);
            if (z + 1 < g.nz) carry(space.fluxZ[q], a.up, a.down, plane);
            if (z == (space.air ? 0 : g.nz - 1)) {
                a.diag[p] += gasCapacity * space.inlet[s];
                a.rhs[p] += gasCapacity * space.inlet[s] * settings_.inletTemperature;
            }
        }
}

std::array<double, 2> FuelCellSolver::heatOf(std::size_t column, double voltage) const {
    const double current = current_[column], all = current * (kThermalVoltage - voltage);
    if (grid_.rows[4] == grid_.rows[5]) return {all, 0}; // no catalyst layer of its own
    const double ohmic = std::min(current * current * (resistance_[column] - kContactResistance), all);
    return {ohmic, all - ohmic};
}

void FuelCellSolver::solveHeat(double voltage, double rate, const std::vector<double>& before, bool refresh) {
    const CellGrid& g = grid_;
    StencilSystem& a = heat_;
    const std::size_t row = std::size_t(g.nx), plane = a.plane();
    const double gasCapacity = concentration_ * kGasHeatCapacity;
    std::vector<Material> materials(plane);
    for (std::size_t s = 0; s < plane; ++s)
        materials[s] = materialOf(grid_.region(int(s % row), int(s / row)), gasCapacity);

    a.clear();
    for (int z = 0; z < g.nz; ++z)
        for (std::size_t s = 0; s < plane; ++s) {
            const std::size_t p = s + plane * std::size_t(z);
            const Material& m = materials[s];
            const double dy = g.height[s / row];
            const double storage = m.capacity * g.dx * dy * g.dz * rate;
            a.diag[p] += storage;
            a.rhs[p] += storage * before[p];
            const auto link = [&](std::vector<double>& next, std::vector<double>& back, std::size_t step, double k) {
                a.diag[p] += k, a.diag[p + step] += k;
                next[p] += k, back[p + step] += k;
            };
            if (s % row + 1 < row)
                link(a.east, a.west, 1, series(m.inPlane, materials[s + 1].inPlane) * dy * g.dz / g.dx);
            if (s + row < plane)
                link(a.north, a.south, row,
                     series(m.through / dy, materials[s + row].through / g.height[s / row + 1]) * g.dx * g.dz);
            if (z + 1 < g.nz) link(a.up, a.down, plane, m.inPlane * g.dx * dy / g.dz);
            // Cooled plates behind the lands (and behind the floor of the channels).
            if (s < row || s + row >= plane) {
                const double k = g.dx * g.dz / (1 / kCoolantTransfer + 0.5 * dy / m.through);
                a.diag[p] += k;
                a.rhs[p] += k * settings_.coolantTemperature;
            }
        }

    for (const GasSpace& space : spaces_) carryHeat(space, gasCapacity);

    for (int z = 0; z < g.nz; ++z)
        for (int x = 0; x < g.nx; ++x) {
            const std::array<double, 2> heat = heatOf(std::size_t(x + g.nx * z), voltage);
            for (const std::size_t layer : {0u, 1u}) {
                const int begin = g.rows[3 + layer], end = g.rows[4 + layer];
                for (int y = begin; y < end; ++y) a.rhs[a.index(x, y, z)] += heat[layer] * g.dx * g.dz / (end - begin);
            }
        }
    // The largest factorisation. The flow changes it little, so it is only computed again for another time step.
    if (refresh || heatPreconditioner_.empty()) heatPreconditioner_ = PlanePreconditioner(a);
    solve(a, heatPreconditioner_, temperature_, 3e-8);
}

} // namespace tessera::volume::cell
