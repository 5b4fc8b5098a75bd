#pragma once

#include "vis/bricks/brick_levels.h"
#include "vis/bricks/residency_options.h"
#include "vis/gl/handles.h"
#include "vis/gl/job_queue.h"

#include <deque>
#include <map>

/// Which channels are on the GPU, and how they get there: decoded and packed on threads, coarse first, uploaded a part
/// per frame, within a budget.
namespace tessera::vis {

inline constexpr std::uint64_t kFramesInUse = 2; ///< what one of the last frames used stays

/// One channel at one time on the GPU: a texture of the whole where that is small enough, else bricks in an atlas.
struct ChannelTexture {
    std::shared_ptr<const Texture> texture; ///< several times may share it; null where there are bricks
    int level = 0;                          ///< of the texture
    int madeOf = 0;                         ///< time that it shows
    TexelEncoding encoding;
    glm::ivec3 size{0}; ///< texels with halo
    BlockRanges wholeBlocks;
    std::size_t bytes = 0;
    std::unique_ptr<BrickLevels> bricks; ///< null where the texture is all there is
    BrickAtlas* atlas = nullptr;
    bool outOfRoom = false; ///< missing bricks stay so: the atlas is full

    /// Texel ranges on blockGrid().
    const BlockRanges& blocks() const { return bricks ? bricks->blocks() : wholeBlocks; }
};

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
    std::uint64_t revision() const { return revision_; }

    ResidencyInfo info() const;
    std::vector<std::string> takeMessages();

private:
    /// Whole channels are uploaded a few slices per frame.
    struct Upload {
        LoadedTexels item;
        Texture texture;
        int slices = 0;
    };
    struct Wanted {
        std::shared_ptr<const BrickDemand> demand;
        std::uint64_t frame = 0; ///< in which a view wanted it last
    };
    struct Entry {
        std::shared_ptr<const ChannelSummary> summary;
        std::optional<ChannelTexture> shown;
        std::shared_ptr<const BrickDemand> demand; ///< of the view that asked last
        std::vector<Wanted> wanted;                ///< of the views of the last frames
        bool loading = false;                      ///< a job for the whole channel, or its first brick, is under way
        bool failed = false;                       ///< nothing more will come
        bool coverage = false;                     ///< a damaged brick asks for it
        int bricksInFlight = 0;
        bool stuck = false; ///< the atlas cannot grow either
        int finest = 0;     ///< level of a whole channel for which the driver has memory
        std::uint64_t used = 0;
    };
    int textureLevel() const;
    int componentsOf(bool coverage) const;
    std::size_t slotBytes(int components) const;
    void add(double priority, LoadRequest request);
    bool still(const ChannelKey& key, int madeOf, glm::ivec3 first, glm::ivec3 last, bool exactly) const;
    bool keepsStill(const ChannelKey& key, int madeOf, const BrickId& id) const;
    bool reuseBrick(const ChannelKey& key, Entry& entry, const BrickId& id);
    bool reuseWhole(const ChannelKey& key, Entry& entry);
    std::size_t textureBytes() const;
    void reserve(std::size_t bytes) const;
    bool refused(const LoadedTexels& item);
    bool uploadWhole(Upload& upload, Entry& entry, std::size_t& bytes);
    void makeNothing();
    void drop(std::map<ChannelKey, Entry>::iterator entry);
    void evict();

    // residency_parts.cpp
    bool samePart(const LoadExchange& former, const ChannelKey& key, SameSamples same) const;
    void keepSame(const LoadExchange& former, SameSamples same);
    std::optional<TexelEncoding> encodingOfParts(const ChannelKey& key) const;

    // residency_bricks.cpp
    bool wantedAnew(Entry& entry, const std::shared_ptr<const BrickDemand>& demand) const;
    void queueBricks(const ChannelKey& key, Entry& entry, double priority);
    void beginBricks(const LoadedTexels& first, Entry& entry);
    void takeBrick(LoadedTexels& brick, Entry& entry);
    BrickAtlas& atlasFor(int components);
    std::unique_ptr<BrickAtlas> makeAtlas(int components, std::size_t slots);
    std::optional<glm::ivec3> slotFor(ChannelTexture& channel, float priority);
    bool makeRoom(const ChannelTexture& channel, float priority);
    bool grow(const BrickAtlas* atlas, bool beyond);

    RendererOptions options_;
    std::shared_ptr<LoadExchange> exchange_; ///< null while there is no source
    struct Atlas {
        std::unique_ptr<BrickAtlas> texture;
        std::size_t most; ///< slots that it may grow to within the budget
    };
    std::map<int, std::vector<Atlas>> atlases_; ///< by components; outlive the entries
    std::map<ChannelKey, Entry> entries_;
    std::deque<Upload> uploads_;
    ChannelTexture nothing_;
    std::unique_ptr<PageTable> nothingPages_;
    struct Guest {
        ChannelKey key;
        BrickLevels::Guest brick;
    };
    std::vector<Guest> guests_; ///< bricks that could make room in guestsOf_, the first to go last
    const BrickAtlas* guestsOf_ = nullptr;
    std::uint64_t guestsFrame_ = 0;
    std::uint64_t frame_ = 1, revision_ = 0;
    bool waiting_ = false; ///< finish() runs: the budget may be exceeded
    Driver driver_;
    double keptChange_ = 0;
    int uploaded_ = 0, kept_ = 0; ///< bricks
    std::vector<std::string> messages_;
    JobQueue jobs_; ///< last: its threads end before anything else goes
};

} // namespace tessera::vis
