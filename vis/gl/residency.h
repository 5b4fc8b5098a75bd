#pragma once

#include "vis/gl/handles.h"
#include "vis/gl/job_queue.h"
#include "vis/gl/texels.h"
#include "vis/renderer.h"

#include <map>
#include <optional>

/// Which channels are on the GPU, and how they get there: decoded and packed on threads, coarse first, uploaded a part
/// per frame, within a budget.
namespace tessera::vis {

struct ChannelKey {
    int channel = 0, time = 0;
    bool prefiltered = true;
    auto operator<=>(const ChannelKey&) const = default;
};

/// One channel at one time as a texture.
struct ChannelTexture {
    Texture texture;
    int level = 0;
    TexelEncoding encoding;
    glm::ivec3 size{0}; ///< texels with halo
    BlockRanges blocks;
    std::size_t bytes = 0;
};

class Residency {
public:
    explicit Residency(const RendererOptions& options);
    ~Residency();

    void setSource(std::shared_ptr<const volume::BrickSource> source);

    /// Says that a channel is needed in this frame: queues what is missing. `coarseFirst`: get a first picture soon.
    void want(const ChannelKey& key, double priority, bool coarseFirst);
    /// The best texture of a channel that is here, if any.
    const ChannelTexture* find(const ChannelKey& key) const;
    /// Keeps a channel that is shown though another time of it is wanted.
    void keep(const ChannelKey& key);
    /// A texture of absent samples, for a channel that is not here.
    const ChannelTexture& nothing();
    /// True when nothing better than find() will come.
    bool settled(const ChannelKey& key) const;
    /// Bricks of a channel still shown coarser than wanted.
    int missing(const ChannelKey& key) const;

    /// Takes what the threads have finished and uploads at most `bytes` of it; true when a texture became available.
    bool update(std::size_t bytes);
    /// Blocks until everything wanted is here.
    void finish();
    /// A new frame begins: textures used before may leave from now on if the budget asks for it.
    void beginFrame() { ++frame_; }

    ResidencyInfo info() const;
    std::vector<std::string> takeMessages();

private:
    struct Entry;
    struct Finished;
    struct Shared;
    void queue(const ChannelKey& key, Entry& entry, int level, double priority);
    int wantedLevel(const TexelEncoding* encoding) const;
    bool uploadPart(Finished& item, std::size_t& bytes);
    void evict();

    RendererOptions options_;
    std::shared_ptr<const volume::BrickSource> source_;
    std::shared_ptr<Shared> shared_;
    std::map<ChannelKey, Entry> entries_;
    std::vector<std::unique_ptr<Finished>> uploading_;
    ChannelTexture nothing_;
    std::uint64_t frame_ = 1;
    int maxTextureSize_ = 0;
    JobQueue jobs_;
};

} // namespace tessera::vis
