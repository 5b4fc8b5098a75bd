#include "vis/raycast/ray_plan.h"

#include "vis/optics/proxy.h"
#include "vis/raycast/brush_uniforms.h"
#include "vis/raycast/clip_uniforms.h"
#include "vis/raycast/lens_uniforms.h"
#include "vis/raycast/light_uniforms.h"
#include "vis/raycast/look_uniforms.h"
#include "vis/raycast/ray_tables.h"
#include "volume/bricks/parts_bricks.h"
#include "volume/reconstruct/part_choice.h"
#include "volume/reconstruct/reconstruct.h"

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

/// `member` of the i-th use as an expression of i that folds to a constant once a loop is unrolled.
template <class Use, class Member> std::string choice(const std::vector<Use>& uses, Member member) {
    std::string chain = "0";
    for (std::size_t i = uses.size(); i-- > 0;)
        chain = "((i)==" + std::to_string(i) + "?" + std::to_string(int(member(uses[i]))) + ":" + chain + ")";
    return chain;
}

/// Shows a field's nearest samples, and leaves out what is made of differences between samples.
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

/// Gives the further parts of channels fields of their own, as far as there is room.
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
        plan.limit = "too many channels at once for the parts of " + plan.limit +
                     ": its nearest samples are shown, without surfaces and gradients; show fewer layers";
}

/// The channel a layer shows.
const std::string& channelOf(const Layer& layer) {
    return std::visit([](const auto& technique) -> const std::string& { return technique.channel; }, layer.technique);
}

