#include "app/views/volume/stereo_eyes.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

RenderedEyes renderEyes(ViewContext& context, EyePictures& pictures, vis::Scene scene, vis::FrameRequest request,
                        const vis::Stereo& stereo) {
    const bool beside = stereo.kind == vis::StereoKind::SideBySide;
    const std::size_t count = stereo.on() ? 2 : 1;
    if (beside) request.size.x = std::max(1, request.size.x / 2);
    request.budgetMs /= double(count);
    RenderedEyes out;
    const vis::Camera middle = scene.camera;
    for (std::size_t eye = 0; eye < count; ++eye) {
        vis::ViewTargetPtr& target = pictures.targets[eye];
        if (!target) target = context.renderer.makeTarget();
        scene.camera = vis::eyeCamera(middle, stereo, vis::Eye(eye));
        const vis::FrameStatus status = context.renderer.render(*target, scene, request);
        context.answers.follow(status);
        out.textures[eye] = status.texture;
        if (eye == 0) {
            out.status = status;
            continue;
        }
        out.status.complete = out.status.complete && status.complete;
        out.status.current = out.status.current && status.current;
        out.status.compiling = out.status.compiling || status.compiling;
        out.status.bricksMissing = std::max(out.status.bricksMissing, status.bricksMissing);
    }
    if (stereo.kind == vis::StereoKind::Anaglyph)
        out.textures[0] =
            pictures.anaglyph.combine(context.renderer.textures(), out.textures[0], out.textures[1], request.size);
    return out;
}

PictureBox halfPicture(const PictureBox& whole, const vis::Stereo& stereo, vis::Eye eye) {
    PictureBox half = whole;
    half.size.x = std::max(1.0f, std::floor(whole.size.x / 2));
    if ((eye == vis::Eye::Left) == stereo.crossed) half.min.x += half.size.x;
    return half;
}

} // namespace tessera::app
