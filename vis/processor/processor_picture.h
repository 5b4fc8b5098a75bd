#pragma once

#include "vis/gl/texture_name.h"
#include "vis/packet/packet_renderer.h"

#include <functional>

/// Pictures without OpenGL.
namespace tessera::vis {

/// The picture of one view that the processor draws alone, as a whole.
class ProcessorPicture {
public:
    /// What a picture is drawn of.
    struct Data {
        std::shared_ptr<packet::PacketVolumes> volumes; ///< null: nothing, then the ground alone is shown
        std::size_t bytes = ~std::size_t(0);            ///< most that samples may take
    };
    /// Draws a scene unless the picture shows it. `say`: for messages. Throws Error when the source does, MachineError
    /// for what only OpenGL can draw.
    void draw(const Scene& scene, glm::ivec2 size, const Data& data, const std::function<void(std::string)>& say);

    const Scene& scene() const { return scene_; }
    packet::InstructionSet instructions() const { return renderer_.instructions(); }
    /// Before the background.
    const packet::PacketPicture& linear() const { return linear_; }
    /// Rays that were cast for a pixel, on the mean.
    double raysCast() const { return raysCast_; }
    /// As it is shown, rows bottom up.
    const MemoryTexture& texture() const { return texture_; }

private:
    packet::PacketRenderer renderer_;
    std::shared_ptr<packet::PacketVolumes> volumes_; ///< of the picture
    Scene scene_;                                    ///< of the picture
    packet::PacketPicture linear_{.box = {}, .rgba = {}};
    double raysCast_ = 0;
    MemoryTexture texture_{.rgba = {}};
};

} // namespace tessera::vis
