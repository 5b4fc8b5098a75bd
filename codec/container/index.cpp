#include "codec/container/index.h"

#include "codec/bytes/lzma.h"
#include "volume/base/error.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace tessera::codec {

namespace {

constexpr std::uint64_t kPageHeadBytes = 64, kMaskRecordBytes = 16, kMaskBrickBytes = 16, kModelBytes = 24,
                        kFrameRecordBytes = 68, kFrameBrickBytes = 8, kNotesBytes = 12, kSegmentBytes = 12;
constexpr double kMost16 = 65535;

std::uint16_t to16(double part) {
    return static_cast<std::uint16_t>(std::lround(std::clamp(part, 0.0, 1.0) * kMost16));
}

volume::BrickChange changeOf(float max, std::uint16_t share) {
    if (!(max > 0) || !std::isfinite(max)) return {max, max};
    return {max, volume::roundedUp(double(max) * share / kMost16)};
}

/// RMS / maximum, rounded up to 16 bits; of what changeOf() gives the same again.
std::uint16_t shareOf(const volume::BrickChange& change) {
    if (!(change.max > 0)) return 0;
    if (!std::isfinite(change.max)) return std::uint16_t(kMost16);
    auto share = static_cast<std::uint16_t>(std::min(double(change.rms) / double(change.max), 1.0) * kMost16);
    while (double(share) < kMost16 && changeOf(change.max, share).rms < change.rms) ++share;
    return share;
}

void require(bool condition, const char* what, const std::string& file) {
    if (!condition) throw Error(what, file, "index");
}

/// Reads the records of a page.
class RecordReader {
public:
    RecordReader(std::span<const std::byte> bytes, const Header& header, const IndexShape& shape,
                 const std::string& file)
        : in_(bytes), notes_((header.features & kBrickNotes) != 0),
          statistics_((header.features & kBrickStatistics) != 0), stepped_((header.features & kSteppedBricks) != 0),
          subsamples_((header.features & kSubsamples) != 0), predicted_((header.features & kPredictedFrames) != 0),
          parted_((header.features & kPartedFrames) != 0), mixed_((header.features & kMixedBricks) != 0),
          end_(header.index.offset), shape_(shape), file_(file) {}

    IndexPage page() {
        IndexPage page;
        const std::uint64_t room = in_.left();
        require(room >= kPageHeadBytes, "the index is truncated", file_);
        page.previousPage = in_.get<Block>();
        page.previousMetadata = in_.get<Block>();
        const std::uint64_t times = in_.get<std::uint32_t>(), masks = in_.get<std::uint32_t>(),
                            frames = in_.get<std::uint32_t>(), models = in_.get<std::uint32_t>();
        const std::uint64_t bricks = shape_.bricks;
        // No count may exceed the capacity of the page's bytes, so nothing below overflows and allocations are
        // proportional to those bytes. Decompressed pages can be larger than the file; mostPageBytes limits them.
        require(bricks <= room || (frames == 0 && masks == 0), "the index is too short", file_);
        const std::uint64_t maskBytes = kMaskRecordBytes + bricks * kMaskBrickBytes;
        const std::uint64_t frameBytes =
            kFrameRecordBytes + bricks * (kFrameBrickBytes + (notes_ ? kNotesBytes : 0) +
                                          static_cast<std::uint64_t>(shape_.grid.levels) * kSegmentBytes);
        require(times <= room / 8 && masks <= room / maskBytes && frames <= room / frameBytes &&
                    models <= room / kModelBytes,
                "the index has the wrong length", file_);
        const std::uint64_t records =
            kPageHeadBytes + 8 * times + models * kModelBytes + masks * maskBytes + frames * frameBytes;
        require(statistics_ ? records <= room : records == room, "the index has the wrong length", file_);
        for (std::uint64_t t = 0; t < times; ++t) page.times.push_back(in_.get<double>());
        for (std::uint64_t m = 0; m < models; ++m) {
            page.models.push_back(in_.get<Block>());
            requireInside(page.models.back().offset, page.models.back().length);
        }
        for (std::uint64_t m = 0; m < masks; ++m) page.masks.push_back(mask());
        for (std::uint64_t f = 0; f < frames; ++f) page.frames.push_back(frame());
        page.statistics.assign(in_.rest().begin(), in_.rest().end());
        return page;
    }

private:
    void requireInside(std::uint64_t offset, std::uint64_t length) const {
        require(offset >= kFirstChunk && offset <= end_ && length <= end_ - offset, "a chunk lies outside the file",
                file_);
    }
    void place(Segment& segment, std::uint64_t& at, std::uint64_t end) const {
        require(segment.length <= end - at, "a brick does not fit its chunk", file_);
        segment.offset = at;
        at += segment.length;
    }

