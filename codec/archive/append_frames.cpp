#include "codec/archive/append_frames.h"

#include "codec/archive/archive_impl.h"
#include "codec/archive/commits.h"

#include <map>
#include <vector>

namespace tessera::codec {

namespace {

/// Appends a range of bytes of another file, piece by piece; returns where they are now.
std::uint64_t copyBytes(const FileBytes& from, std::uint64_t offset, std::uint64_t length, GrowingFile& to) {
    constexpr std::uint64_t kPiece = std::uint64_t(16) << 20;
    const std::uint64_t begin = to.position();
    for (std::uint64_t done = 0; done < length; done += kPiece)
        to.append(from.part({offset + done, std::min(kPiece, length - done)}).bytes());
    return begin;
}

} // namespace

std::uint64_t appendFrames(const Archive& archive, const Archive& more, const Metadata& now,
                           std::span<const std::size_t> componentOf) {
    constexpr std::uint32_t kSetWhenUsed = kSteppedBricks | kSubsamples;
    const Archive::Impl& from = *more.impl_;
    const ArchiveState state = stateOf(archive, false);
    if (((state.header.features ^ from.header.header.features) & ~kSetWhenUsed) != 0)
        throw Error("it was packed by another version of the program than " + archive.path(), more.path());
    Commits commits = commitsOf(archive, state);
    commits.header.features |= from.header.header.features;
    GrowingFile file(archive.path(), state.header);
    IndexPage page;

    for (const Block& model : from.index.models)
        page.models.push_back({copyBytes(*from.bytes, model.offset, model.length, file), model.length, model.checksum});

    std::map<MaskHash::Value, std::int32_t> maskByHash;
    for (const auto& [number, hash] : state.lastMasks) maskByHash.emplace(hash, number);
    std::vector<std::int32_t> maskOf(from.index.masks.size(), -1);
    for (FrameRecord frame : from.index.frames) {
        if (frame.mask >= 0 && maskOf[std::size_t(frame.mask)] < 0) {
            const auto next = static_cast<std::int32_t>(state.masks + page.masks.size());
            const auto [known, isNew] = maskByHash.try_emplace(maskHashOf(more, frame), next);
            maskOf[std::size_t(frame.mask)] = known->second;
            if (isNew) {
                MaskRecord mask = from.index.masks[std::size_t(frame.mask)];
                const std::uint64_t before = mask.offset;
                mask.offset = copyBytes(*from.bytes, before, mask.length, file);
                for (MaskBrick& brick : mask.bricks) brick.segment.offset += mask.offset - before;
                page.masks.push_back(std::move(mask));
            }
        }
        const std::uint64_t before = frame.offset;
        frame.offset = copyBytes(*from.bytes, before, frame.length, file);
        for (Segment& segment : frame.segments) segment.offset += frame.offset - before;
        frame.time += static_cast<std::uint32_t>(state.times);
        frame.component = static_cast<std::uint32_t>(componentOf[frame.component]);
        if (frame.mask >= 0) frame.mask = maskOf[std::size_t(frame.mask)];
        frame.model += static_cast<std::int32_t>(state.models);
        page.frames.push_back(std::move(frame));
    }
    commits.commit(file, page, now, now.info.times.size(), true);
    file.finish();
    return commits.header.fileSize;
}

} // namespace tessera::codec
