#pragma once

#include "volume/base/progress.h"
#include "volume/bricks/brick_source.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

/// Samples of several parameters side by side on one grid, as searches in them need.
namespace tessera::volume {

struct WorthSamplesQuery {
    std::vector<int> channels; ///< indices of DatasetInfo::channels()
    int time = 0;
    int level = 0;  ///< of detail
    int label = -1; ///< channel of a label whose values are regions; -1: none
    std::vector<int> doiChannels = {};
    /// Degree of interest 0..1 of a sample, given the values of `doiChannels` (NaN where absent) and its position;
    /// samples of at least 1/2 are inside. Called from several threads at once. Empty: nothing is selected.
    std::function<double(std::span<const float> values, glm::dvec3 position)> doi = {};
};

/// The samples of a level at a time; of a BCC lattice those of the even sublattice, a grid of half of them.
struct WorthSamples {
    glm::ivec3 size{0};
    std::vector<int> channels;                 ///< as asked
    std::vector<std::vector<float>> values;    ///< [position in channels][sample], x fastest; NaN: absent
    std::vector<int> regions;                  ///< values of the label that are there, rising; the largest ones
    std::size_t regionsLeft = 0;               ///< further values, whose samples are in none
    std::vector<std::uint8_t> group;           ///< by sample: 1 + position in `regions`; 0: in none; empty: no label
    std::vector<std::uint8_t> inside;          ///< by sample: 1 = selected; empty: nothing is
    std::array<std::vector<double>, 3> places; ///< coordinates of samples by their index along an axis

    std::size_t count() const { return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z); }
    glm::ivec3 indexOf(std::size_t sample) const {
        const auto x = std::size_t(size.x), y = std::size_t(size.y);
        return {int(sample % x), int(sample / x % y), int(sample / (x * y))};
    }
    glm::dvec3 placeOf(std::size_t sample) const {
        const glm::ivec3 at = indexOf(sample);
        return {places[0][std::size_t(at.x)], places[1][std::size_t(at.y)], places[2][std::size_t(at.z)]};
    }
    std::size_t step(int axis) const {
        return axis == 0 ? 1 : axis == 1 ? std::size_t(size.x) : std::size_t(size.x) * std::size_t(size.y);
    }
    /// 0: every sample; else those of a region.
    bool isIn(std::size_t sample, std::size_t of) const { return of == 0 || group[sample] == of; }
};

/// Throws Error when a brick is damaged, Cancelled.
WorthSamples readWorthSamples(const BrickSource& source, const WorthSamplesQuery& query, const Progress& progress = {});

/// Makes samples absent that are not selected.
void keepInside(WorthSamples& samples);

/// By sample: 1 where any channel has a value.
std::vector<std::uint8_t> anyPresent(const WorthSamples& samples);

} // namespace tessera::volume
