#pragma once

#include "vis/packed/packet_volume.h"
#include "vis/scene/drawn_scene.h"

#include <optional>
#include <vector>

/// Which samples of a data set a scene needs.
namespace tessera::vis::packet {

/// The samples of a layer that is drawn.
struct LayerSamples {
    DrawnLayer drawn;
    PacketChannel channel;
    std::optional<PacketChannel> colors = {}; ///< of the channel that colours it
};
/// Those of all layers of a scene that is not refused.
std::vector<LayerSamples> layerSamples(const Scene& scene, const volume::DatasetInfo& info, const DrawnScene& drawn);
/// All samples that a scene needs: of its layers, each followed by those that colour it, then of brushed channels.
std::vector<PacketChannel> packetChannels(const Scene& scene, const volume::DatasetInfo& info);

} // namespace tessera::vis::packet
