#include "vis/raycast/lens_uniforms.h"

#include <algorithm>

namespace tessera::vis {

namespace {

/// Whether something is drawn only inside a lens.
bool anyOwned(const Scene& scene) {
    const auto owned = [](const auto& layer) { return !layer.lens.empty(); };
    return std::any_of(scene.layers.begin(), scene.layers.end(), owned) ||
           std::any_of(scene.geometry.begin(), scene.geometry.end(), owned);
}

} // namespace

void addLenses(ProgramRecipe& recipe, const std::vector<PlacedLens>& lenses, const Scene& scene) {
    const auto define = [&](const char* name, const std::string& value) { recipe.defines.emplace_back(name, value); };
    const auto flag = [&](const char* name, bool on) { define(name, on ? "1" : "0"); };
    const auto any = [&](LensEffect effect) {
        return std::ranges::any_of(lenses, [=](const PlacedLens& lens) { return lens.effect == effect; });
    };
    define("LENSES", std::to_string(lenses.size()));
    define("LENS_KIND(i)", choice(lenses, [](const PlacedLens& lens) { return lens.shape; }));
    define("LENS_BENDING(i)",
           choice(lenses, [](const PlacedLens& lens) { return lens.effect == LensEffect::Magnify; }));
    flag("LENS_ACTS", !lenses.empty() && (std::ranges::any_of(lenses, &PlacedLens::acts) || anyOwned(scene)));
    flag("LENS_SELECTS",
         std::ranges::any_of(lenses, [](const PlacedLens& lens) { return lens.shape == LensShape::Selection; }));
    flag("LENS_BENDS", any(LensEffect::Magnify));
    flag("LENS_FOCUS", any(LensEffect::Focus));
}

void setLensUniforms(const Program& program, const std::vector<PlacedLens>& lenses) {
    std::vector<glm::vec3> centers, rows, columns, acts;
    std::vector<glm::vec4> edges;
    for (const PlacedLens& lens : lenses) {
        centers.emplace_back(lens.center);
        for (int i = 0; i < 3; ++i) {
            rows.emplace_back(lens.toUnit[0][i], lens.toUnit[1][i], lens.toUnit[2][i]);
            columns.emplace_back(lens.fromUnit[i]);
        }
        edges.emplace_back(lens.rim, lens.inverted ? 1 : 0, lens.magnification, lens.focus);
        acts.emplace_back(lens.inside, lens.outside, lens.saturation);
    }
    program.set("lensCenter", centers);
    program.set("lensToUnit", rows);
    program.set("lensFromUnit", columns);
    program.set("lensEdge", edges);
    program.set("lensAct", acts);
}

} // namespace tessera::vis
