#pragma once

#include "vis/bricks/texels.h"
#include "volume/bricks/brick_cache.h"

#include <atomic>
#include <mutex>
#include <optional>
#include <set>
#include <stop_token>
#include <string>

/// Work of the decoding threads: turns one channel at one level, or one brick of it, into texels. Without OpenGL.
namespace tessera::vis {

struct ChannelKey {
    int channel = 0, time = 0; ///< a stored time, or one of WithComputedTimes
    volume::Prefilter prefilter = volume::Prefilter::Linear;
    int part = -1; ///< only the samples of this part (volume/field/parts.h); -1: all samples
    auto operator<=>(const ChannelKey&) const = default;
};

/// Statistics of a channel at one time, known before any texel.
struct ChannelSummary {
    ChannelStats all;
    std::vector<volume::BrickStats> bricks; ///< x fastest
    std::vector<float> importance;          ///< per brick, 0..1; empty: unknown
};

/// Texels ready for upload, or a flag that nothing is present.
struct LoadedTexels {
    ChannelKey key;
    int level = 0;
    std::optional<glm::ivec3> brick; ///< one brick at its own level (vis/bricks/brick_levels.h), else the whole channel
    std::shared_ptr<const ChannelSummary> summary;
    TexelEncoding encoding;
    TexelBlock block;
    bool failed = false;
    /// A brick was unreadable and is drawn as absent, so the channel needs coverage from now on.
    bool damaged = false;
};

/// State shared between decoding threads and the renderer; outlives the renderer while a job runs.
struct LoadExchange {
    std::shared_ptr<const volume::BrickSource> source;
    std::unique_ptr<volume::BrickCache> bricks;
    std::mutex mutex;
    std::vector<LoadedTexels> loaded;
    std::vector<std::string> messages;
    std::set<std::string> said; ///< messages already reported, so that each is reported once

    void say(const std::string& message);
};

struct LoadRequest {
    ChannelKey key;
    int level = 0;
    std::optional<glm::ivec3> brick;
    std::shared_ptr<const ChannelSummary> summary; ///< null: computed by the job
    std::optional<TexelEncoding> encoding;         ///< of the other bricks of the channel; none: chosen by the job
    bool exact = false;
    bool coverage = false; ///< store coverage even if no sample is known to be absent
};

/// Executes a request and stores its result or failure in the exchange. Never throws; stores nothing when stopped.
void loadTexels(LoadExchange& exchange, const LoadRequest& request, std::stop_token stop);

} // namespace tessera::vis
