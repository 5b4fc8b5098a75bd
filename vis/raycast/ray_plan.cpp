#include "vis/raycast/ray_plan.h"

#include "vis/optics/surface_light.h"
#include "vis/raycast/look_bits.h"
#include "vis/scene/drawn_scene.h"
#include "volume/bricks/parts_bricks.h"
#include "volume/reconstruct/part_choice.h"

#include <algorithm>

namespace tessera::vis {

namespace {

int fieldOf(RayPlan& plan, const DrawnChannel& drawn, bool raw = false) {
    for (std::size_t i = 0; i < plan.fields.size(); ++i) {
        const BoundField& field = plan.fields[i];
        if (field.channel == drawn.channel && field.raw == raw && field.transfer == drawn.transfer &&
            field.timeShift == drawn.timeShift)
            return int(i);
    }
    BoundField field;
    field.channel = drawn.channel;
    field.raw = raw;
    field.transfer = drawn.transfer;
    field.timeShift = drawn.timeShift;
    field.categorical = field.nearest = drawn.categorical;
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

/// Adds a volume layer, its field and its page of the plane tables to a plan.
RayLayer volumeUse(RayPlan& plan, const DrawnLayer& drawn, Filter filter) {
    RayLayer use{.layer = drawn.layer,
                 .style = drawn.volume->style,
                 .shaded = drawn.shaded,
                 .gradient = drawn.gradient,
                 .look = drawn.look ? lookBits(*drawn.look) : 0};
    if (drawn.byRegions)
        use.lookup = RayLookup::Plane;
    else if (drawn.classification == Classification::Pre)
        use.lookup = RayLookup::Lattice;
    else if (drawn.classification == Classification::PreIntegrated)
        use.lookup = RayLookup::Slab;
    if (use.lookup == RayLookup::Plane || use.lookup == RayLookup::Slab) use.page = plan.pages++;
    use.field =
        fieldOf(plan, drawn.shown, use.lookup == RayLookup::Lattice && prefilterOf(filter) != volume::Prefilter::None);
    return use;
}

/// Adds a layer to the plan, with its fields.
void planLayer(RayPlan& plan, const DrawnLayer& drawn, Filter filter, bool strokes) {
    if (drawn.slice) {
        plan.slices.push_back({drawn.layer, fieldOf(plan, drawn.shown), drawn.lens, drawn.brushes, 0, strokes});
        return;
    }
    if (drawn.volume)
        plan.layers.push_back(volumeUse(plan, drawn, filter));
    else
        plan.layers.push_back({.layer = drawn.layer,
                               .style = RayStyle::Iso,
                               .field = fieldOf(plan, drawn.shown),
                               .shaded = true,
                               .look = lookBits(*drawn.look)});
    plan.layers.back().lens = drawn.lens;
    plan.layers.back().brushes = drawn.brushes;
    if (drawn.colors) plan.layers.back().color = fieldOf(plan, *drawn.colors);
}

/// Adds layers while there is room for their fields; returns the channels of the others.
std::vector<std::string> planLayers(RayPlan& plan, const DrawnScene& drawn, const Scene& scene) {
    std::vector<std::string> left;
    for (const DrawnLayer& layer : drawn.layers) {
        const RayPlan former = plan;
        planLayer(plan, layer, scene.render.filter, strokesOf(scene, layer.layer) != nullptr);
        if (int(plan.fields.size()) <= plan.mostFields) continue;
        plan = former;
        left.push_back(shownChannel(scene.layers[std::size_t(layer.layer)].technique));
    }
    return left;
}

/// Adds the brushes and their fields; channels without room are added to `left`.
void planBrushes(RayPlan& plan, const DrawnScene& drawn, const Scene& scene, const volume::DatasetInfo& info,
                 std::vector<std::string>& left) {
    for (const int channel : drawn.brushed) {
        const int field = fieldOf(plan, drawnChannel(scene, info, channel));
        if (int(plan.fields.size()) > plan.mostFields) {
            plan.fields.pop_back();
            left.push_back(info.channel(channel).name);
            continue;
        }
        if (std::find(plan.brushFields.begin(), plan.brushFields.end(), field) == plan.brushFields.end())
            plan.brushFields.push_back(field);
    }
    // Brushes on unknown channels still have an effect, and the shader needs a field to sample.
    if (plan.brushFields.empty() && !selectedChannels(scene.selection).empty()) plan.brushFields.push_back(0);
    std::vector<int> channels;
    for (const int field : plan.brushFields) channels.push_back(plan.fields[std::size_t(field)].channel);
    plan.brushes = brushTests(scene.selection, info, channels, plan.lenses);
}

} // namespace

int mostFields(int samplers, const Scene& scene, bool bricked) {
    // Textures besides fields: transfer tables and block distances; lassos, plane tables, light maps, light volume,
    // grain, geometry, strokes.
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
                       (peelsOf(scene) > 0 ? 2 : 0) + !scene.strokes.empty();
    return std::min(kMostFields, samplers - others) / (bricked ? 2 : 1);
}

RayPlan planRays(const Scene& scene, const volume::DatasetInfo& info, int mostFields) {
    RayPlan plan;
    plan.mostFields = mostFields;
    const DrawnScene drawn = drawnScene(scene, info);
    plan.lenses = drawn.lenses;
    std::vector<std::string> left = planLayers(plan, drawn, scene);
    plan.peels = peelsOf(scene);
    if (plan.peels > 0 && plan.fields.empty() && !info.channels().empty())
        fieldOf(plan, drawnChannel(scene, info, 0)); // GLSL needs at least one field sampler
    if (!plan.empty() && scene.selection.active()) planBrushes(plan, drawn, scene, info, left);
    addParts(plan, info, mostFields);
    if (!left.empty()) plan.limit += (plan.limit.empty() ? "" : "; ") + tooMany(left);
    for (RayLayer& layer : plan.layers) layer.row = plan.rows++;
    for (SliceUse& slice : plan.slices) slice.row = plan.rows++;
    for (RayLayer& layer : plan.layers)
        if (layer.color >= 0) layer.colorRow = plan.rows++;
    return plan;
}

} // namespace tessera::vis
