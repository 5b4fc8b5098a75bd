#pragma once

#include "vis/packet/cast_job.h"
#include "vis/packet/skip_map.h"
#include "vis/scene/scene.h"

#include <memory>
#include <string>
#include <vector>

/// A scene as the packet ray caster draws it.
namespace tessera::vis::packet {

/// Why a scene cannot be drawn by packets of rays, in words for users; empty: it can. Everything else must be drawn by
/// OpenGL.
std::string packetRefusal(const Scene& scene, const volume::DatasetInfo& info, const volume::Lattice& lattice);

/// The layers that rays intersect, with their channels; of a scene that is not refused.
struct DrawnChannel {
    int layer = 0; ///< index into Scene::layers
    PacketChannel channel;
};
std::vector<DrawnChannel> drawnChannels(const Scene& scene, const volume::DatasetInfo& info);
/// All samples that a scene needs: those of drawnChannels(), then those of brushed channels.
std::vector<PacketChannel> packetChannels(const Scene& scene, const volume::DatasetInfo& info);

using SharedVolume = std::shared_ptr<const PacketVolume>;

/// Tables and maps of a scene, for every camera. Owns all that its views refer to; not to be moved.
class PacketScene {
public:
    /// `volumes`: of packetChannels(), in their order.
    PacketScene(const Scene& scene, const volume::DatasetInfo& info, std::vector<SharedVolume> volumes);
    PacketScene(const PacketScene&) = delete;
    PacketScene& operator=(const PacketScene&) = delete;

    bool empty() const { return layers_.empty(); }
    /// A job without a picture. `scene` may differ from that of the constructor in its camera, clips, lighting, steps
    /// and the places of its lenses.
    CastJob job(const Scene& scene, const volume::DatasetInfo& info, const volume::Lattice& lattice, glm::ivec2 size,
                double stepFactor);

private:
    void addBrushes(const Scene& scene, const volume::DatasetInfo& info);
    void addLayer(const Scene& scene, const volume::DatasetInfo& info, const DrawnChannel& drawn,
                  const VolumeView* view);

    std::vector<SharedVolume> volumes_;
    std::vector<VolumeView> views_;
    std::vector<std::vector<std::int32_t>> tables_;
    std::vector<std::vector<std::uint32_t>> packed_;
    std::vector<LayerView> layers_;
    SkipMap skip_;
    std::vector<std::uint8_t> absent_, bound_;
    std::vector<PlacedClip> clips_;
    std::vector<PlacedLight> lights_;
    Lighting lighting_;
    std::vector<BrushView> brushes_;
    std::vector<LassoTable> lassos_;
    std::vector<const VolumeView*> fields_;
    FocusView focus_;
    std::vector<PlacedLens> lenses_;
};

} // namespace tessera::vis::packet
