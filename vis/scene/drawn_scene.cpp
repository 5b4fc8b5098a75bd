#include "vis/scene/drawn_scene.h"

namespace tessera::vis {

namespace {

/// Sets what depends on how a volume is projected.
void setVolume(DrawnLayer& drawn) {
    const bool composite = drawn.volume->style == RayStyle::Composite, labels = drawn.shown.categorical;
    drawn.gradient = drawn.volume->quantity == Quantity::Gradient;
    if (!composite) return;
    const bool byValue = !drawn.gradient;
    drawn.look = &drawn.volume->look;
    drawn.shaded = drawn.volume->shaded && !labels;
    drawn.byRegions = byValue && drawn.shown.function->kind == TransferKind::Regions;
    if (byValue && !drawn.byRegions && !labels) drawn.classification = drawn.volume->classification;
}

std::optional<DrawnLayer> drawnLayer(const Scene& scene, const volume::DatasetInfo& info, int number,
                                     const std::vector<PlacedLens>& lenses) {
    const Layer& layer = scene.layers[std::size_t(number)];
    const std::optional<int> channel = info.findChannel(shownChannel(layer.technique));
    const std::optional<int> lens = lensOf(lenses, layer.lens);
    DrawnLayer drawn{.layer = number,
                     .volume = std::get_if<VolumeLayer>(&layer.technique),
                     .surface = std::get_if<IsoLayer>(&layer.technique),
                     .slice = std::get_if<SliceLayer>(&layer.technique),
                     .lens = lens.value_or(-1),
                     .brushes = layer.brushes,
                     .shown = {}};
    const bool rays = drawn.volume || drawn.slice || (drawn.surface && !drawn.surface->meshed());
    if (!layer.visible || !channel || !lens || !rays) return std::nullopt;
    // A layer's own function is that of its values, of a surface coloured by another channel that of its colours.
    const std::optional<int> colors = info.findChannel(colorByOf(layer.technique));
    const std::string ofColors = drawn.surface ? layer.transfer : "";
    drawn.shown = drawnChannel(scene, info, *channel, drawn.surface && colors ? "" : layer.transfer, layer.timeShift);
    if (colors) drawn.colors = drawnChannel(scene, info, *colors, ofColors, layer.timeShift);
    if (drawn.surface) drawn.look = &drawn.surface->look;
    if (drawn.volume) setVolume(drawn);
    return drawn;
}

} // namespace

DrawnChannel drawnChannel(const Scene& scene, const volume::DatasetInfo& info, int channel, const std::string& transfer,
                          double timeShift) {
    const volume::Channel known = info.channel(channel);
    const TransferFunction& function = transferFor(scene, transfer.empty() ? known.name : transfer);
    return {.channel = channel,
            .categorical = info.parameters[std::size_t(known.parameter)].categorical,
            .transfer = transfer,
            .timeShift = timeShift,
            .function = &function,
            .range = effectiveRange(function, info.channelRange(known))};
}

DrawnScene drawnScene(const Scene& scene, const volume::DatasetInfo& info) {
    DrawnScene drawn;
    drawn.lenses = placeLenses(scene, worldFrame(info, scene.stretch));
    for (int i = 0; i < int(scene.layers.size()); ++i)
        if (const auto layer = drawnLayer(scene, info, i, drawn.lenses)) drawn.layers.push_back(*layer);
    for (const std::string& name : selectedChannels(scene.selection))
        if (const std::optional<int> channel = info.findChannel(name)) drawn.brushed.push_back(*channel);
    return drawn;
}

std::vector<DrawnGeometry> drawnGeometry(const Scene& scene, const std::vector<PlacedLens>& lenses) {
    std::vector<DrawnGeometry> layers;
    for (int i = 0; i < int(scene.geometry.size()); ++i) {
        const GeometryLayer& layer = scene.geometry[std::size_t(i)];
        const std::optional<int> lens = lensOf(lenses, layer.lens);
        if (lens && drawn(scene, layer)) layers.push_back({i, *lens});
    }
    return layers;
}

std::optional<DrawnChannel> colorsOf(const Scene& scene, const volume::DatasetInfo& info, const GeometryLayer& layer) {
    const std::optional<int> channel = info.findChannel(layer.channel);
    if (!channel) return std::nullopt;
    return drawnChannel(scene, info, *channel, layer.transfer);
}

} // namespace tessera::vis
