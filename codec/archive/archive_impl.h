#pragma once

#include "codec/archive/archive.h"
#include "codec/archive/brick_access.h"
#include "codec/brick/predicted_brick.h"
#include "codec/container/index.h"
#include "codec/remote/remote_file.h"

#include <algorithm>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

/// Implementation of Archive: archive_info.cpp has the metadata, archive_read.cpp decodes samples, archive_state.cpp
/// collects the state to continue writing, archive_verify.cpp checks all bytes.
namespace tessera::codec {

struct Archive::Impl {
    std::string path;
    RemoteOptions remote;
    std::shared_ptr<const FileBytes> bytes;
    HeaderState header;
    Metadata metadata;
    Index index;
    std::vector<volume::Channel> channels;
    std::size_t components = 0, bricks = 0;
    /// Decoders of the most recently used models, latest first; their tables take about 200 KiB each. -1: the model of
    /// stepped frames.
    mutable std::list<std::pair<std::int32_t, std::shared_ptr<const BandDecoder>>> decoders;
    mutable std::mutex decodersMutex;
    /// Decoded bricks in the pool, whose memory is reused.
    mutable std::vector<std::unique_ptr<DecodedBrick>> idle;
    mutable std::mutex idleMutex;
    mutable KeptNumbers kept; ///< of archives with predicted frames

    /// The archives of corrections, once they were asked for.
    mutable std::optional<std::vector<std::shared_ptr<const Archive>>> corrections;
    mutable std::mutex correctionsMutex;
    mutable std::shared_ptr<const StoredNumbers> ofRegions; ///< the numbers, once they were asked for
    mutable std::mutex numbersMutex;

    Impl(const std::string& name, const RemoteOptions& options) : Impl(name, options, openBytes(name, options)) {}
    /// Of a file on this machine whose header is not written yet.
    Impl(const std::string& name, const Header& so) : path(name), bytes(openBytes(name, {})), header{so, false} {}
    Impl(const std::string& name, const RemoteOptions& options, std::shared_ptr<const FileBytes> from)
        : path(name), remote(options), bytes(std::move(from)) {
        const std::uint64_t size = bytes->size();
        header = parseHeaders(bytes->part({0, std::min(size, kFirstChunk)}).bytes(), size, path);
    }

    /// Reads metadata and index, which the header names. Throws Error.
    void load();
    /// Sets what follows from metadata and index, and checks that they agree. Throws Error.
    void settle();

