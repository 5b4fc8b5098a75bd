#include "vis/raycast/look_uniforms.h"

#include "vis/optics/grain.h"
#include "vis/optics/look_shading.h"

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>

namespace tessera::vis {

std::vector<const Look*> looksOf(const RayPlan& plan, const Scene& scene) {
    std::vector<const Look*> looks;
    for (const RayLayer& layer : plan.layers)
        looks.push_back(layer.look != 0 ? lookOf(scene.layers[std::size_t(layer.layer)].technique) : nullptr);
    return looks;
}

void setLookUniforms(const Program& program, const std::vector<const Look*>& looks, const Scene& scene,
                     const WorldFrame& frame, const volume::Lattice& lattice, glm::ivec2 size, int unit) {
    if (std::none_of(looks.begin(), looks.end(), [](const Look* look) { return look != nullptr; })) return;
    const LookView view = lookView(scene, frame.halfSize, worldCell(lattice, frame), size);
    const auto linear = [](glm::vec3 srgb) { return glm::vec3(linearFromSrgb(glm::dvec3(srgb))); };
    program.set("lookLight", glm::vec4(view.light.place, view.light.point ? 1 : 0));
    program.set("lookDepth", glm::vec2(view.nearest, 1 / (view.farthest - view.nearest)));
    program.set("lookPixel", glm::vec2(view.pixel));
    program.set("lookGround", glm::vec3(view.ground));
    program.set("grainTile", unit);
    program.set("grainPlaneCount", 3);
    std::vector<glm::vec2> share, layers;
    const auto inkOf = [&](const std::optional<glm::vec3>& own) {
        return own ? linear(*own) : glm::vec3(inkOn(luminance(view.ground)));
    };
    std::vector<glm::vec4> warm, cool, distance, cartoon, outline, rim, tone, mark, grain, wire;
    std::vector<glm::vec3> smooth, boundary, silhouette, stick, line, wireColor;
    std::vector<float> exponent;
    for (const Look* own : looks) {
        static const Look kPlain;
        const Look& look = own ? *own : kPlain;
        const double none = lookShare(look.part, 0.0), all = lookShare(look.part, 1.0);
        share.emplace_back(none, all - none);
        const WarmCool gooch = look.tone.value_or(WarmCool{});
        warm.emplace_back(linear(gooch.warmColor), gooch.amount);
        cool.emplace_back(linear(gooch.coolColor), std::min(gooch.ownColor, 1.0f));
        const BoundaryEnhancement steep = look.boundary.value_or(BoundaryEnhancement{});
        boundary.emplace_back(steep.retained, steep.strength, steep.exponent);
        const SilhouetteEnhancement turned = look.silhouette.value_or(SilhouetteEnhancement{});
        silhouette.emplace_back(turned.retained, turned.strength, turned.exponent);
        rim.emplace_back(inkOf(turned.inkColor), turned.ink);
        const DistanceColor far = look.distance.value_or(DistanceColor{});
        distance.emplace_back(far.toBackground ? glm::vec3(view.ground) : linear(far.color), far.amount);
        exponent.push_back(far.exponent);
        const Cartoon flat = look.cartoon.value_or(Cartoon{});
        cartoon.emplace_back(flat.amount, flat.steps, flat.shadow, flat.outlineColor ? 1 : 0);
        outline.emplace_back(inkOf(flat.outlineColor), flat.outline);
        const CharcoalDrawing drawn = look.charcoal.value_or(CharcoalDrawing{});
        stick.push_back(inkOf(drawn.color));
        tone.emplace_back(drawn.contrast, drawn.steepness, drawsLight(drawn, view.ground) ? 1 : 0, drawn.bare);
        line.emplace_back(drawn.outline, drawn.outlineStrength, drawn.closure);
        mark.emplace_back(grainSoftness(drawn), drawn.strokes, drawn.smudge, drawn.pressure);
        const WireFrame net = look.wire.value_or(WireFrame{});
        wire.emplace_back(net.spacing, net.width, net.retained, net.ownColor);
        wireColor.push_back(linear(net.color));
        grain.emplace_back(double(drawn.grain) / kGrainTexels, glm::radians(double(drawn.angle)), drawn.localTone,
                           drawn.follow);
        layers.emplace_back(drawn.crossing, 0.5f * drawn.tooth);
        const double wide = volume::smoothReach(lattice.kind, std::max(double(look.smooth), 1e-3));
        smooth.emplace_back(wide, volume::smoothReach(lattice.kind, 1) / (4 * wide), bendReach(look, view));
    }
    program.set("lookShare", share);
    program.set("lookWarm", warm);
    program.set("lookCool", cool);
    program.set("lookBoundary", boundary);
    program.set("lookSilhouette", silhouette);
    program.set("lookRim", rim);
    program.set("lookDarkInk", linear(kDarkInk));
    program.set("lookLightInk", linear(kLightInk));
    program.set("lookDistance", distance);
    program.set("lookDistanceExponent", exponent);
    program.set("lookCartoon", cartoon);
    program.set("lookOutline", outline);
    program.set("lookStick", stick);
    program.set("lookTone", tone);
    program.set("lookLine", line);
    program.set("lookMark", mark);
    program.set("lookGrain", grain);
    program.set("lookLayers", layers);
    program.set("lookSmooth", smooth);
    program.set("lookWire", wire);
    program.set("lookWireColor", wireColor);
}

GLuint GrainTexture::get() {
    if (!texture_) {
        texture_ = makeTexture2D({kGrainEdge, kGrainEdge}, GL_RGBA32F, GL_LINEAR, "paper grain");
        glTextureParameteri(texture_.name(), GL_TEXTURE_WRAP_S, GL_REPEAT);
        glTextureParameteri(texture_.name(), GL_TEXTURE_WRAP_T, GL_REPEAT);
        glTextureSubImage2D(texture_.name(), 0, 0, 0, kGrainEdge, kGrainEdge, GL_RGB, GL_FLOAT,
                            grainTile()->texels.data());
    }
    return texture_.name();
}

} // namespace tessera::vis