/// A volume layer of a plan; its field and the page of its table are added.
RayLayer volumeUse(RayPlan& plan, int layer, const VolumeLayer& volume, int channel, const Scene& scene,
                   const volume::DatasetInfo& info) {
    const volume::Channel known = info.channel(channel);
    const Layer& own = scene.layers[std::size_t(layer)];
    RayLayer use;
    use.layer = layer;
    use.style = RayStyle(int(volume.style));
    use.gradient = volume.quantity == Quantity::Gradient;
    if (volume.style == VolumeStyle::Composite) {
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

/// The layers of a scene that rays meet, and their fields.
void planLayers(RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info) {
    const std::vector<PlacedLens> lenses = placeLenses(scene, {});
    for (std::size_t i = 0; i < scene.layers.size(); ++i) {
        const Layer& layer = scene.layers[i];
        const std::optional<int> channel = info.findChannel(channelOf(layer));
        const std::optional<int> lens = lensOf(lenses, layer.lens);
        if (!layer.visible || !channel || !lens) continue;
        const auto* surface = std::get_if<IsoLayer>(&layer.technique);
        const std::optional<int> color =
            colorByOf(layer.technique).empty() ? std::nullopt : info.findChannel(colorByOf(layer.technique));
        // A function of its own is that of what it shows by colours: of a surface, that which colours it.
        Layer shape = layer, colors = layer;
        (surface && color ? shape : colors).transfer.clear();
        if (surface && surface->method == SurfaceMethod::Polygons) continue; // comes as Scene::geometry
        if (std::holds_alternative<FlowLayer>(layer.technique)) continue;    // so does this
        if (const auto* volume = std::get_if<VolumeLayer>(&layer.technique))
            plan.layers.push_back(volumeUse(plan, int(i), *volume, *channel, scene, info));
        else if (surface)
            plan.layers.push_back({.layer = int(i),
                                   .style = RayStyle::Iso,
                                   .field = fieldOf(plan, info, *channel, false, shape),
                                   .shaded = true,
                                   .look = lookBits(surface->look)});
        else
            plan.slices.push_back({int(i), fieldOf(plan, info, *channel, false, layer), *lens, layer.brushes, 0});
        if (std::holds_alternative<SliceLayer>(layer.technique)) continue;
        plan.layers.back().lens = *lens;
        plan.layers.back().brushes = layer.brushes;
        if (color) plan.layers.back().color = fieldOf(plan, info, *color, false, colors);
    }
}

/// The fields that brushes look at.
void planBrushes(RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info) {
    const std::vector<std::string> brushed = selectedChannels(scene.selection);
    for (const std::string& name : brushed) {
        const std::optional<int> channel = info.findChannel(name);
        if (!channel) continue;
        const int field = fieldOf(plan, info, *channel);
        if (std::find(plan.brushFields.begin(), plan.brushFields.end(), field) == plan.brushFields.end())
            plan.brushFields.push_back(field);
    }
    // Brushes whose channels are unknown still decide: sample something.
    if (plan.brushFields.empty() && !brushed.empty()) plan.brushFields.push_back(0);
}

} // namespace

RayPlan planRays(const Scene& scene, const volume::DatasetInfo& info, int mostFields) {
    RayPlan plan;
    planLayers(plan, scene, info);
    plan.peels = peelsOf(scene);
    if (plan.peels > 0 && plan.fields.empty() && !info.channels().empty()) fieldOf(plan, info, 0); // samplers need one
    const bool brushes = !plan.empty() && scene.selection.active();
    if (brushes) planBrushes(plan, scene, info);
    addParts(plan, info, mostFields);
    for (RayLayer& layer : plan.layers) layer.row = plan.rows++;
    for (SliceUse& slice : plan.slices) slice.row = plan.rows++;
    for (RayLayer& layer : plan.layers)
        if (layer.color >= 0) layer.colorRow = plan.rows++;
    plan.brushDefines = brushDefines(brushes ? brushTests(plan, scene, info) : BrushTests(), scene);
    return plan;
}

ProgramRecipe rayRecipe(const RayPlan& plan, const Scene& scene, const volume::BrickGrid& grid, bool skip) {
    const bool bcc = grid.lattice.kind == volume::LatticeKind::BCC;
    const auto any = [&](const auto& holds) {
        return std::any_of(plan.layers.begin(), plan.layers.end(), holds) ? "1" : "0";
    };
    const auto looks = [&](RayLookup lookup) {
        return any([=](const RayLayer& layer) { return layer.lookup == lookup; });
    };
    std::vector<int> isos;
    for (std::size_t i = 0; i < plan.layers.size(); ++i)
        if (plan.layers[i].style == RayStyle::Iso) isos.push_back(int(i));
    ProgramRecipe recipe;
    const bool proxy = drawnByProxy(scene);
    recipe.vertex = proxy ? "proxy.vert.glsl" : "screen.vert.glsl";
    recipe.fragment = proxy ? "proxy.frag.glsl" : "raycast.frag.glsl";
    const bool bricked =
        std::any_of(plan.fields.begin(), plan.fields.end(), [](const BoundField& f) { return f.atlas; });
    recipe.slots["fetch"] = bricked ? "slots/fetch_bricked.glsl" : "slots/fetch_dense.glsl";
    recipe.slots["skip"] = skip ? "slots/skip_distance.glsl" : "slots/skip_none.glsl";
    recipe.slots["reconstruct"] = !bcc                                         ? "slots/recon_cc_linear.glsl"
                                  : scene.render.filter == Filter::Tetrahedral ? "slots/recon_bcc_tetrahedral.glsl"
                                                                               : "slots/recon_bcc_average.glsl";
    const auto define = [&](const char* name, const std::string& value) { recipe.defines.emplace_back(name, value); };
    define("FIELDS", std::to_string(plan.fields.size()));
    define("LATER", std::to_string(plan.later));
    define("GEOMETRY", std::to_string(plan.peels));
    define("FIELD_COVERAGE(i)", choice(plan.fields, [](const BoundField& field) { return field.encoding.coverage; }));
    if (bricked) {
        define("BRICK_TEXELS", std::to_string(grid.brickSize));
    }
    define("FIELD_NEAREST(i)", choice(plan.fields, [](const BoundField& field) { return field.nearest; }));
    const bool parts = std::ranges::any_of(plan.fields, [](const BoundField& field) { return field.parts > 1; });
    define("PARTS", parts ? "1" : "0");
    define("FIELD_PARTS(i)", choice(plan.fields, [](const BoundField& field) { return field.parts; }));
    define("FIELD_MORE(i)", choice(plan.fields, [](const BoundField& field) { return field.more; }));
    define("PART_MARGIN", std::to_string(volume::kPartMargin));
    define("LAYERS", std::to_string(plan.layers.size()));
    define("LAYER_STYLE(i)", choice(plan.layers, [](const RayLayer& layer) { return int(layer.style); }));
    define("LAYER_FIELD(i)", choice(plan.layers, [](const RayLayer& layer) { return layer.field; }));
    define("COLORED", any([](const RayLayer& layer) { return layer.color >= 0; }));
    define("LAYER_COLORED(i)", choice(plan.layers, [](const RayLayer& layer) { return layer.color >= 0; }));
    define("LAYER_COLOR(i)", choice(plan.layers, [](const RayLayer& layer) { return std::max(layer.color, 0); }));
    define("LAYER_COLOR_ROW(i)",
           choice(plan.layers, [](const RayLayer& layer) { return std::max(layer.colorRow, 0); }));
    define("LAYER_SHADED(i)", choice(plan.layers, [](const RayLayer& layer) { return layer.shaded; }));
    define("LAYER_LENS(i)", choice(plan.layers, [](const RayLayer& layer) { return layer.lens; }));
    define("SLICE_LENS(i)", choice(plan.slices, [](const SliceUse& slice) { return slice.lens; }));
    define("LAYER_BRUSHED(i)", choice(plan.layers, [](const RayLayer& layer) { return int(layer.brushes); }));
    define("SLICE_BRUSHED(i)", choice(plan.slices, [](const SliceUse& slice) { return int(slice.brushes); }));
    define("SLICES", std::to_string(plan.slices.size()));
    define("SLICE_FIELD(i)", choice(plan.slices, [](const SliceUse& slice) { return slice.field; }));
    define("BRUSH_FIELDS", std::to_string(plan.brushFields.size()));
    define("BRUSH_FIELD(i)", choice(plan.brushFields, [](int field) { return field; }));
    recipe.defines.insert(recipe.defines.end(), plan.brushDefines.begin(), plan.brushDefines.end());
    define("LAYER_LOOKUP(i)", choice(plan.layers, [](const RayLayer& layer) { return int(layer.lookup); }));
    define("LAYER_LOOK(i)", choice(plan.layers, [](const RayLayer& layer) { return layer.look; }));
    int lookParts = 0;
    for (const RayLayer& layer : plan.layers) lookParts |= layer.look;
    define("LOOKS", std::to_string(lookParts));
    define("LAYER_GRADIENT(i)", choice(plan.layers, [](const RayLayer& layer) { return layer.gradient; }));
    define("LAYER_INTERVAL(i)", choice(plan.layers, [](const RayLayer& layer) { return layer.opaque.has_value(); }));
    define("LAYER_PLANE(i)", choice(plan.layers, [](const RayLayer& layer) { return layer.page; }));
    define("ISOS", std::to_string(isos.size()));
    define("ISO_LAYER(i)", choice(isos, [](int layer) { return layer; }));
    define("PLANES", std::to_string(plan.pages));
    define("PLANE_SIZE", std::to_string(kPlaneSize));
    define("HAS_PLANES", looks(RayLookup::Plane));
    define("HAS_LATTICE", looks(RayLookup::Lattice));
    define("HAS_SLABS", looks(RayLookup::Slab));
    define("ONLY_COMPOSITE", std::all_of(plan.layers.begin(), plan.layers.end(),
                                         [](const RayLayer& layer) { return layer.style == RayStyle::Composite; })
                                 ? "1"
                                 : "0");
    define("HAS_COMPOSITE", any([](const RayLayer& layer) { return layer.style == RayStyle::Composite; }));
    define("HAS_PROJECTION", any([](const RayLayer& layer) {
               return layer.style != RayStyle::Composite && layer.style != RayStyle::Iso;
           }));
    define("FLAT", std::none_of(plan.layers.begin(), plan.layers.end(),
                                [](const RayLayer& layer) {
                                    return layer.shaded || layer.look != 0 || layer.lookup == RayLookup::Plane ||
                                           layer.lookup == RayLookup::Lattice;
                                })
                       ? "1"
                       : "0");
    define("CONTEXT_BLUR", blursContext(scene) ? "1" : "0");
    define("BCC", bcc ? "1" : "0");
    define("GRADIENT_DIAGONAL", volume::gradientStencil(grid.lattice.kind, scene.render.gradient).diagonal ? "1" : "0");
    define("NORMAL_BITS", std::to_string(scene.render.normalBits));
    addLighting(recipe, scene);
    addClipping(recipe, scene);
    addLenses(recipe, scene);
    define("JITTER", scene.render.jitter ? "1" : "0");
    std::vector<int> rows;
    for (const RayLayer& layer : plan.layers) rows.push_back(layer.row);
    for (const SliceUse& slice : plan.slices) rows.push_back(slice.row);
    define("TABLE_SIZE", std::to_string(kTableSize));
    define("TABLE_ROWS", std::to_string(plan.rows));
    define("TABLE_ROW(i)", choice(rows, [](int row) { return row; }));
    define("HALO", std::to_string(kHalo));
    define("PRESENT_COVERAGE", std::to_string(volume::kPresentCoverage));
    define("REFERENCE_LENGTHS", std::to_string(1 / kReferenceLength));
    return recipe;
}

} // namespace tessera::vis
