#include "vis/bricks/residency.h"

#include "volume/base/error.h"

#include <algorithm>

/// Uploads of the results of the decoding threads.
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
        if (!found) { // dropped since it was requested
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

/// Uploads one item, at most about `bytes` of it; false if some of it remains.
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

/// Reloads a channel with coverage after a damaged brick, which is drawn as absent, was found in a channel without.
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
    } else if (channel.shown) { // for example out of memory: keep what is resident
        channel.bricksInFlight = std::max(0, channel.bricksInFlight - 1);
        channel.shown->bricks->forget({brick.level, *brick.brick});
        channel.shown->room = ChannelTexture::Room::Never;
    }
    channel.ended(brick.failed && !channel.shown);
}

/// Uploads a few slices of a whole channel, at most `bytes` but at least one slice; true when all are uploaded.
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

/// Handles the driver's refusal of memory for a whole channel: drops channels that no view uses now, else uses a
/// coarser level. True if another attempt makes sense.
bool Residency::refused(const LoadedTexels& item) {
    if (item.brick) return false;
    if (channels_.dropUnused(frame_, item.key)) return true; // try again
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
