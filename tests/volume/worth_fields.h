#pragma once

#include "tests/volume/fields.h"
#include "volume/flow/flow_channels.h"
#include "volume/worth/worth_seeing.h"

#include <cmath>
#include <random>
#include <vector>

/// Fields of noise, and searches in them.
namespace tessera::volume::test {

/// Normal noise, smoothed by a Gaussian of `sigma` samples; deviation 1.
inline Field smoothNoise(glm::ivec3 size, double sigma, unsigned seed) {
    Field field = makeField(ccLattice(size), ScalarType::F32);
    const auto out = field.as<float>();
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::vector<double> values(out.size());
    for (double& value : values) value = normal(random);
    const int reach = int(std::ceil(3 * sigma));
    for (int axis = 0; axis < 3 && sigma > 0; ++axis) {
        const std::vector<double> before = values;
        for (std::size_t i = 0; i < values.size(); ++i) {
            const glm::ivec3 at(int(i) % size.x, int(i) / size.x % size.y, int(i) / (size.x * size.y));
            double sum = 0, squares = 0;
            for (int d = -reach; d <= reach; ++d) {
                glm::ivec3 beside = at;
                beside[axis] += d;
                if (beside[axis] < 0 || beside[axis] >= size[axis]) continue;
                const double weight = std::exp(-d * d / (2 * sigma * sigma));
                sum += weight * before[field.lattice.index(beside)];
                squares += weight * weight;
            }
            values[i] = sum / std::sqrt(squares);
        }
    }
    for (std::size_t i = 0; i < values.size(); ++i) out[i] = float(values[i]);
    return field;
}

/// A search in all scalars and magnitudes, at the last time.
inline WorthQuery queryOf(const BrickSource& source, WorthSearch search = WorthSearch::Views) {
    const DatasetInfo& info = source.info();
    WorthQuery query;
    query.search = search;
    const std::vector<Channel> channels = info.channels();
    for (std::size_t c = 0; c < channels.size(); ++c) {
        const Parameter& parameter = info.parameters[std::size_t(channels[c].parameter)];
        if (!parameter.categorical && (parameter.components == 1 || channels[c].magnitude))
            query.channels.push_back(int(c));
    }
    query.label = labelChannel(info).value_or(-1);
    query.time = search == WorthSearch::When ? 0 : int(info.times.size()) - 1;
    return query;
}

} // namespace tessera::volume::test
