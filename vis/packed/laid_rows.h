#pragma once

#include "vis/packed/padded_samples.h"
#include "volume/base/cpu.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

/// Rows of samples as they are laid out for packets of rays: filtered where the scene asks for it.
namespace tessera::vis::packet {

/// Reads rows out of padded samples. Refers to these.
class LaidRows {
public:
    /// `filtered`: by the prefilter of volume/reconstruct/reconstruct.h, in float; then the samples have one texel more
    /// on every side than there are rows.
    LaidRows(const PaddedSamples& samples, volume::LatticeKind kind, bool filtered, Cpu cpu = bestCpu());

    bool masked() const { return !samples_.present.empty(); }
    /// Storage samples: those that are given without the border that filtering needs.
    glm::ivec3 size() const { return size_; }
    /// `rows` rows along y from `first` on, `width` samples each, one after another. `present`: 1 or 0 each, for masked
    /// samples; absent ones are 0.
    void read(glm::ivec3 first, int width, int rows, float* values, std::uint8_t* present) const;
    /// Of the present samples before `end`.
    Extent extent(glm::ivec3 end) const;

private:
    const PaddedSamples& samples_;
    int slices_; ///< of a texel
    int halo_;
    glm::ivec3 size_;
    Cpu cpu_;
    std::size_t neighbours_ = 0;                         ///< of a sample; 0: not filtered
    std::array<std::array<std::ptrdiff_t, 8>, 2> steps_; ///< to them in memory, for even and odd slices
};

} // namespace tessera::vis::packet
