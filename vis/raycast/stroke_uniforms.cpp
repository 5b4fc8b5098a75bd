#include "vis/raycast/stroke_uniforms.h"

#include <algorithm>
#include <glm/common.hpp>

namespace tessera::vis {

namespace {

using SharedStrokes = std::shared_ptr<const StrokePicture>;

Texture makeStrokeTexture(const std::vector<SharedStrokes>& pictures) {
    if (pictures.empty()) return {};
    glm::ivec2 size(1);
    for (const SharedStrokes& picture : pictures) size = glm::max(size, picture->size);
    Texture texture = makeTexture2DArray(size, int(pictures.size()), GL_RG32F, GL_NEAREST, "strokes");
    for (std::size_t i = 0; i < pictures.size(); ++i)
        glTextureSubImage3D(texture.name(), 0, 0, 0, GLint(i), pictures[i]->size.x, pictures[i]->size.y, 1, GL_RG,
                            GL_FLOAT, pictures[i]->texels.data());
    return texture;
}

} // namespace

void setStrokeUniforms(const Program& program, const RayPlan& plan, const Scene& scene, int unit) {
    if (std::ranges::none_of(plan.slices, &SliceUse::strokes)) return;
    std::vector<glm::vec4> across, up, sizes;
    std::vector<glm::vec2> looks;
    int layer = 0;
    for (const SliceUse& use : plan.slices) {
        const StrokePicture* const picture = use.strokes ? strokesOf(scene, use.layer) : nullptr;
        const StrokeMap map = picture ? strokeMap(*picture) : StrokeMap{};
        const auto& slice = std::get<SliceLayer>(scene.layers[std::size_t(use.layer)].technique);
        across.emplace_back(map.across);
        up.emplace_back(map.up);
        sizes.emplace_back(picture ? glm::vec2(picture->size) : glm::vec2(1), picture ? layer++ : 0, 0);
        looks.emplace_back(slice.strokes.strength, slice.strokes.grey ? 1 : 0);
    }
    program.set("strokeAcross", across);
    program.set("strokeUp", up);
    program.set("strokeSize", sizes);
    program.set("strokeLook", looks);
    program.set("strokeTexture", unit);
}

GLuint StrokeTexture::update(const RayPlan& plan, const Scene& scene) {
    Pictures pictures;
    for (const SliceUse& use : plan.slices)
        for (const SliceStrokes& each : scene.strokes)
            if (use.strokes && each.layer == use.layer) pictures.push_back(each.picture);
    return texture_.get(pictures, makeStrokeTexture).name();
}

} // namespace tessera::vis
