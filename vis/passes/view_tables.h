#pragma once

#include "vis/bricks/channel_load.h"
#include "vis/demand/covered_pixels.h"
#include "vis/passes/render_tools.h"
#include "vis/raycast/ray_uniforms.h"
#include "volume/base/cached.h"

namespace tessera::vis {

/// What the tables of a picture are made of. `scene` has only what they depend on, and they are made of it.
struct TablesKey {
    Scene scene;
    std::uint64_t resident = 0;     ///< Residency::revision()
    std::vector<ChannelKey> frames; ///< that are drawn
    bool operator==(const TablesKey&) const = default;
};

/// A scene without what its tables do not depend on, such as its camera. What is not taken out here counts, so that a
/// new member of the scene is never forgotten.
Scene tablesScene(const Scene& scene, const volume::DatasetInfo& info);

/// What the tables say of a picture.
struct TablesContent {
    bool adaptive = false;                            ///< take longer steps through smooth blocks
    bool skip = false;                                ///< leap over empty blocks
    std::vector<std::optional<glm::vec2>> opaque;     ///< RayLayer::opaque
    std::optional<std::vector<OccupiedBox>> occupied; ///< nullopt: not known
};

/// The stage that makes transfer tables and block distances of a view.
class ViewTables {
public:
    /// Brings the textures up to date and tells the plan's layers where they are opaque.
    const TablesContent& update(const RenderCall& call, std::uint64_t resident, const std::vector<ChannelKey>& frames);
    void bind(const RayUnits& units) const;
    /// The part of a picture of `size` pixels that rays can see anything in; null: all of it.
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
    volume::Cached<CoveredKey, std::vector<Tile>> covered_; ///< of what is occupied now
    Texture table_, planes_, blocks_;
    int tableRows_ = 0, planePages_ = 0;
    glm::ivec3 blockCount_{0};
};

} // namespace tessera::vis
