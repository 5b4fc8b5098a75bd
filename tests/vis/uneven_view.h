#pragma once

#include "vis/scene/scene.h"
#include "volume/bricks/brick_source.h"

#include <cmath>
#include <memory>
#include <utility>

/// Data with uneven axes that have the samples of other data: drawn by cells, both give one picture.
namespace tessera::vis {

/// A source with maps for its axes; its samples, cells and box stay.
class UnevenView : public volume::BrickSource {
public:
    UnevenView(std::shared_ptr<const volume::BrickSource> source, volume::AxisMaps axes)
        : source_(std::move(source)), info_(source_->info()), grid_(source_->grid()) {
        info_.lattice.axes = grid_.lattice.axes = std::move(axes);
    }
    const volume::DatasetInfo& info() const override { return info_; }
    const volume::BrickGrid& grid() const override { return grid_; }
    volume::BrickStats stats(const volume::BrickKey& key) const override { return source_->stats(key); }
    volume::BrickSamples read(const volume::BrickKey& key) const override { return source_->read(key); }

private:
    std::shared_ptr<const volume::BrickSource> source_;
    volume::DatasetInfo info_;
    volume::BrickGrid grid_;
};

/// Maps that keep a box: x grows 1:10, z has a thin layer in its middle; y is even.
inline volume::AxisMaps gradedAxes(const volume::Box& box, volume::AxisMap::Of of = volume::AxisMap::Of::Points) {
    constexpr int kCells = 12;
    std::vector<double> x{box.lo.x}, z{box.lo.z};
    double sumX = 0, sumZ = 0, atX = 0, atZ = 0;
    const auto lengthX = [](int i) { return std::pow(10.0, i / (kCells - 1.0)); };
    const auto lengthZ = [](int i) { return i >= 4 && i < 9 ? 0.05 : 1.0 + 0.3 * i; };
    for (int i = 0; i < kCells; ++i) sumX += lengthX(i), sumZ += lengthZ(i);
    for (int i = 0; i < kCells; ++i) {
        atX += lengthX(i), atZ += lengthZ(i);
        x.push_back(i + 1 == kCells ? box.hi.x : box.lo.x + box.size().x * atX / sumX);
        z.push_back(i + 1 == kCells ? box.hi.z : box.lo.z + box.size().z * atZ / sumZ);
    }
    volume::AxisMaps axes;
    axes.of[0] = std::make_shared<const volume::AxisMap>(of, std::move(x));
    axes.of[2] = std::make_shared<const volume::AxisMap>(of, std::move(z));
    return axes;
}

/// A scene whose places are of the sheet, with these places in space: what a session of uneven data would say.
inline Scene placedInSpace(Scene scene, const volume::Box& box, const volume::AxisMaps& axes) {
    scene.cursor = axes.toSpace(scene.cursor);
    for (Lens& lens : scene.lenses) lens.center = axes.toSpace(lens.center);
    const auto share = [&](glm::dvec3 of) { return (axes.toSpace(box.lo + of * box.size()) - box.lo) / box.size(); };
    for (Clip& clip : scene.clips) clip.center = glm::vec3(share(glm::dvec3(clip.center)));
    for (Layer& layer : scene.layers)
        if (auto* slice = std::get_if<SliceLayer>(&layer.technique);
            slice && !slice->atCursor && slice->orientation != SliceOrientation::Oblique)
            slice->position = share(glm::dvec3(slice->position))[int(slice->orientation)];
    for (Brush& brush : scene.selection.brushes) {
        if (auto* ball = std::get_if<SphereRegion>(&brush.region)) ball->center = axes.toSpace(ball->center);
        if (auto* cuboid = std::get_if<BoxRegion>(&brush.region)) {
            const glm::dvec3 lo = axes.toSpace(cuboid->center - cuboid->radius),
                             hi = axes.toSpace(cuboid->center + cuboid->radius);
            cuboid->center = 0.5 * (lo + hi);
            cuboid->radius = 0.5 * (hi - lo);
        }
    }
    return scene;
}

} // namespace tessera::vis
