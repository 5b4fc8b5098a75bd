#include "vis/passes/renderer_impl.h"

#include "vis/demand/changed_pixels.h"
#include "vis/raycast/lens_uniforms.h"
#include "vis/shapes/proxy.h"
#include "volume/base/error.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tessera::vis {

namespace {

constexpr std::size_t kUploadPerFrame = std::size_t(24) << 20;

/// GL state that drawing changes and restores.
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

/// Whether anything drawn depends on the linked cursor.
bool liesAtCursor(const Scene& scene) {
    return sliceAtCursor(scene) || std::any_of(scene.lenses.begin(), scene.lenses.end(),
                                               [](const Lens& lens) { return lens.enabled && lens.followsCursor; });
}

} // namespace

void ViewTargetDeleter::operator()(ViewTarget* target) const {
    delete target;
}

RendererOptions quickestOptions(RendererOptions options) {
    options.packets = (options.driver ? *options.driver : currentDriver()).software;
    return options;
}

Renderer::Renderer(const RendererOptions& options)
    : impl_(std::make_unique<Impl>(options, options.driver ? *options.driver : currentDriver())) {}
Renderer::~Renderer() = default;

void Renderer::setSource(std::shared_ptr<const volume::BrickSource> source, SameSamples same) {
    if (source == impl_->source) return;
    impl_->formerSource = same.channels > 0 && same.times > 0 ? impl_->source.get() : nullptr;
    impl_->source = source;
    impl_->volumes = source ? std::make_shared<packet::PacketVolumes>(source) : nullptr;
    impl_->residency.setSource(std::move(source), same);
}

const volume::BrickSource* Renderer::source() const {
    return impl_->source.get();
}

ViewTargetPtr Renderer::makeTarget() {
    return ViewTargetPtr(new ViewTarget(impl_->tools.driver));
}

/// Resizes the target to the picture; returns false, with a single message, if the driver has no memory.
bool Renderer::Impl::resize(ViewTarget& target, const FrameRequest& request) {
    try {
        target.resize(request.size, options.exactTextures);
        return true;
    } catch (const MachineError& error) {
        if (request.wait) throw;
        if (refusal != error.what()) tools.messages.push_back(error.what());
        refusal = error.what();
        return false;
    }
}

/// Uploads loaded data within the scene's limits.
void Renderer::Impl::beginFrame(ViewTarget& target, const Scene& scene, const FrameRequest& request) {
    const RenderLimits& given = scene.render.limits;
    residency.setBudgets(std::min(options.textureBudget, std::size_t(given.textureMemory) << 20),
                         std::min(options.memoryBudget, std::size_t(given.brickMemory) << 20));
    residency.setKeptChange(double(given.keptChange));
    // A window draws each target once per frame; a picture drawn with `wait` counts as a frame of its own.
    if (request.wait || target.shown.frame == residency.frame()) residency.beginFrame();
    target.shown.frame = residency.frame();
    residency.update(request.wait ? ~std::size_t(0) : kUploadPerFrame);
}

/// Whether pictures of the scene tell which bricks are occluded. With a magnifying lens, rays sample other positions
/// than those they pass; with depth of field, those of a pixel pass different ones.
bool Renderer::Impl::findsHidden(const Scene& scene) const {
    return scene.render.cullHidden && residency.bricked() && !lensesBend(scene) && !drawnByProxy(scene) &&
           !options.countSamples && scene.camera.aperture <= 0;
}

/// The bricks that the last picture of these data occluded; null if they cannot be used for a scene.
const HiddenInView* Renderer::Impl::hiddenIn(const ViewTarget& target, const Scene& scene) const {
    return findsHidden(scene) && target.shown.source == source.get() ? &target.hidden.bricks() : nullptr;
}

void Renderer::Impl::takeHidden(ViewTarget& target, bool wait) {
    target.hidden.take(wait, target.shown.source == source.get() && source ? &source->grid() : nullptr);
}

/// Requests what the plan samples and binds the resident part; false if it cannot be drawn yet.
bool Renderer::Impl::bind(ViewTarget& target, const RenderCall& call, FrameStatus& status) {
    takeHidden(target, false);
    const std::optional<double> former = target.demand.time();
    const bool any = target.demand.bind(residency, call, hiddenIn(target, call.scene), status);
    if (target.demand.time() != former) ++target.shown.number;
    return any;
}

