#include "volume/synthetic/marschner_lobb.h"

#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/synthetic/settings.h"

#include <cmath>
#include <numbers>

namespace tessera::volume {

namespace {

constexpr double kPi = std::numbers::pi;

Field sampleField(const Lattice& lattice, ScalarType type, const MarschnerLobb& signal, double phase) {
    Field field = makeField(lattice, type);
    double steps = 0; // largest integer code; 0 for floats
    if (type != ScalarType::F32) {
        steps = type == ScalarType::U8 ? 255 : 65535;
        field.scale = 1 / steps;
    }
    dispatch(type, [&]<class T>(T) {
        const auto samples = field.as<T>();
        parallelFor(std::size_t(lattice.size.z), [&](std::size_t k) {
            std::size_t to = lattice.index({0, 0, int(k)});
            for (int j = 0; j < lattice.size.y; ++j)
                for (int i = 0; i < lattice.size.x; ++i, ++to) {
                    const double value = signal(lattice.position({i, j, int(k)}), phase);
                    samples[to] = steps > 0 ? T(std::lround(value * steps)) : T(value);
                }
        });
    });
    return field;
}

} // namespace

double MarschnerLobb::operator()(glm::dvec3 p, double phase) const {
    const double r = std::sqrt(p.x * p.x + p.y * p.y);
    const double rings = std::cos(2 * kPi * (fM * std::cos(kPi * r / 2) + phase));
    return (1 - std::sin(kPi * p.z / 2) + alpha * (1 + rings)) / (2 * (1 + alpha));
}

glm::dvec3 MarschnerLobb::gradient(glm::dvec3 p, double phase) const {
    const double r = std::sqrt(p.x * p.x + p.y * p.y), norm = 1 / (2 * (1 + alpha));
    const double alongZ = -kPi / 2 * std::cos(kPi * p.z / 2) * norm;
    if (r == 0) return {0, 0, alongZ};
    const double ringsByR =
        std::sin(2 * kPi * (fM * std::cos(kPi * r / 2) + phase)) * kPi * kPi * fM * std::sin(kPi * r / 2);
    const double alongR = alpha * ringsByR * norm;
    return {alongR * p.x / r, alongR * p.y / r, alongZ};
}

Dataset makeMarschnerLobb(const std::map<std::string, double>& given) {
    const auto settings = settingsFrom<MarschnerLobbSettings>(given, "marschner-lobb");
    const int bits = settings.bits;
    if (bits != 8 && bits != 16 && bits != 32) throw Error("must be 8, 16 or 32", "marschner-lobb", "bits");
    const MarschnerLobb signal{settings.alpha, settings.fM};
    Lattice lattice;
    lattice.size = {settings.nx, settings.ny, settings.nz};
    lattice.origin = glm::dvec3(-1);
    lattice.spacing = 2.0 / glm::dvec3(lattice.size - 1);

    Dataset dataset;
    DatasetInfo& info = dataset.info;
    info.name = "marschner-lobb";
    info.lattice = lattice;
    info.bounds = {glm::dvec3(-1), glm::dvec3(1)};
    info.lengthUnit.clear(); // the signal has no length unit
    info.timeUnit.clear();
    Parameter rho;
    rho.name = "rho";
    rho.type = bits == 8 ? ScalarType::U8 : bits == 16 ? ScalarType::U16 : ScalarType::F32;
    rho.ranges = {{0, 1}};
    info.parameters = {rho};
    info.times.clear();
    for (int t = 0; t < settings.times; ++t) info.times.push_back(double(t) / settings.times);
    info.provenance = "Marschner and Lobb's test signal, Vis 1994";
    dataset.read = [lattice, type = rho.type, signal, phases = info.times](int, int, int time) {
        return sampleField(lattice, type, signal, phases[std::size_t(time)]);
    };
    return dataset;
}

} // namespace tessera::volume
