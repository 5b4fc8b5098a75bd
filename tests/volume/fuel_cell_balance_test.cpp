// What enters the built-in fuel cell, is made in it and leaves it, summed anew from its fields.
#include "volume/synthetic/fuel_cell_properties.h"
#include "volume/synthetic/fuel_cell_solver.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numeric>

namespace tessera::volume {
namespace {

using cell::FuelCellSolver;
using cell::GasSpace;

/// Steady, with gas colder than the plates, so that both carry heat away.
const FuelCellSolver& withColdGas() {
    static const FuelCellSolver solver = [] {
        FuelCellSettings settings;
        settings.nx = 7, settings.ny = 13, settings.nz = 20;
        settings.inletTemperature = 323.15;
        settings.airStoichiometry = 6;
        FuelCellSolver made(settings);
        made.settle(0.55);
        return made;
    }();
    return solver;
}

double sumOf(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

TEST(FuelCellBalance, HeatLeavesThroughThePlatesAndWithTheGas) {
    const FuelCellSolver& s = withColdGas();
    const cell::CellGrid& g = s.grid();
    const auto at = [&](int x, int y, int z) { return s.temperature()[std::size_t(x + g.nx * (y + g.ny * z))]; };
    double plates = 0;
    for (int z = 0; z < g.nz; ++z)
        for (int x = 0; x < g.nx; ++x)
            for (const int y : {0, g.ny - 1}) {
                const CellRegion region = g.region(x, y);
                const double conductivity = region == CellRegion::Land           ? cell::kConductivityLand
                                            : region == CellRegion::AnodeChannel ? cell::kConductivityHydrogen
                                                                                 : cell::kConductivityAir;
                // Half a cell of the material, then the way into the coolant.
                const double resistance = 0.5 * g.height[std::size_t(y)] / conductivity + 1 / cell::kCoolantTransfer;
                plates += g.dx * g.dz * (at(x, y, z) - s.settings().coolantTemperature) / resistance;
            }
    // Each cell warms the gas that flows in.
    const double capacity =
        s.settings().outletPressure / (cell::kGas * s.settings().coolantTemperature) * cell::kGasHeatCapacity;
    double gas = 0;
    for (const GasSpace* space : {&s.fuel(), &s.air()})
        for (int z = 0; z < g.nz; ++z)
            for (int row = 0; row < space->rows; ++row)
                for (int x = 0; x < g.nx; ++x) {
                    const std::size_t section = std::size_t(x + g.nx * row),
                                      p = section + space->kind.size() * std::size_t(z);
                    const double own = at(x, row + space->yBegin, z);
                    const auto from = [&](double flux, double temperature) {
                        gas += capacity * std::max(flux, 0.0) * (own - temperature);
                    };
                    const int y = row + space->yBegin;
                    if (x > 0) from(space->fluxX[p - 1], at(x - 1, y, z));
                    if (x + 1 < g.nx) from(-space->fluxX[p], at(x + 1, y, z));
                    if (row > 0) from(space->fluxY[p - std::size_t(g.nx)], at(x, y - 1, z));
                    if (row + 1 < space->rows) from(-space->fluxY[p], at(x, y + 1, z));
                    if (z > 0) from(space->fluxZ[p - space->kind.size()], at(x, y, z - 1));
                    if (z + 1 < g.nz) from(-space->fluxZ[p], at(x, y, z + 1));
                    if (z == (space->air ? 0 : g.nz - 1)) from(space->inlet[section], s.settings().inletTemperature);
                }
    const double heat = s.totalCurrent() * (cell::kThermalVoltage - 0.55);
    EXPECT_NEAR((plates + gas) / heat, 1, 1e-3);
    EXPECT_GT(gas, 0.02 * heat);
    EXPECT_GT(plates, 0.2 * heat);
}

TEST(FuelCellBalance, BothHalvesAreAlike) {
    const FuelCellSolver& s = withColdGas();
    const cell::CellGrid& g = s.grid();
    double hottest = 0;
    for (std::size_t p = 0; p < s.temperature().size(); ++p) {
        const std::size_t x = p % std::size_t(g.nx);
        EXPECT_NEAR(s.temperature()[p], s.temperature()[p - x + std::size_t(g.nx) - 1 - x], 1e-3) << p;
        hottest = std::max(hottest, s.temperature()[p]);
    }
    EXPECT_GT(hottest, s.settings().coolantTemperature + 1);
}

// The catalysts give as many moles as react: of two H2 and one O2 come two H2O, all of them on the side of the air.
TEST(FuelCellBalance, TheReactionTakesThreeMolesAndGivesTwo) {
    const FuelCellSolver& s = withColdGas();
    const double charge = s.totalCurrent() / cell::kFaraday; // mol/s of electrons
    const double concentration = s.settings().outletPressure / (cell::kGas * s.settings().coolantTemperature);
    EXPECT_NEAR((sumOf(s.fuel().wall) + sumOf(s.air().wall)) * concentration / (-charge / 4), 1, 1e-3);
}

// Where more hydrogen is used than is fed, exhaust flows back in through the outlet; it brings water.
TEST(FuelCellBalance, WaterOfExhaustThatFlowsBackIsCounted) {
    FuelCellSettings settings;
    settings.nx = 5, settings.ny = 13, settings.nz = 16;
    settings.ratedCurrent = 1000;
    settings.hydrogenStoichiometry = 1.2;
    settings.airStoichiometry = 20;
    FuelCellSolver s(settings);
    s.settle(0.75);
    for (int step = 0; step < 4; ++step) {
        s.step(0.01, 0.5);
        const cell::Balance fuel = s.balance(0);
        EXPECT_NEAR(fuel.waterIn + fuel.waterReleased - fuel.waterOut - fuel.waterStored, 0, 0.01 * fuel.waterIn)
            << step;
    }
    EXPECT_LT(sumOf(s.fuel().outlet), 0);
}

} // namespace
} // namespace tessera::volume
