#include "vis/technique/ray_plan.h"

#include "vis/model/proxy.h"
#include "vis/technique/brush_uniforms.h"
#include "vis/technique/ray_tables.h"
#include "volume/reconstruct.h"

#include <algorithm>

namespace tessera::vis {

namespace {

int fieldOf(RayPlan& plan, const volume::DatasetInfo& info, int channel) {
    for (std::size_t i = 0; i < plan.fields.size(); ++i)
        if (plan.fields[i].channel == channel) return int(i);
    BoundField field;
    field.channel = channel;
    const volume::Channel known = info.channels()[std::size_t(channel)];
    field.categorical = info.parameters[std::size_t(known.parameter)].categorical;
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

/// The channel a layer shows.
const std::string& channelOf(const Layer& layer) {
    return std::visit([](const auto& technique) -> const std::string& { return technique.channel; }, layer.technique);
}

} // namespace

RayPlan planRays(const Scene& scene, const volume::DatasetInfo& info) {
    RayPlan plan;
    for (std::size_t i = 0; i < scene.layers.size(); ++i) {
        const Layer& layer = scene.layers[i];
        const std::optional<int> channel = info.findChannel(channelOf(layer));
        if (!layer.visible || !channel) continue;
        const auto* surface = std::get_if<IsoLayer>(&layer.technique);
        if (surface && surface->method == SurfaceMethod::Polygons) continue; // comes as Scene::geometry
        const int field = fieldOf(plan, info, *channel);
        if (const auto* volume = std::get_if<VolumeLayer>(&layer.technique))
            plan.layers.push_back({int(i), RayStyle(int(volume->style)), field,
                                   volume->shaded && volume->style == VolumeStyle::Composite});
        else if (surface)
            plan.layers.push_back({int(i), RayStyle::Iso, field, true});
        else
            plan.slices.push_back({int(i), field});
    }
    plan.brushDefines = brushDefines({});
    plan.peels = peelsOf(scene.geometry);
    if (plan.peels > 0 && plan.fields.empty() && !info.channels().empty()) fieldOf(plan, info, 0); // samplers need one
    if (plan.empty() || !scene.selection.active()) return plan;
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
    plan.brushDefines = brushDefines(brushTests(plan, scene, info));
    return plan;
}

ProgramRecipe rayRecipe(const RayPlan& plan, const Scene& scene, const volume::BrickGrid& grid, bool skip) {
    const bool bcc = grid.lattice.kind == volume::LatticeKind::BCC;
    const auto uses = [&](RayStyle style) {
        return std::any_of(plan.layers.begin(), plan.layers.end(),
                           [&](const RayLayer& layer) { return layer.style == style; });
    };
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
    define("GEOMETRY", std::to_string(plan.peels));
    define("FIELD_COVERAGE(i)", choice(plan.fields, [](const BoundField& field) { return field.encoding.coverage; }));
    if (bricked) {
        define("BRICK_TEXELS", std::to_string(grid.brickSize));
    }
    define("FIELD_NEAREST(i)", choice(plan.fields, [](const BoundField& field) { return field.categorical; }));
    define("LAYERS", std::to_string(plan.layers.size()));
    define("LAYER_STYLE(i)", choice(plan.layers, [](const RayLayer& layer) { return int(layer.style); }));
    define("LAYER_FIELD(i)", choice(plan.layers, [](const RayLayer& layer) { return layer.field; }));
    define("LAYER_SHADED(i)", choice(plan.layers, [](const RayLayer& layer) { return layer.shaded; }));
    define("SLICES", std::to_string(plan.slices.size()));
    define("SLICE_FIELD(i)", choice(plan.slices, [](const SliceUse& slice) { return slice.field; }));
    define("BRUSH_FIELDS", std::to_string(plan.brushFields.size()));
    define("BRUSH_FIELD(i)", choice(plan.brushFields, [](int field) { return field; }));
    recipe.defines.insert(recipe.defines.end(), plan.brushDefines.begin(), plan.brushDefines.end());
    define("HAS_ISO", uses(RayStyle::Iso) ? "1" : "0");
    define("HAS_COMPOSITE", uses(RayStyle::Composite) ? "1" : "0");
    define("HAS_PROJECTION", uses(RayStyle::Maximum) || uses(RayStyle::XRay) ? "1" : "0");
    define("FLAT",
           std::none_of(plan.layers.begin(), plan.layers.end(), [](const RayLayer& layer) { return layer.shaded; })
               ? "1"
               : "0");
    define("TABLE_SIZE", std::to_string(kTableSize));
    define("HALO", std::to_string(kHalo));
    define("PRESENT_COVERAGE", std::to_string(volume::kPresentCoverage));
    define("REFERENCE_LENGTHS", std::to_string(1 / kReferenceLength));
    return recipe;
}

} // namespace tessera::vis
