#include "vis/bricks/resident_channel.h"

#include <algorithm>

namespace tessera::vis {

ChannelTexture ChannelTexture::sharedWhole() const {
    ChannelTexture made;
    made.texture = texture;
    made.level = level;
    made.madeOf = madeOf;
    made.encoding = encoding;
    made.size = size;
    made.wholeBlocks = wholeBlocks;
    made.bytes = bytes;
    return made;
}

bool ResidentChannel::wantedAnew(const std::shared_ptr<const BrickDemand>& asked, std::uint64_t frame) {
    const auto left = [&](const Wanted& each) { return each.frame + kFramesInUse < frame; };
    const auto same = [&](const Wanted& each) {
        return each.demand == asked || (each.demand && asked && *each.demand == *asked);
    };
    const bool fewer = std::erase_if(wanted_, left) > 0;
    const auto found = std::ranges::find_if(wanted_, same);
    if (found == wanted_.end()) {
        wanted_.push_back({asked, frame});
        return true;
    }
    found->frame = frame;
    return fewer;
}

bool ResidentChannel::settled(int textureLevel, bool beyond) const {
    if (work == Work::Failed) return true;
    if (!shown) return false;
    if (!shown->bricks) return shown->level <= std::max(textureLevel, finest);
    return shown->full(beyond) || (shown->bricks->drawable() && shown->bricks->missing() == 0);
}

int ResidentChannel::missing(int all) const {
    if (work == Work::Failed) return 0;
    if (hasBricks()) return shown->bricks->missing();
    return shown && shown->level == 0 ? 0 : all;
}

} // namespace tessera::vis
