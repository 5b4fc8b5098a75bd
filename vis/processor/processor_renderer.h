#pragma once

#include "vis/bricks/residency_options.h"
#include "vis/processor/processor_picture.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tessera::vis {

/// What all pictures share that the processor draws without OpenGL.
class ProcessorRenderer {
public:
    explicit ProcessorRenderer(const RendererOptions& options) : options_(options) {}

    const RendererOptions& options() const { return options_; }
    void setSource(std::shared_ptr<const volume::BrickSource> source);
    const volume::BrickSource* source() const { return volumes_ ? volumes_->source().get() : nullptr; }
    /// Draws a scene of the source. Throws Error when that does, MachineError for what only OpenGL can draw.
    void draw(ProcessorPicture& picture, const Scene& scene, glm::ivec2 size);
    /// The physical position that is seen at a pixel, x right, y down.
    std::optional<glm::dvec3> pick(const ProcessorPicture& picture, glm::ivec2 pixel) const;
    std::vector<std::string> takeMessages() { return std::exchange(messages_, {}); }

private:
    RendererOptions options_;
    std::shared_ptr<packet::PacketVolumes> volumes_; ///< null: no data
    std::vector<std::string> messages_;
};

/// A picture before the background, rows top down.
std::vector<glm::vec4> linearRows(const ProcessorPicture& picture);
/// A picture as it is shown, RGBA8, rows top down.
std::vector<std::uint8_t> shownRows(const ProcessorPicture& picture);

} // namespace tessera::vis
