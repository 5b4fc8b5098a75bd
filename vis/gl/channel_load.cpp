#include "vis/gl/channel_load.h"

#include "volume/error.h"

#include <glm/common.hpp>

namespace tessera::vis {

namespace {

/// A brick of absent samples, in place of one that cannot be read.
SharedBrick absentBrick(const volume::BrickGrid& grid, const volume::BrickKey& key) {
    volume::BrickSamples brick;
    brick.size = grid.brickSamples(key.index, key.level);
    brick.values.assign(std::size_t(brick.size.x) * std::size_t(brick.size.y) * std::size_t(brick.size.z), 0);
    brick.present.assign(brick.values.size(), 0);
    return std::make_shared<const volume::BrickSamples>(std::move(brick));
}

/// `byBrick`: bricks are loaded one by one, so it matters which come first.
ChannelSummary summarize(const volume::BrickSource& source, int channel, int time, bool byBrick) {
    ChannelSummary summary;
    const glm::ivec3 count = source.grid().count();
    for (int z = 0; z < count.z; ++z)
        for (int y = 0; y < count.y; ++y)
            for (int x = 0; x < count.x; ++x) {
                const volume::BrickKey key{channel, time, 0, {x, y, z}};
                summary.bricks.push_back(source.stats(key));
                if (!byBrick) continue;
                if (const auto importance = source.importance(key)) summary.importance.push_back(importance->largest());
            }
    if (summary.importance.size() != summary.bricks.size()) summary.importance.clear();
    summary.all = channelStats(summary.bricks);
    return summary;
}

void load(LoadExchange& exchange, const LoadRequest& request, LoadedTexels& out, std::stop_token stop) {
    const volume::BrickSource& source = *exchange.source;
    const volume::BrickGrid& grid = source.grid();
    const volume::Channel channel = source.info().channels()[std::size_t(request.key.channel)];
    const bool categorical = source.info().parameters[std::size_t(channel.parameter)].categorical;
    if (!out.summary)
        out.summary = std::make_shared<const ChannelSummary>(
            summarize(source, request.key.channel, request.key.time, request.brick.has_value()));
    const ChannelStats& own = out.summary->all;
    const bool many = source.info().times.size() > 1;
    // Bricks of a channel stay alike though the range of all times may have grown since the first one.
    out.encoding = request.encoding ? *request.encoding
                                    : makeEncoding(many ? commonStats(own, source.info().channelRange(channel)) : own,
                                                   categorical, request.exact, request.key.prefiltered);
    out.encoding.coverage = out.encoding.coverage || request.coverage;

    std::atomic<bool> damaged = false;
    const ReadBrick read = [&](const volume::BrickKey& brick) {
        if (stop.stop_requested()) throw Cancelled();
        try {
            return exchange.bricks->get(brick);
        } catch (const Error& error) {
            exchange.say(channel.name + ": a brick cannot be read and is left out: " + error.what());
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
    } catch (const std::exception& error) {
        exchange.say(exchange.source->info().channels()[std::size_t(request.key.channel)].name +
                     " cannot be shown: " + error.what());
        out.failed = true;
    }
    const std::lock_guard lock(exchange.mutex);
    exchange.loaded.push_back(std::move(out));
}

} // namespace tessera::vis
