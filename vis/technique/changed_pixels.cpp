#include "vis/technique/changed_pixels.h"

#include "vis/technique/box_lines.h"
#include "vis/technique/brush_uniforms.h"

#include <algorithm>

namespace tessera::vis {

namespace {

constexpr double kBeside = 1.5; ///< pixels around

bool sliceAtCursor(const Scene& scene) {
    return std::any_of(scene.layers.begin(), scene.layers.end(), [](const Layer& layer) {
        const auto* slice = std::get_if<SliceLayer>(&layer.technique);
        return slice && slice->atCursor && layer.visible;
    });
}

/// Pixels of the rays that pass through a lens; nullopt where it reaches behind the eye.
std::optional<Tile> pixelsOf(const PlacedLens& lens, const Camera& camera, glm::ivec2 size) {
    const double aspect = double(size.x) / std::max(size.y, 1);
    const glm::dmat4 view = viewMatrix(camera), projection = projectionMatrix(camera, aspect);
    glm::dvec2 lo(1e9), hi(-1e9);
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 unit(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
        const glm::dvec4 eye = view * glm::dvec4(lens.center + lens.fromUnit * unit, 1);
        if (camera.projection == Projection::Perspective && eye.z > -kNear) return std::nullopt;
        const glm::dvec4 clip = projection * eye;
        const glm::dvec2 pixel = (glm::dvec2(clip) / clip.w * 0.5 + 0.5) * glm::dvec2(size);
        lo = glm::min(lo, pixel);
        hi = glm::max(hi, pixel);
    }
    const glm::dvec2 most(size);
    return Tile{glm::ivec2(glm::floor(glm::clamp(lo - kBeside, glm::dvec2(0), most))),
                glm::ivec2(glm::ceil(glm::clamp(hi + kBeside, glm::dvec2(0), most)))};
}

} // namespace

std::optional<Tile> changedPixels(const Scene& before, const Scene& after, const WorldFrame& frame, glm::ivec2 size) {
    Scene otherwise = after;
    otherwise.lenses = before.lenses;
    if (!sliceAtCursor(after)) otherwise.cursor = before.cursor;
    // Shadows fall, what is out of focus spreads, and brushes made of lenses choose, beyond a lens.
    if (!(otherwise == before) || after.lighting.shadows.any() || blursContext(after) || selectsLens(after.selection))
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
        // The interest that a magnifying lens shows is that of another place.
        if (!(placed == is[i]) || (bends && is[i].focus > 0)) return std::nullopt;
        const std::optional<Tile> from = pixelsOf(was[i], after.camera, size), to = pixelsOf(is[i], after.camera, size);
        if (!from || !to) return std::nullopt;
        changed = united(changed, united(*from, *to));
    }
    return changed;
}

} // namespace tessera::vis