    const FrameRecord& frame(int parameter, int component, int time) const {
        return index
            .frames[std::size_t(time) * components + firstComponent(metadata.info, parameter) + std::size_t(component)];
    }
    /// The frame that holds the bytes of a brick: its own, or the one it repeats.
    const FrameRecord& holding(const FrameRecord& frame, std::size_t brick) const {
        const int repeats = frame.bricks[brick].notes.repeats;
        if (repeats == 0) return frame;
        return index.frames[(std::size_t(frame.time) - std::size_t(repeats)) * components + frame.component];
    }
    /// Total bytes of a brick's segments.
    std::uint64_t bytesOf(const FrameRecord& frame, std::size_t brick) const {
        const FrameRecord& held = holding(frame, brick);
        std::uint64_t sum = 0;
        for (std::size_t s = brick; s < held.segments.size(); s += bricks) sum += held.segments[s].length;
        return sum;
    }
    /// The channel of a key; throws Error for a key outside the archive.
    const volume::Channel& channelOf(const volume::BrickKey& key) const {
        const glm::ivec3 count = metadata.grid.count();
        bool inside = key.channel >= 0 && std::size_t(key.channel) < channels.size() && key.time >= 0 &&
                      std::size_t(key.time) < metadata.info.times.size() && key.level >= 0 &&
                      key.level < metadata.grid.levels;
        for (int axis = 0; axis < 3; ++axis) inside = inside && key.index[axis] >= 0 && key.index[axis] < count[axis];
        if (!inside) throw Error("no such brick", path);
        return channels[std::size_t(key.channel)];
    }
    /// The frame of a key that names a stored component; throws Error for others.
    const FrameRecord& storedFrame(const volume::BrickKey& key) const {
        const volume::Channel& channel = channelOf(key);
        if (channel.magnitude) throw Error("a magnitude is not stored", path);
        return frame(channel.parameter, channel.component, key.time);
    }
    const volume::Parameter& parameter(int number) const { return metadata.info.parameters[std::size_t(number)]; }
    FilePart segment(const Segment& segment) const;
    std::vector<std::uint8_t> flags(const FrameRecord& frame, std::size_t brick) const;
    /// The model of a frame; throws Error when it is damaged. Stepped frames have the one for frames without bands.
    Model model(const FrameRecord& frame) const;
    /// The steps of a frame with numbers of kind Stepped; throws Error when they are damaged.
    StepChoice steps(const FrameRecord& frame) const;
    std::shared_ptr<const BandDecoder> decoder(const FrameRecord& frame) const;
    void fetchBrick(const FrameRecord& frame, std::size_t brick, int segments) const;
    /// How many bricks a brick is predicted from, one from the other; 0: it is coded by itself. `frame` holds it.
    std::uint8_t depthOf(const FrameRecord& frame, std::size_t brick) const;
    /// The frame before on the same grid, which a predicted one follows; null: there is none.
    const FrameRecord* before(const FrameRecord& frame) const;
    void decode(const FrameRecord& frame, const BrickFormat& format, std::size_t brick, int level,
                std::span<const std::uint8_t> present, DecodedBrick& out) const;
    /// The same; the codes of a predicted brick are the differences.
    void decodeOwn(const FrameRecord& frame, const BrickFormat& format, std::size_t brick, int level,
                   std::span<const std::uint8_t> present, DecodedBrick& out) const;
    /// The part of each sample of a brick of a frame whose parts are transformed apart; empty: they are all of one.
    std::vector<std::uint8_t> partsOf(const FrameRecord& frame, std::size_t brick) const;
    /// Converts a brick decoded at full resolution to stored numbers; undefined for absent samples.
    Bytes numbersOf(const FrameRecord& frame, volume::ScalarType type, const DecodedBrick& decoded) const;
    volume::BrickSamples readComponent(int parameter, int component, const volume::BrickKey& key) const;
    /// The coarsest level of a brick of a subsampled frame: samples of level 0. What each is physically must be finite
    /// to be present.
    volume::BrickSamples readSubsamples(int parameter, int component, const volume::BrickKey& key) const;
    /// readComponent, but if several parts of the parameter (volume/field/parts.h) meet in the brick, coarser levels
    /// are computed from level 0 (or read from what is stored of it), part by part, since stored coarse samples mix
    /// parts. So are coarse labels, which the prediction between the sublattices of BCC mixes too.
    volume::BrickSamples readOfParts(int parameter, int component, const volume::BrickKey& key) const;
    volume::BrickStats statsOf(int parameter, int component, const volume::BrickKey& key) const;
    std::optional<volume::BrickChange> changeOf(int parameter, int component, const volume::BrickKey& key,
                                                int toTime) const;
    bool hasStatistics() const { return (header.header.features & kBrickStatistics) != 0; }
    bool hasNotes() const { return (header.header.features & kBrickNotes) != 0; }
};

/// A brick borrowed from the pool to decode into; the destructor returns it.
class PooledBrick {
public:
    explicit PooledBrick(const auto& archive) : idle_(archive.idle), mutex_(archive.idleMutex) {
        const std::lock_guard lock(mutex_);
        if (idle_.empty()) idle_.push_back(std::make_unique<DecodedBrick>());
        brick_ = std::move(idle_.back());
        idle_.pop_back();
    }
    ~PooledBrick() {
        const std::lock_guard lock(mutex_);
        idle_.push_back(std::move(brick_));
    }
    PooledBrick(const PooledBrick&) = delete;
    PooledBrick& operator=(const PooledBrick&) = delete;
    DecodedBrick& operator*() const { return *brick_; }
    DecodedBrick* operator->() const { return brick_.get(); }

private:
    std::vector<std::unique_ptr<DecodedBrick>>& idle_;
    std::mutex& mutex_;
    std::unique_ptr<DecodedBrick> brick_;
};

/// Throws Error for damage at a byte offset of an archive.
[[noreturn]] void damaged(const std::string& path, std::uint64_t offset, const std::string& what);

/// The bytes of a block; throws Error when its checksum is wrong.
FilePart checkedPart(const FileBytes& file, const Block& block, const std::string& path, const char* what);

} // namespace tessera::codec
