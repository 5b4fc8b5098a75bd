#pragma once

#include "vis/bricks/resident_channels.h"
#include "vis/gl/job_queue.h"

#include <deque>

/// Which channels are on the GPU, and how they get there: decoded and packed on threads, coarse first, uploaded a part
/// per frame, within a budget.
namespace tessera::vis {

class Residency {
public:
    Residency(const RendererOptions& options, const Driver& driver);
    ~Residency();

    /// Textures and decoded bricks of the samples that the former source has too stay.
    void setSource(std::shared_ptr<const volume::BrickSource> source, SameSamples same = {});
    /// Bytes of textures and of decoded bricks. A smaller atlas, or a larger one where bricks had no room, is filled
    /// anew, coarse first.
    void setBudgets(std::size_t texture, std::size_t memory);
    /// Share of a parameter's range: bricks that move less from one time to another are drawn with the same texels.
    void setKeptChange(double share) { keptChange_ = share; }

    /// A new frame begins, of all views: textures not wanted in one of the last few frames may leave if the budget asks
    /// for it.
    void beginFrame() { ++frame_; }
    std::uint64_t frame() const { return frame_; }
    /// Says that a channel is needed in this frame and queues what is missing. `coarseFirst`: get a first picture soon.
    /// `demand`: which bricks of a bricked channel; null: the coarsest level alone.
    void want(const ChannelKey& key, double priority, bool coarseFirst, std::shared_ptr<const BrickDemand> demand);
    /// Whether channels of this data set are cut into bricks.
    bool bricked() const { return exchange_ && textureLevel() > 0; }
    /// What is known of a channel, whether it can be drawn yet or not.
    const ChannelTexture* known(const ChannelKey& key) const;
    /// Keeps a channel that is shown though another time of it is wanted.
    void keep(const ChannelKey& key);
    /// What is here of a channel, if anything.
    const ChannelTexture* find(const ChannelKey& key) const;
    /// A texture of absent samples, for a channel that is not here.
    const ChannelTexture& nothing() const { return nothing_; }
    /// A page table of nothing, for the same.
    GLuint nothingPages() const { return nothingPages_->texture.name(); }
    /// True when nothing better than find() will come.
    bool settled(const ChannelKey& key) const;
    /// Bricks of a channel still shown coarser than they were wanted last.
    int missing(const ChannelKey& key) const;

    /// Takes what the threads have finished and uploads at most `bytes` of it.
    void update(std::size_t bytes);
    /// Blocks until everything wanted in this frame is here, over the budget if need be.
    void finish();
    /// Changes whenever what find() gives changed.
    std::uint64_t revision() const { return revision_ + channels_.drops(); }

    ResidencyInfo info() const;
    std::vector<std::string> takeMessages();

private:
    /// Whole channels are uploaded a few slices per frame.
    struct Upload {
        LoadedTexels item;
        Texture texture;
        int slices = 0;
    };
    int textureLevel() const;
    int bricksOfChannel() const;
    Unchanged unchanged() const { return {*exchange_->source, keptChange_}; }
    void add(double priority, LoadRequest request);
    void wantBricks(const ChannelKey& key, ResidentChannel& channel, double priority,
                    std::shared_ptr<const BrickDemand> demand);
    void wantWhole(const ChannelKey& key, ResidentChannel& channel, double priority, bool coarseFirst);
    void makeNothing();

    // residency_uploads.cpp
    bool upload(Upload& upload, ResidentChannel& channel, std::size_t& bytes);
    bool uploadWhole(Upload& upload, ResidentChannel& channel, std::size_t& bytes);
    void uploadBrick(LoadedTexels& brick, ResidentChannel& channel);
    void beginAnew(const ChannelKey& key, const ResidentChannel& former);
    bool refused(const LoadedTexels& item);

    // residency_parts.cpp
    bool samePart(const LoadExchange& former, const ChannelKey& key, SameSamples same) const;
    void keepSame(const LoadExchange& former, SameSamples same);

    // residency_bricks.cpp
    void queueBricks(const ChannelKey& key, ResidentChannel& channel, double priority);
    void beginBricks(const LoadedTexels& first, ResidentChannel& channel);
    void takeBrick(LoadedTexels& brick, ResidentChannel& channel);

    RendererOptions options_;
    Driver driver_;
    std::shared_ptr<LoadExchange> exchange_; ///< null while there is no source
    ResidentChannels channels_;
    std::deque<Upload> uploads_;
    ChannelTexture nothing_;
    std::unique_ptr<PageTable> nothingPages_;
    std::uint64_t frame_ = 1, revision_ = 0;
    bool waiting_ = false; ///< finish() runs: the budget may be exceeded
    double keptChange_ = 0;
    int uploaded_ = 0, kept_ = 0; ///< bricks
    std::vector<std::string> messages_;
    JobQueue jobs_; ///< last: its threads end before anything else goes
};

} // namespace tessera::vis
