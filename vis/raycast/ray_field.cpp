#include "vis/raycast/ray_field.h"

namespace tessera::vis {

glm::dvec2 transferMap(const BoundField& field, const Scene& scene, const volume::DatasetInfo& info) {
    const Range range = drawnChannel(scene, info, field).range;
    const double width = range.hi - range.lo;
    if (width == 0) return {0, 0.5};
    return {field.encoding.scale / width, (field.encoding.offset - range.lo) / width};
}

double toTexel(const BoundField& field, double value) {
    return (value - field.encoding.offset) / field.encoding.scale;
}

const BlockRanges* commonBlocks(const RayPlan& plan) {
    const BlockRanges* first = nullptr;
    for (const RayLayer& layer : plan.layers) {
        const BlockRanges* blocks = plan.fields[std::size_t(layer.field)].blocks;
        if (!blocks || blocks->min.empty()) return nullptr;
        if (!first) first = blocks;
        if (blocks->level != first->level || blocks->edge != first->edge || blocks->count != first->count)
            return nullptr;
    }
    return first;
}

} // namespace tessera::vis
