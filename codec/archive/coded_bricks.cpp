#include "codec/archive/coded_bricks.h"

#include "volume/base/parallel.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <functional>
#include <span>
#include <utility>

namespace tessera::codec {

CodedBricks::CodedBricks(std::size_t bricks, std::size_t segments, const std::string* folder) : segments_(segments) {
    if (folder) {
        file_ = std::make_unique<volume::ScratchFile>(*folder);
        places_.resize(bricks * segments);
    } else {
        bytes_.resize(bricks);
    }
}

void CodedBricks::clear() {
    end_ = 0; // the scratch file is overwritten
    for (std::vector<Bytes>& segments : bytes_) segments.clear();
}

void CodedBricks::put(std::size_t brick, std::vector<Bytes> segments) {
    if (!file_) {
        bytes_[brick] = std::move(segments);
        return;
    }
    for (std::size_t s = 0; s < segments_; ++s) {
        file_->write(end_, segments[s]);
        places_[brick * segments_ + s] = {end_, static_cast<std::uint32_t>(segments[s].size())};
        end_ += segments[s].size();
    }
}

Bytes CodedBricks::take(std::size_t brick, std::size_t segment) {
    if (!file_) return std::move(bytes_[brick][segment]);
    const Place& place = places_[brick * segments_ + segment];
    Bytes bytes(place.size);
    file_->read(place.offset, bytes);
    return bytes;
}

namespace {

/// Of a brick that is not a repeat.
struct BrickProperties {
    float min = 0, max = -1;
    std::uint32_t samples = 0, infinite = 0, mean = 0, bins = 0;
    std::array<std::uint32_t, 32> counts{};
    std::uint32_t whole = 0, mixed = 0;
    SampleErrors errors;
};

BrickProperties propertiesOf(const FrameCoding& coding, std::size_t b) {
    const FrameBrick& brick = coding.frame.bricks[b];
    const BrickHistogram& histogram = brick.histogram;
    BrickProperties out{brick.min, brick.max, histogram.samples, histogram.infinite, histogram.mean, 0, {}, 0, 0, {}};
    assert(histogram.counts.size() <= out.counts.size());
    out.bins = static_cast<std::uint32_t>(histogram.counts.size());
    std::ranges::copy(histogram.counts, out.counts.begin());
    out.whole = coding.whole[b];
    out.mixed = coding.mixed[b];
    if (coding.measures()) out.errors = coding.errors[b];
    return out;
}

void take(const BrickProperties& of, std::size_t b, FrameCoding& coding) {
    const auto end = of.counts.begin() + std::ptrdiff_t(std::min<std::size_t>(of.bins, of.counts.size()));
    coding.frame.bricks[b] = {of.min, of.max, {of.samples, of.infinite, of.mean, {of.counts.begin(), end}}, {}};
    coding.frame.bricks[b].notes.importance = coding.importance[b];
    coding.whole[b] = of.whole != 0 ? 1 : 0;
    coding.mixed[b] = of.mixed != 0 ? 1 : 0;
    coding.taken.bricks[b].reset(); // another process used its own; it must not serve another quantum
    if (coding.measures()) coding.errors[b] = of.errors;
}

template <class T> void read(const volume::ScratchFile& file, std::uint64_t at, std::vector<T>& to) {
    file.read(at, std::as_writable_bytes(std::span(to)));
}

/// What the others need of a slab that one process coded: properties of the bricks in their order, the sizes of their
/// segments, then these.
void writeSlab(const FrameCoding& coding, std::size_t first, const std::vector<std::vector<Bytes>>& bricks,
               const SlabTeam::Write& to) {
    std::vector<BrickProperties> properties;
    std::vector<std::uint64_t> sizes;
    for (std::size_t b = 0; b < bricks.size(); ++b) {
        properties.push_back(propertiesOf(coding, first + b));
        for (const Bytes& segment : bricks[b]) sizes.push_back(segment.size());
    }
    to(std::as_bytes(std::span(properties)));
    to(std::as_bytes(std::span(sizes)));
    for (const std::vector<Bytes>& segments : bricks)
        for (const Bytes& segment : segments) to(segment);
}

/// Takes the properties of bricks [first, end) over, and their segments into `coded` unless it is null.
void readSlab(const volume::ScratchFile& file, std::size_t first, std::size_t end, FrameCoding& coding,
              CodedBricks* coded) {
    const auto levels = std::size_t(coding.grid.levels);
    std::vector<BrickProperties> properties(end - first);
    read(file, 0, properties);
    for (std::size_t b = first; b < end; ++b) take(properties[b - first], b, coding);
    if (!coded) return;
    std::uint64_t at = properties.size() * sizeof(BrickProperties);
    std::vector<std::uint64_t> sizes(properties.size() * levels);
    read(file, at, sizes);
    at += sizes.size() * sizeof(std::uint64_t);
    for (std::size_t b = 0; b < properties.size(); ++b) {
        std::vector<Bytes> segments(levels);
        for (std::size_t s = 0; s < levels; ++s) {
            segments[s].resize(sizes[b * levels + s]);
            file.read(at, segments[s]);
            at += segments[s].size();
        }
        coded->put(first + b, std::move(segments));
    }
}

/// Codes the bricks of a slab and gives their segments to `put`, in their order.
void codeSlab(FrameCoding& coding, const volume::Field& part, Slab slab, const ZstdUse& zstd,
              const std::function<void(std::size_t, std::vector<Bytes>)>& put, const Progress& progress) {
    const volume::BrickGrid& grid = coding.grid;
    const BandEncoder encoder(coding.model);
    const std::size_t perBatch = batchOf(brickBytes(grid, part.type));
    const volume::BrickGrid own = slab.grid(grid);
    const std::size_t firstBrick = slab.bricks(grid).first, endBrick = slab.bricks(grid).second;
    // In batches, to react to a cancel; the batch size does not affect the output.
    for (std::size_t first = firstBrick; first < endBrick; first += perBatch) {
        const std::size_t count = std::min(perBatch, endBrick - first);
        std::vector<std::vector<Bytes>> batch(count);
        parallelRanges(count, [&](std::size_t begin, std::size_t end) {
            Compressor compressor(zstd.level, zstd.thorough);
            BrickInput input;
            SplitMemory memory;
            for (std::size_t b = first + begin; b < first + end; ++b)
                batch[b - first] = coding.code(b, part, own, b - firstBrick, encoder, compressor, input, memory);
        });
        for (std::size_t b = first; b < first + count; ++b) put(b, std::move(batch[b - first]));
        progress.advance(double(first + count) / double(grid.brickCount()));
    }
}

void codeTogether(FrameCoding& coding, const FrameSamples& samples, const ZstdUse& zstd, CodedBricks& coded,
                  const Progress& progress) {
    SlabTeam& team = *samples.team();
    volume::Field part;
    const auto files = team.share("bricks", samples.slabCount(), [&](std::size_t number, const SlabTeam::Write& write) {
        const Slab slab = samples.slab(number);
        std::vector<std::vector<Bytes>> bricks;
        const auto put = [&](std::size_t, std::vector<Bytes> segments) { bricks.push_back(std::move(segments)); };
        samples.take(slab.first, slab.count, part);
        codeSlab(coding, part, slab, zstd, put, progress);
        writeSlab(coding, slab.bricks(coding.grid).first, bricks, write);
    });
    for (std::size_t number = 0; number < files.size(); ++number) {
        const auto [first, end] = samples.slab(number).bricks(coding.grid);
        readSlab(*files[number].file, first, end, coding, team.writes() ? &coded : nullptr);
    }
}

} // namespace

bool codeBricks(FrameCoding& coding, const FrameSamples& samples, const ZstdUse& zstd, CodedBricks& coded,
                const Progress& progress) {
    const auto put = [&](std::size_t brick, std::vector<Bytes> segments) { coded.put(brick, std::move(segments)); };
    if (samples.team())
        codeTogether(coding, samples, zstd, coded, progress);
    else
        samples.forSlabs([&](const volume::Field& part, Slab slab) {
            codeSlab(coding, part, slab, zstd, put, progress);
            return true;
        });
    const auto isWhole = [](std::uint8_t flag) { return flag != 0; };
    return coding.grid.levels > 1 && std::ranges::all_of(coding.whole, isWhole);
}

} // namespace tessera::codec