/// Makes the scene that of the target and marks outdated pixels.
/// `resident`: changes with the samples that are drawn.
void Renderer::Impl::show(ViewTarget& target, const Scene& scene, std::uint64_t resident) {
    ShownScene& shown = target.shown;
    const bool same = shown.source == source.get();
    if (shown.started && shown.scene == scene && shown.resident == resident && same) return;
    std::optional<Tile> part;
    if (source && shown.started && target.state.presented() && same && shown.resident == resident)
        part = changedPixels(shown.scene, scene, worldFrame(source->info().bounds, scene.stretch), target.buffers.size);
    target.redraw(part.value_or(target.buffers.everything()));
    if (!(shown.scene == scene) || !same) ++shown.number;
    target.state.setPresented(target.state.presented() && (same || shown.source == formerSource));
    shown.scene = scene;
    shown.resident = resident;
    shown.source = source.get();
    shown.started = true;
}

/// Requests the data of the scene and draws or refines what is resident; false if nothing can be drawn.
bool Renderer::Impl::draw(ViewTarget& target, const RenderCall& call, Clock::time_point start, FrameStatus& status) {
    const bool any = !call.plan.empty() && bind(target, call, status);
    show(target, call.scene, residency.revision());
    target.shown.compiling = false;
    if (any) {
        refine(target, call, start);
        if (findsHidden(call.scene))
            target.hidden.start(tools, call, target.buffers, target.state, target.shown.number);
    } else if (!target.state.full()) {
        const bool comes = !call.plan.empty() && !status.complete;
        if (comes && !target.state.presented() && !call.request.wait)
            blank(target, call.scene);
        else if (!comes || !target.state.presented())
            nothing(target, call.scene);
    }
    return any;
}

/// Draws small pictures from the coarsest bricks, then with growing shares of the others, nearest first, so that most
/// occluded bricks are never requested.
void Renderer::Impl::probe(ViewTarget& target, const RenderCall& call) {
    ++target.shown.number;
    target.shown.scene = call.scene;
    target.shown.source = source.get();
    for (const double share : {0.0, 0.125, 0.25, 0.5}) {
        target.demand.setShare(share);
        FrameStatus unused;
        if (!bind(target, call, unused)) break;
        target.redraw(target.buffers.everything());
        refine(target, call, Clock::now());
        target.hidden.start(tools, call, target.buffers, target.state, target.shown.number);
        takeHidden(target, true);
    }
    target.demand.setShare(1);
}

/// Whether the finished picture shows bricks assumed to be occluded, so that other bricks are wanted.
bool Renderer::Impl::reveals(ViewTarget& target, const RenderCall& call) {
    takeHidden(target, true);
    return target.demand.chooseAgain(residency, call, hiddenIn(target, call.scene));
}

/// Draws the scene as far as the request allows.
void Renderer::Impl::drawAll(ViewTarget& target, const RenderCall& call, Clock::time_point start, FrameStatus& status) {
    const bool waits = call.request.wait, finds = !call.plan.empty() && findsHidden(call.scene);
    // Occlusion in the last picture is a sufficient start.
    if (waits && finds && !target.hidden.any()) probe(target, call);
    bool any = false;
    do any = draw(target, call, start, status);
    while (waits && any && finds && reveals(target, call));
    // Occluded bricks may be coarse, but that they are occluded must be certain.
    if (any && finds) status.complete = status.complete && target.hidden.known();
}

namespace {

/// Whether a volume or surface is shown. The pictures of sections, in slices and cubes, say nothing of what casts rays.
bool hasVolumes(const Scene& scene) {
    return std::ranges::any_of(scene.layers, [](const Layer& layer) {
        return layer.visible && (std::holds_alternative<VolumeLayer>(layer.technique) ||
                                 std::holds_alternative<IsoLayer>(layer.technique));
    });
}

} // namespace

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
    const bool fits = impl_->resize(target, request);
    status.texture = target.buffers.output.name();
    if (!fits) return status;
    if (!liesAtCursor(scene)) target.shown.scene.cursor = scene.cursor;
    if (target.shown.source != impl_->source.get()) target.hidden.forgetData();
    if (impl_->source) {
        impl_->beginFrame(target, scene, request);
        const int most = mostFields(impl_->tools.driver.fragmentSamplers, scene, impl_->residency.bricked());
        RayPlan plan = planRays(scene, impl_->source->info(), most);
        const RenderCall call{scene, request, *impl_->source, plan};
        if (!impl_->chooseEngine(target, call, status) || !impl_->drawByPackets(target, call, start, status))
            impl_->drawAll(target, call, start, status);
    } else {
        impl_->show(target, scene, 0);
        target.shown.compiling = false;
        if (!target.state.full()) impl_->nothing(target, scene);
    }
    status.complete = status.complete && target.state.converged();
    status.current = status.complete || target.state.changed().empty();
    status.compiling = target.shown.compiling;
    if (request.wait) target.pace().collect(true);
    status.milliseconds = target.pace().pass();
    if (hasVolumes(scene)) impl_->engine = status.engine;
    return status;
}

