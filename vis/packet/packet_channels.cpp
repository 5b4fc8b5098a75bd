#include "vis/packet/packet_channels.h"

#include <cmath>
#include <optional>

namespace tessera::vis::packet {

namespace {

/// A range of places narrower than this part of the data's range is read from floats.
constexpr double kNarrow = 1.0 / 8;

/// Whether placeLenses() gives a lens of that name.
bool hasLens(const Scene& scene, const std::string& name) {
    int enabled = 0;
    for (const Lens& lens : scene.lenses)
        if (lens.enabled && enabled++ < kMaxLenses && lens.name == name) return true;
    return false;
}

} // namespace

Transfer transferOfLayer(const Scene& scene, const volume::DatasetInfo& info, const Layer& layer, int channel) {
    const volume::Channel known = info.channel(channel);
    const TransferFunction& function = transferFor(scene, layer.transfer.empty() ? known.name : layer.transfer);
    return {function, effectiveRange(function, info.channelRange(known))};
}

Transfer transferOfColors(const Scene& scene, const volume::DatasetInfo& info, const Layer& layer, int channel) {
    // A surface's own function is that of its colours, a volume's that of its opacity.
    if (std::holds_alternative<IsoLayer>(layer.technique)) return transferOfLayer(scene, info, layer, channel);
    return transferOfLayer(scene, info, {}, channel);
}

namespace {

/// The stored times that samples at a time come from; of labels the nearest.
volume::TimePair timesOf(const volume::DatasetInfo& info, int channel, double time) {
    const volume::TimePair around = volume::timesAround(info.times, time);
    if (!info.parameters[std::size_t(info.channel(channel).parameter)].categorical) return around;
    return {around.nearest(), around.nearest(), 0};
}

/// Whether a range is a small part of that of the data.
bool isNarrow(Range range, Range whole) {
    return std::abs(range.hi - range.lo) < kNarrow * std::abs(whole.hi - whole.lo);
}

/// Whether strokes or dots depend on second differences and thresholds, for which 15 bits are too few here and there.
bool drawsMarks(const Look* look) {
    return look && look->charcoal;
}

} // namespace

bool byRegions(const Technique& technique, const TransferFunction& function) {
    const auto* volume = std::get_if<VolumeLayer>(&technique);
    return volume && volume->style == RayStyle::Composite && volume->quantity == Quantity::Value &&
           function.kind == TransferKind::Regions;
}

Classification classificationOf(const Technique& technique, const TransferFunction& function, bool categorical) {
    const auto* volume = std::get_if<VolumeLayer>(&technique);
    const bool chooses = volume && volume->style == RayStyle::Composite && volume->quantity == Quantity::Value &&
                         !categorical && function.kind == TransferKind::Curve;
    return chooses ? volume->classification : Classification::Post;
}

std::vector<DrawnChannel> drawnChannels(const Scene& scene, const volume::DatasetInfo& info) {
    std::vector<DrawnChannel> out;
    bool exact = false; // all have samples of the same kind
    for (std::size_t i = 0; i < scene.layers.size(); ++i) {
        const Layer& layer = scene.layers[i];
        if (!layer.lens.empty() && !hasLens(scene, layer.lens)) continue;
        if (!layer.visible || std::holds_alternative<FlowLayer>(layer.technique)) continue;
        const auto* iso = std::get_if<IsoLayer>(&layer.technique);
        if (iso && iso->method == SurfaceMethod::Polygons) continue;
        const std::string& name =
            std::visit([](const auto& t) -> const std::string& { return t.channel; }, layer.technique);
        const std::optional<int> channel = info.findChannel(name);
        if (!channel) continue;
        const double time = scene.time + layer.timeShift;
        const auto wholeOf = [&](int of) { return info.channelRange(info.channel(of)); };
        const auto* volume = std::get_if<VolumeLayer>(&layer.technique);
        exact = exact || isNarrow(transferOfLayer(scene, info, layer, *channel).range, wholeOf(*channel)) ||
                (volume && volume->quantity == Quantity::Gradient) || drawsMarks(lookOf(layer.technique)) ||
                byRegions(layer.technique, transferOfLayer(scene, info, layer, *channel).function);
        Filter filter = scene.render.filter;
        const TransferFunction& function = transferOfLayer(scene, info, layer, *channel).function;
        const bool labels = info.parameters[std::size_t(info.channel(*channel).parameter)].categorical;
        if (classificationOf(layer.technique, function, labels) == Classification::Pre &&
            filter == Filter::AverageQuasi)
            filter = Filter::Average; // samples themselves are classified
        out.push_back({int(i), {*channel, timesOf(info, *channel, time), filter, false}});
        const std::optional<int> colors = info.findChannel(colorByOf(layer.technique));
        if (!colors) continue;
        exact = exact || isNarrow(transferOfColors(scene, info, layer, *colors).range, wholeOf(*colors));
        out.back().colors = {*colors, timesOf(info, *colors, time), scene.render.filter, false};
    }
    for (DrawnChannel& drawn : out) {
        drawn.channel.exact = exact;
        if (drawn.colors) drawn.colors->exact = exact;
    }
    return out;
}

std::vector<int> brushedChannels(const Scene& scene, const volume::DatasetInfo& info) {
    std::vector<int> out;
    for (const std::string& name : selectedChannels(scene.selection))
        if (const std::optional<int> channel = info.findChannel(name)) out.push_back(*channel);
    return out;
}

std::vector<PacketChannel> packetChannels(const Scene& scene, const volume::DatasetInfo& info) {
    std::vector<PacketChannel> out;
    for (const DrawnChannel& drawn : drawnChannels(scene, info)) {
        out.push_back(drawn.channel);
        if (drawn.colors) out.push_back(*drawn.colors);
    }
    const bool exact = !out.empty() && out.front().exact;
    for (const int channel : brushedChannels(scene, info))
        out.push_back({channel, timesOf(info, channel, scene.time), scene.render.filter, exact});
    return out;
}

} // namespace tessera::vis::packet
