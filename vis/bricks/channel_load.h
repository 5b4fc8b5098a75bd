#pragma once

#include "vis/bricks/texels.h"
#include "volume/bricks/brick_cache.h"

#include <atomic>
#include <mutex>
#include <optional>
#include <set>
#include <stop_token>
#include <string>

/// Decoding threads: one channel at one level, or one brick of it, to texels. No OpenGL.
namespace tessera::vis {

struct ChannelKey {
    int channel = 0, time = 0;
    bool prefiltered = true;
    int part = -1; ///< the samples of this part alone (volume/field/parts.h); -1: all
    auto operator<=>(const ChannelKey&) const = default;
};

/// What is known of a channel at one time before any texel.
struct ChannelSummary {
    ChannelStats all;
    std::vector<volume::BrickStats> bricks; ///< x fastest
    std::vector<float> importance;          ///< of them, 0..1; empty: not known
};

/// Texels ready to upload, or a flag that there are none.
struct LoadedTexels {
    ChannelKey key;
    int level = 0;
    std::optional<glm::ivec3>
        brick; ///< one brick of the level's own (vis/bricks/brick_levels.h), else the whole channel
    std::shared_ptr<const ChannelSummary> summary;
    TexelEncoding encoding;
    TexelBlock block;
    bool failed = false;
    /// A brick that could not be read is drawn as absent, so the channel needs coverage from now on.
    bool damaged = false;
};

/// State shared between decoding threads and the renderer; outlives the renderer while a job runs.
struct LoadExchange {
    std::shared_ptr<const volume::BrickSource> source;
    std::unique_ptr<volume::BrickCache> bricks;
    std::mutex mutex;
    std::vector<LoadedTexels> loaded;
    std::vector<std::string> messages;
    std::set<std::string> said; ///< each message comes once

    void say(const std::string& message);
};

struct LoadRequest {
    ChannelKey key;
    int level = 0;
    std::optional<glm::ivec3> brick;
    std::shared_ptr<const ChannelSummary> summary; ///< null: find out
    std::optional<TexelEncoding> encoding;         ///< of the channel's other bricks; none: find out
    bool exact = false;
    bool coverage = false; ///< wanted even if no sample is known to be absent
};

/// Executes a request and stores the result, or the failure, in the exchange. Never throws; stores nothing when
/// stopped.
void loadTexels(LoadExchange& exchange, const LoadRequest& request, std::stop_token stop);

} // namespace tessera::vis
