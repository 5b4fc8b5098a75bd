#pragma once

#include "volume/base/describe.h"
#include "volume/field/dataset.h"

#include <array>
#include <map>
#include <string>

/// A layered fuel cell whose volumes, integrals and fluxes are known in closed form: test data on axes of uneven
/// spacing.
///
/// Layers along z, from 0: air channel, cathode diffusion layer, cathode catalyst layer, membrane, anode catalyst
/// layer, anode diffusion layer, fuel channel. The cell is kLengthX long along x and kLengthY wide along y. Of each
/// sample the mean over its cell is stored, so the sum of value times volume is the integral, but for the rounding to
/// floats:
///
///     region   1 .. 7, a label
///     T        kAirSide + sum over layers of heatFlux * thickness / conductivity up to z: k dT/dz is heatFlux
///     O2       in the first three layers: kOxygen (1 - kOxygenUsed x / kLengthX), less the drop by the flux
///              current / 4F: (flux / diffusivity) per length in the diffusion and the catalyst layer
///     H2       in the last three layers: kHydrogen (1 - kHydrogenUsed (kLengthX - x) / kLengthX), less the drop by the
///              flux current / 2F from the fuel channel down to the membrane
///     lambda   in the membrane: linear from kWet at its cathode to kDry at its anode
///     phi      in the catalyst layers and the membrane: 0 at the lower end of the cathode catalyst layer, and
///              current / conductivity per length from there
///     U        in the channels, along x: 6 speed s (1 - s), s = 0 .. 1 across the channel; against x in the fuel
///     channel
///
/// Elsewhere a parameter is absent.
namespace tessera::volume {

struct MembraneSettings {
    int nx = 24, ny = 8, nz = 54;
    double current = 1e4, heatFlux = 5e3;
    bool operator==(const MembraneSettings&) const = default;

    static void describe(auto& self, auto&& visit) {
        const Range edge{2, 4096};
        visit(self.nx,
              FieldInfo{.key = "nx", .doc = "Cells along x, the last twice as long as the first", .range = edge});
        visit(self.ny, FieldInfo{.key = "ny", .doc = "Cells along y, all alike", .range = edge});
        visit(self.nz, FieldInfo{.key = "nz", .doc = "Cells along z, through all layers", .range = Range{16, 4096}});
        visit(self.current,
              FieldInfo{.key = "current", .doc = "Current density", .unit = "A/m2", .range = Range{0, 2e4}});
        visit(self.heatFlux, FieldInfo{.key = "heatFlux",
                                       .doc = "Heat that flows against z through all layers",
                                       .unit = "W/m2",
                                       .range = Range{0, 1e5}});
    }
};

class Membrane {
public:
    struct Layer {
        const char* name;
        double thickness;    ///< m
        double conductivity; ///< of heat, W/(m K)
        double diffusivity;  ///< of O2 or H2, m2/s; 0 in the membrane and the channels, which are mixed
        double protons;      ///< conductivity of protons, S/m; 0 where there are none
        double speed;        ///< mean of U along x, m/s
    };
    static constexpr std::array<Layer, 7> kLayers{{{"air channel", 1e-3, 2, 0, 0, 3},
                                                   {"cathode diffusion layer", 200e-6, 0.5, 5e-6, 0, 0},
                                                   {"cathode catalyst layer", 10e-6, 0.27, 1e-6, 2, 0},
                                                   {"membrane", 25e-6, 0.2, 0, 10, 0},
                                                   {"anode catalyst layer", 10e-6, 0.27, 4e-6, 2, 0},
                                                   {"anode diffusion layer", 200e-6, 0.5, 2e-5, 0, 0},
                                                   {"fuel channel", 1e-3, 2, 0, 0, -1}}};
    static constexpr int kMembraneLayer = 3;
    static constexpr double kLengthX = 40e-3, kLengthY = 1e-3, kAirSide = 340, kWet = 14, kDry = 8;
    static constexpr double kOxygen = 7, kOxygenUsed = 0.3, kHydrogen = 30, kHydrogenUsed = 0.2; ///< mol/m3, share
    static constexpr double kFaraday = 96485.33212;                                              ///< C/mol

    explicit Membrane(const MembraneSettings& settings) : settings_(settings) {}

    /// Where a layer begins along z; `begin(7)` is the height of the cell.
    static double begin(int layer);
    /// Borders of the cells along x and z: exactly at the borders of layers. Layers have from 1 cell to what `nz`
    /// allows; cells of diffusion layers grow 1:3 and those of channels 1:10 away from the membrane.
    std::vector<double> planesX() const, planesZ() const;
    /// The layer of each cell along z.
    std::vector<int> layersZ() const;

    /// Means over a cell from z to z + height in one layer; in the middle of the cell x is at `x`. NaN where absent.
    double temperature(int layer, double z, double height) const;
    double oxygen(int layer, double x, double z, double height) const;
    double hydrogen(int layer, double x, double z, double height) const;
    double water(int layer, double z, double height) const;
    double potential(int layer, double z, double height) const;
    double speed(int layer, double z, double height) const;

private:
    std::array<int, 7> cellsOf() const;

    MembraneSettings settings_;
};

/// The cell as a data set: axes of cells along x and z, an even one along y, one time. Throws Error on bad settings.
Dataset makeMembrane(const std::map<std::string, double>& settings);

} // namespace tessera::volume
