#pragma once

#include "vis/bricks/computed_times.h"
#include "vis/bricks/resident_channels.h"
#include "vis/gl/job_queue.h"

#include <deque>

/// Keeps the wanted channels in GPU memory within a budget: bricks are decoded and packed on threads, coarse levels
/// first, and uploaded in limited amounts per frame.
namespace tessera::vis {

class Residency {
public:
    Residency(const RendererOptions& options, const Driver& driver);
    ~Residency();

    /// Changes the data set. Textures and decoded bricks of samples that both data sets share are kept.
    void setSource(std::shared_ptr<const volume::BrickSource> source, SameSamples same = {});
    /// Sets the budgets in bytes for textures and decoded bricks. If an atlas must shrink, or can grow because bricks
    /// had no room, it is refilled, coarse levels first.
    void setBudgets(std::size_t texture, std::size_t memory);
    /// Fraction of a parameter's range: bricks that change by less between two times share texels.
    void setKeptChange(double share) { keptChange_ = share; }

    /// Begins a frame of all views. Textures that were not wanted in the last few frames may be evicted if the budget
    /// requires it.
    void beginFrame() { ++frame_; }
    std::uint64_t frame() const { return frame_; }
    /// Requests a channel for this frame and queues missing data. `coarseFirst`: load a coarse level first for an early
    /// picture. `demand`: the bricks of a bricked channel; null: the coarsest level only.
    void want(const ChannelKey& key, double priority, bool coarseFirst, std::shared_ptr<const BrickDemand> demand);
    /// The time of keys for a channel that is computed between two stored times (volume/bricks/source_at_time.h), none
    /// for others: theirs are mixed when drawn.
    std::optional<int> computedTime(int channel, const volume::TimePair& time) const;
    /// Whether channels of this data set are divided into bricks.
    bool bricked() const { return exchange_ && textureLevel() > 0; }
    /// The entry of a channel, drawable or not; null if unknown.
    const ChannelTexture* known(const ChannelKey& key) const;
    /// Keeps a channel that is still drawn while another time of it is wanted.
    void keep(const ChannelKey& key);
    /// The drawable data of a channel; null if there is none.
    const ChannelTexture* find(const ChannelKey& key) const;
    /// A texture of absent samples, bound in place of a channel that is not resident.
    const ChannelTexture& nothing() const { return nothing_; }
    /// The corresponding page table.
    GLuint nothingPages() const { return nothingPages_->texture.name(); }
    /// True if find() will not improve any more.
    bool settled(const ChannelKey& key) const;
    /// Number of bricks of a channel that are drawn coarser than last wanted.
    int missing(const ChannelKey& key) const;

    /// Uploads finished results of the threads, at most `bytes`.
    void update(std::size_t bytes);
    /// Blocks until everything wanted in this frame is resident, exceeding the budget if necessary.
    void finish();
    /// Lets pictures be drawn anew that show other resident data than before.
    void announce() { ++revision_; }
    /// Changes whenever the result of find() changes, and with announce().
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
    std::shared_ptr<LoadExchange> exchange_;         ///< null while there is no source
    std::shared_ptr<const WithComputedTimes> times_; ///< the source of exchange_
    ResidentChannels channels_;
    std::deque<Upload> uploads_;
    ChannelTexture nothing_;
    std::unique_ptr<PageTable> nothingPages_;
    std::uint64_t frame_ = 1, revision_ = 0;
    bool waiting_ = false; ///< finish() is running: the budget may be exceeded
    double keptChange_ = 0;
    int uploaded_ = 0, kept_ = 0; ///< bricks
    std::vector<std::string> messages_;
    JobQueue jobs_; ///< last member: its threads end before the other members are destroyed
};

} // namespace tessera::vis
