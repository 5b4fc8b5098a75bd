#include "vis/demand/changed_pixels.h"
#include "vis/passes/renderer_impl.h"

#include "volume/base/error.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tessera::vis {

namespace {

constexpr std::size_t kUploadPerFrame = std::size_t(24) << 20;

/// What drawing needs and leaves as it was.
struct SavedState {
    GLint framebuffer = 0, viewport[4] = {0, 0, 0, 0};
    SavedState() {
        glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &framebuffer);
        glGetIntegerv(GL_VIEWPORT, viewport);
        for (GLenum capability : {GL_BLEND, GL_DEPTH_TEST, GL_CULL_FACE, GL_SCISSOR_TEST, GL_STENCIL_TEST})
            glDisable(capability);
        glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    }
    ~SavedState() {
        glDisable(GL_SCISSOR_TEST);
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(framebuffer));
        glViewport(viewport[0], viewport[1], viewport[2], viewport[3]);
        glUseProgram(0);
        glBindVertexArray(0);
        glActiveTexture(GL_TEXTURE0);
    }
};

/// Whether anything drawn moves with the linked cursor.
bool liesAtCursor(const Scene& scene) {
    return sliceAtCursor(scene) || std::any_of(scene.lenses.begin(), scene.lenses.end(),
                                               [](const Lens& lens) { return lens.enabled && lens.followsCursor; });
}

} // namespace

