#include "app/views/slices/inner_slices.h"

#include <algorithm>

namespace tessera::app {

void addInnerSlices(vis::Scene& scene, const Session& session, const vis::SliceLayer& like) {
    std::erase_if(scene.lenses, [&](const vis::Lens& lens) {
        return lens.effect != vis::LensEffect::Replace || lens.shape == vis::LensShape::Disc ||
               std::none_of(session.layers.begin(), session.layers.end(),
                            [&](const vis::Layer& layer) { return layer.visible && layer.lens == lens.name; });
    });
    for (const vis::Lens& lens : scene.lenses)
        for (const vis::Layer& layer : session.layers) {
            if (!layer.visible || layer.lens != lens.name) continue;
            vis::SliceLayer inner = like;
            inner.channel = vis::shownChannel(layer.technique);
            scene.layers.push_back({layer.name, true, inner, layer.lens, layer.transfer, layer.timeShift});
        }
}

} // namespace tessera::app
