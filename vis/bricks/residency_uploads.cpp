#include "vis/bricks/residency.h"

#include "volume/base/error.h"

#include <algorithm>

/// What the threads have loaded becomes textures.
namespace tessera::vis {

void Residency::update(std::size_t bytes) {
    if (!exchange_) return;
    {
        const std::lock_guard lock(exchange_->mutex);
        for (LoadedTexels& item : exchange_->loaded) uploads_.push_back({std::move(item), {}, 0});
        exchange_->loaded.clear();
    }
    bool changed = false;
    while (!uploads_.empty() && bytes > 0) {
        ResidentChannel* const found = channels_.find(uploads_.front().item.key);
        if (!found) { // dropped since
            uploads_.pop_front();
            continue;
        }
        ResidentChannel& channel = *found;
        try {
            if (!upload(uploads_.front(), channel, bytes)) break;
        } catch (const MachineError& error) {
            if (refused(uploads_.front().item)) continue;
            exchange_->say(error.what());
            channel.ended(!channel.shown);
            if (channel.hasBricks()) channel.shown->room = ChannelTexture::Room::Never;
        } catch (const Error& error) {
            exchange_->say(error.what());
            channel.ended(true);
        }
        changed = true;
        uploads_.pop_front();
    }
    if (!changed) return;
    ++revision_;
    channels_.evict(frame_);
}

/// Takes in one item, at most about so many bytes of it; false when there is more of it.
bool Residency::upload(Upload& upload, ResidentChannel& channel, std::size_t& bytes) {
    LoadedTexels& item = upload.item;
    if (item.brick && item.damaged) {
        beginAnew(item.key, channel);
    } else if (item.brick) {
        const std::size_t size = item.block.bytes();
        uploadBrick(item, channel);
        bytes -= std::min(bytes, size);
    } else {
        if (!item.failed && !uploadWhole(upload, channel, bytes)) return false;
        channel.summary = item.summary;
        channel.ended(item.failed);
    }
    return true;
}

/// A damaged brick is drawn as absent, and the channel has no coverage in its texels: it begins anew, with it.
void Residency::beginAnew(const ChannelKey& key, const ResidentChannel& former) {
    ResidentChannel fresh;
    fresh.used = former.used;
    fresh.summary = former.summary;
    fresh.coverage = true;
    channels_.drop(key);
    channels_.all()[key] = std::move(fresh);
}

void Residency::uploadBrick(LoadedTexels& brick, ResidentChannel& channel) {
    if (!brick.failed) {
        takeBrick(brick, channel);
    } else if (channel.shown) { // out of memory, say: what is here stays as it is
        channel.bricksInFlight = std::max(0, channel.bricksInFlight - 1);
        channel.shown->bricks->forget({brick.level, *brick.brick});
        channel.shown->room = ChannelTexture::Room::Never;
    }
    channel.ended(brick.failed && !channel.shown);
}

/// A few slices of a whole channel, at most `bytes` but one at least; true when all of it is here.
bool Residency::uploadWhole(Upload& upload, ResidentChannel& channel, std::size_t& bytes) {
    LoadedTexels& item = upload.item;
    const TexelBlock& block = item.block;
    if (!upload.texture) {
        channels_.reserve(block.bytes());
        upload.texture = makeTexture3D(block.size, texelFormat(block.components, item.encoding.exact), GL_LINEAR,
                                       "channel " + std::to_string(item.key.channel) + " time " +
                                           std::to_string(item.key.time) + " level " + std::to_string(item.level));
    }
    const std::size_t perSlice = block.bytes() / std::size_t(block.size.z);
    const int slices = int(std::clamp<std::size_t>(bytes / perSlice, 1, std::size_t(block.size.z - upload.slices)));
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage3D(upload.texture.name(), 0, 0, 0, upload.slices, block.size.x, block.size.y, slices,
                        texelLayout(block.components), item.encoding.exact ? GL_FLOAT : GL_UNSIGNED_SHORT,
                        static_cast<const char*>(block.data()) + perSlice * std::size_t(upload.slices));
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    upload.slices += slices;
    bytes -= std::min(bytes, perSlice * std::size_t(slices));
    if (upload.slices < block.size.z) return false;

    ChannelTexture made;
    made.texture = std::make_shared<const Texture>(std::move(upload.texture));
    made.level = item.level;
    made.madeOf = item.key.time;
    made.encoding = item.encoding;
    made.size = block.size;
    made.bytes = block.bytes();
    made.wholeBlocks =
        item.level == 0 ? std::move(item.block.blocks) : onBlockGrid(exchange_->source->grid(), item.block.blocks);
    channel.coverage = item.encoding.coverage;
    channel.shown = std::move(made);
    if (item.level == 0) uploaded_ += bricksOfChannel();
    return true;
}

/// The driver has no memory for a whole channel: channels that no view uses now give way, or it is shown coarser.
/// True where that leaves something to try.
bool Residency::refused(const LoadedTexels& item) {
    if (item.brick) return false;
    if (channels_.dropUnused(frame_, item.key)) return true; // once more
    ResidentChannel& channel = *channels_.find(item.key);
    if (item.level + 1 >= exchange_->source->grid().levels) return false;
    exchange_->say("the graphics driver has not enough memory for full resolution; " +
                   exchange_->source->info().channel(item.key.channel).name + " is drawn coarser");
    channel.finest = item.level + 1;
    channel.summary = item.summary;
    channel.ended(false);
    uploads_.pop_front();
    ++revision_;
    return true;
}

} // namespace tessera::vis
