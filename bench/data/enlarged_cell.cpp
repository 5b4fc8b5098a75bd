#include "bench/data/enlarged_cell.h"

#include "volume/base/parallel.h"
#include "volume/synthetic/models.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

namespace tessera::app {

namespace {

/// -0.5 .. 0.5, the same for the same sample of the same frame.
double noiseAt(std::size_t sample, int frame) {
    std::uint64_t bits = sample * 0x9e3779b97f4a7c15u + std::uint64_t(frame) * 0xd1b54a32d192ed03u;
    bits = (bits ^ (bits >> 31)) * 0xbf58476d1ce4e5b9u;
    bits ^= bits >> 29;
    return double(bits & 0xffffff) / double(0x1000000) - 0.5;
}

/// A frame of the cell between its samples: trilinear over those that are present, of labels the nearest.
volume::Field enlarged(const volume::Field& coarse, const volume::Lattice& from, const volume::Lattice& to,
                       bool label) {
    volume::Field fine = volume::makeField(to, coarse.type);
    auto mask = std::make_shared<volume::Mask>(to.count(), std::uint8_t(1));
    parallelFor(std::size_t(to.size.z), [&](std::size_t slice) {
        const int z = int(slice);
        for (int y = 0; y < to.size.y; ++y)
            for (int x = 0; x < to.size.x; ++x) {
                const glm::dvec3 at = (to.position({x, y, z}) - from.origin) / from.spacing;
                const glm::ivec3 near =
                    glm::clamp(glm::ivec3(glm::round(at)), glm::ivec3(0), glm::ivec3(from.size) - 1);
                const std::size_t i = to.index({x, y, z}), n = from.index(near);
                (*mask)[i] = coarse.present(n) ? 1 : 0;
                double sum = 0, weights = 0;
                for (int corner = 0; corner < 8 && !label; ++corner) {
                    const glm::dvec3 below = glm::floor(at);
                    const glm::ivec3 step(corner & 1, corner >> 1 & 1, corner >> 2);
                    const glm::ivec3 index = glm::ivec3(below) + step;
                    const glm::dvec3 part = glm::mix(1.0 - (at - below), at - below, glm::dvec3(step));
                    if (glm::any(glm::lessThan(index, glm::ivec3(0))) ||
                        glm::any(glm::greaterThanEqual(index, from.size)) || !coarse.present(from.index(index)))
                        continue;
                    const double weight = part.x * part.y * part.z;
                    sum += weight * coarse.value(from.index(index));
                    weights += weight;
                }
                if (label)
                    fine.as<std::uint8_t>()[i] = coarse.as<std::uint8_t>()[n];
                else
                    fine.as<float>()[i] = float(weights > 0 ? sum / weights : coarse.value(n));
            }
    });
    fine.mask = mask;
    return fine;
}

} // namespace

volume::Dataset enlargedCell(glm::ivec3 size, int times, double noise) {
    auto small =
        std::make_shared<volume::Dataset>(volume::makeModel("fuel-cell", {{"times", double(times)}, {"even", 1}}));
    volume::Dataset large{.info = small->info, .read = {}};
    const volume::Lattice from = small->info.lattice;
    volume::Lattice& to = large.info.lattice;
    to.size = size;
    to.origin = small->info.bounds.lo;
    to.spacing = small->info.bounds.size() / glm::dvec3(to.size - 1);
    large.read = [small, from, to, noise](int parameter, int component, int time) {
        const volume::Parameter& known = small->info.parameters[std::size_t(parameter)];
        volume::Field fine = enlarged(small->read(parameter, component, time), from, to, known.categorical);
        if (noise == 0 || known.categorical) return fine;
        const auto [least, most] = std::ranges::minmax(fine.as<float>());
        const double scale = noise * double(most - least);
        const std::span<float> values = fine.as<float>();
        parallelFor(
            values.size(),
            [&](std::size_t i) { values[i] += float(scale * noiseAt(i, (time * 64 + parameter) * 4 + component)); },
            1 << 16);
        return fine;
    };
    return large;
}

} // namespace tessera::app
