#include "vis/passes/renderer.h"

#include "vis/demand/changed_pixels.h"
#include "vis/image/turned_rows.h"
#include "vis/passes/draw_scene.h"
#include "vis/passes/packet_frame.h"
#include "vis/passes/present.h"
#include "vis/processor/processor_renderer.h"
#include "volume/system/free_memory.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tessera::vis {

namespace {

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
    const std::size_t quarter = volume::machineMemory() / 4;
    options.memoryBudget = std::min(options.memoryBudget, quarter);
    if (!options.openGl) return options;
    const bool software = (options.driver ? *options.driver : currentDriver()).software;
    if (software) options.textureBudget = std::min(options.textureBudget, quarter); // they are in the same memory
    options.packets = software ? Packets::Always : Packets::WhileCompiling;
    return options;
}

Renderer::Renderer(const RendererOptions& options) {
    if (options.openGl)
        state_ = std::make_unique<RendererState>(options, options.driver ? *options.driver : currentDriver());
    else
        processor_ = std::make_unique<ProcessorRenderer>(options);
}
Renderer::~Renderer() = default;

std::unique_ptr<Renderer> Renderer::another() const {
    return std::make_unique<Renderer>(processor_ ? processor_->options() : state_->options);
}

TexturesIn Renderer::textures() const {
    return processor_ ? TexturesIn::Memory : TexturesIn::OpenGl;
}

void Renderer::setSource(std::shared_ptr<const volume::BrickSource> source, SameSamples same) {
    if (processor_) return processor_->setSource(std::move(source));
    if (source == state_->source) return;
    state_->formerSource = same.channels > 0 && same.times > 0 ? state_->source.get() : nullptr;
    state_->source = source;
    makePacketVolumes(*state_);
    state_->residency.setSource(std::move(source), same);
}

const volume::BrickSource* Renderer::source() const {
    return processor_ ? processor_->source() : state_->source.get();
}

ViewTargetPtr Renderer::makeTarget() {
    return ViewTargetPtr(new ViewTarget(processor_ ? Driver{} : state_->tools.driver));
}

namespace {

/// Whether a volume or surface is shown. The pictures of sections, in slices and cubes, say nothing of what casts rays.
bool hasVolumes(const Scene& scene) {
    return std::ranges::any_of(scene.layers, [](const Layer& layer) {
        return layer.visible && (std::holds_alternative<VolumeLayer>(layer.technique) ||
                                 std::holds_alternative<IsoLayer>(layer.technique));
    });
}

EngineUse byProcessor(packet::InstructionSet with) {
    return {.byProcessor = true, .instructions = packet::kInstructionSetNames[std::size_t(with)], .refusal = {}};
}

/// What the processor has drawn as a whole since `start`.
FrameStatus statusAlone(const ProcessorPicture& picture, Clock::time_point start) {
    FrameStatus status;
    status.complete = status.current = true;
    status.texture = picture.texture().name();
    status.engine = byProcessor(picture.instructions());
    status.milliseconds = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    return status;
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
    if (processor_) {
        processor_->draw(target.alone, scene, request.size);
        status = statusAlone(target.alone, start);
        alone_ = status.engine;
        return status;
    }
    const SavedState saved;
    status.complete = true;
    const bool fits = resizeTarget(*state_, target, request);
    status.texture = target.buffers.output.name();
    if (!fits) return status;
    if (!liesAtCursor(scene)) target.shown.scene.cursor = scene.cursor;
    if (target.shown.source != state_->source.get()) target.hidden.forgetData();
    if (state_->source) {
        beginFrame(*state_, target, scene, request);
        const int most = mostFields(state_->tools.driver.fragmentSamplers, scene, state_->residency.bricked());
        RayPlan plan = planRays(scene, state_->source->info(), most);
        const RenderCall call{scene, request, *state_->source, plan};
        if (!chooseEngine(*state_, target, call, status) || !drawByPackets(*state_, target, call, start, status))
            drawAll(*state_, target, call, start, status);
    } else {
        showScene(*state_, target, scene, 0);
        target.shown.compiling = false;
        if (!target.state.full()) showNothing(*state_, target, scene);
    }
    status.complete = status.complete && target.state.converged();
    status.current = status.complete || target.state.changed().empty();
    status.compiling = target.shown.compiling;
    const bool drawn = target.state.converged() || (status.compiling && !target.meanwhile);
    status.waits = !status.complete && (status.waits || drawn);
    if (target.meanwhile) status.engine = byProcessor(target.packets.full.instructions());
    if (request.wait) target.pace().collect(true);
    status.milliseconds = target.pace().pass();
    if (hasVolumes(scene)) state_->engine = status.engine;
    return status;
}

std::optional<Pick> Renderer::pick(ViewTarget& target, glm::ivec2 pixel) {
    if (processor_) {
        const std::optional<glm::dvec3> position = processor_->pick(target.alone, pixel);
        return position ? std::optional(Pick{*position}) : std::nullopt;
    }
    const PictureBuffers& buffers = target.buffers;
    const PictureState& state = target.state;
    const glm::ivec2 place(pixel.x, buffers.size.y - 1 - pixel.y);
    if (!target.shown.started || !state_->source || !buffers.everything().holds(place)) return std::nullopt;
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
    const WorldFrame frame = worldFrame(state_->source->info(), target.shown.scene.stretch);
    return Pick{frame.toPhysical(ray.origin + ray.direction * double(distance))};
}

std::vector<glm::vec4> Renderer::readLinear(ViewTarget& target) {
    if (processor_) return linearRows(target.alone);
    const glm::ivec2 size = target.buffers.size;
    std::vector<glm::vec4> pixels(std::size_t(size.x) * std::size_t(size.y));
    if (pixels.empty()) return pixels;
    glGetTextureImage(target.buffers.full.color.name(), 0, GL_RGBA, GL_FLOAT,
                      GLsizei(pixels.size() * sizeof(glm::vec4)), pixels.data());
    return turnedRows(pixels, std::size_t(size.x));
}

std::vector<std::uint8_t> Renderer::readPixels(ViewTarget& target, glm::ivec2& size) {
    if (processor_) {
        size = target.alone.texture().size;
        return shownRows(target.alone);
    }
    size = target.buffers.size;
    const std::size_t row = std::size_t(size.x) * 4;
    std::vector<std::uint8_t> pixels(row * std::size_t(size.y));
    if (pixels.empty()) return pixels;
    glGetTextureImage(target.buffers.output.name(), 0, GL_RGBA, GL_UNSIGNED_BYTE, GLsizei(pixels.size()),
                      pixels.data());
    return turnedRows(pixels, row);
}

const EngineUse& Renderer::engine() const {
    return processor_ ? alone_ : state_->engine;
}

ResidencyInfo Renderer::residency() const {
    return processor_ ? ResidencyInfo{} : state_->residency.info();
}

std::vector<std::string> Renderer::takeMessages() {
    if (processor_) return processor_->takeMessages();
    std::vector<std::string> all = state_->tools.programs.takeMessages();
    for (std::string& message : state_->residency.takeMessages()) all.push_back(std::move(message));
    for (std::string& message : std::exchange(state_->tools.messages, {})) all.push_back(std::move(message));
    for (std::string& message : state_->tools.brushes.takeMessages()) all.push_back(std::move(message));
    return all;
}

} // namespace tessera::vis
