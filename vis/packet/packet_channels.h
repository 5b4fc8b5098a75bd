#pragma once

#include "vis/packed/packet_volume.h"
#include "vis/scene/scene.h"

#include <optional>
#include <vector>

/// Which samples of a data set a scene needs.
namespace tessera::vis::packet {

/// The layers that rays intersect, with their channels; of a scene that is not refused.
struct DrawnChannel {
    int layer = 0; ///< index into Scene::layers
    PacketChannel channel;
    std::optional<PacketChannel> colors = {}; ///< the channel that colours it
};
std::vector<DrawnChannel> drawnChannels(const Scene& scene, const volume::DatasetInfo& info);
/// All samples that a scene needs: those of drawnChannels(), each followed by those that colour it, then those of
/// brushed channels.
std::vector<PacketChannel> packetChannels(const Scene& scene, const volume::DatasetInfo& info);

/// The channels of the enabled brushes that the data set has.
std::vector<int> brushedChannels(const Scene& scene, const volume::DatasetInfo& info);

/// The transfer function of a layer, and its range for the layer's channel.
struct Transfer {
    const TransferFunction& function;
    Range range;
};
Transfer transferOfLayer(const Scene& scene, const volume::DatasetInfo& info, const Layer& layer, int channel);
/// The same for the channel that colours a layer.
Transfer transferOfColors(const Scene& scene, const volume::DatasetInfo& info, const Layer& layer, int channel);
/// Whether a layer is classified by regions of value and gradient magnitude.
bool byRegions(const Technique& technique, const TransferFunction& function);
/// How a layer is classified: after interpolation what can only be so.
Classification classificationOf(const Technique& technique, const TransferFunction& function, bool categorical);

} // namespace tessera::vis::packet
