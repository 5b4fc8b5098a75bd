#pragma once

#include "vis/gl/driver.h"

#include <cstddef>
#include <functional>
#include <optional>

/// Memory limits of the renderer, and what is in use.
namespace tessera::vis {

/// When the processor casts the rays of scenes that leave this to the renderer (Engine::Automatic).
enum class Packets {
    Never,
    WhileCompiling, ///< until OpenGL has compiled their program
    Always
};

struct RendererOptions {
    /// Budgets in bytes for textures and for decoded bricks in RAM; they apply if lower than the scene's limits.
    std::size_t textureBudget = ~std::size_t(0), memoryBudget = ~std::size_t(0);
    int decodeThreads = 2;
    /// Largest channel in texels that is kept as a single texture, which is cheapest to sample. Larger ones are divided
    /// into bricks.
    std::size_t denseTexels = std::size_t(32) << 20;
    Packets packets = Packets::Never;
    double patience = 250;      ///< how long the former picture stays while a program is compiled, milliseconds
    bool openGl = true;         ///< else there is none: the processor draws everything
    bool exactTextures = false; ///< store bricks as 32-bit float instead of 16-bit, for comparison with the reference
    /// Called from any thread when samples are there that were read in the background: another frame can show them.
    std::function<void()> arrived = {};
    /// Simulated memory of the driver for data textures in bytes; larger allocations are refused. For tests.
    std::size_t driverMemory = ~std::size_t(0);
    std::optional<Driver> driver = {}; ///< replaces the detected driver profile, for tests
    bool countSamples =
        false; ///< readLinear returns, instead of colours, the number of reconstructions of each ray (in red)
};

/// What a data set shares with the one drawn before: the first channels, at the first times, have identical samples in
/// identical bricks.
struct SameSamples {
    int channels = 0, times = 0;
};

/// Bytes in use and their limits; resident bricks, wanted bricks that are not resident, bricks not wanted because all
/// views that would show them find them occluded, running jobs; and, since the data set was opened, uploaded bricks and
/// bricks that reused texels of another time.
struct ResidencyInfo {
    std::size_t textureBytes = 0, textureBudget = 0, memoryBytes = 0, memoryBudget = 0;
    int bricksResident = 0, bricksWanted = 0, bricksHidden = 0, bricksQueued = 0, bricksUploaded = 0, bricksKept = 0;
};

} // namespace tessera::vis
