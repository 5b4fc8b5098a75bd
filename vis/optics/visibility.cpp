#include "vis/optics/visibility.h"

#include "vis/optics/ray_setup.h"
#include "volume/base/parallel.h"
#include "volume/flow/flow.h"

#include <algorithm>

namespace tessera::vis {

std::vector<double> visibilityHistogram(const volume::SampleGrid& grid, const volume::Box& bounds,
                                        const VisibilityQuery& query, const Progress& progress) {
    constexpr double kStepVoxels = 1;
    const WorldFrame frame = worldFrame(bounds, query.stretch, grid.lattice.axes);
    const glm::dvec3 cell = worldCell(grid.lattice, frame);
    const auto rows = std::size_t(query.rays), bins = std::size_t(query.bins);
    std::vector<std::vector<double>> parts(rows);
    std::vector<int> met(rows, 0);
    parallelFor(rows, [&](std::size_t row) {
        if (progress.stop.stop_requested()) throw Cancelled();
        std::vector<double>& sums = parts[row];
        sums.resize(bins);
        for (int column = 0; column < query.rays; ++column) {
            const glm::dvec2 ndc((column + 0.5) / query.rays * 2 - 1, (double(row) + 0.5) / query.rays * 2 - 1);
            const Ray ray = cameraRay(query.camera, query.aspect, ndc);
            const auto segment = clipToBox(ray, frame.halfSize, query.camera.projection == Projection::Perspective);
            if (!segment) continue;
            ++met[row];
            const RaySamples samples = raySamples(*segment, ray.direction, cell, kStepVoxels);
            double through = 1;
            for (int k = 0; k < samples.count && through > 1 - kOpaque; ++k) {
                const auto value = volume::valueAt(grid, frame.toPhysical(ray.origin + samples.at(k) * ray.direction));
                if (!value) continue;
                const double alpha =
                    correctedOpacity(evaluate(query.function, query.range, *value).a, samples.step, query.density);
                const double place = (*value - query.range.lo) / (query.range.hi - query.range.lo);
                sums[std::size_t(std::clamp(place, 0.0, 1.0) * (double(bins) - 1e-9))] += through * alpha;
                through *= 1 - alpha;
            }
        }
    });
    std::vector<double> out(bins);
    int rays = 0;
    for (std::size_t row = 0; row < rows; ++row) {
        rays += met[row];
        for (std::size_t b = 0; b < bins; ++b) out[b] += parts[row][b];
    }
    for (double& sum : out) sum /= std::max(rays, 1);
    return out;
}

} // namespace tessera::vis