std::optional<Pick> Renderer::pick(ViewTarget& target, glm::ivec2 pixel) {
    const PictureBuffers& buffers = target.buffers;
    const PictureState& state = target.state;
    const glm::ivec2 place(pixel.x, buffers.size.y - 1 - pixel.y);
    if (!target.shown.started || !impl_->source || !buffers.everything().holds(place)) return std::nullopt;
    const bool full = state.full() || (state.presented() && !state.stale().holds(place));
    const bool half = state.half() && state.half()->holds(place);
    if (!full && !half && !(state.reduced() && state.reduced()->holds(place))) return std::nullopt;
    const RayBuffer& from = full ? buffers.full : half ? buffers.half : buffers.reduced;
    const glm::dvec2 size(buffers.size);
    glm::dvec2 at = glm::dvec2(place) + 0.5;
    const glm::ivec2 texel =
        full ? glm::ivec2(at) : from.first + glm::min(glm::ivec2(at / size * glm::dvec2(from.used)), from.used - 1);
    if (!full) at = (glm::dvec2(texel - from.first) + 0.5) / glm::dvec2(from.used) * size;
    float distance = 0;
    glGetTextureSubImage(from.pick.name(), 0, texel.x, texel.y, 0, 1, 1, 1, GL_RED, GL_FLOAT, sizeof distance,
                         &distance);
    if (std::abs(distance) > 1e8f) return std::nullopt;
    const Ray ray = cameraRay(target.shown.scene.camera, size.x / size.y, at / size * 2.0 - 1.0);
    const WorldFrame frame = worldFrame(impl_->source->info().bounds, target.shown.scene.stretch);
    return Pick{frame.toPhysical(ray.origin + ray.direction * double(distance))};
}

std::vector<glm::vec4> Renderer::readLinear(ViewTarget& target) {
    const std::size_t width(static_cast<std::size_t>(target.buffers.size.x)),
        height(static_cast<std::size_t>(target.buffers.size.y));
    std::vector<glm::vec4> pixels(width * height), out(pixels.size());
    if (pixels.empty()) return pixels;
    glGetTextureImage(target.buffers.full.color.name(), 0, GL_RGBA, GL_FLOAT,
                      GLsizei(pixels.size() * sizeof(glm::vec4)), pixels.data());
    for (std::size_t y = 0; y < height; ++y)
        std::copy_n(pixels.begin() + std::ptrdiff_t((height - 1 - y) * width), width,
                    out.begin() + std::ptrdiff_t(y * width));
    return out;
}

std::vector<std::uint8_t> Renderer::readPixels(ViewTarget& target, glm::ivec2& size) {
    size = target.buffers.size;
    const std::size_t row = static_cast<std::size_t>(size.x) * 4, height = static_cast<std::size_t>(size.y);
    std::vector<std::uint8_t> pixels(row * height), out(pixels.size());
    if (pixels.empty()) return pixels;
    glGetTextureImage(target.buffers.output.name(), 0, GL_RGBA, GL_UNSIGNED_BYTE, GLsizei(pixels.size()),
                      pixels.data());
    for (std::size_t y = 0; y < height; ++y)
        std::copy_n(pixels.begin() + std::ptrdiff_t((height - 1 - y) * row), row,
                    out.begin() + std::ptrdiff_t(y * row));
    return out;
}

const EngineUse& Renderer::engine() const {
    return impl_->engine;
}

ResidencyInfo Renderer::residency() const {
    return impl_->residency.info();
}

std::vector<std::string> Renderer::takeMessages() {
    std::vector<std::string> all = impl_->tools.programs.takeMessages();
    for (std::string& message : impl_->residency.takeMessages()) all.push_back(std::move(message));
    for (std::string& message : std::exchange(impl_->tools.messages, {})) all.push_back(std::move(message));
    for (std::string& message : impl_->tools.brushes.takeMessages()) all.push_back(std::move(message));
    return all;
}

} // namespace tessera::vis
