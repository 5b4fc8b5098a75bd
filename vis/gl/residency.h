#pragma once

#include "vis/gl/brick_atlas.h"
#include "vis/gl/channel_load.h"
#include "vis/gl/handles.h"
#include "vis/gl/job_queue.h"
#include "vis/renderer.h"

#include <deque>
#include <map>

/// Which channels are on the GPU, and how they get there: decoded and packed on threads, coarse first, uploaded a part
/// per frame, within a budget.
namespace tessera::vis {

/// One channel at one time on the GPU: a texture of the whole at the finest level that fits one, and where that is not
/// the full resolution, its bricks in an atlas.
struct ChannelTexture {
    Texture texture;
    int level = 0;
    TexelEncoding encoding;
    glm::ivec3 size{0}; ///< texels with halo
    BlockRanges blocks;
    std::size_t bytes = 0;
    std::unique_ptr<PageTable> pages; ///< null where the texture is all there is
    const BrickAtlas* atlas = nullptr;
    int bricksMissing = 0;  ///< pages still coarse
    bool outOfRoom = false; ///< and they stay so: the atlas is full
};

class Residency {
public:
    explicit Residency(const RendererOptions& options);
    ~Residency();

    void setSource(std::shared_ptr<const volume::BrickSource> source);

    /// A new frame begins: textures not wanted in one of the last few frames may leave if the budget asks for it.
    void beginFrame() { ++frame_; }
    /// Says that a channel is needed in this frame and queues what is missing. `coarseFirst`: get a first picture soon.
    /// Bricks nearer to `focus` (cells) come first.
    void want(const ChannelKey& key, double priority, bool coarseFirst, glm::dvec3 focus);
    /// Keeps a channel that is shown though another time of it is wanted.
    void keep(const ChannelKey& key);
    /// What is here of a channel, if anything.
    const ChannelTexture* find(const ChannelKey& key) const;
    /// A texture of absent samples, for a channel that is not here.
    const ChannelTexture& nothing();
    /// True when nothing better than find() will come.
    bool settled(const ChannelKey& key) const;
    /// Bricks of a channel still shown coarser than at full resolution.
    int missing(const ChannelKey& key) const;

    /// Takes what the threads have finished and uploads at most `bytes` of it.
    void update(std::size_t bytes);
    /// Blocks until everything wanted in this frame is here, over the budget if need be.
    void finish();
    /// Changes whenever what find() gives changed.
    std::uint64_t revision() const { return revision_; }

    ResidencyInfo info() const;
    std::vector<std::string> takeMessages();

private:
    struct Entry;
    struct Upload;
    int textureLevel() const;
    int componentsOf(bool coverage) const;
    void add(double priority, LoadRequest request);
    void queueBricks(const ChannelKey& key, Entry& entry, double priority, glm::dvec3 focus);
    bool uploadWhole(Upload& upload, Entry& entry, std::size_t& bytes);
    void makePages(ChannelTexture& channel, const ChannelSummary& summary);
    void takeBrick(LoadedTexels& brick, Entry& entry);
    std::optional<glm::ivec3> slotFor(ChannelTexture& channel);
    void drop(std::map<ChannelKey, Entry>::iterator entry);
    void evict();

    RendererOptions options_;
    std::shared_ptr<LoadExchange> exchange_;             ///< null while there is no source
    std::map<int, std::unique_ptr<BrickAtlas>> atlases_; ///< by components; outlive the entries
    std::map<ChannelKey, Entry> entries_;
    std::deque<Upload> uploads_;
    ChannelTexture nothing_;
    std::uint64_t frame_ = 1, revision_ = 0;
    bool waiting_ = false; ///< finish() runs: the budget may be exceeded
    int maxTextureSize_ = 0;
    std::vector<std::string> messages_;
    JobQueue jobs_; ///< last: its threads end before anything else goes
};

} // namespace tessera::vis
