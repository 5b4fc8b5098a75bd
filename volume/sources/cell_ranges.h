#pragma once

#include "volume/resample/resample_taps.h"
#include "volume/sources/sampled_box.h"
#include "volume/sources/weighed_rows.h"

#include <algorithm>
#include <array>
#include <vector>

namespace tessera::volume {

/// The range of the corners of the cell around each sample, a row of samples after another.
class CellRanges {
public:
    /// `tapOf(axis, index)`: of the samples in a box.
    template <class TapOf>
    CellRanges(const SampledBox& grid, const IndexBox& samples, const TapOf& tapOf)
        : grid_(grid), samples_(samples), least_(std::size_t(grid.box.size().x)), most_(least_.size()) {
        const glm::ivec3 size = grid.box.size(), steps(1, size.x, size.x * size.y);
        for (int axis = 0; axis < 3; ++axis)
            for (int i = samples.begin[axis]; i < samples.end[axis]; ++i) {
                const Tap& tap = tapOf(axis, i);
                along_[std::size_t(axis)].push_back({std::size_t((tap.cell[0] - grid.box.begin[axis]) * steps[axis]),
                                                     std::size_t((tap.cell[1] - tap.cell[0]) * steps[axis])});
            }
        lo.resize(along_[0].size());
        hi.resize(along_[0].size());
    }
    void setRow(int atY, int atZ) {
        const Side &y = along_[1][std::size_t(atY - samples_.begin.y)],
                   &z = along_[2][std::size_t(atZ - samples_.begin.z)];
        const float* const first = grid_.values.data() + (y.place + z.place);
        extremesOfRows({first, first + y.step, first + z.step, first + y.step + z.step}, least_.size(), least_.data(),
                       most_.data());
        for (std::size_t i = 0; i < lo.size(); ++i) {
            const Side& x = along_[0][i];
            lo[i] = std::min(least_[x.place], least_[x.place + x.step]);
            hi[i] = std::max(most_[x.place], most_[x.place + x.step]);
        }
    }
    std::vector<float> lo, hi; ///< of the row

private:
    struct Side {
        std::size_t place, step;
    };
    const SampledBox& grid_;
    const IndexBox& samples_;
    std::array<std::vector<Side>, 3> along_;
    std::vector<float> least_, most_; ///< of a row of the grid and its three neighbours
};

} // namespace tessera::volume
