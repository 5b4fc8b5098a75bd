#pragma once

#include "vis/bricks/residency.h"
#include "vis/view/render_tools.h"
#include "vis/view/view_target.h"

namespace tessera::vis {

/// What all pictures of a renderer share.
struct RendererState {
    RendererOptions options;
    Residency residency;
    std::shared_ptr<const volume::BrickSource> source;
    /// Samples of `source` for the processor, and those of a coarse level; null: it reads all as soon as these.
    std::shared_ptr<packet::PacketVolumes> volumes, coarseVolumes;
    const volume::BrickSource* formerSource =
        nullptr; ///< the source that `source` replaced with shared samples: its pictures stay until new ones are drawn
    RenderTools tools;
    EngineUse engine;    ///< of the last picture with a volume or surface
    std::string limits;  ///< last message about exceeded limits
    std::string refusal; ///< last message about refused memory

    RendererState(const RendererOptions& given, const Driver& driver)
        : options(given), residency(given, driver), tools(driver) {}
};

/// Whether pictures of the scene tell which bricks are occluded. With a magnifying lens, rays sample other positions
/// than those they pass; with depth of field, those of a pixel pass different ones.
bool findsHidden(const RendererState& shared, const Scene& scene);

/// Makes the scene that of the target and marks outdated pixels. `resident`: changes with the samples that are drawn.
void showScene(RendererState& shared, ViewTarget& target, const Scene& scene, std::uint64_t resident);

} // namespace tessera::vis
