#pragma once

#include "vis/packed/skip_map.h"
#include "vis/packet/cast_job.h"
#include "vis/packet/packet_channels.h"
#include "vis/packet/packet_table.h"
#include "vis/scene/scene.h"

#include <deque>
#include <memory>
#include <vector>

/// A scene as the packet ray caster draws it.
namespace tessera::vis::packet {

using SharedVolume = std::shared_ptr<const PacketVolume>;

/// Refers to a volume, but not to its parts.
VolumeView viewOf(const PacketVolume& volume);

/// Tables and maps of a scene, for every camera. Owns all that its views refer to; not to be moved.
class PacketScene {
public:
    /// `volumes`: of packetChannels(), in their order.
    PacketScene(const Scene& scene, const volume::DatasetInfo& info, std::vector<SharedVolume> volumes);
    PacketScene(const PacketScene&) = delete;
    PacketScene& operator=(const PacketScene&) = delete;

    bool empty() const { return layers_.empty() && slices_.empty(); }
    /// A job without a picture. `scene` may differ from that of the constructor in its camera, clips, lighting, steps
    /// and the places of its lenses and slices. The job refers to `around`.
    CastJob job(const Scene& scene, const volume::DatasetInfo& info, const volume::Lattice& lattice, glm::ivec2 size,
                double stepFactor, const PackedLight& around);

private:
    void addBrushes(const Scene& scene, const volume::DatasetInfo& info, const std::vector<int>& channels);
    LayerView viewOfLayer(const DrawnLayer& layer, glm::vec2 places, std::size_t index) const;
    IntegralView integralsOf(const TransferFunction& function, Range range);
    const std::int32_t* keep(std::vector<std::int32_t> entries);
    ColorView colorsOf(const DrawnLayer& drawn, std::size_t index);
    void addSlice(const DrawnLayer& drawn, std::size_t index);
    void placeSlices(const Scene& scene, const WorldFrame& frame);
    void addLayer(const DrawnLayer& drawn, std::size_t index);

    std::vector<SharedVolume> volumes_;
    std::vector<VolumeView> views_;
    std::vector<std::vector<VolumeView>> partViews_; ///< of each volume
    std::deque<Look> looks_;                         ///< of layers
    std::deque<std::vector<TransferRegion>> regions_;
    std::vector<std::vector<std::int32_t>> tables_;
    std::vector<std::vector<std::uint32_t>> packed_;
    std::vector<LayerView> layers_;
    std::vector<SliceView> slices_;
    std::vector<int> sliceLayers_; ///< indices into Scene::layers
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
