#include "codec/blocks/append_frames.h"

#include "codec/archive/archive_impl.h"
#include "codec/archive/commits.h"

#include <map>
#include <utility>
#include <vector>

namespace tessera::codec {

namespace {

/// Appends a block of another archive; returns where it is now. Throws Error when it is damaged.
std::uint64_t copyBlock(const Archive& archive, const FileBytes& from, const Block& block, GrowingFile& to) {
    const std::uint64_t begin = to.position();
    if (block.length > 0) to.append(checkedPart(from, block, archive.path(), "a block").bytes());
    return begin;
}

/// The same for segments; sets their places.
void copySegment(const Archive& archive, const FileBytes& from, Segment& segment, GrowingFile& to) {
    segment.offset = copyBlock(archive, from, {segment.offset, segment.length, segment.checksum}, to);
}

} // namespace

bool codedAlike(const Archive& archive, const Archive& more) {
    const std::uint32_t own = archive.impl_->header.header.features, others = more.impl_->header.header.features;
    return ((own ^ others) & ~kSetWhenUsed) == 0;
}

std::uint64_t appendFrames(const Archive& archive, const Archive& more, const Metadata& now,
                           std::span<const std::size_t> componentOf) {
    const Archive::Impl& from = *more.impl_;
    const ArchiveState state = stateOf(archive, false);
    const bool bringsTimes = now.info.times.size() > state.times;
    if (!codedAlike(archive, more))
        throw Error("it was packed by another version of the program than " + archive.path(), more.path());
    Commits commits = commitsOf(archive, state);
    commits.header.features |= from.header.header.features;
    GrowingFile file(archive.path(), state.header);
    IndexPage page;

    for (const Block& model : from.index.models)
        page.models.push_back({copyBlock(more, *from.bytes, model, file), model.length, model.checksum});

    std::map<MaskHash::Value, std::int32_t> maskByHash;
    for (const auto& [number, hash] : state.lastMasks) maskByHash.emplace(hash, number);
    std::vector<std::uint8_t> seen(archive.impl_->index.masks.size());
    for (const FrameRecord& frame : archive.impl_->index.frames) // parameters have the masks of all times
        if (!bringsTimes && frame.mask >= 0 && !std::exchange(seen[std::size_t(frame.mask)], std::uint8_t(1)))
            maskByHash.emplace(maskHashOf(archive, frame), frame.mask);
    std::vector<std::int32_t> maskOf(from.index.masks.size(), -1);
    for (FrameRecord frame : from.index.frames) {
        if (frame.mask >= 0 && maskOf[std::size_t(frame.mask)] < 0) {
            const auto next = static_cast<std::int32_t>(state.masks + page.masks.size());
            const auto [known, isNew] = maskByHash.try_emplace(maskHashOf(more, frame), next);
            maskOf[std::size_t(frame.mask)] = known->second;
            if (isNew) {
                MaskRecord mask = from.index.masks[std::size_t(frame.mask)];
                mask.offset = file.position();
                for (MaskBrick& brick : mask.bricks) copySegment(more, *from.bytes, brick.segment, file);
                page.masks.push_back(std::move(mask));
            }
        }
        frame.offset = file.position();
        for (Segment& segment : frame.segments) copySegment(more, *from.bytes, segment, file);
        if (bringsTimes) frame.time += static_cast<std::uint32_t>(state.times);
        frame.component = static_cast<std::uint32_t>(componentOf[frame.component]);
        if (frame.mask >= 0) frame.mask = maskOf[std::size_t(frame.mask)];
        frame.model += static_cast<std::int32_t>(state.models);
        page.frames.push_back(std::move(frame));
    }
    Metadata together = now;
    const auto copyParts = [&](std::vector<FileRange>& to, const std::vector<FileRange>& own,
                               const std::vector<FileRange>& added) {
        to = own;
        for (const FileRange& range : added) {
            to.push_back({file.position(), range.length});
            file.append(from.bytes->part(range).bytes());
        }
    };
    copyParts(together.corrections, archive.metadata().corrections, more.metadata().corrections);
    copyParts(together.numbers, archive.metadata().numbers, more.metadata().numbers);
    commits.commit(file, page, together, now.info.times.size(), true);
    file.finish();
    return commits.header.fileSize;
}

} // namespace tessera::codec
