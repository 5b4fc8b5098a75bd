#pragma once

#include "vis/bricks/residency_options.h"
#include "vis/passes/frame_request.h"
#include "vis/scene/scene.h"
#include "volume/bricks/brick_source.h"

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// The shared renderer: one per GL context. Needs a current GL 4.5 core context in every call, its destructor too.
namespace tessera::vis {

/// Result of picking: the first sample along the ray with noticeable opacity.
struct Pick {
    glm::dvec3 position; ///< physical
};

/// The picture of one view: framebuffers and the state of refinement. One per view; may be destroyed at any time.
class ViewTarget;
struct ViewTargetDeleter {
    void operator()(ViewTarget* target) const;
};
using ViewTargetPtr = std::unique_ptr<ViewTarget, ViewTargetDeleter>;

class Renderer {
public:
    explicit Renderer(const RendererOptions& options = {});
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    /// Shows another data set; drops every brick of the former one but for those they have in common. Null shows
    /// nothing.
    void setSource(std::shared_ptr<const volume::BrickSource> source, SameSamples same = {});
    const volume::BrickSource* source() const;

    /// A new, empty target for a view.
    ViewTargetPtr makeTarget();
    /// Draws or refines the scene into the target. Repeated calls with an equal scene and request continue the
    /// refinement. If the driver has no memory for a picture of this size, the former one is kept, with a message; a
    /// request that waits throws MachineError.
    FrameStatus render(ViewTarget& target, const Scene& scene, const FrameRequest& request);
    /// What lies under a pixel (x right, y down, of the last request's size) of the target's last picture.
    std::optional<Pick> pick(ViewTarget& target, glm::ivec2 pixel);
    /// Linear float RGBA of the target's last complete picture before the background, premultiplied, rows top down:
    /// what the tests compare with the reference.
    std::vector<glm::vec4> readLinear(ViewTarget& target);
    /// RGBA8 of the picture, rows top down.
    std::vector<std::uint8_t> readPixels(ViewTarget& target, glm::ivec2& size);

    ResidencyInfo residency() const;
    /// Messages since the last call (shader failures, damaged bricks), for the log pane.
    std::vector<std::string> takeMessages();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace tessera::vis