    MaskRecord mask() {
        MaskRecord mask;
        mask.offset = in_.get<std::uint64_t>();
        mask.length = in_.get<std::uint64_t>();
        requireInside(mask.offset, mask.length);
        std::uint64_t at = mask.offset;
        mask.bricks.resize(shape_.bricks);
        for (MaskBrick& brick : mask.bricks) {
            brick.segment.length = in_.get<std::uint32_t>();
            brick.present = in_.get<std::uint32_t>();
            brick.segment.checksum = in_.get<std::uint64_t>();
            place(brick.segment, at, mask.offset + mask.length);
        }
        require(at == mask.offset + mask.length, "the bricks of a mask do not fill its chunk", file_);
        return mask;
    }

    FrameBrick::Notes notes() {
        FrameBrick::Notes notes;
        notes.importance.importance = static_cast<float>(in_.get<std::uint16_t>() / kMost16);
        notes.importance.detail = static_cast<float>(in_.get<std::uint16_t>() / kMost16);
        const auto max = in_.get<float>();
        const auto share = in_.get<std::uint16_t>();
        notes.repeats = in_.get<std::uint16_t>();
        require(max >= 0 || (max == FrameBrick::kUnknown && notes.repeats == 0), "an invalid change of a brick", file_);
        notes.change = changeOf(max, share);
        return notes;
    }

    FrameRecord frame() {
        FrameRecord frame;
        frame.time = in_.get<std::uint32_t>();
        frame.component = in_.get<std::uint32_t>();
        frame.offset = in_.get<std::uint64_t>();
        frame.length = in_.get<std::uint64_t>();
        requireInside(frame.offset, frame.length);
        const auto kind = in_.get<std::uint8_t>(), wavelet = in_.get<std::uint8_t>(), keeps = in_.get<std::uint8_t>();
        const auto codeBits = in_.get<std::uint8_t>();
        require(kind <= static_cast<std::uint8_t>(stepped_ ? NumberKind::Stepped : NumberKind::Quantised),
                "an unknown coding of numbers", file_);
        require(wavelet < std::size(kWaveletNames), "an unknown wavelet", file_);
        const bool mayPredict = predicted_ && kind == static_cast<std::uint8_t>(NumberKind::Stepped) && frame.time > 0;
        const int flags = 1 | (notes_ ? 2 : 0) | (subsamples_ && shape_.grid.levels > 1 ? 4 : 0) |
                          (mayPredict ? 8 : 0) |
                          (parted_ && kind == static_cast<std::uint8_t>(NumberKind::Stepped) ? 32 : 0);
        require((keeps & ~flags) == 0, "an unknown flag of a frame", file_);
        require(codeBits >= 1 && codeBits <= 32, "an invalid width of codes", file_);
        frame.numbers.kind = static_cast<NumberKind>(kind);
        frame.wavelet = static_cast<Wavelet>(wavelet);
        frame.keepsAbsent = (keeps & 1) != 0;
        frame.bodyCentred = (keeps & 2) != 0;
        frame.subsampled = (keeps & 4) != 0;
        frame.predicted = (keeps & 8) != 0;
        frame.parted = (keeps & 32) != 0;
        frame.mixed = mixed_;
        frame.codeBits = codeBits;
        frame.mask = in_.get<std::int32_t>();
        frame.model = in_.get<std::int32_t>();
        frame.numbers.origin = in_.get<double>();
        frame.numbers.step = in_.get<double>();
        frame.valueOffset = in_.get<double>();
        frame.valueScale = in_.get<double>();
        frame.bricks.resize(shape_.bricks);
        for (FrameBrick& brick : frame.bricks) {
            brick.min = in_.get<float>();
            brick.max = in_.get<float>();
            if (notes_) brick.notes = notes();
        }
        std::uint64_t at = frame.offset;
        frame.segments.resize(shape_.bricks * static_cast<std::uint64_t>(shape_.grid.levels));
        for (Segment& segment : frame.segments) {
            segment.length = in_.get<std::uint32_t>();
            segment.checksum = in_.get<std::uint64_t>();
            place(segment, at, frame.offset + frame.length);
        }
        require(at == frame.offset + frame.length, "the bricks of a frame do not fill its chunk", file_);
        return frame;
    }

