#include "vis/reference/prepared.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tessera::vis::reference {

double DrawnLayer::unclamped(double value) const {
    const double width = range.hi - range.lo;
    return width != 0 ? (value - range.lo) / width : 0.5;
}

double DrawnLayer::place(double value) const {
    const double width = range.hi - range.lo;
    if (width == 0) return value > range.lo ? 1 : value < range.lo ? 0 : 0.5;
    return std::clamp((value - range.lo) / width, 0.0, 1.0);
}

glm::dvec4 DrawnLayer::classify(double value) const {
    const glm::dvec4 srgb = evaluate(*function, range, value);
    return {linearFromSrgb(glm::dvec3(srgb)), srgb.a};
}

glm::dvec4 DrawnLayer::classifyPlace(double at) const {
    return classify(glm::mix(range.lo, range.hi, at));
}

Prepared::Prepared(const Scene& drawn, const volume::BrickSource& source, const Options& wanted)
    : scene(drawn), options(wanted), lattice(source.grid().lattice), interestOf(drawn.selection) {
    const volume::DatasetInfo& info = source.info();
    frame = worldFrame(info.bounds, scene.stretch);
    cell = worldCell(lattice, frame);
    toLight = lightDirection(scene.render, scene.camera);
    const int time = info.nearestTime(scene.time);
    const auto load = [&](const std::string& name, bool raw = false) -> const Samples* {
        const std::optional<int> channel = info.findChannel(name);
        if (!channel) return nullptr;
        std::unique_ptr<Samples>& entry = (raw ? rawSamples : samples)[name];
        const Filter filter =
            raw && scene.render.filter == Filter::AverageQuasi ? Filter::Average : scene.render.filter;
        if (!entry) entry = std::make_unique<Samples>(source, *channel, time, filter, options.flaws);
        return entry.get();
    };
    for (const Layer& layer : scene.layers) {
        const std::string& name =
            std::visit([](const auto& t) -> const std::string& { return t.channel; }, layer.technique);
        DrawnLayer one;
        one.technique = &layer.technique;
        one.samples = layer.visible ? load(name) : nullptr;
        if (one.samples == nullptr) continue;
        const volume::Channel channel = info.channels()[std::size_t(*info.findChannel(name))];
        one.function = &transferFor(scene, channel.name);
        one.range = effectiveRange(*one.function, info.channelRange(channel));
        const auto* volume = std::get_if<VolumeLayer>(one.technique);
        if (volume != nullptr && volume->style == VolumeStyle::Composite && volume->quantity == Quantity::Value &&
            !one.samples->categorical() && one.function->kind == TransferKind::Curve)
            one.classification = volume->classification;
        if (one.classification == Classification::Pre) one.samples = load(name, true);
        if (one.classification == Classification::PreIntegrated)
            one.integrals = integralFunctions(*one.function, one.range);
        if (const auto* slice = std::get_if<SliceLayer>(one.technique))
            one.plane = slicePlane(*slice, frame, scene.cursor);
        layers.push_back(std::move(one));
    }
    for (const std::string& channel : interestOf.channels()) brushed.push_back(load(channel));
}

double Prepared::interest(glm::dvec3 world) const {
    if (!scene.selection.active()) return 1;
    std::vector<double> values;
    for (const Samples* of : brushed)
        values.push_back(
            (of ? of->value(cells(world)) : std::nullopt).value_or(std::numeric_limits<double>::quiet_NaN()));
    return interestOf(values, frame.toPhysical(world));
}

double Prepared::steepness(const DrawnLayer& layer, glm::dvec3 world) const {
    const double width = std::abs(layer.range.hi - layer.range.lo);
    if (layer.samples->categorical() || !(width > 0)) return 0;
    const glm::dvec3 edges = lattice.spacing * frame.scale; // of a sublattice cell
    return glm::length(gradient(*layer.samples, world) / edges * cell) / width;
}

} // namespace tessera::vis::reference
