#include "vis/raycast/brush_uniforms.h"
#include "vis/raycast/clip_uniforms.h"
#include "vis/raycast/lens_uniforms.h"
#include "vis/raycast/light_uniforms.h"
#include "vis/raycast/ray_tables.h"
#include "vis/shapes/proxy.h"
#include "volume/reconstruct/part_choice.h"
#include "volume/reconstruct/reconstruct.h"

#include <algorithm>

/// Constants and slots of the program for a plan; vis/shaders/lib/bindings/bindings.glsl documents them.
namespace tessera::vis {

namespace {

/// Adds defines to a recipe.
struct Defines {
    ProgramRecipe& recipe;

    void text(const char* name, const std::string& value) { recipe.defines.emplace_back(name, value); }
    void number(const char* name, std::size_t value) { text(name, std::to_string(value)); }
    void flag(const char* name, bool value) { text(name, value ? "1" : "0"); }
    /// Adds one value per element of a list, as macro "NAME(i)".
    template <class Each, class Member> void each(const char* name, const std::vector<Each>& all, Member member) {
        text(name, choice(all, member));
    }
};

void addFields(Defines define, const RayPlan& plan, bool cubic) {
    define.number("FIELDS", plan.fields.size());
    define.number("LATER", std::size_t(plan.later));
    define.each("FIELD_COVERAGE(i)", plan.fields, [](const BoundField& field) { return field.encoding.coverage; });
    define.each("FIELD_NEAREST(i)", plan.fields, [](const BoundField& field) { return field.nearest; });
    define.flag("CUBIC", cubic);
    define.each("FIELD_CUBIC(i)", plan.fields,
                [=](const BoundField& field) { return cubic && !field.nearest && !field.raw; });
    define.flag("PARTS", std::ranges::any_of(plan.fields, [](const BoundField& field) { return field.parts > 1; }));
    define.each("FIELD_PARTS(i)", plan.fields, [](const BoundField& field) { return field.parts; });
    define.each("FIELD_MORE(i)", plan.fields, [](const BoundField& field) { return field.more; });
    define.text("PART_MARGIN", std::to_string(volume::kPartMargin));
}

void addLayers(Defines define, const RayPlan& plan) {
    const std::vector<RayLayer>& layers = plan.layers;
    define.number("LAYERS", layers.size());
    define.each("LAYER_STYLE(i)", layers, [](const RayLayer& layer) { return layer.style; });
    define.each("LAYER_FIELD(i)", layers, [](const RayLayer& layer) { return layer.field; });
    define.flag("COLORED", std::ranges::any_of(layers, [](const RayLayer& layer) { return layer.color >= 0; }));
    define.each("LAYER_COLORED(i)", layers, [](const RayLayer& layer) { return layer.color >= 0; });
    define.each("LAYER_COLOR(i)", layers, [](const RayLayer& layer) { return std::max(layer.color, 0); });
    define.each("LAYER_COLOR_ROW(i)", layers, [](const RayLayer& layer) { return std::max(layer.colorRow, 0); });
    define.each("LAYER_SHADED(i)", layers, [](const RayLayer& layer) { return layer.shaded; });
    define.each("LAYER_LENS(i)", layers, [](const RayLayer& layer) { return layer.lens; });
    define.each("LAYER_BRUSHED(i)", layers, [](const RayLayer& layer) { return layer.brushes; });
    define.each("LAYER_LOOKUP(i)", layers, [](const RayLayer& layer) { return layer.lookup; });
    define.each("LAYER_LOOK(i)", layers, [](const RayLayer& layer) { return layer.look; });
    define.each("LAYER_GRADIENT(i)", layers, [](const RayLayer& layer) { return layer.gradient; });
    define.each("LAYER_INTERVAL(i)", layers, [](const RayLayer& layer) { return layer.opaque.has_value(); });
    define.each("LAYER_PLANE(i)", layers, [](const RayLayer& layer) { return layer.page; });
    std::vector<int> isos;
    for (std::size_t i = 0; i < layers.size(); ++i)
        if (layers[i].style == RayStyle::Iso) isos.push_back(int(i));
    define.number("ISOS", isos.size());
    define.each("ISO_LAYER(i)", isos, [](int layer) { return layer; });
}

/// Adds the constants that depend on any layer.
void addNeeds(Defines define, const RayPlan& plan) {
    const auto any = [&](const auto& is) { return std::ranges::any_of(plan.layers, is); };
    const auto looksUp = [&](RayLookup lookup) {
        return any([=](const RayLayer& layer) { return layer.lookup == lookup; });
    };
    const auto composite = [](const RayLayer& layer) { return layer.style == RayStyle::Composite; };
    int lookParts = 0;
    for (const RayLayer& layer : plan.layers) lookParts |= layer.look;
    define.number("LOOKS", std::size_t(lookParts));
    define.flag("HAS_PLANES", looksUp(RayLookup::Plane));
    define.flag("HAS_LATTICE", looksUp(RayLookup::Lattice));
    define.flag("HAS_SLABS", looksUp(RayLookup::Slab));
    define.flag("ONLY_COMPOSITE", std::ranges::all_of(plan.layers, composite));
    define.flag("HAS_COMPOSITE", any(composite));
    define.flag("HAS_PROJECTION",
                any([&](const RayLayer& layer) { return !composite(layer) && layer.style != RayStyle::Iso; }));
    define.flag("FLAT", !any([](const RayLayer& layer) {
                    return layer.shaded || layer.look != 0 || layer.lookup == RayLookup::Plane ||
                           layer.lookup == RayLookup::Lattice;
                }));
}

void addSlices(Defines define, const RayPlan& plan) {
    define.number("SLICES", plan.slices.size());
    define.each("SLICE_FIELD(i)", plan.slices, [](const SliceUse& slice) { return slice.field; });
    define.each("SLICE_LENS(i)", plan.slices, [](const SliceUse& slice) { return slice.lens; });
    define.each("SLICE_BRUSHED(i)", plan.slices, [](const SliceUse& slice) { return slice.brushes; });
    define.flag("STROKES", std::ranges::any_of(plan.slices, &SliceUse::strokes));
    define.each("SLICE_STROKES(i)", plan.slices, [](const SliceUse& slice) { return int(slice.strokes); });
}

void addTables(Defines define, const RayPlan& plan) {
    std::vector<int> rows;
    for (const RayLayer& layer : plan.layers) rows.push_back(layer.row);
    for (const SliceUse& slice : plan.slices) rows.push_back(slice.row);
    define.number("PLANES", std::size_t(plan.pages));
    define.number("PLANE_SIZE", kPlaneSize);
    define.number("TABLE_SIZE", kTableSize);
    define.number("TABLE_ROWS", std::size_t(plan.rows));
    define.each("TABLE_ROW(i)", rows, [](int row) { return row; });
}

void addLattice(Defines define, const Scene& scene, const volume::BrickGrid& grid, bool bricked) {
    const volume::LatticeKind kind = grid.lattice.kind;
    if (bricked) define.number("BRICK_TEXELS", std::size_t(grid.brickSize));
    define.flag("BCC", kind == volume::LatticeKind::BCC);
    define.flag("GRADIENT_DIAGONAL", volume::gradientStencil(kind, scene.render.gradient).diagonal);
    define.number("NORMAL_BITS", std::size_t(scene.render.normalBits));
    define.number("HALO", kHalo);
    define.text("PRESENT_COVERAGE", std::to_string(volume::kPresentCoverage));
    define.text("REFERENCE_LENGTHS", std::to_string(1 / kReferenceLength));
}

std::string reconstruction(volume::LatticeKind kind, Filter filter) {
    const bool cubic = filter == Filter::Cubic;
    if (kind != volume::LatticeKind::BCC) return cubic ? "slots/recon_cc_cubic.glsl" : "slots/recon_cc_linear.glsl";
    if (filter == Filter::Tetrahedral) return "slots/recon_bcc_tetrahedral.glsl";
    return cubic ? "slots/recon_bcc_cubic.glsl" : "slots/recon_bcc_average.glsl";
}

} // namespace

ProgramRecipe rayRecipe(const RayPlan& plan, const Scene& scene, const volume::BrickGrid& grid, bool skip) {
    const bool proxy = drawnByProxy(scene);
    const bool bricked = std::ranges::any_of(plan.fields, [](const BoundField& field) { return field.atlas != 0; });
    ProgramRecipe recipe;
    recipe.vertex = proxy ? "proxy.vert.glsl" : "screen.vert.glsl";
    recipe.fragment = proxy ? "proxy.frag.glsl" : "raycast.frag.glsl";
    recipe.slots["fetch"] = bricked ? "slots/fetch_bricked.glsl" : "slots/fetch_dense.glsl";
    recipe.slots["skip"] = skip ? "slots/skip_distance.glsl" : "slots/skip_none.glsl";
    recipe.slots["reconstruct"] = reconstruction(grid.lattice.kind, scene.render.filter);
    Defines define{recipe};
    addFields(define, plan, scene.render.filter == Filter::Cubic);
    addLayers(define, plan);
    addNeeds(define, plan);
    addSlices(define, plan);
    addTables(define, plan);
    addLattice(define, scene, grid, bricked);
    define.number("GEOMETRY", std::size_t(plan.peels));
    define.number("BRUSH_FIELDS", plan.brushFields.size());
    define.each("BRUSH_FIELD(i)", plan.brushFields, [](int field) { return field; });
    for (auto& [name, value] : brushDefines(plan.brushes, scene.selection)) define.text(name.c_str(), value);
    define.flag("CONTEXT_BLUR", blursContext(scene));
    define.flag("JITTER", scene.render.jitter);
    addLighting(recipe, scene);
    addClipping(recipe, scene);
    addLenses(recipe, plan.lenses, scene);
    return recipe;
}

} // namespace tessera::vis
