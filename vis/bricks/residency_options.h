#pragma once

#include "vis/gl/driver.h"

#include <cstddef>
#include <optional>

/// What may be held on the GPU, and what is.
namespace tessera::vis {

struct RendererOptions {
    /// Bytes of textures, and of decoded bricks kept in RAM, if that is less than the scene's limits.
    std::size_t textureBudget = ~std::size_t(0), memoryBudget = ~std::size_t(0);
    int decodeThreads = 2;
    /// Largest channel, in texels, kept as one texture: cheapest to sample. Larger ones are cut into bricks.
    std::size_t denseTexels = std::size_t(32) << 20;
    bool exactTextures = false; ///< 32-bit float bricks instead of 16-bit: for comparison with the reference
    /// Bytes of data textures that the driver is taken to have; more is refused as a driver does. For tests.
    std::size_t driverMemory = ~std::size_t(0);
    std::optional<Driver> driver = {}; ///< taken to be this one; none: as it says. For tests.
    bool countSamples = false; ///< instead of colours, readLinear gives how often each ray reconstructed a layer (red)
};

/// What a data set has in common with the one that was shown before it: its first channels, at the first times, have
/// the same samples in the same bricks.
struct SameSamples {
    int channels = 0, times = 0;
};

/// Bytes in use and allowed; bricks in textures, bricks that a view wants and that are not there yet, bricks not wanted
/// since they are hidden in every view that would show them, jobs under way; of this data set so far, bricks uploaded,
/// and bricks of another time that were shown with texels that were there.
struct ResidencyInfo {
    std::size_t textureBytes = 0, textureBudget = 0, memoryBytes = 0, memoryBudget = 0;
    int bricksResident = 0, bricksWanted = 0, bricksHidden = 0, bricksQueued = 0, bricksUploaded = 0, bricksKept = 0;
};

} // namespace tessera::vis
