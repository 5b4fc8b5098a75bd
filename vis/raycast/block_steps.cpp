#include "vis/raycast/block_steps.h"

#include "vis/raycast/ray_field.h"
#include "volume/base/parallel.h"

#include <algorithm>

namespace tessera::vis {

namespace {

/// The properties of a layer that bound its variation within blocks.
struct BlockLayer {
    const BoundField* field;
    std::optional<CurveMedium> medium; ///< none for an iso-surface
    glm::dvec2 map{0};                 ///< from texel values to transfer function positions
    double value = 0;                  ///< iso-value, texel units
};

} // namespace

std::vector<std::uint8_t> blockSteps(const RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info,
                                     const volume::Lattice& lattice) {
    const BlockRanges* grid = commonBlocks(plan);
    if (!grid || grid->level > 0 || !stepsAdapt(scene, info)) return {};
    std::vector<BlockLayer> layers;
    for (const RayLayer& use : plan.layers) {
        const BoundField& field = plan.fields[std::size_t(use.field)];
        const Layer& layer = scene.layers[std::size_t(use.layer)];
        BlockLayer& added = layers.emplace_back(BlockLayer{&field, {}});
        if (const auto* iso = std::get_if<IsoLayer>(&layer.technique)) {
            added.value = toTexel(field, iso->value);
            continue;
        }
        const DrawnChannel shown = drawnChannel(scene, info, field);
        added.medium.emplace(*shown.function, shown.range, double(std::get<VolumeLayer>(layer.technique).density),
                             use.shaded);
        added.map = transferMap(field, scene, info);
    }
    if (std::ranges::none_of(layers, [](const BlockLayer& layer) { return layer.medium.has_value(); })) return {};
    const double unit = stepUnit(worldCell(lattice, worldFrame(info, scene.stretch)));
    std::vector<std::uint8_t> codes(grid->min.size());
    parallelRanges(
        codes.size(),
        [&](std::size_t begin, std::size_t end) {
            std::vector<BlockMedium> medium;
            for (std::size_t i = begin; i < end; ++i) {
                medium.clear();
                bool smooth = true;
                for (const BlockLayer& layer : layers) {
                    const double lo = double(layer.field->blocks->min[i]), hi = double(layer.field->blocks->max[i]);
                    if (!(lo <= hi)) continue; // absent
                    if (layer.medium)
                        medium.push_back(layer.medium->between(lo * layer.map.x + layer.map.y,
                                                               hi * layer.map.x + layer.map.y,
                                                               layer.field->encoding.coverage));
                    else
                        smooth = smooth && !(lo <= layer.value && layer.value <= hi);
                }
                codes[i] = smooth ? std::uint8_t(stepCode(longestStep(medium, double(scene.render.adaptiveStep)), unit))
                                  : std::uint8_t(0);
            }
        },
        4096);
    return codes;
}

double samplesLeft(int code, const Scene& scene, const volume::DatasetInfo& info, const volume::Lattice& lattice,
                   double edge) {
    constexpr double kChord = 2.0 / 3; // mean chord of a cube over all rays, in edges
    if (code == 0) return 1;
    const glm::dvec3 cell = worldCell(lattice, worldFrame(info, scene.stretch));
    const double sample = double(scene.render.stepVoxels) * (cell.x + cell.y + cell.z) / 3;
    const double together = stepOfCode(code, stepUnit(cell)) / sample;
    return 1 / std::clamp(std::floor(together), 1.0, std::max(kChord * edge / double(scene.render.stepVoxels), 1.0));
}

} // namespace tessera::vis
