#include "volume/synthetic/fuel_cell_solver.h"

#include "volume/synthetic/fuel_cell_properties.h"

#include <algorithm>
#include <cmath>

namespace tessera::volume::cell {

namespace {

/// Velocity profile of a duct, of fully developed laminar flow: -laplace(profile) = 1, 0 on its walls (and at the
/// gas-diffusion layer, where velocities are four orders of magnitude smaller); velocity = profile / viscosity *
/// pressure gradient.
std::vector<double> ductProfile(const GasSpace& space, const CellGrid& g) {
    StencilSystem duct(g.nx, space.rows, 1);
    for (int row = 0; row < space.rows; ++row)
        for (int x = 0; x < g.nx; ++x) {
            const std::size_t p = std::size_t(x + g.nx * row);
            if (space.kind[p] != 1) {
                duct.diag[p] = 1;
                continue;
            }
            const auto face = [&](bool inside, std::size_t neighbour, double step, std::vector<double>& coupling) {
                const double weight = 1 / (step * step);
                const bool open = inside && space.kind[neighbour] == 1;
                duct.diag[p] += open ? weight : 2 * weight;
                if (open) coupling[p] = weight;
            };
            const double dy = g.height[std::size_t(space.yBegin + row)]; // the same for all rows of a channel
            face(x > 0, p - 1, g.dx, duct.west);
            face(x + 1 < g.nx, p + 1, g.dx, duct.east);
            face(row > 0, p - std::size_t(g.nx), dy, duct.south);
            face(row + 1 < space.rows, p + std::size_t(g.nx), dy, duct.north);
            duct.rhs[p] = 1;
        }
    std::vector<double> profile(space.kind.size(), 0.0);
    solve(duct, PlanePreconditioner(duct), profile, 1e-12);
    return profile;
}

/// The pressure system of a gas space: volume flux = conductance * pressure difference. Along the flow the duct profile
/// or Darcy's law; across it Darcy's law too, with the mean of the profile in the channel: the flow across a channel is
/// only what the reaction draws, and its pressure differences are far below those along it.
StencilSystem pressureSystem(const GasSpace& space, const CellGrid& g, double meanProfile) {
    const std::size_t section = space.kind.size();
    StencilSystem flow(g.nx, space.rows, g.nz);
    const double viscosity = space.air ? kViscosityAir : kViscosityHydrogen;
    const auto across = [&](std::size_t p) { return space.kind[p] == 1 ? meanProfile : space.permeability[p]; };
    const std::size_t row = std::size_t(g.nx);
    const double* const height = g.height.data() + space.yBegin;
    for (int z = 0; z < g.nz; ++z)
        for (std::size_t s = 0; s < section; ++s) {
            const std::size_t p = s + section * std::size_t(z);
            const double dy = height[s / row];
            if (space.kind[s] == 0) {
                flow.diag[p] = 1;
                continue;
            }
            const auto link = [&](std::vector<double>& toNext, std::vector<double>& back, std::size_t step, double k) {
                flow.diag[p] += k, flow.diag[p + step] += k;
                toNext[p] = k, back[p + step] = k;
            };
            const std::size_t x = s % row;
            if (x + 1 < row && space.kind[s + 1] != 0)
                link(flow.east, flow.west, 1, series(across(s), across(s + 1)) / viscosity * dy * g.dz / g.dx);
            if (s + row < section && space.kind[s + row] != 0)
                link(flow.north, flow.south, row,
                     series(across(s) / dy, across(s + row) / height[s / row + 1]) / viscosity * g.dx * g.dz);
            const double along = space.permeability[s] / viscosity * g.dx * dy / g.dz;
            if (z + 1 < g.nz) link(flow.up, flow.down, section, along);
            if (z == (space.air ? g.nz - 1 : 0) && space.kind[s] == 1) flow.diag[p] += 2 * along;
        }
    return flow;
}

} // namespace

void FuelCellSolver::setUpSpace(int which) {
    GasSpace& space = spaces_[std::size_t(which)];
    const CellGrid& g = grid_;
    space.air = which == 1;
    space.yBegin = space.air ? g.rows[4] : 0;
    space.rows = space.air ? g.ny - g.rows[4] : g.rows[3];
    const std::size_t section = std::size_t(g.nx * space.rows), cells = section * std::size_t(g.nz);

    space.kind.assign(section, 0);
    for (int row = 0; row < space.rows; ++row)
        for (int x = 0; x < g.nx; ++x) {
            const CellRegion region = g.region(x, space.yBegin + row);
            const bool gdl = region == CellRegion::AnodeGdl || region == CellRegion::CathodeGdl;
            const bool channel = region == CellRegion::AnodeChannel || region == CellRegion::CathodeChannel;
            if (region != CellRegion::Land) space.kind[std::size_t(x + g.nx * row)] = channel ? 1 : gdl ? 2 : 3;
        }

    space.permeability = ductProfile(space, g);
    double sum = 0;
    int channelCells = 0;
    for (std::size_t p = 0; p < section; ++p) {
        if (space.kind[p] == 1) sum += space.permeability[p], ++channelCells;
        if (space.kind[p] == 2) space.permeability[p] = kPermeability;
        if (space.kind[p] == 3) space.permeability[p] = kCatalystPermeability;
    }
    const double meanProfile = sum / channelCells;

    // Feeds: what the rated current uses, times the stoichiometry.
    const double width = 2 * kLandWidth + kChannelWidth;
    const double charge = settings_.ratedCurrent * width * kLength / kFaraday; // mol/s
    const double humidity = space.air ? settings_.airHumidity : settings_.fuelHumidity;
    const double water = humidity * saturationPressure(settings_.coolantTemperature) / settings_.outletPressure;
    space.inletWater = water * concentration_;
    space.inletReactant = (space.air ? 0.21 : 1.0) * (1 - water) * concentration_;
    const double feed =
        (space.air ? settings_.airStoichiometry * charge / 4 : settings_.hydrogenStoichiometry * charge / 2);
    const double volume = feed / space.inletReactant; // m3/s
    space.inlet.assign(section, 0.0), space.outlet.assign(section, 0.0);
    for (std::size_t p = 0; p < section; ++p)
        if (space.kind[p] == 1) space.inlet[p] = volume * space.permeability[p] / sum;

    space.pressure.assign(cells, 0.0);
    space.reactant.assign(cells, 0.0), space.water.assign(cells, 0.0);
    for (std::size_t p = 0; p < cells; ++p)
        if (space.kind[p % section] != 0) space.reactant[p] = space.inletReactant, space.water[p] = space.inletWater;
    space.fluxX.assign(cells, 0.0), space.fluxY.assign(cells, 0.0), space.fluxZ.assign(cells, 0.0);
    space.wall.assign(std::size_t(g.nx * g.nz), 0.0);
    for (auto* column : {&reactantRate_, &waterRate_, &waterSlope_})
        (*column)[std::size_t(which)].assign(std::size_t(g.nx * g.nz), 0.0);

    flow_[std::size_t(which)] = pressureSystem(space, g, meanProfile);
    flowPreconditioner_[std::size_t(which)] = PlanePreconditioner(flow_[std::size_t(which)]);
    for (int water2 : {0, 1}) species_[std::size_t(2 * which + water2)].system = StencilSystem(g.nx, space.rows, g.nz);
}

double FuelCellSolver::diffusion(const GasSpace& space, bool water, std::size_t section, bool inPlane) const {
    if (space.kind[section] == 0) return 0;
    const double free = space.air ? (water ? kDiffusionWaterInAir : kDiffusionO2) : kDiffusionHydrogen;
    const double scaled =
        free * 101325 / settings_.outletPressure * std::pow(settings_.coolantTemperature / kReferenceTemperature, 1.75);
    if (space.kind[section] == 3) return scaled * std::pow(kCatalystPorosity, 1.5);
    return space.kind[section] == 1 ? scaled : scaled * fibreDiffusibility(kPorosity, inPlane);
}

void FuelCellSolver::solveFlow(int which) {
    GasSpace& space = spaces_[std::size_t(which)];
    StencilSystem& flow = flow_[std::size_t(which)];
    const CellGrid& g = grid_;
    const std::size_t section = std::size_t(g.nx * space.rows);
    std::fill(flow.rhs.begin(), flow.rhs.end(), 0.0);
    const std::size_t first = space.air ? 0 : section * std::size_t(g.nz - 1);
    for (std::size_t s = 0; s < section; ++s) flow.rhs[first + s] += space.inlet[s];
    for (int z = 0; z < g.nz; ++z)
        for (int x = 0; x < g.nx; ++x) {
            const std::size_t column = std::size_t(x + g.nx * z);
            const double i = current_[column], water = waterFlux_[column];
            // Moles that leave the catalyst for the gas: water made and carried, less the reactant used.
            const double moles = space.air ? i / (4 * kFaraday) + water : -i / (2 * kFaraday) - water;
            space.wall[column] = moles / concentration_ * g.dx * g.dz;
            flow.rhs[flow.index(x, space.wallRow(), z)] += space.wall[column];
        }
    solve(flow, flowPreconditioner_[std::size_t(which)], space.pressure, 1e-9);

    const std::vector<double>& p = space.pressure;
    const std::size_t row = std::size_t(g.nx), count = flow.count();
    for (std::size_t c = 0; c < count; ++c) {
        if (c + 1 < count) space.fluxX[c] = flow.east[c] * (p[c] - p[c + 1]);
        if (c + row < count) space.fluxY[c] = flow.north[c] * (p[c] - p[c + row]);
        if (c + section < count) space.fluxZ[c] = flow.up[c] * (p[c] - p[c + section]);
    }
    const double viscosity = space.air ? kViscosityAir : kViscosityHydrogen;
    const std::size_t last = space.air ? section * std::size_t(g.nz - 1) : 0;
    for (std::size_t s = 0; s < section; ++s)
        if (space.kind[s] == 1)
            space.outlet[s] = 2 * space.permeability[s] / viscosity * g.dx *
                              g.height[std::size_t(space.yBegin) + s / row] / g.dz * p[last + s];
}

FuelCellSolver::WallRate FuelCellSolver::wallRate(int which, bool water, const std::vector<double>& c,
                                                  StencilSystem& a) const {
    const GasSpace& space = spaces_[std::size_t(which)];
    const CellGrid& g = grid_;
    const double area = g.dx * g.dz;
    const std::size_t columns = std::size_t(g.nx * g.nz);
    WallRate wall{std::vector<double>(columns), std::vector<double>(columns)};
    for (int z = 0; z < g.nz; ++z)
        for (int x = 0; x < g.nx; ++x) {
            const std::size_t column = std::size_t(x + g.nx * z), p = a.index(x, space.wallRow(), z);
            const double i = current_[column];
            const double release = !water      ? -i / ((space.air ? 4 : 2) * kFaraday)
                                   : space.air ? i / (2 * kFaraday) + waterFlux_[column]
                                               : -waterFlux_[column];
            const double now = std::max(c[p], 1e-9);
            const double slope = water       ? waterSlope_[std::size_t(which)][column]
                                 : space.air ? currentSlope_[column] / (4 * kFaraday)
                                             : 0.0;
            const bool tangent = !water && space.air;
            wall.constant[column] = release + slope * now;
            wall.factor[column] = slope;
            if (!tangent && wall.constant[column] < 0) {
                wall.factor[column] -= wall.constant[column] / now;
                wall.constant[column] = 0;
            }
            a.rhs[p] += area * wall.constant[column];
            a.diag[p] += area * wall.factor[column];
        }
    return wall;
}

void FuelCellSolver::solveSpecies(int which, bool water, double rate, const std::vector<double>& before, bool refresh) {
    GasSpace& space = spaces_[std::size_t(which)];
    SpeciesSystem& own = species_[std::size_t(2 * which + (water ? 1 : 0))];
    StencilSystem& a = own.system;
    const CellGrid& g = grid_;
    const std::size_t section = std::size_t(g.nx * space.rows), row = std::size_t(g.nx);
    const double* const height = g.height.data() + space.yBegin;
    std::vector<double>& c = water ? space.water : space.reactant;
    const double inletValue = water ? space.inletWater : space.inletReactant;

    // Diffusive conductances of a cross-section to x+1, y+1, z+1, m3/s.
    std::vector<double> toX(section, 0.0), toY(section, 0.0), toZ(section, 0.0);
    for (std::size_t s = 0; s < section; ++s) {
        const double inPlane = diffusion(space, water, s, true), through = diffusion(space, water, s, false);
        const double dy = height[s / row];
        if (s % row + 1 < row) toX[s] = series(inPlane, diffusion(space, water, s + 1, true)) * dy * g.dz / g.dx;
        if (s + row < section)
            toY[s] = series(through / dy, diffusion(space, water, s + row, false) / height[s / row + 1]) * g.dx * g.dz;
        toZ[s] = inPlane * g.dx * dy / g.dz;
    }

    a.clear();
    for (int z = 0; z < g.nz; ++z)
        for (std::size_t s = 0; s < section; ++s) {
            const std::size_t p = s + section * std::size_t(z);
            if (space.kind[s] == 0) {
                a.diag[p] = 1;
                continue;
            }
            const double storage = space.gasVolume(g, s) * rate;
            a.diag[p] += storage;
            a.rhs[p] += storage * before[p];
            // Upwind advection and central diffusion through the face to the next cell.
            const auto link = [&](std::vector<double>& next, std::vector<double>& back, std::size_t step, double flux,
                                  double conductance) {
                const double forward = conductance + std::max(flux, 0.0), backward = conductance + std::max(-flux, 0.0);
                a.diag[p] += forward, back[p + step] = forward;
                a.diag[p + step] += backward, next[p] = backward;
            };
            if (toX[s] > 0) link(a.east, a.west, 1, space.fluxX[p], toX[s]);
            if (toY[s] > 0) link(a.north, a.south, row, space.fluxY[p], toY[s]);
            if (z + 1 < g.nz) link(a.up, a.down, section, space.fluxZ[p], toZ[s]);
            if (z == (space.air ? 0 : g.nz - 1)) a.rhs[p] += space.inlet[s] * inletValue;
            if (z == (space.air ? g.nz - 1 : 0)) {
                // If more is consumed than fed, exhaust flows back in; it contains water, but no reactant.
                a.diag[p] += std::max(space.outlet[s], 0.0);
                if (water) a.rhs[p] += std::max(-space.outlet[s], 0.0) * inletValue;
            }
        }

    const WallRate wall = wallRate(which, water, c, a);
    if (refresh || own.preconditioner.empty()) own.preconditioner = PlanePreconditioner(a);
    const std::vector<double> start = !water && space.air ? c : std::vector<double>();
    solve(a, own.preconditioner, c, 1e-8);
    std::vector<double>& used = water ? waterRate_[std::size_t(which)] : reactantRate_[std::size_t(which)];
    for (int z = 0; z < g.nz; ++z)
        for (int x = 0; x < g.nx; ++x) {
            const std::size_t column = std::size_t(x + g.nx * z);
            used[column] = wall.constant[column] - wall.factor[column] * c[a.index(x, space.wallRow(), z)];
        }
    if (!water && space.air)
        for (std::size_t p = 0; p < c.size(); ++p) c[p] = std::max(c[p], 0.2 * start[p]); // a Newton step can overshoot
}

} // namespace tessera::volume::cell
