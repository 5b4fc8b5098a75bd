#pragma once

#include "volume/base/progress.h"
#include "volume/synthetic/fuel_cell_settings.h"
#include "volume/synthetic/plane_solver.h"

#include <array>
#include <cstdint>
#include <vector>

/// The equations of the built-in fuel cell on a box of finite volumes, one per sample.
///
///      y ^   +----+--------+----+
///        |   |land|        |land|   cathode channel (air flows to +z)
///        |   +----+--------+----+
///        |   |                  |   cathode gas-diffusion layer
///        |   +------------------+   cathode catalyst layer
///        |   +------------------+   membrane
///        |   +------------------+   anode catalyst layer
///        |   |                  |   anode gas-diffusion layer
///        |   +----+--------+----+
///        |   |land|        |land|   anode channel (hydrogen flows to -z)
///        |   +----+--------+----+
///        +-----------------------> x
namespace tessera::volume::cell {

/// Which cells belong to what: columns across x and rows through y.
struct CellGrid {
    int nx = 0, ny = 0, nz = 0;
    double dx = 0, dz = 0;                ///< m
    std::vector<double> height;           ///< of each row, m
    int channelBegin = 0, channelEnd = 0; ///< columns of the channels
    /// First row of: anode channel, GDL and catalyst layer; membrane; cathode catalyst layer, GDL and channel; then ny.
    /// Of an even cell the catalyst layers have no rows of their own.
    std::array<int, 8> rows{};

    CellGrid() = default;
    /// Each layer gets at least one row. Throws Error if there are fewer rows than layers.
    explicit CellGrid(const FuelCellSettings& settings);
    CellRegion region(int x, int y) const;
    /// The planes between the rows, m; one more than rows.
    std::vector<double> planes() const;
    /// The middle of each row, m.
    std::vector<double> middles() const;
};

/// One gas space: channel, gas-diffusion layer and catalyst layer of one electrode, `rows` rows from `yBegin`. Arrays
/// of cells are nx * rows * nz, x fastest; of columns nx * nz; of a cross-section nx * rows.
struct GasSpace {
    bool air = false; ///< else hydrogen
    int yBegin = 0, rows = 0;
    std::vector<std::uint8_t> kind;   ///< cross-section: 0 land, 1 channel, 2 gas-diffusion layer, 3 catalyst layer
    std::vector<double> permeability; ///< cross-section, m2: of the layer, or duct profile of the channel
    double inletReactant = 0, inletWater = 0; ///< mol/m3
    std::vector<double> pressure;             ///< cells, Pa above the outlet
    std::vector<double> reactant, water;      ///< cells, mol/m3: O2 or H2, and H2O
    /// Volume fluxes (m3/s) of the molar-average velocity through the faces of a cell to x+1, y+1 and z+1.
    std::vector<double> fluxX, fluxY, fluxZ;
    std::vector<double> inlet, outlet; ///< cross-section, volume fluxes into and out of the gas space
    std::vector<double> wall;          ///< columns, volume flux from the catalyst into the gas space

    /// The row next to the membrane, at whose far face the reaction is.
    int wallRow() const { return air ? 0 : rows - 1; }
    /// Volume (m3) of gas in a cell of the cross-section.
    double gasVolume(const CellGrid& grid, std::size_t section) const;
    /// The sum of volume fluxes out of a cell; 0 but for the tolerance of the pressure solver.
    double divergence(const CellGrid& grid, int x, int row, int z) const;
    /// Velocity (m/s) at the centre of a cell: means of its faces.
    std::array<double, 3> velocity(const CellGrid& grid, int x, int row, int z) const;
};

/// Molar rates (mol/s) of a gas space, for balances.
struct Balance {
    double reactantIn = 0, reactantOut = 0, reactantUsed = 0, reactantStored = 0;
    double waterIn = 0, waterOut = 0, waterReleased = 0, waterStored = 0;
};

class FuelCellSolver {
public:
    /// Solves on settings.nx * ny * nz cells; starts without current, filled with inlet gas.
    explicit FuelCellSolver(const FuelCellSettings& settings);

    /// Goes to the steady state at this cell voltage (V). Throws Cancelled.
    void settle(double voltage, const Progress& progress = {});
    /// One implicit Euler step of `dt` seconds at this cell voltage; stable at any dt. Throws Cancelled.
    void step(double dt, double voltage, const Progress& progress = {});

    const FuelCellSettings& settings() const { return settings_; }
    const CellGrid& grid() const { return grid_; }
    const GasSpace& fuel() const { return spaces_[0]; }
    const GasSpace& air() const { return spaces_[1]; }
    const std::vector<double>& temperature() const { return temperature_; } ///< K, all cells
    const std::vector<double>& current() const { return current_; }         ///< A/m2, columns nx * nz
    const std::vector<double>& resistance() const { return resistance_; }   ///< Ohm m2, columns
    double totalCurrent() const;                                            ///< A
    double meanCurrent() const;                                             ///< A/m2
    /// Rates of the last step (stored: 0 after settle) of 0 the fuel or 1 the air side.
    Balance balance(int space) const;

private:
    struct SpeciesSystem {
        StencilSystem system;
        PlanePreconditioner preconditioner;
    };

    /// Molar rate from the catalyst into a gas space by column, as constant - factor * concentration, mol/(m2 s).
    struct WallRate {
        std::vector<double> constant, factor;
    };

    void setUpSpace(int space);
    bool advance(double rate, double voltage, int maxIterations, double tolerance, const Progress& progress);
    void updateCurrent(double voltage);
    void solveFlow(int space);
    void solveSpecies(int space, bool water, double rate, const std::vector<double>& before, bool refresh);
    /// The rate given at the catalyst, added to the equations of a species: for oxygen the tangent of the current
    /// (Newton's method), for water the answer of the membrane; any other loss as proportional to the concentration,
    /// which keeps it positive.
    WallRate wallRate(int space, bool water, const std::vector<double>& concentration, StencilSystem& equations) const;
    /// Heat carried by the gas, upwind, in the form that needs no balance of moles: each cell takes what flows in.
    void carryHeat(const GasSpace& space, double gasCapacity);
    void solveHeat(double voltage, double rate, const std::vector<double>& before, bool refresh);
    double diffusion(const GasSpace& space, bool water, std::size_t section, bool inPlane) const;
    /// Heat made in a column (W/m2), in the membrane and in the cathode's catalyst layer.
    std::array<double, 2> heatOf(std::size_t column, double voltage) const;

    FuelCellSettings settings_;
    CellGrid grid_;
    double concentration_ = 0; // mol/m3 of the gas, p / RT at outlet pressure and coolant temperature
    std::array<GasSpace, 2> spaces_;
    std::array<StencilSystem, 2> flow_;
    std::array<PlanePreconditioner, 2> flowPreconditioner_;
    std::array<SpeciesSystem, 4> species_; // fuel reactant, fuel water, air reactant, air water
    StencilSystem heat_;
    PlanePreconditioner heatPreconditioner_;
    double heatRate_ = -1; // 1 / time step of the last advance
    std::vector<double> temperature_, current_, resistance_;
    std::vector<double> currentSlope_; // columns, A m/mol: change of the current with the oxygen next to the catalyst
    std::vector<double> waterFlux_;    // columns, mol/(m2 s), anode to cathode
    std::array<std::vector<double>, 2> waterSlope_; // columns, m/s: change of the water flux with the concentration
    std::array<std::vector<double>, 2> reactantRate_,
        waterRate_; // columns: what the last species solve used, mol/(m2 s)
    std::array<Balance, 2> stored_;
    int iterations_ = 0;
};

} // namespace tessera::volume::cell
