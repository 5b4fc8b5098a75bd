#include "vis/model/scene.h"

namespace tessera::vis {

const TransferFunction& transferFor(const Scene& scene, const std::string& name) {
    static const TransferFunction fallback;
    const auto found = scene.transfer.find(name);
    return found == scene.transfer.end() ? fallback : found->second;
}

std::vector<PlacedLens> placeLenses(const Scene& scene, const WorldFrame& frame) {
    return placeLenses(scene.lenses, frame, scene.camera, scene.cursor);
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
