#pragma once

#include "vis/bricks/channel_load.h"
#include "vis/demand/covered_pixels.h"
#include "vis/raycast/ray_uniforms.h"
#include "vis/view/render_tools.h"
#include "volume/base/cached.h"

namespace tessera::vis {

/// Everything that the tables of a picture depend on. `scene` is reduced to what matters, and the tables are made of
/// it.
struct TablesKey {
    Scene scene;
    std::uint64_t resident = 0;     ///< Residency::revision()
    std::vector<ChannelKey> frames; ///< the channels drawn
    bool operator==(const TablesKey&) const = default;
};

/// Resets the members of a scene that its tables do not depend on, such as the camera. Members not reset here count, so
/// that a new one cannot be forgotten.
Scene tablesScene(const Scene& scene, const volume::DatasetInfo& info);

/// What the tables imply for drawing.
struct TablesContent {
    bool adaptive = false;                            ///< use adaptive steps
    bool skip = false;                                ///< use empty-space skipping
    std::vector<std::optional<glm::vec2>> opaque;     ///< RayLayer::opaque
    std::optional<std::vector<OccupiedBox>> occupied; ///< nullopt: unknown
};

/// The stage that makes the transfer tables and the block distances of a view.
class ViewTables {
public:
    /// Updates the textures and sets the opaque intervals of the plan's layers.
    const TablesContent& update(const RenderCall& call, std::uint64_t resident, const std::vector<ChannelKey>& frames);
    void bind(const RayUnits& units) const;
    /// The part of a picture of `size` pixels in which anything can be visible; null: all of it.
    const std::vector<Tile>* covered(const RenderCall& call, glm::ivec2 size);
    const TablesContent& content() const { return content_.value(); }

private:
    struct CoveredKey {
        Camera camera;
        glm::ivec2 size{0};
        bool operator==(const CoveredKey&) const = default;
    };
    TablesContent make(const TablesKey& key, const RenderCall& call);
    void uploadTransfer(const std::vector<glm::vec4>& table);
    void uploadPlanes(const RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info);
    void uploadBlocks(const BlockDistances& blocks, const std::vector<std::uint8_t>& steps);

    volume::Cached<TablesKey, TablesContent> content_;
    volume::Cached<CoveredKey, std::vector<Tile>> covered_; ///< for the current occupied boxes
    Texture table_, planes_, blocks_;
    int tableRows_ = 0, planePages_ = 0;
    glm::ivec3 blockCount_{0};
};

} // namespace tessera::vis
