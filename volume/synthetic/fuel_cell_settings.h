#pragma once

#include "volume/base/describe.h"

#include <cstdint>

namespace tessera::volume {

/// Settings of the built-in fuel cell: a straight channel of a low-temperature PEM cell (353 K, one gas phase),
/// hydrogen and air in counter-flow. x lateral, y through-plane (anode below, cathode above), z along the air flow.
/// Each layer through the plane has cells of its own height, unless `even`.
/// docs/fuel-cell-model.md has the equations and the source of every number.
struct FuelCellSettings {
    int nx = 11, ny = 13, nz = 101;
    bool even = false;
    int times = 24;
    double interval = 0.03;
    double stepTime = 0.15;
    double voltageBefore = 0.75;
    double voltageAfter = 0.55;
    double airStoichiometry = 2.0;
    double hydrogenStoichiometry = 1.5;
    double ratedCurrent = 8.0e3;
    double airHumidity = 0.3;
    double fuelHumidity = 0.5;
    double coolantTemperature = 353.15;
    double inletTemperature = 353.15;
    double outletPressure = 101325;
    double dragFactor = 1;
    double backDiffusionFactor = 1;
    bool operator==(const FuelCellSettings&) const = default;

    static void describe(auto& self, auto&& visit) {
        visit(self.nx, {.key = "nx", .doc = "Samples across the channel", .range = Range{3, 250}});
        visit(self.ny, {.key = "ny", .doc = "Samples through the layers", .range = Range{5, 250}});
        visit(self.nz, {.key = "nz", .doc = "Samples along the flow", .range = Range{4, 1000}});
        visit(self.even, {.key = "even",
                          .doc = "1: cells of one height, so that the membrane and both catalyst layers are one layer "
                                 "of 100 um",
                          .range = Range{0, 1}});
        visit(self.times, {.key = "times", .doc = "Number of times stored", .range = Range{1, 10000}});
        visit(self.interval,
              {.key = "interval", .doc = "Time between two stored times", .unit = "s", .range = Range{1e-5, 1e4}});
        visit(self.stepTime, {.key = "stepTime",
                              .doc = "Time at which the cell voltage falls; the cell is steady before",
                              .unit = "s",
                              .range = Range{0, 1e8}});
        visit(self.voltageBefore, {.key = "voltageBefore",
                                   .doc = "Cell voltage before the load step",
                                   .unit = "V",
                                   .range = Range{0.4, 1.0}});
        visit(
            self.voltageAfter,
            {.key = "voltageAfter", .doc = "Cell voltage after the load step", .unit = "V", .range = Range{0.4, 1.0}});
        visit(self.airStoichiometry, {.key = "airStoichiometry",
                                      .doc = "Oxygen fed / oxygen consumed at the rated current",
                                      .range = Range{1.5, 20}});
        visit(self.hydrogenStoichiometry, {.key = "hydrogenStoichiometry",
                                           .doc = "Hydrogen fed / hydrogen consumed at the rated current",
                                           .range = Range{1.2, 20}});
        visit(self.ratedCurrent, {.key = "ratedCurrent",
                                  .doc = "Current density for which the gas flows are chosen",
                                  .unit = "A/m2",
                                  .range = Range{1e3, 3e4}});
        visit(self.airHumidity, {.key = "airHumidity",
                                 .doc = "Relative humidity of the air at coolant temperature",
                                 .range = Range{0.05, 0.9}});
        visit(self.fuelHumidity, {.key = "fuelHumidity",
                                  .doc = "Relative humidity of the hydrogen at coolant temperature",
                                  .range = Range{0.05, 0.9}});
        visit(self.coolantTemperature, {.key = "coolantTemperature",
                                        .doc = "Temperature of the cooled plates behind the lands",
                                        .unit = "K",
                                        .range = Range{323.15, 363.15}});
        visit(self.inletTemperature, {.key = "inletTemperature",
                                      .doc = "Temperature of both gases at their inlets",
                                      .unit = "K",
                                      .range = Range{303.15, 363.15}});
        visit(self.outletPressure,
              {.key = "outletPressure", .doc = "Pressure at both outlets", .unit = "Pa", .range = Range{9e4, 3e5}});
        visit(self.dragFactor, {.key = "dragFactor",
                                .doc = "Factor on the electro-osmotic drag of water; 0 = none",
                                .range = Range{0, 2}});
        visit(self.backDiffusionFactor, {.key = "backDiffusionFactor",
                                         .doc = "Factor on the diffusion of water through the membrane; 0 = none",
                                         .range = Range{0, 4}});
    }
};

/// Values of the labels of "region".
enum class CellRegion : std::uint8_t {
    Land,
    AnodeChannel,
    AnodeGdl,
    Membrane, ///< of the even cell with both catalyst layers
    CathodeGdl,
    CathodeChannel,
    AnodeCatalyst,
    CathodeCatalyst
};

} // namespace tessera::volume
