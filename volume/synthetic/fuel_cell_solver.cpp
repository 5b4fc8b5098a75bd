#include "volume/synthetic/fuel_cell_solver.h"

#include "volume/base/parallel.h"
#include "volume/synthetic/fuel_cell_properties.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tessera::volume::cell {

FuelCellSolver::FuelCellSolver(const FuelCellSettings& settings)
    : settings_(settings), grid_(settings),
      concentration_(settings.outletPressure / (kGas * settings.coolantTemperature)) {
    const std::size_t columns = std::size_t(grid_.nx * grid_.nz);
    heat_ = StencilSystem(grid_.nx, grid_.ny, grid_.nz);
    temperature_.assign(heat_.count(), settings.coolantTemperature);
    current_.assign(columns, 0.0);
    currentSlope_.assign(columns, 0.0);
    resistance_.assign(columns, kContactResistance);
    waterFlux_.assign(columns, 0.0);
    for (int space : {0, 1}) setUpSpace(space);
}

void FuelCellSolver::updateCurrent(double voltage) {
    const CellGrid& g = grid_;
    const GasSpace &fuel = spaces_[0], &air = spaces_[1];
    const auto half = [&](const GasSpace& space, bool water) { // m/s from the cell next to the catalyst to it
        const double distance = 0.5 * g.height[std::size_t(space.yBegin + space.wallRow())];
        return diffusion(space, water, std::size_t(g.nx * space.wallRow()), false) / distance;
    };
    const double oxygenHalf = half(air, false), airWaterHalf = half(air, true), fuelWaterHalf = half(fuel, true);
    parallelFor(
        std::size_t(g.nz),
        [&](std::size_t z) {
            for (int x = 0; x < g.nx; ++x) {
                const std::size_t column = std::size_t(x) + std::size_t(g.nx) * z;
                const auto nextTo = [&](const GasSpace& space) {
                    return std::size_t(x + g.nx * space.wallRow()) + std::size_t(g.nx * space.rows) * z;
                };
                double mea = 0;
                for (int y = g.rows[3]; y < g.rows[4]; ++y) mea += temperature_[heat_.index(x, y, int(z))];
                mea /= g.rows[4] - g.rows[3];

                // Water content of the membrane from the activities at the catalysts on either side.
                const double saturated = saturationPressure(mea) / (kGas * mea); // mol/m3
                const double i0 = current_[column], flux0 = waterFlux_[column];
                const double activityAir =
                    (air.water[nextTo(air)] + (i0 / (2 * kFaraday) + flux0) / airWaterHalf) / saturated;
                const double activityFuel = (fuel.water[nextTo(fuel)] - flux0 / fuelWaterHalf) / saturated;
                const double contentAir = waterContent(activityAir), contentFuel = waterContent(activityFuel);
                const double content = 0.5 * (contentAir + contentFuel);
                resistance_[column] = kContactResistance + kMembraneThickness / protonConductivity(content, mea);

                current_[column] = localCurrent(voltage, mea, fuel.reactant[nextTo(fuel)], air.reactant[nextTo(air)],
                                                oxygenHalf, resistance_[column]);
                currentSlope_[column] = localCurrentSlope(current_[column], mea, air.reactant[nextTo(air)], oxygenHalf,
                                                          resistance_[column]);
                const double transfer = settings_.backDiffusionFactor * kSulfonicDensity *
                                        membraneWaterDiffusion(content, mea) / kMembraneThickness; // mol/(m2 s)
                waterFlux_[column] = settings_.dragFactor * dragCoefficient(content) * current_[column] / kFaraday -
                                     transfer * (contentAir - contentFuel);
                // The drag follows the mean content, back diffusion the difference.
                const double drag = settings_.dragFactor * dragCoefficient(0.5) * current_[column] / kFaraday;
                waterSlope_[0][column] = (transfer + drag) * waterContentSlope(activityFuel) / saturated;
                waterSlope_[1][column] = std::max(transfer - drag, 0.0) * waterContentSlope(activityAir) / saturated;
            }
        },
        16);
}

