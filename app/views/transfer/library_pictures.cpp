#include "app/views/transfer/library_pictures.h"

#include "app/pane/view_parts.h"

#include <algorithm>

namespace tessera::app {

namespace {

constexpr std::size_t kMostPictures = 96; ///< kept, of several channels and times
constexpr double kPictureBudget = 15;     ///< ms of a frame
constexpr float kPictureStep = 1;         ///< voxels along a ray, at least

/// True while the user does something, which pictures must not slow down.
bool handMoves() {
    const ImGuiIO& io = ImGui::GetIO();
    return io.MouseDelta.x != 0 || io.MouseDelta.y != 0 || io.MouseWheel != 0 || ImGui::IsAnyMouseDown();
}

constexpr float kCloser = 0.8f; ///< than where the whole sphere around the box is seen: the corners are mostly empty

} // namespace

void LibraryPictures::begin(const ViewContext& context, int channel, int side) {
    if (source_ != context.source) {
        source_ = context.source;
        pictures_.clear();
        target_.reset();
    }
    const volume::DatasetInfo& info = source_->info();
    subject_ = {info.channel(channel).name, info.nearestTime(context.session.time), side, context.session.stretch,
                sceneWithLimits(context).background};
    for (Picture& picture : pictures_) picture.wanted = false;
}

vis::TextureName LibraryPictures::get(const vis::TransferFunction& function) {
    const auto same = [&](const Picture& picture) { return picture.of == subject_ && picture.function == function; };
    const auto found = std::ranges::find_if(pictures_, same);
    if (found != pictures_.end())
        pictures_.splice(pictures_.begin(), pictures_, found);
    else
        pictures_.push_front({subject_, function, {}, false});
    pictures_.front().wanted = true;
    return pictures_.front().texture.name();
}

vis::Scene LibraryPictures::sceneOf(const ViewContext& context, const Picture& picture) const {
    const volume::DatasetInfo& info = source_->info();
    vis::Scene scene;
    scene.render = sceneWithLimits(context).render;
    scene.render.samples = 1;
    scene.render.stepVoxels = std::max(scene.render.stepVoxels, kPictureStep);
    scene.layers = {{.name = picture.of.channel, .technique = vis::VolumeLayer{.channel = picture.of.channel}}};
    scene.transfer = {{picture.of.channel, picture.function}};
    scene.stretch = picture.of.stretch;
    scene.background = picture.of.background;
    scene.showBox = false;
    if (!info.times.empty()) scene.time = info.times[std::size_t(picture.of.time)];
    const vis::WorldFrame world = vis::worldFrame(info, scene.stretch);
    scene.camera.orientation = vis::firstOrientation(world);
    vis::fit(scene.camera, world, 1);
    scene.camera.distance *= kCloser;
    return scene;
}

bool LibraryPictures::draw(ViewContext& context, Picture& picture) {
    if (!target_) target_ = context.renderer.makeTarget();
    vis::FrameRequest request;
    request.size = glm::ivec2(picture.of.side);
    request.budgetMs = kPictureBudget;
    request.wait = context.headless;
    if (!context.renderer.render(*target_, sceneOf(context, picture), request).complete) return false;
    glm::ivec2 size(0);
    const std::vector<std::uint8_t> rgba = context.renderer.readPixels(*target_, size);
    picture.texture.upload(context.renderer.textures(), size, rgba);
    return true;
}

void LibraryPictures::work(ViewContext& context) {
    const auto missing = [](const Picture& picture) { return picture.wanted && picture.texture.name() == 0; };
    const bool rests = context.headless || (context.idle && !context.answers.unfinished() && !context.interacting &&
                                            !context.session.animation.playing && !handMoves());
    // The first one asked for lies last.
    for (auto next = pictures_.rbegin(); next != pictures_.rend(); ++next) {
        if (!missing(*next)) continue;
        if (!rests || !draw(context, *next)) break;
        if (!context.headless) break;
    }
    context.answers.postponed = context.answers.postponed || std::ranges::any_of(pictures_, missing);
    if (!context.answers.postponed) target_.reset();
    while (pictures_.size() > kMostPictures && !pictures_.back().wanted) pictures_.pop_back();
}

} // namespace tessera::app
