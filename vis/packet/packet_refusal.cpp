#include "vis/packet/packet_refusal.h"

#include "vis/packed/packet_volume.h"
#include "vis/packet/cast_job.h"
#include "vis/packet/packet_channels.h"

#include <algorithm>

namespace tessera::vis::packet {

namespace {

std::string refusalOfFocus(const Scene& scene, const DrawnScene& drawn) {
    if (!scene.selection.active()) return "";
    if (scene.selection.contextBlur > 0) return "blurred context";
    return drawn.brushed.size() > std::size_t(kMostBrushFields) ? "brushes of so many parameters" : "";
}

} // namespace

std::string packetRefusal(const Scene& scene, const volume::DatasetInfo& info, const volume::Lattice& lattice) {
    const DrawnScene drawn = drawnScene(scene, info);
    if (std::string why = refusalOfFocus(scene, drawn); !why.empty()) return why;
    if (!fitsPackets(lattice)) return "so long data";
    if (scene.render.proxy != Proxy::Rays) return "proxy geometry";
    if (scene.render.adaptiveStep > 0) return "adaptive steps";
    if (scene.render.normalBits > 0) return "quantised normals";
    if (scene.render.filter == Filter::Tetrahedral && lattice.kind == volume::LatticeKind::BCC)
        return "tetrahedral interpolation";
    int surfaces = 0, slices = 0;
    for (const DrawnLayer& layer : drawn.layers) {
        surfaces += layer.surface != nullptr;
        slices += layer.slice != nullptr;
    }
    if (drawn.layers.size() > std::size_t(kMostPacketLayers) || surfaces > kMostPacketSurfaces ||
        slices > kMostPacketSlices)
        return "so many layers";
    return "";
}

double packetBytes(const Scene& scene, const volume::DatasetInfo& info, const volume::Lattice& lattice) {
    constexpr double kShared = 2.69; // pairs, and samples that several bricks hold
    std::vector<PacketChannel> channels;
    const auto add = [&](const PacketChannel& channel) {
        if (std::ranges::find(channels, channel) == channels.end()) channels.push_back(channel);
    };
    for (const PacketChannel& channel : packetChannels(scene, info)) {
        add(channel);
        add(channel.at(channel.time.earlier));
        add(channel.at(channel.time.later));
    }
    const double samples = double(lattice.size.x) * double(lattice.size.y) * double(lattice.size.z);
    double bytes = 0;
    for (const PacketChannel& channel : channels) {
        const volume::Parameter& parameter = info.parameters[std::size_t(info.channel(channel.channel).parameter)];
        bytes += samples * kShared * (channel.exact ? 4 : 2) * double(parameter.parts.count());
    }
    return bytes;
}

} // namespace tessera::vis::packet