Renderer::Renderer(const RendererOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Renderer::~Renderer() = default;

void Renderer::setSource(std::shared_ptr<const volume::BrickSource> source, SameSamples same) {
    if (source == impl_->source) return;
    impl_->formerSource = same.channels > 0 && same.times > 0 ? impl_->source.get() : nullptr;
    impl_->source = source;
    impl_->residency.setSource(std::move(source), same);
}

const volume::BrickSource* Renderer::source() const {
    return impl_->source.get();
}

ViewTargetPtr Renderer::makeTarget() {
    return ViewTargetPtr(new ViewTarget);
}

/// Asks for what the scene shows and draws, or refines, what is here of it; false where nothing can be drawn.
bool Renderer::Impl::draw(ViewTarget& target, const Scene& scene, const FrameRequest& request, RayPlan& plan,
                          Clock::time_point start, FrameStatus& status) {
    const bool any = source && !plan.empty() && bind(target, scene, request, plan, status);
    const std::uint64_t revision = residency.revision();
    const bool same = target.source == source.get();
    if (!target.started || !(target.scene == scene) || target.revision != revision || !same) {
        std::optional<Tile> part;
        if (source && target.started && target.shows && same && target.revision == revision)
            part = changedPixels(target.scene, scene, worldFrame(source->info().bounds, scene.stretch), target.size);
        target.redraw(part.value_or(target.everything()));
        if (!(target.scene == scene) || !same) ++target.sceneNumber;
        target.scene = scene;
        target.revision = revision;
        target.shows = target.shows && (same || target.source == formerSource);
        target.source = source.get();
        target.started = true;
    }
    target.compiling = false;
    if (any) {
        refine(target, scene, request, plan, start);
        if (findsHidden(scene)) startReach(target, scene);
    } else if (!target.fullValid && !plan.empty() && !status.complete && !target.shows && !request.wait) {
        blank(target, scene);
    } else if (!target.fullValid && (plan.empty() || status.complete || !target.shows)) {
        nothing(target, scene);
    }
    return any;
}

FrameStatus Renderer::render(ViewTarget& target, const Scene& scene, const FrameRequest& wanted) {
    const Clock::time_point start = Clock::now();
    FrameStatus status;
    FrameRequest request = wanted;
    if (request.budgetMs <= 0) request.budgetMs = scene.render.limits.frameTime;
    if (request.size.x <= 0 || request.size.y <= 0) {
        status.complete = status.current = true;
        return status;
    }
    const SavedState saved;
    status.complete = true;
    try {
        target.resize(request.size, impl_->options.exactTextures);
    } catch (const MachineError& error) {
        if (request.wait) throw;
        if (impl_->refusal != error.what()) impl_->messages.push_back(error.what());
        impl_->refusal = error.what();
        status.texture = target.output.name();
        return status;
    }
    status.texture = target.output.name();

    RayPlan plan;
    bool any = false, finds = false;
    if (impl_->source) {
        const RenderLimits& limits = scene.render.limits;
        impl_->residency.setBudgets(std::min(impl_->options.textureBudget, std::size_t(limits.textureMemory) << 20),
                                    std::min(impl_->options.memoryBudget, std::size_t(limits.brickMemory) << 20));
        impl_->residency.setKeptChange(double(limits.keptChange));
        // A frame of a window draws each of its targets once; a picture that is waited for stands for itself.
        if (request.wait || target.frame == impl_->residency.frame()) impl_->residency.beginFrame();
        target.frame = impl_->residency.frame();
        impl_->residency.update(request.wait ? ~std::size_t(0) : kUploadPerFrame);
        // Bricks take two texture units each.
        const int mostFields = kMostFields / (impl_->residency.bricked() ? 2 : 1);
        plan = planRays(scene, impl_->source->info(), mostFields);
        finds = !plan.empty() && impl_->findsHidden(scene);
    }
    if (!liesAtCursor(scene)) target.scene.cursor = scene.cursor;
    if (target.source != impl_->source.get()) {
        target.hidden.learn({}, false);
        target.hiddenScene = 0;
    }
    // What the last picture hid will do to begin with.
    if (request.wait && finds && target.hiddenScene == 0) impl_->probe(target, scene, request, plan);
    do any = impl_->draw(target, scene, request, plan, start, status);
    while (request.wait && any && finds && impl_->reveals(target, scene, request, plan));
    status.complete = status.complete && target.fullValid && target.stillDone;
    // What is hidden may be coarse, but it has to be known that it is.
    if (any && finds) status.complete = status.complete && target.hiddenKnown;
    status.current = status.complete || target.changed.empty();
    status.compiling = target.compiling;
    status.milliseconds = target.passMilliseconds;
    return status;
}

std::optional<Pick> Renderer::pick(ViewTarget& target, glm::ivec2 pixel) {
    if (!target.started || !impl_->source || pixel.x < 0 || pixel.y < 0 || pixel.x >= target.size.x ||
        pixel.y >= target.size.y)
        return std::nullopt;
    const glm::ivec2 place(pixel.x, target.size.y - 1 - pixel.y);
    const bool full = target.fullValid || (target.shows && !target.stale.holds(place));
    if (!full && !(target.reducedValid && target.reducedTile.holds(place))) return std::nullopt;
    const RayBuffer& from = full ? target.full : target.reduced;
    const glm::dvec2 size(target.size);
    glm::dvec2 at = glm::dvec2(place) + 0.5;
    const glm::ivec2 texel =
        full ? glm::ivec2(at)
             : from.first + glm::min(glm::ivec2(at / size * glm::dvec2(target.reducedSize)), target.reducedSize - 1);
    if (!full) at = (glm::dvec2(texel - from.first) + 0.5) / glm::dvec2(target.reducedSize) * size;
    float distance = 0;
    glGetTextureSubImage(from.pick.name(), 0, texel.x, texel.y, 0, 1, 1, 1, GL_RED, GL_FLOAT, sizeof distance,
                         &distance);
    if (std::abs(distance) > 1e8f) return std::nullopt;
    const Ray ray = cameraRay(target.scene.camera, size.x / size.y, at / size * 2.0 - 1.0);
    const WorldFrame frame = worldFrame(impl_->source->info().bounds, target.scene.stretch);
    return Pick{frame.toPhysical(ray.origin + ray.direction * double(distance))};
}

std::vector<glm::vec4> Renderer::readLinear(ViewTarget& target) {
    const std::size_t width(static_cast<std::size_t>(target.size.x)), height(static_cast<std::size_t>(target.size.y));
    std::vector<glm::vec4> pixels(width * height), out(pixels.size());
    if (pixels.empty()) return pixels;
    glGetTextureImage(target.full.color.name(), 0, GL_RGBA, GL_FLOAT, GLsizei(pixels.size() * sizeof(glm::vec4)),
                      pixels.data());
    for (std::size_t y = 0; y < height; ++y)
        std::copy_n(pixels.begin() + std::ptrdiff_t((height - 1 - y) * width), width,
                    out.begin() + std::ptrdiff_t(y * width));
    return out;
}

std::vector<std::uint8_t> Renderer::readPixels(ViewTarget& target, glm::ivec2& size) {
    size = target.size;
    const std::size_t row = static_cast<std::size_t>(size.x) * 4, height = static_cast<std::size_t>(size.y);
    std::vector<std::uint8_t> pixels(row * height), out(pixels.size());
    if (pixels.empty()) return pixels;
    glGetTextureImage(target.output.name(), 0, GL_RGBA, GL_UNSIGNED_BYTE, GLsizei(pixels.size()), pixels.data());
    for (std::size_t y = 0; y < height; ++y)
        std::copy_n(pixels.begin() + std::ptrdiff_t((height - 1 - y) * row), row,
                    out.begin() + std::ptrdiff_t(y * row));
    return out;
}

ResidencyInfo Renderer::residency() const {
    return impl_->residency.info();
}

std::vector<std::string> Renderer::takeMessages() {
    std::vector<std::string> all = impl_->programs.takeMessages();
    for (std::string& message : impl_->residency.takeMessages()) all.push_back(std::move(message));
    for (std::string& message : std::exchange(impl_->messages, {})) all.push_back(std::move(message));
    for (std::string& message : impl_->brushes.takeMessages()) all.push_back(std::move(message));
    return all;
}

} // namespace tessera::vis
