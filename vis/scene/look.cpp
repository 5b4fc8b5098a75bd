#include "vis/scene/look.h"

#include <algorithm>

namespace tessera::vis {

namespace {

Look illustration() {
    Look look;
    look.smooth = 1.5f;
    look.tone = WarmCool{.amount = 0.8f};
    look.boundary = BoundaryEnhancement{.retained = 0.3f, .strength = 1.5f};
    look.silhouette = SilhouetteEnhancement{.retained = 0.5f, .strength = 3, .ink = 0.7f};
    return look;
}

/// A drawing on paper with normals smoothed over `smooth` voxels.
Look drawing(float smooth, const CharcoalDrawing& own) {
    Look look;
    look.smooth = smooth;
    look.charcoal = own;
    return look;
}

/// Broad and black, rubbed in the middle tones.
Look charcoalStick() {
    return drawing(
        2,
        {.pressure = 1, .contrast = 0.6f, .bare = 0.28f, .outline = 3, .grain = 3, .hardness = 0.4f, .smudge = 0.35f});
}

Look sanguine() {
    return drawing(
        2, {.color = glm::vec3(0.55f, 0.2f, 0.12f), .contrast = 0.8f, .grain = 3, .strokes = 0.35f, .smudge = 0.35f});
}

/// Soft, medium and hard: a wide dark grainy line, a middle one, and a thin light even one.
Look softPencil() {
    return drawing(2, {.pressure = 0.97f,
                       .contrast = 0.65f,
                       .bare = 0.15f,
                       .outline = 2.2f,
                       .closure = 0.3f,
                       .grain = 1.8f,
                       .hardness = 0.45f,
                       .strokes = 0.75f,
                       .smudge = 0.2f});
}

Look pencil() {
    return drawing(1.5f, {.pressure = 0.82f,
                          .contrast = 0.85f,
                          .bare = 0.18f,
                          .outline = 1.6f,
                          .closure = 0.25f,
                          .grain = 1.6f,
                          .hardness = 0.55f,
                          .tooth = 0.75f,
                          .strokes = 0.9f,
                          .crossing = 0.6f,
                          .smudge = 0.08f});
}

Look hardPencil() {
    return drawing(1.5f, {.pressure = 0.72f,
                          .contrast = 1,
                          .bare = 0.2f,
                          .outline = 1.1f,
                          .closure = 0.2f,
                          .grain = 1.3f,
                          .hardness = 0.7f,
                          .tooth = 0.5f,
                          .strokes = 1,
                          .crossing = 0.5f,
                          .smudge = 0});
}

Look hatching() {
    return drawing(2.5f, {.pressure = 1,
                          .contrast = 0.9f,
                          .bare = 0.15f,
                          .localTone = 0,
                          .outline = 2.2f,
                          .outlineStrength = 1,
                          .closure = 0.2f,
                          .grain = 2,
                          .hardness = 1,
                          .tooth = 0,
                          .strokes = 1,
                          .crossing = 0.4f,
                          .smudge = 0});
}

Look stipple() {
    return drawing(2, {.mark = Mark::Dots,
                       .pressure = 1,
                       .contrast = 0.9f,
                       .bare = 0.1f,
                       .localTone = 0.1f,
                       .outline = 2,
                       .closure = 0.2f,
                       .grain = 2,
                       .hardness = 1,
                       .smudge = 0});
}

Look chalk() {
    return drawing(2,
                   {.stick = Stick::Chalk, .contrast = 1.4f, .bare = 0.25f, .outline = 1.6f, .closure = 0, .grain = 3});
}

Look made(std::string_view name) {
    Look look;
    if (name == "tone") look.tone.emplace(), look.smooth = 1;
    if (name == "illustration") look = illustration();
    if (name == "boundaries") look.boundary = BoundaryEnhancement{.retained = 0.05f, .strength = 4, .exponent = 1.5f};
    if (name == "glass") {
        look.silhouette = SilhouetteEnhancement{.retained = 0.02f, .strength = 2.5f, .exponent = 3};
        look.boundary = BoundaryEnhancement{.retained = 0.1f, .strength = 2};
    }
    if (name == "distance") look.distance.emplace();
    if (name == "cartoon") look.cartoon.emplace(), look.smooth = 2;
    if (name == "charcoal") look = charcoalStick();
    if (name == "sanguine") look = sanguine();
    if (name == "softpencil") look = softPencil();
    if (name == "pencil") look = pencil();
    if (name == "hardpencil") look = hardPencil();
    if (name == "hatching") look = hatching();
    if (name == "stipple") look = stipple();
    if (name == "chalk") look = chalk();
    if (name == "wire") look.wire.emplace();
    return look;
}

} // namespace

std::optional<Look> Look::preset(std::string_view name) {
    if (std::find(std::begin(kPresetNames), std::end(kPresetNames), name) == std::end(kPresetNames))
        return std::nullopt;
    return made(name);
}

} // namespace tessera::vis
