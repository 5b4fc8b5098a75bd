#pragma once

#include "tests/reference/raycast.h"
#include "vis/passes/renderer.h"

#include <memory>
#include <vector>

/// What the rendering benchmarks share: pictures of one layer, timed, compared and counted.
namespace tessera::app {

inline constexpr int kBenchPicture = 512; ///< pixels along an edge of the timed pictures
inline constexpr int kBenchCompared = 48; ///< of the pictures compared with the reference
inline constexpr int kBenchFrames = 5;    ///< timed pictures; the median is reported

/// How pictures are timed.
enum class BenchClock {
    Processor, ///< processor time of all threads, which hardly depends on other load of the machine
    Wall       ///< time that passes: where a GPU draws, processors only wait
};

/// The clock for the driver of the current OpenGL context.
BenchClock benchClock();

/// "CPU ms" or "ms", the name of a column.
const char* timeColumn(BenchClock clock);

/// So far; only differences mean something.
double milliseconds(BenchClock clock);

/// One layer of parameter "v" (range 0..255) seen as a whole, a sample per voxel.
vis::Scene benchScene(const vis::Technique& technique, const std::vector<glm::vec2>& opacity);

/// Median milliseconds() by benchClock() of a picture while the camera turns, after one to warm up.
double timeFrames(vis::Renderer& renderer, vis::Scene scene);

/// milliseconds() by benchClock() until other samples are seen, however coarse, in a renderer that has drawn the scene
/// before.
double timeChanged(vis::Renderer& renderer, const vis::Scene& scene, std::shared_ptr<const volume::BrickSource> source);

/// A picture of kBenchCompared pixels, linear.
vis::reference::Image benchPicture(vis::Renderer& renderer, const vis::Scene& scene);

/// Mean number of times that the rays of a timed picture reconstruct a value; `counter` counts samples.
double samplesPerPixel(vis::Renderer& counter, const vis::Scene& scene);

} // namespace tessera::app
