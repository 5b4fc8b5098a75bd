#pragma once

/// Constants and correlations of the fuel-cell model. SI units throughout.
namespace tessera::volume::cell {

inline constexpr double kFaraday = 96485.33212;         // C/mol
inline constexpr double kGas = 8.314462618;             // J/(mol K)
inline constexpr double kReferenceTemperature = 353.15; // K, of the transport properties

// Geometry.
inline constexpr double kLength = 40e-3;         // m, along the flow
inline constexpr double kLandWidth = 0.6e-3;     // m, each side (half a rib)
inline constexpr double kChannelWidth = 1.0e-3;  // m
inline constexpr double kChannelHeight = 0.4e-3; // m
inline constexpr double kGdlThickness = 0.2e-3;  // m, e.g. compressed carbon paper
inline constexpr double kCatalystThickness = 10e-6;
inline constexpr double kMembraneThickness = 51e-6; // m, Nafion 212
/// Of the even cell, membrane and both catalyst layers: at 13 samples through the plane a cell is 100 um, so that the
/// gas-diffusion layers take two, this one, and the channels four.
inline constexpr double kMeaThickness = 0.1e-3;

/// Gas-diffusion layer (carbon paper). Porosity and permeability: Gostick et al., J. Power Sources 162 (2006) 228.
inline constexpr double kPorosity = 0.7;
inline constexpr double kPermeability = 5e-12; // m2
/// D_eff / D of random fibres across and along the sheet: Tomadakis and Sotirchos, AIChE J. 39 (1993) 397,
/// porosity ((porosity - 0.11) / 0.89)^a with a = 0.785 through the plane and 0.521 in it.
double fibreDiffusibility(double porosity, bool inPlane);
/// Catalyst layers: D_eff / D is porosity^1.5 (Bruggeman); porosity and permeability are assumed.
inline constexpr double kCatalystPorosity = 0.4;
inline constexpr double kCatalystPermeability = 1e-13; // m2

/// Binary diffusion coefficients (m2/s at 1 atm) from the tables of Cussler, Diffusion (3rd ed.), chapter 5, carried to
/// 353 K with T^1.75 (Fuller et al., Ind. Eng. Chem. 58 (1966) 18).
inline constexpr double kDiffusionO2 = 2.84e-5;         // in N2, from 0.181 cm2/s at 273 K
inline constexpr double kDiffusionWaterInAir = 3.26e-5; // from 0.256 cm2/s at 307 K
inline constexpr double kDiffusionHydrogen = 1.17e-4;   // H2-H2O, from 0.915 cm2/s at 307 K

inline constexpr double kViscosityAir = 2.0e-5;       // Pa s, moist air at 353 K
inline constexpr double kViscosityHydrogen = 1.1e-5;  // Pa s, moist hydrogen at 353 K
inline constexpr double kGasHeatCapacity = 30.0;      // J/(mol K), near that of each of the gases here
inline constexpr double kConductivityAir = 0.030;     // W/(m K)
inline constexpr double kConductivityHydrogen = 0.15; // W/(m K), moist

/// Saturation pressure of water (Pa): Springer, Zawodzinski, Gottesfeld, J. Electrochem. Soc. 138 (1991) 2334, eq. A-1
/// (log10 of atm, degC).
double saturationPressure(double temperature);

/// Water molecules per sulfonic group of Nafion at water activity a: Springer et al. 1991, eq. 16 (measured at 30
/// degC); above 1 the line 14 + 1.4 (a - 1).
double waterContent(double activity);
double waterContentSlope(double activity);
/// Proton conductivity (S/m): Springer et al. 1991, eq. 23 and 24.
double protonConductivity(double waterContent, double temperature);
/// Diffusion coefficient of water in Nafion (m2/s): Springer et al. 1991, the fit of their figure 6 for contents
/// above 4, held constant below.
double membraneWaterDiffusion(double waterContent, double temperature);
/// Water molecules dragged per proton, 2.5 content / 22: Springer et al. 1991, eq. 19.
double dragCoefficient(double waterContent);
inline constexpr double kSulfonicDensity = 1800;   // mol/m3, dry density 1980 kg/m3 over 1.1 kg/mol
inline constexpr double kContactResistance = 5e-6; // Ohm m2 (50 mOhm cm2), both plates and layers together

/// Oxygen reduction on Pt: exchange current 2.47e-8 A per cm2 Pt at 353 K and 101.3 kPa O2, order 0.54 at constant
/// overpotential, 67 kJ/mol, one transferred charge in the Tafel slope. Neyerlin, Gu, Jorne, Gasteiger, J. Electrochem.
/// Soc. 153 (2006) A1955. Roughness for 0.4 mg/cm2 at 50 m2/g.
inline constexpr double kExchangeCurrent = 2.47e-4; // A/m2 of Pt
inline constexpr double kRoughness = 200;           // m2 of Pt per m2
inline constexpr double kOxygenOrder = 0.54;
inline constexpr double kActivationEnergy = 67e3; // J/mol
inline constexpr double kTransferCoefficient = 1;

/// Reversible voltage at the partial pressures given (Pa): 1.229 V - 0.846 mV/K (T - 298.15 K) + RT/2F ln(p_H2
/// sqrt(p_O2)) in atm. Larminie and Dicks, Fuel Cell Systems Explained, chapter 2; the product is liquid water, as the
/// Tafel constants above assume.
double reversibleVoltage(double temperature, double hydrogen, double oxygen);

/// Current density (A/m2) at which reversible voltage, Tafel law and ohmic loss give the cell voltage.
/// `oxygen` is the concentration in the cell next to the catalyst (mol/m3), `conductance` D / distance to it (m/s).
/// 0 where the voltage is above the reversible one; always below 4 F conductance oxygen.
double localCurrent(double voltage, double temperature, double hydrogen, double oxygen, double conductance,
                    double resistance);
/// Its derivative with respect to `oxygen` at the current found (A m/mol); at most current / oxygen, as the current
/// grows slower than the concentration.
double localCurrentSlope(double current, double temperature, double oxygen, double conductance, double resistance);

/// Voltage that would turn all of the reaction's enthalpy into work, product vapour: 241.8 kJ/mol / 2F.
inline constexpr double kThermalVoltage = 1.253;

/// Heat: thermal conductivities W/(m K) and volumetric heat capacities J/(m3 K). Plates: graphite composite. Layers:
/// Burheim et al., J. Power Sources 196 (2011) 249 through the plane; Sadeghi, Djilali, Bahrami, J. Power Sources 196
/// (2011) 3565 in it; Khandelwal and Mench, J. Power Sources 161 (2006) 1106 for Nafion.
inline constexpr double kConductivityLand = 20, kHeatCapacityLand = 1.6e6;
inline constexpr double kConductivityGdl = 0.4, kConductivityGdlInPlane = 10, kHeatCapacityGdl = 0.5e6;
inline constexpr double kConductivityMembrane = 0.2, kHeatCapacityMembrane = 2e6;
inline constexpr double kConductivityCatalyst = 0.27, kHeatCapacityCatalyst = 1.5e6;
inline constexpr double kCoolantTransfer = 8e3; // W/(m2 K), plate behind the lands and coolant

} // namespace tessera::volume::cell
