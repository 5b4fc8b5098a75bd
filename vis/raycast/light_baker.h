#pragma once

#include "vis/gl/pixel_reader.h"
#include "vis/gl/program.h"
#include "vis/optics/surface_light.h"
#include "vis/shapes/mesh_medium.h"

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <thread>
#include <variant>

namespace tessera::vis {

inline constexpr GLenum kMediumFormat = GL_RGBA32F; ///< of the texture of extinction

/// Updates the light volume of a picture and its textures (vis/optics/light_volume.h) without blocking the window:
/// extinction is drawn or computed a few rows per call; a thread adds meshes and propagates light. The former volume is
/// used until then.
class LightBaker {
public:
    /// Inputs of the extinction besides the scene.
    struct Medium {
        std::uint64_t revision = 0; ///< of the resident data
        double time = 0;            ///< of the data
        bool computed = false;      ///< by Rows, not drawn by a Pass
        bool operator==(const Medium&) const = default;
    };

    /// How to draw the extinction.
    struct Pass {
        const Program& program;
        const std::function<void(const Program&)>& setUniforms; ///< sets the uniforms of the bound picture
        GLuint vertices = 0;
        bool waits = true; ///< wait for the driver after some rows, to stay within the budget
    };
    /// Computes rows [begin, end) of the extinction, y + z * size.y, into their places of `out`.
    using Rows = std::function<void(const LightGrid& grid, int begin, int end, vis::Medium<float>& out)>;
    /// Continues the work for about `budgetMs`, or until it is finished if `wait`. With a Pass it changes the
    /// framebuffer, viewport and scissor.
    void update(const Scene& scene, const volume::DatasetInfo& info, const Medium& medium,
                const std::variant<Pass, Rows>& how, double budgetMs, bool wait);
    /// Whether the textures are up to date.
    bool ready() const;
    /// Number of finished volumes; 0: none yet.
    std::uint64_t version() const { return version_; }
    /// The volume of the textures; null: none yet.
    const std::shared_ptr<const LightVolume<float>>& light() const { return light_; }
    GLuint visible() const { return visible_.name(); }
    GLuint scattered() const { return scattered_.name(); }

private:
    /// Inputs of one light propagation.
    struct Spread {
        std::uint64_t medium = 0;
        std::vector<PlacedLight> lights;
        Shadows shadows;
    };
    struct Job {
        Spread key;
        std::shared_ptr<const vis::Medium<float>> medium; ///< including the meshes
        std::shared_ptr<const LightVolume<float>> result;
        std::atomic<bool> done = false;
    };
    static bool same(const Spread& a, const Spread& b);
    void drawMedium(const Pass& pass, double budgetMs, bool wait);
    bool readMedium(bool wait);
    bool computeMedium(const Rows& rows, double budgetMs, bool wait);
    void start();
    void take();

    Spread wanted_, shown_;
    /// What the extinction depends on: the reduced scene, and its placed lenses.
    struct MediumKey {
        Scene scene;
        std::vector<PlacedLens> lenses;
        LightGrid grid;
        Medium medium;
        bool operator==(const MediumKey&) const = default;
    };
    static MediumKey keyOf(const Scene& scene, const LightGrid& grid, const Medium& medium);

    std::optional<MediumKey> mediumOf_;
    LightGrid grid_;
    int rows_ = 0; ///< rows of the extinction drawn so far
    bool mediumReady_ = false;
    Texture atlas_;
    Framebuffer framebuffer_;
    PixelReader reader_;
    glm::ivec2 atlasSize_{0};
    MeshCasters casters_;
    bool casting_ = false; ///< `casters_` are not yet added to the extinction
    std::shared_ptr<const vis::Medium<float>> medium_;
    std::shared_ptr<vis::Medium<float>> read_; ///< being read back or computed
    std::shared_ptr<Job> job_;
    Texture visible_, scattered_;
    std::shared_ptr<const LightVolume<float>> light_;
    std::uint64_t version_ = 0;
    std::jthread worker_; ///< last member: joined before the data it uses are destroyed
};

} // namespace tessera::vis
