#pragma once

#include "tests/volume/fields.h"

#include <glm/geometric.hpp>

/// Data of two regions for tests: what each holds by itself, and the border between them.
namespace tessera::volume::test {

/// Two regions, 1 and 3, on either side of an oblique plane that moves with time.
struct TwoRegions {
    glm::dvec3 normal{1, 0.4, -0.3};
    double place = 7, speed = 0;
    int at(glm::dvec3 p, double time = 0) const { return glm::dot(normal, p) < place + speed * time ? 1 : 3; }
};

/// What a region holds: constants 1 and 2, or linear functions that lie far apart.
inline double constantIn(int region, glm::dvec3) {
    return region == 1 ? 1 : 2;
}
inline double linearIn(int region, glm::dvec3 p) {
    return region == 1 ? 3 + 0.2 * p.x - 0.15 * p.y + 0.1 * p.z : 60 - 0.3 * p.x + 0.1 * p.y + 0.2 * p.z;
}

/// A parameter "v" of two parts and the label "region".
template <class Value>
Dataset twoRegions(const Lattice& lattice, const Value& value, const TwoRegions& regions = {}, int times = 1) {
    std::vector<Field> fields;
    for (int t = 0; t < times; ++t)
        fields.push_back(sampled<float>(lattice, [&](glm::dvec3 p) { return value(regions.at(p, t), p); }));
    for (int t = 0; t < times; ++t)
        fields.push_back(sampled<std::uint8_t>(lattice, [&](glm::dvec3 p) { return regions.at(p, t); }));
    Dataset dataset = datasetOf(std::move(fields), std::size_t(times));
    dataset.info.parameters[0].name = "v";
    dataset.info.parameters[0].parts = {"region", {{1}, {3}}};
    dataset.info.parameters[1].name = "region";
    dataset.info.parameters[1].categorical = true;
    return dataset;
}

/// The same with v as the components of a vector "U".
inline Dataset asVector(Dataset dataset) {
    dataset.info.parameters[0].name = "U";
    dataset.info.parameters[0].components = 3;
    dataset.read = [read = dataset.read](int parameter, int, int time) { return read(parameter, 0, time); };
    return dataset;
}

} // namespace tessera::volume::test