    ByteReader in_;
    bool notes_, statistics_, stepped_, subsamples_, predicted_, parted_, mixed_;
    std::uint64_t end_; ///< of the part of the file that may contain chunks
    const IndexShape& shape_;
    const std::string& file_;
};

/// Reads the pages from the last, which the header names, to the first; returned in file order.
std::vector<IndexPage> readPages(const FileBytes& bytes, const Header& header, const IndexShape& shape,
                                 const std::string& file, std::vector<Block>& places, std::uint64_t& pageBytes) {
    std::vector<IndexPage> pages;
    Header upTo = header;
    pageBytes = 0;
    for (Block at = header.index;;) {
        const std::optional<FilePart> read = wholePart(bytes, at, file);
        require(read.has_value(), "the index is damaged (checksum)", file);
        const auto part = read->bytes();
        upTo.index = at; // a page may only refer to bytes before it
        Bytes records;
        const bool compact = (header.features & kCompact) != 0;
        require(!compact || decodeBlock(part, records) == DecodeStatus::Ok, "a page of the index cannot be decoded",
                file);
        pageBytes += compact ? records.size() : part.size();
        require(!compact || pageBytes <= mostPageBytes(header.fileSize), "the index is far too long for the file",
                file);
        pages.push_back(RecordReader(compact ? records : part, upTo, shape, file).page());
        places.push_back(at);
        const Block before = pages.back().previousPage;
        if (before == Block{}) break;
        require(before.offset >= kFirstChunk && before.offset < at.offset && before.length <= at.offset - before.offset,
                "a page of the index lies outside the file", file);
        bytes.goesOn(before.offset + before.length, before.checksum);
        at = before;
    }
    std::reverse(pages.begin(), pages.end());
    std::reverse(places.begin(), places.end());
    return pages;
}

/// Reads the statistics of a page; the index already has its masks and those of older pages.
void takeStatistics(const Index& index, const IndexShape& shape, IndexPage& page, const std::string& file) {
    BitReader in(page.statistics);
    for (FrameRecord& frame : page.frames)
        for (std::size_t b = 0; b < frame.bricks.size(); ++b) {
            FrameBrick& brick = frame.bricks[b];
            if (brick.notes.repeats > 0) continue;
            const glm::u64vec3 size(shape.grid.brickSamples(shape.grid.indexOf(b), 0));
            const std::uint64_t samples = size.x * size.y * size.z,
                                present =
                                    frame.mask < 0 ? samples : index.masks[std::size_t(frame.mask)].bricks[b].present;
            const bool isFloat = frame.numbers.kind != NumberKind::Integer;
            require(present <= samples &&
                        take(in, brick.min, brick.max, isFloat, static_cast<std::uint32_t>(present), brick.histogram),
                    "statistics of a brick cannot be read", file);
        }
    require(in.atEnd(), "statistics of bricks do not fill the index", file);
}

/// Requires that a brick that repeats another has no bytes of its own, and that the other is not a repeat.
void requireRepeats(const Index& index, const IndexShape& shape, const std::string& file) {
    for (std::size_t f = 0; f < index.frames.size(); ++f) {
        const FrameRecord& frame = index.frames[f];
        for (std::size_t b = 0; b < shape.bricks; ++b) {
            const auto repeats = static_cast<std::uint32_t>(frame.bricks[b].notes.repeats);
            if (repeats == 0) continue;
            require(repeats <= frame.time, "a brick repeats one before the first time", file);
            const FrameRecord& other = index.frames[f - repeats * shape.components];
            require(other.bricks[b].notes.repeats == 0, "a brick repeats one that repeats another", file);
            for (std::size_t s = b; s < frame.segments.size(); s += shape.bricks)
                require(frame.segments[s].length == 0, "a brick that repeats another has bytes of its own", file);
        }
    }
}

/// Requires that chunks, pages and all metadata fill the file from the first chunk to its end without gaps.
void requireFilled(const Index& index, const IndexShape& shape, const Header& header, const std::string& file) {
    std::vector<std::pair<std::uint64_t, std::uint64_t>> parts;
    const auto add = [&](const auto& part) {
        const std::uint64_t end = header.fileSize;
        require(part.offset <= end && part.length <= end - part.offset, "a part lies outside the file", file);
        parts.emplace_back(part.offset, part.offset + part.length);
    };
    for (const auto* blocks : {&index.models, &index.pages, &index.retired})
        for (const Block& block : *blocks) add(block);
    for (const MaskRecord& mask : index.masks) add(mask);
    for (const FrameRecord& frame : index.frames) add(frame);
    require(shape.corrections.empty() || (header.features & kCorrections) != 0,
            "there are corrections that the archive does not declare", file);
    require(shape.numbers.empty() || (header.features & kRegionNumbers) != 0,
            "there are numbers of regions that the archive does not declare", file);
    for (const auto* ranges : {&shape.corrections, &shape.numbers})
        for (const FileRange& range : *ranges) add(range);
    add(header.metadata);
    std::sort(parts.begin(), parts.end());
    std::uint64_t at = kFirstChunk;
    for (const auto& [begin, end] : parts) {
        require(begin == at, "the chunks do not fill the file", file);
        at = end;
    }
    require(at == header.fileSize, "the chunks do not fill the file", file);
}

} // namespace

