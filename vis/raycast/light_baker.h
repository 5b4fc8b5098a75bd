#pragma once

#include "vis/gl/handles.h"
#include "vis/gl/program.h"
#include "vis/optics/mesh_matter.h"
#include "vis/optics/surface_light.h"

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <thread>

namespace tessera::vis {

inline constexpr GLenum kMatterFormat = GL_RGBA32F; ///< of the texture that the matter is drawn to

/// Keeps the textures of a picture's light volume (vis/optics/light_volume.h) up to date without holding up the window:
/// matter is drawn some rows a call, meshes are added and light is spread by a thread of its own; until then the former
/// volume shows.
class LightBaker {
public:
    /// What the matter depends on besides the scene.
    struct Matter {
        std::uint64_t revision = 0; ///< of what is resident
        double time = 0;            ///< of the data
        bool operator==(const Matter&) const = default;
    };

    /// Goes on with the work. `setUniforms` sets those of the bound picture on the program
    /// of the matter. Changes the framebuffer, viewport and scissor. Works about `budgetMs`, or until ready if `wait`.
    void update(const Scene& scene, const volume::DatasetInfo& info, const Matter& matter, const Program& program,
                const std::function<void(const Program&)>& setUniforms, GLuint vertices, double budgetMs, bool wait);
    /// The textures show what was last asked for.
    bool ready() const;
    /// Counts the volumes finished; 0: there is none yet.
    std::uint64_t version() const { return version_; }
    GLuint visible() const { return visible_.name(); }
    GLuint scattered() const { return scattered_.name(); }
    const LightGrid& grid() const { return shownGrid_; }

private:
    /// What one spreading was made for.
    struct Spread {
        std::uint64_t matter = 0;
        std::vector<PlacedLight> lights;
        Shadows shadows;
    };
    struct Job {
        Spread key;
        std::shared_ptr<const vis::Matter<float>> matter; ///< with the meshes
        LightVolume<float> result;
        std::atomic<bool> done = false;
    };
    static bool same(const Spread& a, const Spread& b);
    bool drawMatter(const Program& program, const std::function<void(const Program&)>& setUniforms, GLuint vertices,
                    double budgetMs, bool wait);
    void start();
    void take();

    Spread wanted_, shown_;
    std::optional<Scene> scene_; ///< the matter's
    Matter matterKey_;
    LightGrid grid_;
    int rows_ = 0; ///< of the matter, drawn
    bool matterReady_ = false;
    Texture atlas_;
    Framebuffer framebuffer_;
    glm::ivec2 atlasSize_{0};
    MeshCasters casters_;
    bool casting_ = false; ///< `casters_` are not in the matter yet
    std::shared_ptr<const vis::Matter<float>> matter_;
    std::shared_ptr<Job> job_;
    Texture visible_, scattered_;
    LightGrid shownGrid_;
    std::uint64_t version_ = 0;
    std::jthread worker_; ///< last: joined before what it uses goes
};

} // namespace tessera::vis
