#include "vis/scene/scene.h"

#include <algorithm>

namespace tessera::vis {

int raysPerPixel(const Scene& scene) {
    return std::max(scene.render.samples, scene.camera.aperture > 0 ? kLensPlaces : 1);
}

const TransferFunction& transferFor(const Scene& scene, const std::string& name) {
    static const TransferFunction fallback;
    const auto found = scene.transfer.find(name);
    return found == scene.transfer.end() ? fallback : found->second;
}

bool lensesBend(const Scene& scene) {
    return std::ranges::any_of(scene.lenses, [&](const Lens& lens) {
        return activeAt(lens, scene.time) && lens.inSpace() && lens.effect == LensEffect::Magnify;
    });
}

int peelsOf(const Scene& scene) {
    const bool brushed = scene.selection.active();
    int peels = 0;
    for (const GeometryLayer& layer : scene.geometry) {
        if (!drawn(scene, layer)) continue;
        const bool fades = brushed && layer.brushes != BrushEffect::None &&
                           !(layer.brushes == BrushEffect::Fade && scene.selection.contextOpacity >= 1);
        const bool translucent = layer.style.opacity < 1 || layer.geometry->translucent ||
                                 layer.style.look.silhouette || layer.style.look.boundary || layer.style.look.wire;
        peels = std::max(peels, translucent || fades || !layer.lens.empty() ? kPeels : 1);
    }
    return peels;
}

std::string coarserText(const std::string& what, int level) {
    const int step = 1 << level;
    const char* const ending = step == 2 ? "nd" : "th";
    return what + ": from every " + std::to_string(step) + ending + " sample along each axis";
}

std::vector<GeometryLayer> withHalos(const std::vector<GeometryLayer>& layers, glm::vec3 color) {
    std::vector<GeometryLayer> out;
    for (const GeometryLayer& layer : layers) {
        out.push_back(layer);
        if (!(layer.style.halo > 0)) continue;
        GeometryLayer& halo = out.emplace_back(layer);
        halo.style.rim = layer.style.halo;
        halo.style.color = color;
        halo.style.look = {};
        halo.channel.clear();
    }
    return out;
}

const StrokePicture* strokesOf(const Scene& scene, int layer) {
    for (const SliceStrokes& each : scene.strokes)
        if (each.layer == layer) return each.picture.get();
    return nullptr;
}

bool drawn(const Scene& scene, const GeometryLayer& layer) {
    // Without an active brush there is no context.
    return layer.geometry && layer.style.opacity > 0 &&
           (layer.brushes != BrushEffect::ContextOnly || scene.selection.active());
}

std::vector<PlacedLens> placeLenses(const Scene& scene, const WorldFrame& frame) {
    return placeLenses(scene.lenses, frame, scene.camera, scene.cursor, scene.time);
}

std::optional<Paper> paperOf(const Scene& scene) {
    if (scene.paper) return scene.paper;
    for (const Layer& layer : scene.layers) {
        const Look* look = lookOf(layer.technique);
        if (!layer.visible || !layer.lens.empty() || !look || !look->charcoal) continue;
        Paper paper;
        if (look->charcoal->stick == Stick::Chalk) paper.color = {0.13f, 0.14f, 0.15f};
        return paper;
    }
    return std::nullopt;
}

glm::vec3 groundColor(const Scene& scene) {
    const std::optional<Paper> paper = paperOf(scene);
    return paper ? paper->color : scene.background;
}

} // namespace tessera::vis