void add(const IndexPage& page, Index& index) {
    index.models.insert(index.models.end(), page.models.begin(), page.models.end());
    index.masks.insert(index.masks.end(), page.masks.begin(), page.masks.end());
    index.frames.insert(index.frames.end(), page.frames.begin(), page.frames.end());
}

FrameBrick::Notes rounded(const FrameBrick::Notes& notes) {
    FrameBrick::Notes out = notes;
    out.importance.importance = static_cast<float>(to16(double(notes.importance.importance)) / kMost16);
    out.importance.detail = static_cast<float>(to16(double(notes.importance.detail)) / kMost16);
    out.change = changeOf(notes.change.max, shareOf(notes.change));
    return out;
}

Bytes serialise(const IndexPage& page, std::uint32_t features) {
    const bool hasNotes = (features & kBrickNotes) != 0;
    ByteWriter out;
    out.put(page.previousPage);
    out.put(page.previousMetadata);
    out.put(static_cast<std::uint32_t>(page.times.size()));
    out.put(static_cast<std::uint32_t>(page.masks.size()));
    out.put(static_cast<std::uint32_t>(page.frames.size()));
    out.put(static_cast<std::uint32_t>(page.models.size()));
    for (const double time : page.times) out.put(time);
    for (const Block& model : page.models) out.put(model);
    for (const MaskRecord& mask : page.masks) {
        out.put(mask.offset);
        out.put(mask.length);
        for (const MaskBrick& brick : mask.bricks) {
            out.put(brick.segment.length);
            out.put(brick.present);
            out.put(brick.segment.checksum);
        }
    }
    for (const FrameRecord& frame : page.frames) {
        out.put(frame.time);
        out.put(frame.component);
        out.put(frame.offset);
        out.put(frame.length);
        out.put(static_cast<std::uint8_t>(frame.numbers.kind));
        out.put(static_cast<std::uint8_t>(frame.wavelet));
        out.put(static_cast<std::uint8_t>((frame.keepsAbsent ? 1 : 0) | (frame.bodyCentred ? 2 : 0) |
                                          (frame.subsampled ? 4 : 0) | (frame.predicted ? 8 : 0) |
                                          (frame.parted ? 32 : 0)));
        out.put(static_cast<std::uint8_t>(frame.codeBits));
        out.put(frame.mask);
        out.put(frame.model);
        out.put(frame.numbers.origin);
        out.put(frame.numbers.step);
        out.put(frame.valueOffset);
        out.put(frame.valueScale);
        for (const FrameBrick& brick : frame.bricks) {
            out.put(brick.min);
            out.put(brick.max);
            if (!hasNotes) continue;
            out.put(to16(double(brick.notes.importance.importance)));
            out.put(to16(double(brick.notes.importance.detail)));
            out.put(brick.notes.change.max);
            out.put(shareOf(brick.notes.change));
            out.put(static_cast<std::uint16_t>(brick.notes.repeats));
        }
        for (const Segment& segment : frame.segments) {
            out.put(segment.length);
            out.put(segment.checksum);
        }
    }
    BitWriter statistics;
    for (const FrameRecord& frame : page.frames)
        for (const FrameBrick& brick : frame.bricks)
            if (brick.notes.repeats == 0)
                put(statistics, brick.min, brick.max, frame.numbers.kind != NumberKind::Integer, brick.histogram);
    if ((features & kBrickStatistics) != 0)
        out.bytes.insert(out.bytes.end(), statistics.bytes.begin(), statistics.bytes.end());
    return out.bytes;
}

