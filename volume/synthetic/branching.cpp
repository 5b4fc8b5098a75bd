#include "volume/synthetic/branching.h"

#include "volume/base/parallel.h"
#include "volume/synthetic/settings.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <memory>

namespace tessera::volume {

namespace {

/// A place in the pipe: how far along it, and how far from its axis.
struct PipePlace {
    double along = 0, away = 0;
};

PipePlace onTrunk(glm::dvec3 p) {
    const glm::dvec3 middle = Branching::kBox * 0.5;
    const double x = glm::min(p.x, Branching::kBranchAt);
    return {x, glm::distance(p, glm::dvec3(x, middle.y, middle.z))};
}

PipePlace onArm(glm::dvec3 p, double side) {
    const glm::dvec3 from(Branching::kBranchAt, Branching::kBox.y / 2, Branching::kBox.z / 2);
    const glm::dvec3 way = glm::normalize(glm::dvec3(1, side * Branching::kSlope, 0));
    const double along = glm::max(0.0, glm::dot(p - from, way));
    return {Branching::kBranchAt + along, glm::distance(p, from + way * along)};
}

constexpr double kUp = 1, kDown = -1; // sides

double pulse(double along, double middle, double peak) {
    const double away = (along - middle) / Branching::kSigma;
    return peak * std::exp(-0.5 * away * away);
}

} // namespace

bool Branching::inside(glm::dvec3 p) {
    return glm::min(onTrunk(p).away, glm::min(onArm(p, kUp).away, onArm(p, kDown).away)) <= kRadius;
}

double Branching::arrival(double along, bool slow) {
    const double beyond = glm::max(0.0, along - kBranchAt);
    return glm::min(along, kBranchAt) / kSpeed + beyond / (slow ? kSlowSpeed : kSpeed);
}

double Branching::tracer(glm::dvec3 p, double time) {
    const auto middle = [&](bool slow) { // of the pulse of an arm, along the pipe
        const double beyond = glm::max(0.0, time - kBranchAt / kSpeed);
        return glm::min(kSpeed * time, kBranchAt) + beyond * (slow ? kSlowSpeed : kSpeed);
    };
    const PipePlace trunk = onTrunk(p);
    const bool slow = p.y < kBox.y / 2;
    const PipePlace arm = onArm(p, slow ? kDown : kUp);
    if (trunk.away > arm.away) return pulse(arm.along, middle(slow), kPeak / 2);
    return pulse(trunk.along, middle(false), kPeak / 2) + pulse(trunk.along, middle(true), kPeak / 2);
}

Dataset makeBranching(const std::map<std::string, double>& given) {
    const auto settings = settingsFrom<BranchingSettings>(given, "branching-pulse");
    Dataset dataset;
    DatasetInfo& info = dataset.info;
    info.name = "branching-pulse";
    info.lattice.size = {settings.nx, settings.ny, settings.nz};
    info.lattice.spacing = Branching::kBox / glm::dvec3(info.lattice.size - 1);
    info.bounds = {glm::dvec3(0), Branching::kBox};
    Parameter concentration, temperature;
    concentration.name = "tracer";
    concentration.unit = "mol/m3";
    temperature.name = "T";
    temperature.unit = "K";
    info.parameters = {temperature, concentration};
    info.times.clear();
    for (int t = 0; t < settings.times; ++t)
        info.times.push_back(Branching::kDuration * double(t) / double(settings.times - 1));
    info.provenance = "a computed pulse in a pipe that branches";
    auto mask = std::make_shared<Mask>(info.lattice.count());
    for (std::size_t at = 0; at < mask->size(); ++at) {
        const auto x = std::size_t(settings.nx), y = std::size_t(settings.ny);
        const glm::ivec3 index(int(at % x), int(at / x % y), int(at / (x * y)));
        (*mask)[at] = Branching::inside(info.lattice.position(index)) ? 1 : 0;
    }
    dataset.read = [lattice = info.lattice, times = info.times, mask](int parameter, int, int time) {
        Field field = makeField(lattice, ScalarType::F32);
        field.mask = mask;
        const auto samples = field.as<float>();
        parallelFor(std::size_t(lattice.size.z), [&](std::size_t k) {
            std::size_t to = lattice.index({0, 0, int(k)});
            for (int j = 0; j < lattice.size.y; ++j)
                for (int i = 0; i < lattice.size.x; ++i, ++to) {
                    if (!field.present(to)) continue;
                    const glm::dvec3 at = lattice.position({i, j, int(k)});
                    const double tracer = Branching::tracer(at, times[std::size_t(time)]);
                    samples[to] = float(parameter == 1 ? tracer : 293 + 20 * at.x / Branching::kBox.x + 2 * tracer);
                }
        });
        return field;
    };
    for (int parameter = 0; parameter < 2; ++parameter) {
        Range range{1e300, -1e300};
        for (int time = 0; time < settings.times; ++time) {
            const Field field = dataset.read(parameter, 0, time);
            for (std::size_t at = 0; at < field.lattice.count(); ++at)
                if (field.present(at))
                    range = {std::min(range.lo, field.value(at)), std::max(range.hi, field.value(at))};
        }
        info.parameters[std::size_t(parameter)].ranges = {range};
    }
    return dataset;
}

} // namespace tessera::volume
