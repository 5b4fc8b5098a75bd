#include "vis/demand/changed_pixels.h"

#include "vis/demand/lens_pixels.h"
#include "vis/raycast/brush_uniforms.h"

#include <algorithm>

namespace tessera::vis {

bool sliceAtCursor(const Scene& scene) {
    return std::any_of(scene.layers.begin(), scene.layers.end(), [](const Layer& layer) {
        const auto* slice = std::get_if<SliceLayer>(&layer.technique);
        return slice && slice->atCursor && layer.visible;
    });
}

std::optional<Tile> changedPixels(const Scene& before, const Scene& after, const WorldFrame& frame, glm::ivec2 size) {
    Scene otherwise = after;
    otherwise.lenses = before.lenses;
    if (!sliceAtCursor(after)) otherwise.cursor = before.cursor;
    // Shadows, of depth too, blur and lens brushes also change pixels outside a lens.
    if (!(otherwise == before) || after.camera.aperture > 0 || after.lighting.shadows.any() || blursContext(after) ||
        after.depthMask.any() || selectsLens(after.selection))
        return std::nullopt;
    const std::vector<PlacedLens> was = placeLenses(before, frame), is = placeLenses(after, frame);
    if (was.size() != is.size()) return std::nullopt;
    const bool bends = std::any_of(is.begin(), is.end(), [](const PlacedLens& lens) { return lens.magnification > 1; });
    Tile changed;
    for (std::size_t i = 0; i < is.size(); ++i) {
        if (was[i] == is[i]) continue;
        PlacedLens placed = was[i];
        placed.center = is[i].center;
        placed.toUnit = is[i].toUnit;
        placed.fromUnit = is[i].fromUnit;
        // A magnifying lens shows the degree of interest of another position.
        if (!(placed == is[i]) || (bends && is[i].focus > 0)) return std::nullopt;
        const std::optional<Tile> from = lensPixels(was[i], after.camera, size),
                                  to = lensPixels(is[i], after.camera, size);
        if (!from || !to) return std::nullopt;
        changed = united(changed, united(*from, *to));
    }
    return changed;
}

} // namespace tessera::vis