Index readIndex(const FileBytes& bytes, const Header& header, const IndexShape& shape, const std::string& file) {
    Index index;
    std::vector<FrameRecord> frames;
    for (IndexPage& page : readPages(bytes, header, shape, file, index.pages, index.pageBytes)) {
        index.times.insert(index.times.end(), page.times.begin(), page.times.end());
        index.models.insert(index.models.end(), page.models.begin(), page.models.end());
        std::move(page.masks.begin(), page.masks.end(), std::back_inserter(index.masks));
        if (page.previousMetadata != Block{}) index.retired.push_back(page.previousMetadata);
        for (FrameRecord& frame : page.frames) {
            require(frame.mask >= -1 && frame.mask < std::ssize(index.masks), "a mask is missing", file);
            require(frame.model >= 0 && frame.model < std::ssize(index.models), "a model is missing", file);
        }
        if ((header.features & kBrickStatistics) != 0) takeStatistics(index, shape, page, file);
        std::move(page.frames.begin(), page.frames.end(), std::back_inserter(frames));
    }
    for (std::size_t t = 0; t < index.times.size(); ++t)
        require(std::isfinite(index.times[t]) && (t == 0 || index.times[t] > index.times[t - 1]),
                "times do not increase", file);
    const std::uint64_t times = index.times.size();
    require(times > 0, "no times", file);
    require(frames.size() / shape.components == times && frames.size() % shape.components == 0,
            "the index and the metadata disagree on the number of frames", file);
    index.frames.resize(frames.size());
    std::vector<bool> known(frames.size());
    for (FrameRecord& frame : frames) {
        require(frame.time < times && frame.component < shape.components, "a frame of no time or parameter", file);
        const std::size_t number = std::size_t(frame.time) * shape.components + frame.component;
        require(!known[number], "a frame is present twice", file);
        known[number] = true;
        index.frames[number] = std::move(frame);
    }
    if ((header.features & kBrickNotes) != 0) requireRepeats(index, shape, file);
    requireFilled(index, shape, header, file);
    return index;
}

} // namespace tessera::codec
