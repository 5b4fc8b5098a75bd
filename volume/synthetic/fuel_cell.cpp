#include "volume/synthetic/fuel_cell.h"

#include "volume/base/parallel.h"
#include "volume/field/own_axes.h"
#include "volume/synthetic/fuel_cell_solver.h"
#include "volume/synthetic/settings.h"
#include "volume/system/kept_numbers.h"
#include "volume/system/user_folder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

namespace tessera::volume {

namespace {

using cell::CellGrid;
using cell::FuelCellSolver;
using cell::GasSpace;

enum { kO2, kH2, kH2O, kPressure, kTemperature, kVelocity, kRegion, kParameters };

/// Solved values of one time in single precision: temperature of all cells, and of each gas space reactant, water,
/// pressure and the three components of the velocity (cells of the space, land included).
struct Frame {
    std::vector<float> temperature;
    std::array<std::array<std::vector<float>, 6>, 2> gas;
};

/// The solved frames, and what is needed to interpolate them on the requested grid.
struct Solution {
    CellGrid grid;  ///< solved
    CellGrid shown; ///< requested
    Lattice lattice;
    std::array<int, 2> yBegin{}, rows{}; ///< of the gas spaces, solved grid
    std::vector<Frame> frames;
    std::shared_ptr<const Mask> fuel, air, gases; ///< on the shown grid
};

bool inSpace(CellRegion region, int space) {
    return space == 0 ? region == CellRegion::AnodeChannel || region == CellRegion::AnodeGdl ||
                            region == CellRegion::AnodeCatalyst
                      : region == CellRegion::CathodeChannel || region == CellRegion::CathodeGdl ||
                            region == CellRegion::CathodeCatalyst;
}

Frame keep(const FuelCellSolver& solver) {
    const CellGrid& g = solver.grid();
    Frame frame;
    frame.temperature.assign(solver.temperature().begin(), solver.temperature().end());
    for (int which : {0, 1}) {
        const GasSpace& space = which == 0 ? solver.fuel() : solver.air();
        auto& out = frame.gas[std::size_t(which)];
        out[0].assign(space.reactant.begin(), space.reactant.end());
        out[1].assign(space.water.begin(), space.water.end());
        for (std::size_t part = 2; part < 6; ++part) out[part].resize(space.pressure.size());
        std::size_t p = 0;
        for (int z = 0; z < g.nz; ++z)
            for (int row = 0; row < space.rows; ++row)
                for (int x = 0; x < g.nx; ++x, ++p) {
                    out[2][p] = float(solver.settings().outletPressure + space.pressure[p]);
                    const std::array<double, 3> u = space.velocity(g, x, row, z);
                    for (std::size_t axis = 0; axis < 3; ++axis) out[3 + axis][p] = float(u[axis]);
                }
    }
    return frame;
}

/// The parts of a frame in the order in which their numbers are kept.
template <class F> auto partsOf(F& frame) {
    std::vector<decltype(&frame.temperature)> parts{&frame.temperature};
    for (auto& space : frame.gas)
        for (auto& part : space) parts.push_back(&part);
    return parts;
}

/// Solves all times.
std::vector<Frame> solveAll(FuelCellSolver& solver, const FuelCellSettings& settings, const Progress& progress) {
    solver.settle(settings.voltageBefore, progress.part(0, 0.3));
    std::vector<Frame> frames{keep(solver)};
    for (int time = 1; time < settings.times; ++time) {
        const bool after = time * settings.interval > settings.stepTime * (1 + 1e-12);
        solver.step(settings.interval, after ? settings.voltageAfter : settings.voltageBefore,
                    progress.part(0.3 + 0.7 * time / settings.times, 0.3 + 0.7 * (time + 1) / settings.times));
        frames.push_back(keep(solver));
    }
    return frames;
}

/// The same of the cell that everybody sees first, which takes a second: solved once by each user.
std::vector<Frame> solvedOnce(FuelCellSolver& solver, const FuelCellSettings& settings, const Progress& progress) {
    Frame form;
    form.temperature.resize(solver.temperature().size());
    for (const int which : {0, 1})
        for (std::vector<float>& part : form.gas[std::size_t(which)])
            part.resize((which == 0 ? solver.fuel() : solver.air()).pressure.size());
    std::size_t count = 0;
    for (const auto* part : partsOf(form)) count += part->size();
    const std::vector<float> numbers =
        computedOnce(userFolder("XDG_CACHE_HOME", ".cache"), "fuel-cell", count * std::size_t(settings.times), [&] {
            std::vector<float> all;
            for (Frame& frame : solveAll(solver, settings, progress))
                for (const auto* part : partsOf(frame)) all.insert(all.end(), part->begin(), part->end());
            return all;
        });
    std::vector<Frame> frames(std::size_t(settings.times), form);
    const float* from = numbers.data();
    for (Frame& frame : frames)
        for (auto* part : partsOf(frame)) {
            std::copy_n(from, part->size(), part->begin());
            from += part->size();
        }
    return frames;
}

std::shared_ptr<const Mask> makeMask(const CellGrid& g, bool fuel, bool air) {
    auto mask = std::make_shared<Mask>();
    mask->reserve(std::size_t(g.nx) * std::size_t(g.ny) * std::size_t(g.nz));
    for (int z = 0; z < g.nz; ++z)
        for (int y = 0; y < g.ny; ++y)
            for (int x = 0; x < g.nx; ++x)
                mask->push_back((fuel && inSpace(g.region(x, y), 0)) || (air && inSpace(g.region(x, y), 1)));
    return mask;
}

/// Position of a sample of the requested grid between two solved ones, along one axis.
struct Blend {
    int lo = 0, hi = 0;
    double weight = 0; ///< of `hi`
};

std::vector<Blend> between(int shown, int solved) {
    std::vector<Blend> result;
    for (int i = 0; i < shown; ++i) {
        const double at = std::clamp((i + 0.5) * solved / shown - 0.5, 0.0, double(solved - 1));
        const int lo = std::min(int(at), std::max(solved - 2, 0));
        result.push_back({lo, std::min(lo + 1, solved - 1), at - lo});
    }
    return result;
}

/// The same for rows, by their middles (m, rising).
std::vector<Blend> between(const std::vector<double>& shown, const std::vector<double>& solved) {
    std::vector<Blend> result;
    const int last = int(solved.size()) - 1;
    for (const double at : shown) {
        const auto above = std::ranges::upper_bound(solved, at) - solved.begin();
        const int lo = std::clamp(int(above) - 1, 0, std::max(last - 1, 0)), hi = std::min(lo + 1, last);
        const double begin = solved[std::size_t(lo)], step = solved[std::size_t(hi)] - begin;
        result.push_back({lo, hi, step > 0 ? std::clamp((at - begin) / step, 0.0, 1.0) : 0});
    }
    return result;
}

/// Up to four solved cells of a cross-section from which a requested one is interpolated; offsets from the first cell
/// of the plane.
struct Stencil {
    std::array<std::size_t, 4> cell{};
    std::array<double, 4> weight{}; ///< sum 1; all 0 for a sample outside
};

/// Bilinear weights of the cells that are `inside`; if none of the four is, the nearest cell of the channel.
template <class Inside> std::vector<Stencil> crossSection(const Solution& s, int yBegin, int rows, Inside&& inside) {
    const auto xs = between(s.shown.nx, s.grid.nx), ys = between(s.shown.middles(), s.grid.middles());
    std::vector<Stencil> stencils;
    stencils.reserve(xs.size() * ys.size());
    for (int y = 0; y < s.shown.ny; ++y)
        for (int x = 0; x < s.shown.nx; ++x) {
            Stencil& stencil = stencils.emplace_back();
            if (!inside(s.shown.region(x, y))) continue;
            const Blend &bx = xs[std::size_t(x)], &by = ys[std::size_t(y)];
            const auto cell = [&](int cx, int cy) { return std::size_t(cx + s.grid.nx * (cy - yBegin)); };
            double sum = 0;
            for (std::size_t corner = 0; corner < 4; ++corner) {
                const int cx = corner & 1 ? bx.hi : bx.lo, cy = corner & 2 ? by.hi : by.lo;
                if (!inside(s.grid.region(cx, cy))) continue;
                stencil.cell[corner] = cell(cx, cy);
                // Never exactly 0, so that a sample on the border still finds a cell of its own space.
                stencil.weight[corner] = ((corner & 1 ? bx.weight : 1 - bx.weight) + 1e-30) *
                                         ((corner & 2 ? by.weight : 1 - by.weight) + 1e-30);
                sum += stencil.weight[corner];
            }
            if (sum > 0) {
                for (double& weight : stencil.weight) weight /= sum;
            } else {
                stencil.cell[0] = cell(std::clamp(bx.lo, s.grid.channelBegin, s.grid.channelEnd - 1),
                                       std::clamp(by.lo, yBegin, yBegin + rows - 1));
                stencil.weight[0] = 1;
            }
        }
    return stencils;
}

/// Interpolates values of some rows of the solved grid linearly on the requested one, from the cells that are `inside`.
template <class Inside>
void spread(const Solution& s, std::span<const float> values, int yBegin, int rows, Inside&& inside,
            std::span<float> out) {
    const std::vector<Stencil> stencils = crossSection(s, yBegin, rows, inside);
    const auto zs = between(s.shown.nz, s.grid.nz);
    const std::size_t plane = std::size_t(s.grid.nx) * std::size_t(rows);
    parallelFor(zs.size(), [&](std::size_t z) {
        const float* lo = values.data() + plane * std::size_t(zs[z].lo);
        const float* hi = values.data() + plane * std::size_t(zs[z].hi);
        for (std::size_t q = 0; q < stencils.size(); ++q) {
            const Stencil& stencil = stencils[q];
            double below = 0, above = 0, weights = 0;
            for (std::size_t corner = 0; corner < 4; ++corner) {
                below += stencil.weight[corner] * double(lo[stencil.cell[corner]]);
                above += stencil.weight[corner] * double(hi[stencil.cell[corner]]);
                weights += stencil.weight[corner];
            }
            // Samples outside keep the values of the other gas space.
            if (weights > 0) out[z * stencils.size() + q] = float(below + (above - below) * zs[z].weight);
        }
    });
}

Lattice latticeOf(const CellGrid& g, bool even) {
    Lattice lattice;
    lattice.size = {g.nx, g.ny, g.nz};
    lattice.spacing = {g.dx, g.height.front(), g.dz};
    lattice.origin = lattice.spacing * 0.5;
    if (even) return lattice;
    return withAxes(lattice, {{nullptr, std::make_shared<const AxisMap>(AxisMap::Of::Cells, g.planes()), nullptr}});
}

Field regionField(const Solution& s) {
    Field field = makeField(s.lattice, ScalarType::U8);
    auto out = field.as<std::uint8_t>();
    std::size_t p = 0;
    for (int z = 0; z < s.shown.nz; ++z)
        for (int y = 0; y < s.shown.ny; ++y)
            for (int x = 0; x < s.shown.nx; ++x) out[p++] = std::uint8_t(s.shown.region(x, y));
    return field;
}

Field loadField(const Solution& s, int parameter, int component, int time) {
    if (parameter == kRegion) return regionField(s);
    Field field = makeField(s.lattice, ScalarType::F32);
    const Frame& frame = s.frames.at(std::size_t(time));
    if (parameter == kTemperature) {
        spread(
            s, frame.temperature, 0, s.grid.ny, [](CellRegion) { return true; }, field.as<float>());
        return field;
    }
    const std::size_t part = parameter == kPressure   ? 2
                             : parameter == kVelocity ? 3 + std::size_t(component)
                             : parameter == kH2O      ? 1
                                                      : 0;
    for (int space : {0, 1}) {
        if ((parameter == kO2 && space == 0) || (parameter == kH2 && space == 1)) continue;
        spread(
            s, frame.gas[std::size_t(space)][part], s.yBegin[std::size_t(space)], s.rows[std::size_t(space)],
            [space](CellRegion region) { return inSpace(region, space); }, field.as<float>());
    }
    field.mask = parameter == kO2 ? s.air : parameter == kH2 ? s.fuel : s.gases;
    return field;
}

std::vector<Parameter> describeParameters(bool even) {
    std::vector<Parameter> parameters(kParameters);
    const auto set = [&](int index, const char* name, const char* unit) {
        parameters[std::size_t(index)].name = name;
        parameters[std::size_t(index)].unit = unit;
    };
    set(kO2, "O2", "mol/m3"), set(kH2, "H2", "mol/m3"), set(kH2O, "H2O", "mol/m3");
    set(kPressure, "p", "Pa"), set(kTemperature, "T", "K"), set(kVelocity, "U", "m/s"), set(kRegion, "region", "");
    parameters[kVelocity].components = 3;
    Parameter& region = parameters[kRegion];
    region.type = ScalarType::U8;
    region.categorical = true;
    region.labels = {{0, "land"},     {1, "anode channel"}, {2, "anode GDL"},
                     {3, "membrane"}, {4, "cathode GDL"},   {5, "cathode channel"}};
    if (!even) region.labels.insert(region.labels.end(), {{6, "anode catalyst"}, {7, "cathode catalyst"}});
    region.ranges = {{0, double(region.labels.back().value)}};
    // Water and pressure jump across the membrane, which may be thinner than a cell.
    const auto values = [even](CellRegion a, CellRegion b, CellRegion catalyst) {
        return even ? std::vector<int>{int(a), int(b)} : std::vector<int>{int(a), int(b), int(catalyst)};
    };
    for (const int jumping : {kH2O, kPressure})
        parameters[std::size_t(jumping)].parts = {
            "region",
            {values(CellRegion::AnodeChannel, CellRegion::AnodeGdl, CellRegion::AnodeCatalyst),
             values(CellRegion::CathodeGdl, CellRegion::CathodeChannel, CellRegion::CathodeCatalyst)}};
    return parameters;
}

struct Widen {
    Range range{1e300, -1e300};
    void operator()(double value) { range = {std::min(range.lo, value), std::max(range.hi, value)}; }
};

/// Throws if the equations have no solution, usually because a cell is fed less than it consumes.
void checkRanges(const std::vector<Parameter>& parameters) {
    const auto within = [&](std::size_t index, double lo, double hi) {
        const Range range = parameters[index].ranges[0];
        return range.lo >= lo && range.hi <= hi; // false for NaN
    };
    bool good = within(kTemperature, 250, 600) && within(kPressure, 0, 1e7);
    for (std::size_t gas : {kO2, kH2, kH2O}) good = good && within(gas, -1e-6, 1e3);
    if (!good)
        throw Error(
            "no solution for these settings; feed more gas (stoichiometries, ratedCurrent) or raise the voltages",
            "fuel-cell");
}

/// Ranges over all frames of the solved grid, present cells only.
void fillRanges(const Solution& s, std::vector<Parameter>& parameters) {
    std::array<Widen, kParameters> scalar;
    std::array<Widen, 4> velocity;
    for (const Frame& frame : s.frames) {
        for (float value : frame.temperature) scalar[kTemperature](double(value));
        for (std::size_t space : {0u, 1u}) {
            const auto& gas = frame.gas[space];
            std::size_t p = 0;
            for (int z = 0; z < s.grid.nz; ++z)
                for (int row = 0; row < s.rows[space]; ++row)
                    for (int x = 0; x < s.grid.nx; ++x, ++p) {
                        if (!inSpace(s.grid.region(x, s.yBegin[space] + row), int(space))) continue;
                        scalar[space == 0 ? kH2 : kO2](double(gas[0][p]));
                        scalar[kH2O](double(gas[1][p]));
                        scalar[kPressure](double(gas[2][p]));
                        double square = 0;
                        for (std::size_t axis = 0; axis < 3; ++axis) {
                            velocity[axis](double(gas[3 + axis][p]));
                            square += double(gas[3 + axis][p]) * double(gas[3 + axis][p]);
                        }
                        velocity[3](std::sqrt(square));
                    }
        }
    }
    for (std::size_t index : {kO2, kH2, kH2O, kPressure, kTemperature})
        parameters[index].ranges = {scalar[index].range};
    for (const Widen& component : velocity) parameters[kVelocity].ranges.push_back(component.range);
}

} // namespace

FuelCellSettings fuelCellSettings(const std::map<std::string, double>& given) {
    return settingsFrom<FuelCellSettings>(given, "fuel-cell");
}

Dataset makeFuelCell(const std::map<std::string, double>& given, const Progress& progress) {
    const FuelCellSettings shown = fuelCellSettings(given);
    // Larger axes are interpolated from this: memory and time of the factorisation grow with the fourth power of a
    // side.
    FuelCellSettings solved = shown;
    solved.nx = std::min(shown.nx, 44), solved.ny = std::min(shown.ny, 65), solved.nz = std::min(shown.nz, 256);

    auto solution = std::make_shared<Solution>();
    solution->grid = CellGrid(solved);
    solution->shown = CellGrid(shown);
    const CellGrid& g = solution->shown;
    solution->lattice = latticeOf(g, shown.even);
    solution->fuel = makeMask(g, true, false);
    solution->air = makeMask(g, false, true);
    solution->gases = makeMask(g, true, true);

    FuelCellSolver solver(solved);
    solution->yBegin = {solver.fuel().yBegin, solver.air().yBegin};
    solution->rows = {solver.fuel().rows, solver.air().rows};
    solution->frames = given.empty() ? solvedOnce(solver, solved, progress) : solveAll(solver, solved, progress);
    std::vector<double> times;
    for (int time = 0; time < shown.times; ++time) times.push_back(time * shown.interval);

    Dataset dataset;
    DatasetInfo& info = dataset.info;
    info.name = "fuel-cell";
    info.lattice = solution->lattice;
    info.bounds = gridBounds(info.lattice);
    info.parameters = describeParameters(shown.even);
    fillRanges(*solution, info.parameters);
    checkRanges(info.parameters);
    info.times = times;
    std::ostringstream text;
    text << "built-in PEM fuel cell, " << solved.nx << " x " << solved.ny << " x " << solved.nz << " volumes solved; "
         << shown.voltageBefore << " V, after " << shown.stepTime << " s " << shown.voltageAfter << " V";
    info.provenance = text.str();
    dataset.read = [solution](int parameter, int component, int time) {
        return loadField(*solution, parameter, component, time);
    };
    progress.advance(1);
    return dataset;
}

} // namespace tessera::volume
