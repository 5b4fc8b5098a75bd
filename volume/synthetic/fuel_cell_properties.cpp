#include "volume/synthetic/fuel_cell_properties.h"

#include <algorithm>
#include <cmath>

namespace tessera::volume::cell {

namespace {
constexpr double kAtmosphere = 101325; // Pa
}

double fibreDiffusibility(double porosity, bool inPlane) {
    return porosity * std::pow((porosity - 0.11) / 0.89, inPlane ? 0.521 : 0.785);
}

double saturationPressure(double temperature) {
    const double t = temperature - 273.15;
    return kAtmosphere * std::pow(10.0, -2.1794 + 0.02953 * t - 9.1837e-5 * t * t + 1.4454e-7 * t * t * t);
}

double waterContent(double a) {
    if (a > 1) return 14 + 1.4 * (std::min(a, 3.0) - 1);
    a = std::max(a, 0.0);
    return 0.043 + a * (17.81 + a * (-39.85 + a * 36.0));
}

double waterContentSlope(double a) {
    if (a > 1) return a < 3 ? 1.4 : 0.0;
    a = std::max(a, 0.0);
    return 17.81 + a * (-79.7 + a * 108.0);
}

double protonConductivity(double content, double temperature) {
    const double at30 = 0.5139 * std::max(content, 1.0) - 0.326; // S/m
    return at30 * std::exp(1268.0 * (1 / 303.0 - 1 / temperature));
}

double membraneWaterDiffusion(double content, double temperature) {
    const double l = std::clamp(content, 4.0, 16.8);
    return 1e-10 * std::exp(2416.0 * (1 / 303.0 - 1 / temperature)) *
           (2.563 + l * (-0.33 + l * (0.0264 - l * 0.000671)));
}

double dragCoefficient(double content) {
    return 2.5 * content / 22;
}

double reversibleVoltage(double temperature, double hydrogen, double oxygen) {
    return 1.229 - 0.846e-3 * (temperature - 298.15) +
           kGas * temperature / (2 * kFaraday) *
               std::log(std::max(hydrogen, 1e-3) / kAtmosphere * std::sqrt(std::max(oxygen, 1e-3) / kAtmosphere));
}

double localCurrent(double voltage, double temperature, double hydrogen, double oxygen, double conductance,
                    double resistance) {
    const double limit = 4 * kFaraday * conductance * oxygen;
    if (limit <= 0) return 0;
    const double rt = kGas * temperature;
    const double exchange = kExchangeCurrent * kRoughness *
                            std::exp(-kActivationEnergy / kGas * (1 / temperature - 1 / kReferenceTemperature));
    const double slope = rt / (kTransferCoefficient * kFaraday);
    // What is left of the voltage at current i; falls monotonously, so that Newton with a bracket cannot fail.
    const auto left = [&](double i) {
        const double pressure = std::max(oxygen * (1 - i / limit), 1e-12) * rt;
        const double loss = slope * std::log(i / (exchange * std::pow(pressure / kAtmosphere, kOxygenOrder)));
        return reversibleVoltage(temperature, hydrogen * rt, pressure) - voltage - loss - i * resistance;
    };
    double lo = 1e-9 * limit, hi = limit;
    if (left(lo) <= 0) return 0;
    double i = std::min(0.5 * limit, 1e4);
    for (int step = 0; step < 60; ++step) {
        const double value = left(i);
        (value > 0 ? lo : hi) = i;
        const double remaining = 1 - i / limit;
        const double derivative = -slope / i - resistance -
                                  (slope * kOxygenOrder + rt / (4 * kFaraday)) / (limit * std::max(remaining, 1e-9));
        double next = i - value / derivative;
        if (!(next > lo && next < hi)) next = 0.5 * (lo + hi);
        if (std::abs(next - i) <= 1e-10 * i) return next;
        i = next;
    }
    return i;
}

double localCurrentSlope(double i, double temperature, double oxygen, double conductance, double resistance) {
    const double limit = 4 * kFaraday * conductance * oxygen;
    if (i <= 0 || limit <= 0) return 0;
    const double rt = kGas * temperature, slope = rt / (kTransferCoefficient * kFaraday);
    const double sensitivity = slope * kOxygenOrder + rt / (4 * kFaraday); // V per relative change of the oxygen
    const double remaining = std::max(1 - i / limit, 1e-9);
    const double perOxygen = sensitivity / (oxygen * remaining);
    const double perCurrent = slope / i + resistance + sensitivity / (limit * remaining);
    return std::min(perOxygen / perCurrent, i / oxygen);
}

} // namespace tessera::volume::cell
