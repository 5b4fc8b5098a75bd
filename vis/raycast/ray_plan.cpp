#include "vis/raycast/ray_plan.h"

#include "vis/optics/surface_light.h"
#include "vis/raycast/lens_uniforms.h"
#include "vis/raycast/look_bits.h"
#include "volume/bricks/parts_bricks.h"
#include "volume/reconstruct/part_choice.h"

#include <algorithm>

namespace tessera::vis {

namespace {

int fieldOf(RayPlan& plan, const volume::DatasetInfo& info, int channel, bool raw = false, const Layer& layer = {}) {
    for (std::size_t i = 0; i < plan.fields.size(); ++i) {
        const BoundField& field = plan.fields[i];
        if (field.channel == channel && field.raw == raw && field.transfer == layer.transfer &&
            field.timeShift == layer.timeShift)
            return int(i);
    }
    BoundField field;
    field.channel = channel;
    field.raw = raw;
    field.transfer = layer.transfer;
    field.timeShift = layer.timeShift;
    const volume::Channel known = info.channel(channel);
    field.categorical = field.nearest = info.parameters[std::size_t(known.parameter)].categorical;
    plan.fields.push_back(field);
    return int(plan.fields.size()) - 1;
}

/// Replaces interpolation by nearest samples for a field, and removes what needs differences between samples.
void drawNearest(RayPlan& plan, int field, const std::string& name) {
    plan.fields[std::size_t(field)].nearest = true;
    std::erase_if(plan.layers, [=](const RayLayer& layer) {
        return layer.field == field &&
               (layer.style == RayStyle::Iso || layer.gradient || layer.lookup == RayLookup::Plane);
    });
    plan.pages = 0;
    for (RayLayer& layer : plan.layers) {
        if (layer.field == field) {
            layer.shaded = false;
            layer.look = 0;
            layer.lookup = RayLookup::Curve;
            layer.page = -1;
        }
        if (layer.page >= 0) layer.page = plan.pages++;
    }
    plan.limit += (plan.limit.empty() ? "" : ", ") + name;
}

/// Adds fields for the further parts of channels, as far as there is room.
void addParts(RayPlan& plan, const volume::DatasetInfo& info, int mostFields) {
    plan.channels = int(plan.fields.size());
    for (int i = 0; i < plan.channels; ++i) {
        const volume::Channel channel = info.channel(plan.fields[std::size_t(i)].channel);
        const volume::Parameter& parameter = info.parameters[std::size_t(channel.parameter)];
        if (!volume::labelChannel(info, parameter)) continue;
        const int parts = int(parameter.parts.count());
        if (int(plan.fields.size()) + parts - 1 > mostFields) {
            drawNearest(plan, i, channel.name);
            continue;
        }
        BoundField& first = plan.fields[std::size_t(i)];
        first.parts = parts;
        first.more = int(plan.fields.size());
        first.part = 0;
        for (int part = 1; part < parts; ++part) {
            BoundField other = plan.fields[std::size_t(i)];
            other.parts = 1;
            other.part = part;
            plan.fields.push_back(other);
        }
    }
    if (!plan.limit.empty())
        plan.limit = "too many parameters are drawn at once to separate the parts of " + plan.limit +
                     ": its nearest samples are drawn, without surfaces and gradients; show fewer layers";
}

std::string tooMany(const std::vector<std::string>& left) {
    std::string names;
    for (const std::string& name : left) names += (names.empty() ? "" : ", ") + name;
    return "too many parameters at once for the graphics driver: " + names + " left out; show fewer layers";
}

/// The channel that a layer shows.
const std::string& channelOf(const Layer& layer) {
    return std::visit([](const auto& technique) -> const std::string& { return technique.channel; }, layer.technique);
}

/// Adds a volume layer, its field and its page of the plane tables to a plan.
RayLayer volumeUse(RayPlan& plan, int layer, const VolumeLayer& volume, int channel, const Scene& scene,
                   const volume::DatasetInfo& info) {
    const volume::Channel known = info.channel(channel);
    const Layer& own = scene.layers[std::size_t(layer)];
    RayLayer use;
    use.layer = layer;
    use.style = volume.style;
    use.gradient = volume.quantity == Quantity::Gradient;
    if (volume.style == RayStyle::Composite) {
        const bool categorical = info.parameters[std::size_t(known.parameter)].categorical;
        const Classification asked = use.gradient || categorical ? Classification::Post : volume.classification;
        use.shaded = volume.shaded && !categorical;
        use.look = lookBits(volume.look);
        if (!use.gradient &&
            transferFor(scene, own.transfer.empty() ? known.name : own.transfer).kind == TransferKind::Regions)
            use.lookup = RayLookup::Plane;
        else if (asked == Classification::Pre)
            use.lookup = RayLookup::Lattice;
        else if (asked == Classification::PreIntegrated)
            use.lookup = RayLookup::Slab;
    }
    if (use.lookup == RayLookup::Plane || use.lookup == RayLookup::Slab) use.page = plan.pages++;
    const bool raw = use.lookup == RayLookup::Lattice && scene.render.filter == Filter::AverageQuasi;
    use.field = fieldOf(plan, info, channel, raw, own);
    return use;
}

/// Adds a layer of the scene to the plan, with its fields, if rays intersect it.
void planLayer(RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info, int number) {
    const Layer& layer = scene.layers[std::size_t(number)];
    const std::optional<int> channel = info.findChannel(channelOf(layer));
    const std::optional<int> lens = lensOf(plan.lenses, layer.lens);
    if (!layer.visible || !channel || !lens) return;
    const auto* surface = std::get_if<IsoLayer>(&layer.technique);
    const std::optional<int> color =
        colorByOf(layer.technique).empty() ? std::nullopt : info.findChannel(colorByOf(layer.technique));
    // A layer's own transfer function applies to its channel or, for a surface coloured by another channel, to that
    // one.
    Layer shape = layer, colors = layer;
    (surface && color ? shape : colors).transfer.clear();
    if (surface && surface->method == SurfaceMethod::Polygons) return; // drawn as Scene::geometry
    if (std::holds_alternative<FlowLayer>(layer.technique)) return;    // also drawn as Scene::geometry
    if (std::holds_alternative<SliceLayer>(layer.technique)) {
        plan.slices.push_back({number, fieldOf(plan, info, *channel, false, layer), *lens, layer.brushes, 0});
        return;
    }
    if (const auto* volume = std::get_if<VolumeLayer>(&layer.technique))
        plan.layers.push_back(volumeUse(plan, number, *volume, *channel, scene, info));
    else
        plan.layers.push_back({.layer = number,
                               .style = RayStyle::Iso,
                               .field = fieldOf(plan, info, *channel, false, shape),
                               .shaded = true,
                               .look = lookBits(surface->look)});
    plan.layers.back().lens = *lens;
    plan.layers.back().brushes = layer.brushes;
    if (color) plan.layers.back().color = fieldOf(plan, info, *color, false, colors);
}

/// Adds the ray layers of a scene while there is room for their fields; returns the channels of the others.
std::vector<std::string> planLayers(RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info) {
    std::vector<std::string> left;
    for (std::size_t i = 0; i < scene.layers.size(); ++i) {
        const RayPlan former = plan;
        planLayer(plan, scene, info, int(i));
        if (int(plan.fields.size()) <= plan.mostFields) continue;
        plan = former;
        left.push_back(channelOf(scene.layers[i]));
    }
    return left;
}

/// Adds the brushes and their fields; channels without room are added to `left`.
void planBrushes(RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info, std::vector<std::string>& left) {
    const std::vector<std::string> brushed = selectedChannels(scene.selection);
    for (const std::string& name : brushed) {
        const std::optional<int> channel = info.findChannel(name);
        if (!channel) continue;
        const int field = fieldOf(plan, info, *channel);
        if (int(plan.fields.size()) > plan.mostFields) {
            plan.fields.pop_back();
            left.push_back(name);
            continue;
        }
        if (std::find(plan.brushFields.begin(), plan.brushFields.end(), field) == plan.brushFields.end())
            plan.brushFields.push_back(field);
    }
    // Brushes on unknown channels still have an effect, and the shader needs a field to sample.
    if (plan.brushFields.empty() && !brushed.empty()) plan.brushFields.push_back(0);
    std::vector<int> channels;
    for (const int field : plan.brushFields) channels.push_back(plan.fields[std::size_t(field)].channel);
    plan.brushes = brushTests(scene.selection, info, channels, plan.lenses);
}

} // namespace

int mostFields(int samplers, const Scene& scene, bool bricked) {
    // Textures besides fields: transfer tables and block distances; lassos, plane tables, light maps, light volume,
    // grain, geometry.
    const auto charcoal = [](const Layer& layer) {
        const Look* look = lookOf(layer.technique);
        return look && look->charcoal;
    };
    const auto regions = [](const auto& each) { return each.second.kind == TransferKind::Regions; };
    const auto integrated = [](const Layer& layer) {
        const auto* volume = std::get_if<VolumeLayer>(&layer.technique);
        return volume && volume->classification == Classification::PreIntegrated;
    };
    const bool lasso = std::ranges::any_of(scene.selection.brushes, [](const Brush& brush) {
        return brush.enabled && std::holds_alternative<LassoRegion>(brush.region);
    });
    const bool planes = std::ranges::any_of(scene.transfer, regions) || std::ranges::any_of(scene.layers, integrated);
    const int others = 2 + lasso + planes + (usesMaps(scene.lighting) ? 2 : 0) +
                       (scene.lighting.shadows.any() ? 2 : 0) + std::ranges::any_of(scene.layers, charcoal) +
                       (peelsOf(scene) > 0 ? 2 : 0);
    return std::min(kMostFields, samplers - others) / (bricked ? 2 : 1);
}

RayPlan planRays(const Scene& scene, const volume::DatasetInfo& info, int mostFields) {
    RayPlan plan;
    plan.mostFields = mostFields;
    plan.lenses = placeLenses(scene, worldFrame(info.bounds, scene.stretch));
    std::vector<std::string> left = planLayers(plan, scene, info);
    plan.peels = peelsOf(scene);
    if (plan.peels > 0 && plan.fields.empty() && !info.channels().empty())
        fieldOf(plan, info, 0); // GLSL needs at least one field sampler
    if (!plan.empty() && scene.selection.active()) planBrushes(plan, scene, info, left);
    addParts(plan, info, mostFields);
    if (!left.empty()) plan.limit += (plan.limit.empty() ? "" : "; ") + tooMany(left);
    for (RayLayer& layer : plan.layers) layer.row = plan.rows++;
    for (SliceUse& slice : plan.slices) slice.row = plan.rows++;
    for (RayLayer& layer : plan.layers)
        if (layer.color >= 0) layer.colorRow = plan.rows++;
    return plan;
}

} // namespace tessera::vis
