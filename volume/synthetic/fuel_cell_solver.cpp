#include "volume/synthetic/fuel_cell_solver.h"

#include "volume/parallel.h"
#include "volume/synthetic/fuel_cell_properties.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tessera::volume::cell {

namespace {

// Cuts n cells into layers of these thicknesses, rounded to whole cells, each at least one. First cells, then n.
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

// Conductance between the centres of two cells half a step from their common face each.
double series(double a, double b) {
    return a > 0 && b > 0 ? 2 * a * b / (a + b) : 0.0;
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

FuelCellSolver::FuelCellSolver(const FuelCellSettings& settings)
    : settings_(settings), grid_(settings.nx, settings.ny, settings.nz),
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

void FuelCellSolver::setUpSpace(int which) {
    GasSpace& space = spaces_[std::size_t(which)];
    const CellGrid& g = grid_;
    space.air = which == 1;
    space.yBegin = space.air ? g.rows[3] : 0;
    space.rows = space.air ? g.ny - g.rows[3] : g.rows[2];
    const int layerBegin = space.air ? 0 : g.rows[1], layerEnd = space.air ? g.rows[4] - g.rows[3] : g.rows[2];
    const std::size_t section = std::size_t(g.nx * space.rows), cells = section * std::size_t(g.nz);

    space.kind.assign(section, 0);
    for (int row = 0; row < space.rows; ++row)
        for (int x = 0; x < g.nx; ++x) {
            const bool layer = row >= layerBegin && row < layerEnd;
            if (layer || (x >= g.channelBegin && x < g.channelEnd))
                space.kind[std::size_t(x + g.nx * row)] = layer ? 2 : 1;
        }

    // Fully developed laminar flow in the duct: -laplace(profile) = 1, 0 on its walls (and on the gas-diffusion layer,
    // where the gas is slower by four orders of magnitude); velocity = profile / viscosity * pressure gradient.
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
            face(x > 0, p - 1, g.dx, duct.west);
            face(x + 1 < g.nx, p + 1, g.dx, duct.east);
            face(row > 0, p - std::size_t(g.nx), g.dy, duct.south);
            face(row + 1 < space.rows, p + std::size_t(g.nx), g.dy, duct.north);
            duct.rhs[p] = 1;
        }
    space.permeability.assign(section, 0.0);
    solve(duct, PlanePreconditioner(duct), space.permeability, 1e-12);

    double sum = 0;
    int channelCells = 0;
    for (std::size_t p = 0; p < section; ++p) {
        if (space.kind[p] == 1) sum += space.permeability[p], ++channelCells;
        if (space.kind[p] == 2) space.permeability[p] = kPermeability;
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

    // The pressure system: volume flux = conductance * pressure difference. Along the flow the duct profile or Darcy's
    // law; across it Darcy's law too, with the mean of the profile in the channel: the flow across a channel is only
    // what the reaction draws, and its pressure differences are far below those along it.
    StencilSystem& flow = flow_[std::size_t(which)];
    flow = StencilSystem(g.nx, space.rows, g.nz);
    const double viscosity = space.air ? kViscosityAir : kViscosityHydrogen;
    const auto across = [&](std::size_t p) { return space.kind[p] == 1 ? meanProfile : space.permeability[p]; };
    const std::size_t row = std::size_t(g.nx);
    for (int z = 0; z < g.nz; ++z)
        for (std::size_t s = 0; s < section; ++s) {
            const std::size_t p = s + section * std::size_t(z);
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
                link(flow.east, flow.west, 1, series(across(s), across(s + 1)) / viscosity * g.dy * g.dz / g.dx);
            if (s + row < section && space.kind[s + row] != 0)
                link(flow.north, flow.south, row, series(across(s), across(s + row)) / viscosity * g.dx * g.dz / g.dy);
            const double along = space.permeability[s] / viscosity * g.dx * g.dy / g.dz;
            if (z + 1 < g.nz) link(flow.up, flow.down, section, along);
            if (z == (space.air ? g.nz - 1 : 0) && space.kind[s] == 1) flow.diag[p] += 2 * along;
        }
    flowPreconditioner_[std::size_t(which)] = PlanePreconditioner(flow);
    for (int water2 : {0, 1}) species_[std::size_t(2 * which + water2)].system = StencilSystem(g.nx, space.rows, g.nz);
}

double FuelCellSolver::diffusion(const GasSpace& space, bool water, std::size_t section, bool inPlane) const {
    if (space.kind[section] == 0) return 0;
    const double free = space.air ? (water ? kDiffusionWaterInAir : kDiffusionO2) : kDiffusionHydrogen;
    const double scaled =
        free * 101325 / settings_.outletPressure * std::pow(settings_.coolantTemperature / kReferenceTemperature, 1.75);
    return space.kind[section] == 1 ? scaled : scaled * fibreDiffusibility(kPorosity, inPlane);
}

void FuelCellSolver::updateCurrent(double voltage) {
    const CellGrid& g = grid_;
    const GasSpace &fuel = spaces_[0], &air = spaces_[1];
    const auto half = [&](const GasSpace& space, bool water) { // m/s from the cell next to the catalyst to it
        return diffusion(space, water, std::size_t(g.nx * space.wallRow()), false) / (0.5 * g.dy);
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
                for (int y = g.rows[2]; y < g.rows[3]; ++y) mea += temperature_[heat_.index(x, y, int(z))];
                mea /= g.rows[3] - g.rows[2];

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
            space.outlet[s] = 2 * space.permeability[s] / viscosity * g.dx * g.dy / g.dz * p[last + s];
}

void FuelCellSolver::solveSpecies(int which, bool water, double rate, const std::vector<double>& before, bool refresh) {
    GasSpace& space = spaces_[std::size_t(which)];
    SpeciesSystem& own = species_[std::size_t(2 * which + (water ? 1 : 0))];
    StencilSystem& a = own.system;
    const CellGrid& g = grid_;
    const std::size_t section = std::size_t(g.nx * space.rows), row = std::size_t(g.nx);
    const double volume = g.dx * g.dy * g.dz, area = g.dx * g.dz;
    std::vector<double>& c = water ? space.water : space.reactant;
    const double inletValue = water ? space.inletWater : space.inletReactant;

    // Diffusive conductances of a cross-section to x+1, y+1, z+1, m3/s.
    std::vector<double> toX(section, 0.0), toY(section, 0.0), toZ(section, 0.0);
    for (std::size_t s = 0; s < section; ++s) {
        const double inPlane = diffusion(space, water, s, true), through = diffusion(space, water, s, false);
        if (s % row + 1 < row) toX[s] = series(inPlane, diffusion(space, water, s + 1, true)) * g.dy * g.dz / g.dx;
        if (s + row < section) toY[s] = series(through, diffusion(space, water, s + row, false)) * g.dx * g.dz / g.dy;
        toZ[s] = inPlane * g.dx * g.dy / g.dz;
    }

    a.clear();
    for (int z = 0; z < g.nz; ++z)
        for (std::size_t s = 0; s < section; ++s) {
            const std::size_t p = s + section * std::size_t(z);
            if (space.kind[s] == 0) {
                a.diag[p] = 1;
                continue;
            }
            const double storage = (space.kind[s] == 2 ? kPorosity : 1.0) * volume * rate;
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
                // Where more is used than fed the exhaust flows back; it brings water, but no reactant.
                a.diag[p] += std::max(space.outlet[s], 0.0);
                if (water) a.rhs[p] += std::max(-space.outlet[s], 0.0) * inletValue;
            }
        }

    // At the catalyst the total molar rate is given, as constant - factor * concentration: for oxygen the tangent of
    // the current (Newton's method), for water the answer of the membrane; any other loss as proportional to the
    // concentration, which keeps it positive.
    std::vector<double>& used = water ? waterRate_[std::size_t(which)] : reactantRate_[std::size_t(which)];
    std::vector<double> constant(used.size()), factor(used.size());
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
            constant[column] = release + slope * now;
            factor[column] = slope;
            if (!tangent && constant[column] < 0) {
                factor[column] -= constant[column] / now;
                constant[column] = 0;
            }
            a.rhs[p] += area * constant[column];
            a.diag[p] += area * factor[column];
        }
    if (refresh || own.preconditioner.empty()) own.preconditioner = PlanePreconditioner(a);
    const std::vector<double> start = !water && space.air ? c : std::vector<double>();
    solve(a, own.preconditioner, c, 1e-8);
    for (int z = 0; z < g.nz; ++z)
        for (int x = 0; x < g.nx; ++x) {
            const std::size_t column = std::size_t(x + g.nx * z);
            used[column] = constant[column] - factor[column] * c[a.index(x, space.wallRow(), z)];
        }
    if (!water && space.air)
        for (std::size_t p = 0; p < c.size(); ++p) c[p] = std::max(c[p], 0.2 * start[p]); // a tangent can go too far
}

void FuelCellSolver::solveHeat(double voltage, double rate, const std::vector<double>& before, bool refresh) {
    const CellGrid& g = grid_;
    StencilSystem& a = heat_;
    const std::size_t row = std::size_t(g.nx), plane = a.plane();
    const double volume = g.dx * g.dy * g.dz;
    struct Material {
        double inPlane, through, capacity;
    };
    const double gasCapacity = concentration_ * kGasHeatCapacity;
    const auto material = [&](CellRegion region) -> Material {
        switch (region) {
        case CellRegion::Land:
            return {kConductivityLand, kConductivityLand, kHeatCapacityLand};
        case CellRegion::AnodeChannel:
            return {kConductivityHydrogen, kConductivityHydrogen, gasCapacity};
        case CellRegion::CathodeChannel:
            return {kConductivityAir, kConductivityAir, gasCapacity};
        case CellRegion::Mea:
            return {kConductivityMea, kConductivityMea, kHeatCapacityMea};
        default:
            return {kConductivityGdlInPlane, kConductivityGdl, kHeatCapacityGdl};
        }
    };
    std::vector<Material> materials(plane);
    for (std::size_t s = 0; s < plane; ++s) materials[s] = material(grid_.region(int(s % row), int(s / row)));

    a.clear();
    for (int z = 0; z < g.nz; ++z)
        for (std::size_t s = 0; s < plane; ++s) {
            const std::size_t p = s + plane * std::size_t(z);
            const Material& m = materials[s];
            const double storage = m.capacity * volume * rate;
            a.diag[p] += storage;
            a.rhs[p] += storage * before[p];
            const auto link = [&](std::vector<double>& next, std::vector<double>& back, std::size_t step, double k) {
                a.diag[p] += k, a.diag[p + step] += k;
                next[p] += k, back[p + step] += k;
            };
            if (s % row + 1 < row)
                link(a.east, a.west, 1, series(m.inPlane, materials[s + 1].inPlane) * g.dy * g.dz / g.dx);
            if (s + row < plane)
                link(a.north, a.south, row, series(m.through, materials[s + row].through) * g.dx * g.dz / g.dy);
            if (z + 1 < g.nz) link(a.up, a.down, plane, m.inPlane * g.dx * g.dy / g.dz);
            // Cooled plates behind the lands (and behind the floor of the channels).
            if (s < row || s + row >= plane) {
                const double k = g.dx * g.dz / (1 / kCoolantTransfer + 0.5 * g.dy / m.through);
                a.diag[p] += k;
                a.rhs[p] += k * settings_.coolantTemperature;
            }
        }

    // Heat carried by the gas, upwind, in the form that needs no balance of moles: each cell takes what flows in.
    for (const GasSpace& space : spaces_) {
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

    const int meaRows = g.rows[3] - g.rows[2];
    for (int z = 0; z < g.nz; ++z)
        for (int x = 0; x < g.nx; ++x) {
            const double heat = current_[std::size_t(x + g.nx * z)] * (kThermalVoltage - voltage) * g.dx * g.dz;
            for (int y = g.rows[2]; y < g.rows[3]; ++y) a.rhs[a.index(x, y, z)] += heat / meaRows;
        }
    // The largest factors; the flow changes them little, so that only another time step calls for new ones.
    if (refresh || heatPreconditioner_.empty()) heatPreconditioner_ = PlanePreconditioner(a);
    solve(a, heatPreconditioner_, temperature_, 3e-8);
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
    const double volume = grid_.dx * grid_.dy * grid_.dz;
    for (std::size_t which : {0u, 1u}) {
        const GasSpace& space = spaces_[which];
        const std::size_t section = space.kind.size();
        stored_[which] = {};
        for (std::size_t p = 0; p < space.reactant.size(); ++p) {
            const double gas = (space.kind[p % section] == 2 ? kPorosity : 1.0) * volume * rate;
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
