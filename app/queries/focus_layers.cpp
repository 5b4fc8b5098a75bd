#include "app/queries/focus_layers.h"

#include "volume/flow/flow_channels.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

/// Values of a channel that brushes may select, as places 0..1 of a function's range.
Range brushedPlaces(const vis::Selection& selection, const std::string& channel, Range range) {
    Range places{0, 1};
    const auto joins = [](const vis::Brush& brush) { return brush.enabled && brush.combine == vis::BrushCombine::Or; };
    if (std::ranges::any_of(selection.brushes, joins)) return places;
    for (const vis::Brush& brush : selection.brushes) {
        const auto* region = std::get_if<vis::RangeRegion>(&brush.region);
        if (!brush.enabled || brush.inverted || brush.combine == vis::BrushCombine::Minus || !region) continue;
        for (const vis::BrushInterval& each : region->intervals) {
            if (each.channel != channel || !(range.hi > range.lo)) continue;
            places.lo = std::max(places.lo, (each.lo - range.lo) / (range.hi - range.lo));
            places.hi = std::min(places.hi, (each.hi - range.lo) / (range.hi - range.lo));
        }
    }
    return places;
}

/// Whether a volume of this density hides some of these values of a function.
bool hides(const vis::TransferFunction& function, double density, Range places, double least) {
    if (function.kind == vis::TransferKind::Regions) return true;
    constexpr int kSteps = 64;
    for (int i = 0; i <= kSteps; ++i) {
        const double opacity = vis::evaluate(function, {0, 1}, places.lo + (places.hi - places.lo) * i / kSteps).a;
        if (1 - std::pow(1 - opacity, density) < least) return true;
    }
    return false;
}

/// The volume of a layer's parameter, of what is brushed alone.
void addBrushedVolume(vis::Scene& scene, const volume::DatasetInfo& info, const vis::Layer& of,
                      vis::VolumeLayer volume) {
    const auto channel = info.findChannel(volume.channel);
    if (!channel || volume::parameterOf(info, *channel).categorical) return;
    const std::string name = of.transfer.empty() ? volume.channel : of.transfer;
    vis::TransferFunction function = vis::transferFor(scene, name);
    const Range range = vis::effectiveRange(function, info.channelRange(info.channel(*channel)));
    const double least = double(scene.selection.focusOpacity);
    if (!hides(function, double(volume.density), brushedPlaces(scene.selection, volume.channel, range), least)) return;
    function.kind = vis::TransferKind::Curve;
    function.opacity = {{0, scene.selection.focusOpacity}, {1, scene.selection.focusOpacity}};
    std::string own = name + " brushed";
    while (scene.transfer.contains(own)) own += "'";
    scene.transfer[own] = function;
    volume.density = 1; // the opacity of the focus is that of the selection
    vis::Layer focus = of;
    focus.name = own;
    focus.technique = std::move(volume);
    focus.brushes = vis::BrushEffect::FocusOnly;
    focus.transfer = own;
    scene.layers.push_back(std::move(focus));
}

} // namespace

void addFocusLayers(vis::Scene& scene, const volume::DatasetInfo& info) {
    if (!scene.selection.active() || !(scene.selection.focusOpacity > 0)) return;
    const std::vector<vis::Layer> layers = scene.layers;
    bool volumes = false;
    for (const vis::Layer& layer : layers) {
        const auto* volume = std::get_if<vis::VolumeLayer>(&layer.technique);
        if (!volume || !layer.visible) continue;
        volumes = true;
        if (volume->style == vis::RayStyle::Composite && volume->quantity == vis::Quantity::Value &&
            layer.brushes == vis::BrushEffect::Fade)
            addBrushedVolume(scene, info, layer, *volume);
    }
    if (volumes) return;
    const auto shown = std::ranges::find_if(layers, [](const vis::Layer& layer) {
        return layer.visible && layer.brushes == vis::BrushEffect::Fade &&
               !std::holds_alternative<vis::FlowLayer>(layer.technique) &&
               !std::holds_alternative<vis::GlyphLayer>(layer.technique);
    });
    if (shown != layers.end()) addBrushedVolume(scene, info, *shown, {.channel = vis::shownChannel(shown->technique)});
}

} // namespace tessera::app
