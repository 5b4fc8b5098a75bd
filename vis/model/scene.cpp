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

} // namespace tessera::vis