bool FuelCellSolver::advance(double rate, double voltage, int maxIterations, double tolerance,
                             const Progress& progress) {
    const std::array<std::vector<double>, 4> gasBefore{spaces_[0].reactant, spaces_[0].water, spaces_[1].reactant,
                                                       spaces_[1].water};
    const std::vector<double> heatBefore = temperature_;
    bool converged = false;
    updateCurrent(voltage);
    for (iterations_ = 1; iterations_ <= maxIterations && !converged; ++iterations_) {
        progress.advance(double(iterations_ - 1) / maxIterations, rate == 0 ? "steady state" : "load step");
        const std::vector<double> currentBefore = current_, waterBefore = waterFlux_;
        const bool refresh = iterations_ == 1 || (rate == 0 && iterations_ == 3);
        parallelFor(2, [&](std::size_t space) { solveFlow(int(space)); });
        parallelFor(5, [&](std::size_t job) {
            if (job == 0)
                solveHeat(voltage, rate, heatBefore, refresh && rate != heatRate_);
            else
                solveSpecies(int(job - 1) / 2, (job - 1) % 2 == 1, rate, gasBefore[job - 1], refresh);
        });
        updateCurrent(voltage);
        double change = 0, scale = 1e-6;
        for (std::size_t column = 0; column < current_.size(); ++column) {
            change = std::max({change, std::abs(current_[column] - currentBefore[column]),
                               kFaraday * std::abs(waterFlux_[column] - waterBefore[column])});
            scale = std::max(scale, current_[column]);
        }
        converged = change <= tolerance * scale;
    }
    heatRate_ = rate;
    for (std::size_t which : {0u, 1u}) {
        const GasSpace& space = spaces_[which];
        const std::size_t section = space.kind.size();
        stored_[which] = {};
        for (std::size_t p = 0; p < space.reactant.size(); ++p) {
            const double gas = space.gasVolume(grid_, p % section) * rate;
            stored_[which].reactantStored += gas * (space.reactant[p] - gasBefore[2 * which][p]);
            stored_[which].waterStored += gas * (space.water[p] - gasBefore[2 * which + 1][p]);
        }
    }
    return converged;
}

void FuelCellSolver::settle(double voltage, const Progress& progress) {
    advance(0, voltage, 200, 1e-5, progress);
}

void FuelCellSolver::step(double dt, double voltage, const Progress& progress) {
    advance(1 / dt, voltage, 12, 5e-4, progress);
}

double FuelCellSolver::totalCurrent() const {
    return std::accumulate(current_.begin(), current_.end(), 0.0) * grid_.dx * grid_.dz;
}

double FuelCellSolver::meanCurrent() const {
    return std::accumulate(current_.begin(), current_.end(), 0.0) / double(current_.size());
}

Balance FuelCellSolver::balance(int which) const {
    const GasSpace& space = spaces_[std::size_t(which)];
    Balance b = stored_[std::size_t(which)];
    const std::size_t section = space.kind.size(), last = space.air ? section * std::size_t(grid_.nz - 1) : 0;
    for (std::size_t s = 0; s < section; ++s) {
        b.reactantIn += space.inlet[s] * space.inletReactant;
        b.waterIn += space.inlet[s] * space.inletWater;
        b.reactantOut += std::max(space.outlet[s], 0.0) * space.reactant[last + s];
        b.waterOut += std::max(space.outlet[s], 0.0) * space.water[last + s];
        b.waterIn += std::max(-space.outlet[s], 0.0) * space.inletWater;
    }
    const double area = grid_.dx * grid_.dz;
    for (double rate : reactantRate_[std::size_t(which)]) b.reactantUsed -= rate * area;
    for (double rate : waterRate_[std::size_t(which)]) b.waterReleased += rate * area;
    return b;
}

} // namespace tessera::volume::cell
