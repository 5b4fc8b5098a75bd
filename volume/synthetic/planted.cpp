#include "volume/synthetic/planted.h"

#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/synthetic/fuel_cell.h"

#include <algorithm>
#include <cmath>

namespace tessera::volume {

namespace planted {

bool inside(const Box& box, glm::dvec3 at) {
    for (int axis = 0; axis < 3; ++axis)
        if (at[axis] < box.lo[axis] || at[axis] > box.hi[axis]) return false;
    return true;
}

namespace {

/// The value of a parameter with the events at a position and time; `value` is that without them.
double changed(const std::string& name, glm::dvec3 at, double time, double value) {
    if (name == "O2") {
        if (inside(kFlooded, at)) return value * kFloodedOxygen;
        if (inside(kStarved, at)) return kStarvedOxygen;
    } else if (name == "H2O") {
        if (inside(kFlooded, at)) return kFloodedWater;
    } else if (name == "T") {
        const glm::dvec3 away = (at - kHotSpot) / kHotSpotSigma;
        return value + kHotSpotRise * std::exp(-(away.x * away.x + away.y * away.y + away.z * away.z) / 2);
    } else if (name == "H2") {
        if (time < kPulseOnset - 1e-9) return value;
        const double away = (at.z - (kPulseStart - kPulseSpeed * (time - kPulseOnset))) / kPulseSigma;
        return value + kPulseHeight * std::exp(-away * away / 2);
    } else if (name == "p") {
        if (at.z >= kSlabBegin && at.z <= kSlabEnd) return value * kSlabFactor;
    }
    return value;
}

} // namespace
} // namespace planted

Dataset makePlanted(const std::map<std::string, double>& given, const Progress& progress) {
    std::map<std::string, double> settings = given;
    settings.insert({"even", 1}); // the places of the events are in this cell
    if (settings.at("even") != 1) throw Error("the events have their places in the even cell", "planted", "even");
    Dataset dataset = makeFuelCell(settings, progress.part(0, 0.9));
    dataset.info.name = "planted";
    dataset.info.provenance += "; with planted events";
    dataset.read = [plain = dataset.read, info = dataset.info](int parameter, int component, int time) {
        Field field = plain(parameter, component, time);
        const std::string& name = info.parameters[std::size_t(parameter)].name;
        if (name == "U" || name == "region") return field;
        const std::span<float> values = field.as<float>();
        const glm::ivec3 size = field.lattice.size;
        const double now = info.times[std::size_t(time)];
        parallelFor(std::size_t(size.z), [&](std::size_t z) {
            for (int y = 0; y < size.y; ++y)
                for (int x = 0; x < size.x; ++x) {
                    const glm::ivec3 at(x, y, int(z));
                    const std::size_t i = field.lattice.index(at);
                    if (!field.present(i)) continue;
                    values[i] = float(planted::changed(name, field.lattice.position(at), now, double(values[i])));
                }
        });
        return field;
    };
    for (std::size_t p = 0; p < dataset.info.parameters.size(); ++p) {
        Parameter& parameter = dataset.info.parameters[p];
        if (parameter.components > 1 || parameter.categorical) continue;
        Range range{1e300, -1e300};
        for (std::size_t time = 0; time < dataset.info.times.size(); ++time) {
            const Field field = dataset.read(int(p), 0, int(time));
            const auto values = field.as<float>();
            for (std::size_t i = 0; i < values.size(); ++i)
                if (field.present(i))
                    range = {std::min(range.lo, double(values[i])), std::max(range.hi, double(values[i]))};
        }
        parameter.ranges = {range};
        progress.advance(0.9 + 0.1 * double(p + 1) / double(dataset.info.parameters.size()), parameter.name);
    }
    progress.advance(1);
    return dataset;
}

} // namespace tessera::volume
