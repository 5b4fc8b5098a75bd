#pragma once

#include "vis/bricks/residency_options.h"
#include "vis/scene/scene.h"
#include "vis/view/frame_request.h"
#include "volume/bricks/brick_source.h"

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// The renderer, shared by all views of a GL context. Every call, including the destructor, needs a current GL 4.5 core
/// context, unless the options say that there is none: then the processor draws whole pictures, and refuses by a
/// MachineError what only OpenGL can draw.
namespace tessera::vis {

/// Options of renderers that users look at: bricks take a quarter of memory at most; the processor casts rays where
/// OpenGL runs on it, and elsewhere while
/// OpenGL compiles. Needs a current context.
RendererOptions quickestOptions(RendererOptions options = {});

/// Result of picking: the first sample along the ray with noticeable opacity.
struct Pick {
    glm::dvec3 position; ///< physical
};

/// The picture of one view: framebuffers and the state of progressive refinement. May be destroyed at any time.
class ViewTarget;
struct ViewTargetDeleter {
    void operator()(ViewTarget* target) const;
};
using ViewTargetPtr = std::unique_ptr<ViewTarget, ViewTargetDeleter>;

struct RendererState;
class ProcessorRenderer;

class Renderer {
public:
    explicit Renderer(const RendererOptions& options = {});
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    /// Changes the data set and drops the bricks of the former one, except those that both share. Null: shows nothing.
    void setSource(std::shared_ptr<const volume::BrickSource> source, SameSamples same = {});
    const volume::BrickSource* source() const;
    /// A renderer of the same kind, without data.
    std::unique_ptr<Renderer> another() const;
    /// Where its pictures are.
    TexturesIn textures() const;

    /// Creates an empty target for a view.
    ViewTargetPtr makeTarget();
    /// Draws or refines the scene in the target. Repeated calls with the same scene and request continue the
    /// refinement. If the driver has no memory for a picture of this size, the former one is kept and a message given;
    /// a request with `wait` throws MachineError.
    FrameStatus render(ViewTarget& target, const Scene& scene, const FrameRequest& request);
    /// Picks at a pixel (x right, y down, in the size of the last request) of the target's last picture.
    std::optional<Pick> pick(ViewTarget& target, glm::ivec2 pixel);
    /// The target's last complete picture before the background: linear float RGBA, premultiplied, rows top down. Tests
    /// compare it with the reference.
    std::vector<glm::vec4> readLinear(ViewTarget& target);
    /// RGBA8 of the picture, rows top down.
    std::vector<std::uint8_t> readPixels(ViewTarget& target, glm::ivec2& size);

    ResidencyInfo residency() const;
    /// What cast the rays of the last picture that shows a volume or surface.
    const EngineUse& engine() const;
    /// Messages since the last call (shader errors, damaged bricks), for the log pane.
    std::vector<std::string> takeMessages();

private:
    std::unique_ptr<RendererState> state_;         ///< null: without OpenGL
    std::unique_ptr<ProcessorRenderer> processor_; ///< instead of these
    EngineUse alone_;                              ///< of its last picture
};

} // namespace tessera::vis
