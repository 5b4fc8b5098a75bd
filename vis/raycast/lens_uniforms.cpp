#include "vis/raycast/lens_uniforms.h"

#include <algorithm>

namespace tessera::vis {

namespace {

/// Whether something is drawn in a lens alone.
bool anyOwned(const Scene& scene) {
    const auto owned = [](const auto& layer) { return !layer.lens.empty(); };
    return std::any_of(scene.layers.begin(), scene.layers.end(), owned) ||
           std::any_of(scene.geometry.begin(), scene.geometry.end(), owned);
}

} // namespace

void addLenses(ProgramRecipe& recipe, const Scene& scene) {
    const std::vector<PlacedLens> lenses = placeLenses(scene, {});
    // Chains of ?: as everywhere (lib/bindings.glsl).
    std::string kinds = "0", bending = "0";
    for (std::size_t i = lenses.size(); i-- > 0;) {
        const std::string test = "((i)==" + std::to_string(i) + "?";
        kinds = test + std::to_string(int(lenses[i].shape)) + ":" + kinds + ")";
        bending = test + (lenses[i].effect == LensEffect::Magnify ? "1" : "0") + ":" + bending + ")";
    }
    const auto any = [&](const auto& is) { return std::any_of(lenses.begin(), lenses.end(), is); };
    const auto define = [&](const char* name, const std::string& value) { recipe.defines.emplace_back(name, value); };
    define("LENSES", std::to_string(lenses.size()));
    define("LENS_KIND(i)", kinds);
    define("LENS_BENDING(i)", bending);
    const bool acts = any([](const PlacedLens& lens) { return lens.acts(); });
    define("LENS_ACTS", !lenses.empty() && (acts || anyOwned(scene)) ? "1" : "0");
    define("LENS_BENDS", lensesBend(scene) ? "1" : "0");
    define("LENS_FOCUS", any([](const PlacedLens& lens) { return lens.effect == LensEffect::Focus; }) ? "1" : "0");
}

void setLensUniforms(const Program& program, const Scene& scene, const WorldFrame& frame) {
    std::vector<glm::vec3> centers, rows, columns, acts;
    std::vector<glm::vec4> edges;
    for (const PlacedLens& lens : placeLenses(scene, frame)) {
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

bool lensesBend(const Scene& scene) {
    return std::any_of(scene.lenses.begin(), scene.lenses.end(),
                       [](const Lens& lens) { return lens.enabled && lens.effect == LensEffect::Magnify; });
}

std::optional<int> lensOf(const std::vector<PlacedLens>& lenses, const std::string& name) {
    if (name.empty()) return -1;
    const int found = findLens(lenses, name);
    return found < 0 ? std::nullopt : std::optional<int>(found);
}

} // namespace tessera::vis
