#include "vis/scene/look.h"

#include <algorithm>

namespace tessera::vis {

namespace {

Look tone() {
    Look look;
    look.tone = WarmCool{.warmColor = {0.98f, 0.8f, 0.36f}, .coolColor = {0.16f, 0.33f, 0.72f}};
    return look;
}

Look illustration() {
    Look look = tone();
    look.tone->amount = 0.75f, look.tone->ownColor = 0.6f;
    look.boundary = BoundaryEnhancement{.retained = 0.3f, .strength = 1.5f};
    look.silhouette = SilhouetteEnhancement{.retained = 0.5f, .strength = 3};
    return look;
}

Look charcoal() {
    Look look;
    look.charcoal.emplace();
    return look;
}

Look pencil() {
    Look look = charcoal();
    CharcoalDrawing& own = *look.charcoal;
    own.color = {0.22f, 0.22f, 0.24f};
    own.pressure = 0.85f, own.contrast = 1.8f, own.outline = 1.3f, own.closure = 0.2f;
    own.grain = 1.2f, own.hardness = 0.4f, own.strokes = 0.8f, own.smudge = 0.1f;
    return look;
}

Look sanguine() {
    Look look = charcoal();
    CharcoalDrawing& own = *look.charcoal;
    own.color = {0.55f, 0.2f, 0.12f};
    own.contrast = 1.1f, own.smudge = 0.45f, own.strokes = 0.35f, own.grain = 3;
    return look;
}

Look chalk() {
    Look look = charcoal();
    CharcoalDrawing& own = *look.charcoal;
    own.stick = Stick::Chalk;
    own.color = {0.96f, 0.95f, 0.92f};
    own.contrast = 1.6f, own.outline = 1.6f, own.closure = 0, own.grain = 3;
    return look;
}

Look made(std::string_view name) {
    Look look;
    if (name == "tone") look = tone();
    if (name == "illustration") look = illustration();
    if (name == "boundaries") look.boundary = BoundaryEnhancement{.retained = 0.05f, .strength = 4, .exponent = 1.5f};
    if (name == "glass") {
        look.silhouette = SilhouetteEnhancement{.retained = 0.02f, .strength = 2.5f, .exponent = 3};
        look.boundary = BoundaryEnhancement{.retained = 0.1f, .strength = 2};
    }
    if (name == "distance") look.distance.emplace();
    if (name == "cartoon") look.cartoon.emplace();
    if (name == "charcoal") look = charcoal();
    if (name == "pencil") look = pencil();
    if (name == "sanguine") look = sanguine();
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
