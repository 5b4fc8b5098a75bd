#include "vis/bricks/channel_load.h"

#include "volume/base/error.h"
#include "volume/bricks/parts_bricks.h"
#include "volume/system/file_bytes.h"

#include <cmath>
#include <glm/common.hpp>

namespace tessera::vis {

namespace {

/// A brick of absent samples, used in place of an unreadable one.
SharedBrick absentBrick(const volume::BrickGrid& grid, const volume::BrickKey& key) {
    volume::BrickSamples brick;
    brick.size = grid.brickSamples(key.index, key.level);
    brick.values.assign(std::size_t(brick.size.x) * std::size_t(brick.size.y) * std::size_t(brick.size.z), 0);
    brick.present.assign(brick.values.size(), 0);
    return std::make_shared<const volume::BrickSamples>(std::move(brick));
}

/// The samples of one part of a channel.
class OnePart {
public:
    OnePart(const volume::BrickSource& source, const ChannelKey& key)
        : source_(source), key_(key), parameter_(parameterOf(source.info(), key.channel)),
          label_(volume::labelChannel(source.info(), parameter_).value_or(-1)) {}

    enum class Share { None, Some, All };
    /// How many samples of a brick belong to the part, as far as the range of the label in the brick tells.
    Share share(glm::ivec3 brick) const {
        constexpr float kMostLabels = 4096;
        const volume::BrickStats stats = source_.stats({label_, key_.time, 0, brick});
        const bool labels = stats.presentFraction > 0 && stats.min <= stats.max;
        bool own = key_.part == 0 && stats.presentFraction < 1, other = key_.part != 0 && stats.presentFraction < 1;
        if (labels && stats.max - stats.min > kMostLabels) return Share::Some;
        for (int value = labels ? int(std::floor(stats.min)) : 1; value <= (labels ? int(std::ceil(stats.max)) : 0);
             ++value)
            (parameter_.parts.partOf(value) == std::size_t(key_.part) ? own : other) = true;
        return !own ? Share::None : other ? Share::Some : Share::All;
    }
    SharedBrick only(const SharedBrick& values, const volume::BrickSamples& labels) const {
        return std::make_shared<const volume::BrickSamples>(
            volume::onlyPart(*values, labels, parameter_.parts, std::size_t(key_.part)));
    }
    volume::BrickKey label(volume::BrickKey brick) const {
        brick.channel = label_;
        return brick;
    }

private:
    static const volume::Parameter& parameterOf(const volume::DatasetInfo& info, int channel) {
        return info.parameters[std::size_t(info.channel(channel).parameter)];
    }
    const volume::BrickSource& source_;
    ChannelKey key_;
    const volume::Parameter& parameter_;
    int label_;
};

/// `byBrick`: bricks are loaded individually, so their order of importance matters. For a part, the range is that of
/// the whole channel, so that all parts share one encoding.
ChannelSummary summarize(const volume::BrickSource& source, const ChannelKey& of, bool byBrick, const OnePart* part) {
    ChannelSummary summary;
    const glm::ivec3 count = source.grid().count();
    for (int z = 0; z < count.z; ++z)
        for (int y = 0; y < count.y; ++y)
            for (int x = 0; x < count.x; ++x) {
                const volume::BrickKey key{of.channel, of.time, 0, {x, y, z}};
                summary.bricks.push_back(source.stats(key));
                if (!byBrick) continue;
                if (const auto importance = source.importance(key)) summary.importance.push_back(importance->largest());
            }
    if (summary.importance.size() != summary.bricks.size()) summary.importance.clear();
    summary.all = channelStats(summary.bricks);
    if (!part) return summary;
    summary.all.someAbsent = true;
    std::size_t i = 0;
    for (int z = 0; z < count.z; ++z)
        for (int y = 0; y < count.y; ++y)
            for (int x = 0; x < count.x; ++x, ++i)
                if (part->share({x, y, z}) == OnePart::Share::None) summary.bricks[i].presentFraction = 0;
    return summary;
}

void load(LoadExchange& exchange, const LoadRequest& request, LoadedTexels& out, std::stop_token stop) {
    const volume::BrickSource& source = *exchange.source;
    const volume::BrickGrid& grid = source.grid();
    const volume::Channel channel = source.info().channel(request.key.channel);
    const bool categorical = source.info().parameters[std::size_t(channel.parameter)].categorical;
    std::optional<OnePart> part;
    if (request.key.part >= 0) part.emplace(source, request.key);
    if (!out.summary)
        out.summary = std::make_shared<const ChannelSummary>(
            summarize(source, request.key, request.brick.has_value(), part ? &*part : nullptr));
    const ChannelStats& own = out.summary->all;
    const bool many = source.info().times.size() > 1;
    // Bricks of a channel keep one encoding, even if the range over all times has grown since the first was loaded.
    out.encoding = request.encoding ? *request.encoding
                                    : makeEncoding(many ? commonStats(own, source.info().channelRange(channel)) : own,
                                                   categorical, request.exact, request.key.prefilter);
    out.encoding.coverage = out.encoding.coverage || request.coverage;

    std::atomic<bool> damaged = false;
    const ReadBrick read = [&](const volume::BrickKey& brick) {
        if (stop.stop_requested()) throw Cancelled();
        try {
            const OnePart::Share share = part ? part->share(brick.index) : OnePart::Share::All;
            if (share == OnePart::Share::None) return absentBrick(grid, brick);
            const SharedBrick samples = exchange.bricks->get(brick);
            return share == OnePart::Share::All ? samples
                                                : part->only(samples, *exchange.bricks->get(part->label(brick)));
        } catch (const ReadError&) {
            throw; // it is not damaged: what is drawn stays as it is
        } catch (const Error& error) {
            exchange.say(channel.name + ": a brick cannot be read and is not drawn: " + error.what());
            damaged = true;
            return absentBrick(grid, brick);
        }
    };
    TexelBox box{request.level, glm::ivec3(0), levelTexels(grid, request.level)};
    if (request.brick) {
        box.begin = *request.brick * grid.brickSize;
        box.end = glm::min(box.begin + grid.brickSize, box.end);
    }
    const volume::BrickKey which{request.key.channel, request.key.time, request.level, {}};
    out.block = makeTexels(grid, which, box, out.encoding, read);
    out.damaged = damaged && !out.encoding.coverage;
    if (out.damaged && !request.brick) {
        out.encoding.coverage = true;
        out.block = makeTexels(grid, which, box, out.encoding, read);
    }
}

} // namespace

void LoadExchange::say(const std::string& message) {
    const std::lock_guard lock(mutex);
    if (said.insert(message).second) messages.push_back(message);
}

void loadTexels(LoadExchange& exchange, const LoadRequest& request, std::stop_token stop) {
    LoadedTexels out;
    out.key = request.key;
    out.level = request.level;
    out.brick = request.brick;
    out.summary = request.summary;
    try {
        load(exchange, request, out, stop);
    } catch (const Cancelled&) {
        return;
    } catch (const ReadError& error) {
        exchange.say(exchange.source->info().channel(request.key.channel).name +
                     " is drawn coarser until the view changes, since a part cannot be read: " + error.what());
        out.failed = true;
    } catch (const std::exception& error) {
        exchange.say(exchange.source->info().channel(request.key.channel).name + " cannot be shown: " + error.what());
        out.failed = true;
    }
    const std::lock_guard lock(exchange.mutex);
    exchange.loaded.push_back(std::move(out));
}

} // namespace tessera::vis
