#include "vis/bricks/unchanged_bricks.h"

#include "volume/bricks/parts_bricks.h"

namespace tessera::vis {

bool Unchanged::bricks(const ChannelKey& key, int madeOf, glm::ivec3 first, glm::ivec3 last, bool exactly) const {
    const volume::DatasetInfo& info = source.info();
    const volume::Channel channel = info.channel(key.channel);
    const volume::Parameter& parameter = info.parameters[std::size_t(channel.parameter)];
    const Range range = info.channelRange(channel);
    const double most = exactly || parameter.categorical ? 0 : share * (range.hi - range.lo);
    // The assignment of samples to parts may change even if no value does.
    const int label = key.part >= 0 ? volume::labelChannel(info, parameter).value_or(-1) : -1;
    for (int z = first.z; z < last.z; ++z)
        for (int y = first.y; y < last.y; ++y)
            for (int x = first.x; x < last.x; ++x) {
                const auto change = source.change({key.channel, madeOf, 0, {x, y, z}}, key.time);
                if (!change || !(double(change->max) <= most)) return false;
                if (label < 0) continue;
                const auto moved = source.change({label, madeOf, 0, {x, y, z}}, key.time);
                if (!moved || moved->max != 0) return false;
            }
    return true;
}

bool Unchanged::brick(const ChannelKey& key, int madeOf, const BrickId& id) const {
    if (madeOf == key.time) return true;
    const volume::BrickGrid& grid = source.grid();
    const int halo = (((kHalo + 1) << id.level) + grid.brickSize - 1) / grid.brickSize; // in bricks
    return bricks(key, madeOf, glm::max((id.index << id.level) - halo, glm::ivec3(0)),
                  glm::min(((id.index + 1) << id.level) + halo, grid.count()), id.level > 0);
}

bool otherTime(const ChannelKey& a, const ChannelKey& b) {
    ChannelKey same = a;
    same.time = b.time;
    return same == b && a.time != b.time;
}

} // namespace tessera::vis
