#include "vis/packet/packet_channels.h"

#include <algorithm>
#include <cmath>

namespace tessera::vis::packet {

namespace {

/// A range of places narrower than this part of the data's range is read from floats.
constexpr double kNarrow = 1.0 / 8;

/// The stored times that samples at a time come from; of labels the nearest.
volume::TimePair timesOf(const volume::DatasetInfo& info, bool labels, double time) {
    const volume::TimePair around = volume::timesAround(info.times, time);
    return labels ? volume::TimePair{around.nearest(), around.nearest(), 0} : around;
}

/// Whether a function covers a small part of the data's range.
bool isNarrow(const DrawnChannel& drawn, const volume::DatasetInfo& info) {
    const Range range = drawn.range, whole = info.channelRange(info.channel(drawn.channel));
    return std::abs(range.hi - range.lo) < kNarrow * std::abs(whole.hi - whole.lo);
}

/// Whether 15 bits are too few: for functions and gradients of a small part of the range, and here and there for
/// strokes and dots, which depend on second differences and thresholds.
bool needsFloats(const DrawnLayer& drawn, const volume::DatasetInfo& info) {
    return isNarrow(drawn.shown, info) || (drawn.colors && isNarrow(*drawn.colors, info)) || drawn.gradient ||
           drawn.byRegions || (drawn.look && drawn.look->charcoal);
}

} // namespace

std::vector<LayerSamples> layerSamples(const Scene& scene, const volume::DatasetInfo& info, const DrawnScene& drawn) {
    // All have samples of the same kind.
    const bool exact =
        std::ranges::any_of(drawn.layers, [&](const DrawnLayer& layer) { return needsFloats(layer, info); });
    const auto samplesOf = [&](const DrawnChannel& of, Filter filter) {
        return PacketChannel{of.channel, timesOf(info, of.categorical, scene.time + of.timeShift), filter, exact};
    };
    std::vector<LayerSamples> out;
    for (const DrawnLayer& layer : drawn.layers) {
        const Filter filter = scene.render.filter;
        // Before interpolation samples themselves are classified.
        const bool raw = layer.classification == Classification::Pre && prefilterOf(filter) != volume::Prefilter::None;
        out.push_back({layer, samplesOf(layer.shown, raw ? Filter::Average : filter)});
        if (layer.colors) out.back().colors = samplesOf(*layer.colors, filter);
    }
    return out;
}

std::vector<PacketChannel> packetChannels(const Scene& scene, const volume::DatasetInfo& info) {
    const DrawnScene drawn = drawnScene(scene, info);
    std::vector<PacketChannel> out;
    for (const LayerSamples& layer : layerSamples(scene, info, drawn)) {
        out.push_back(layer.channel);
        if (layer.colors) out.push_back(*layer.colors);
    }
    const bool exact = !out.empty() && out.front().exact;
    for (const int channel : drawn.brushed) {
        const bool labels = info.parameters[std::size_t(info.channel(channel).parameter)].categorical;
        out.push_back({channel, timesOf(info, labels, scene.time), scene.render.filter, exact});
    }
    return out;
}

} // namespace tessera::vis::packet
