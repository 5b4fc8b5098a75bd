#pragma once

#include "vis/packet/packet_scene.h"

#include <chrono>
#include <functional>
#include <future>
#include <optional>
#include <span>
#include <stop_token>

/// The ray caster on the processor's vector units: pictures without OpenGL.
namespace tessera::vis::packet {

enum class InstructionSet { Plain, Avx2, Avx512 };
inline constexpr std::string_view kInstructionSetNames[] = {"plain", "AVX2", "AVX-512"};
/// Those of this processor, the fastest last.
std::vector<InstructionSet> instructionSets();

/// Pixels [begin, end) of a picture, rows counted from the bottom.
struct PixelBox {
    glm::ivec2 begin{0}, end{0};
    glm::ivec2 extent() const { return end - begin; }
};

/// A box of a picture: linear light, RGBA, premultiplied, before the background, rows bottom up.
struct PacketPicture {
    glm::ivec2 size{0}; ///< of the whole picture
    PixelBox box;
    std::vector<float> rgba;
    std::vector<float> pick = {}; ///< distance along each ray of what is seen there, kNowhere: nothing; or empty

    /// Becomes an empty box of a picture of `size` pixels; `picks`: with distances.
    void begin(glm::ivec2 size, const PixelBox& box, bool picks);
};

/// Meshes and lines that were rasterised for the pixels of a box of a picture: surfaces of each pixel, nearest first.
struct PacketGeometry {
    int peels = 0;
    /// Of all pixels for each peel, rows bottom up: distance along the ray (1e9: none) and BrushEffect; RGBA, linear,
    /// premultiplied.
    std::vector<float> distance = {}, color = {};
};

/// How samples are read in the background.
struct PacketReading {
    bool awaited = true;                ///< nothing else is shown until they are there
    std::function<void()> arrived = {}; ///< called from another thread when they are
};

/// The samples that renderers of one data set share: those that one of them holds, and the last ones used as far as
/// they fit a limit. Not for several threads at once.
class PacketVolumes {
public:
    explicit PacketVolumes(std::shared_ptr<const volume::BrickSource> source, PacketReading how = {})
        : source_(std::move(source)), how_(std::move(how)) {}
    ~PacketVolumes(); ///< gives up what is being read
    /// Keeps the last ones used up to so many bytes.
    void keep(std::size_t bytes);
    const std::shared_ptr<const volume::BrickSource>& source() const { return source_; }
    /// The samples of a channel, between two stored times blended anew unless somebody holds them; waits until they are
    /// read. Throws Error when the source does.
    SharedVolume get(const PacketChannel& channel);
    /// Whether get() would not wait.
    bool has(const PacketChannel& channel) const;
    /// The same; begins to read them in the background otherwise.
    bool request(const PacketChannel& channel);
    /// Whether any are being read in the background.
    bool reading() const;

private:
    struct Held {
        PacketChannel channel;
        std::weak_ptr<const PacketVolume> volume;
        SharedVolume earlier = {}, later = {}; ///< what it was blended from
        std::future<SharedVolume> coming;      ///< valid until what is being read is taken
        std::stop_source stop = {};            ///< of reading
        std::future<void> reader = {};         ///< the thread that reads it
        std::uint64_t asked = 0;               ///< value of asked_ when it was last asked for
    };
    Held& entry(const PacketChannel& channel);
    bool blends(const PacketChannel& channel) const;
    SharedVolume blend(const PacketChannel& channel);
    SharedVolume use(const SharedVolume& volume);

    std::shared_ptr<const volume::BrickSource> source_;
    PacketReading how_;
    std::vector<Held> held_;
    std::uint64_t asked_ = 0;
    std::vector<SharedVolume> recent_; ///< the last one used at the end
    std::size_t keep_ = 0;
};

/// Draws the scenes that packetRefusal() does not refuse; keeps the samples and tables of the last ones. Not for
/// several threads at once; it uses all cores itself.
class PacketRenderer {
public:
    /// With a certain instruction set, by default the fastest.
    explicit PacketRenderer(std::optional<InstructionSet> with = {});

    void setSource(std::shared_ptr<const volume::BrickSource> source);
    /// A source whose samples other renderers use, too; false if it is the former one.
    bool setVolumes(std::shared_ptr<PacketVolumes> volumes);
    /// Lets go of samples and tables.
    void release();
    /// Between stored times, values that are to be computed there may be mixed, which is quicker: while time is
    /// dragged.
    void setMixes(bool yes) { mixes_ = yes; }
    /// Whether some of the last scene are.
    bool mixed() const { return mixed_; }
    /// Whether prepare() need not wait for samples.
    bool has(const Scene& scene) const;
    /// The same; begins to read them in the background otherwise.
    bool request(const Scene& scene);
    /// Begins to read the samples of a scene that may come next; whether they are there.
    bool prefetch(const Scene& scene);
    /// Reads samples and makes tables for a scene. Throws Error when the source does.
    void prepare(const Scene& scene);
    /// What lights the next pictures besides lamps: nothing, until this is called. Their volume must be of the scenes.
    void setLight(const SceneLight& light);
    /// All that lights a scene besides lamps; after prepare(). `surroundings` of Environment::Picture.
    SceneLight lightOf(const Scene& scene, const CubeMap* surroundings);
    /// The extinction of rows [begin, end) of a light grid (y + z * size.y), each of which begins at cell row * size.x
    /// of `out`; after prepare().
    void fillMedium(const Scene& scene, const LightGrid& grid, int begin, int end, Medium<float>& out);
    /// Adds one pass of a picture with `passes` of them; after prepare(). `geometry`: of the same box.
    void draw(const Scene& scene, int pass, int passes, double stepFactor, PacketPicture& picture,
              const PacketGeometry& geometry = {});
    /// The same for some boxes of the picture's own alone.
    void draw(const Scene& scene, int pass, int passes, double stepFactor, PacketPicture& picture,
              const PacketGeometry& geometry, std::span<const PixelBox> only);
    /// The whole picture with all passes, lit as the scene says; `surroundings` of Environment::Picture.
    PacketPicture render(const Scene& scene, glm::ivec2 size, const CubeMap* surroundings = nullptr);

    const volume::BrickSource& source() const { return *volumes_->source(); }
    InstructionSet instructions() const { return with_; }
    std::size_t volumes() const { return held_.size(); }    ///< that the last scene draws
    std::size_t bytes() const;                              ///< of samples
    std::uint64_t samplesTaken() const { return samples_; } ///< since countSamples(true)
    void countSamples(bool yes) { counts_ = yes, samples_ = 0; }

private:
    bool isPrepared(const Scene& scene) const;
    std::vector<PacketChannel> channels(const Scene& scene) const;

    InstructionSet with_;
    std::shared_ptr<PacketVolumes> volumes_;
    std::vector<SharedVolume> held_; ///< of the last scene
    std::unique_ptr<PacketScene> scene_;
    Scene prepared_; ///< the scene of scene_
    bool mixes_ = false, mixed_ = false;
    SceneLight light_;
    PackedLight packedLight_; ///< of light_
    bool counts_ = false;
    std::uint64_t samples_ = 0;
};

} // namespace tessera::vis::packet
