#include "codec/archive.h"

#include "codec/archive_state.h"
#include "codec/brick_access.h"
#include "codec/brick_codec_v1.h"
#include "codec/mapped_file.h"
#include "volume/alternating_source.h"
#include "volume/memory_source.h"
#include "volume/parallel.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <list>
#include <mutex>

namespace tessera::codec {

struct Archive::Impl {
    std::string path;
    MappedFile file;
    HeaderState header;
    Metadata metadata;
    Index index;
    std::vector<volume::Channel> channels;
    std::size_t components = 0, bricks = 0;
    /// The models used last, the latest first; their tables take about 200 KiB each.
    mutable std::list<std::pair<std::int32_t, std::shared_ptr<const BandDecoder>>> decoders;
    mutable std::mutex decodersMutex;
    /// Bricks whose memory waits to be used again.
    mutable std::vector<std::unique_ptr<DecodedBrick>> idle;
    mutable std::mutex idleMutex;

    explicit Impl(const std::string& name) : path(name), file(name) {
        header = parseHeaders(file.bytes(), file.bytes().size(), path);
    }

    const FrameRecord& frame(int parameter, int component, int time) const {
        return index
            .frames[std::size_t(time) * components + firstComponent(metadata.info, parameter) + std::size_t(component)];
    }
    /// The frame that holds the bytes of a brick: itself, or the one it repeats.
    const FrameRecord& holding(const FrameRecord& frame, std::size_t brick) const {
        const int repeats = frame.bricks[brick].notes.repeats;
        if (repeats == 0) return frame;
        return index.frames[(std::size_t(frame.time) - std::size_t(repeats)) * components + frame.component];
    }
    /// Bytes that decoding all of a brick takes.
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
    std::span<const std::byte> segment(const Segment& segment) const;
    std::vector<std::uint8_t> flags(const FrameRecord& frame, std::size_t brick) const;
    std::shared_ptr<const BandDecoder> decoder(std::int32_t model) const;
    void decode(const FrameRecord& frame, const BrickFormat& format, std::size_t brick, int level,
                std::span<const std::uint8_t> present, DecodedBrick& out) const;
    volume::BrickSamples readComponent(int parameter, int component, const volume::BrickKey& key) const;
    volume::BrickStats statsOf(int parameter, int component, const volume::BrickKey& key) const;
    std::optional<volume::BrickChange> changeOf(int parameter, int component, const volume::BrickKey& key,
                                                int toTime) const;
    bool hasNotes() const { return (header.header.features & kBrickNotes) != 0; }
};

namespace {

/// A brick to decode into, given back at the end.
class Lent {
public:
    explicit Lent(const auto& archive) : idle_(archive.idle), mutex_(archive.idleMutex) {
        const std::lock_guard lock(mutex_);
        if (idle_.empty()) idle_.push_back(std::make_unique<DecodedBrick>());
        brick_ = std::move(idle_.back());
        idle_.pop_back();
    }
    ~Lent() {
        const std::lock_guard lock(mutex_);
        idle_.push_back(std::move(brick_));
    }
    Lent(const Lent&) = delete;
    Lent& operator=(const Lent&) = delete;
    DecodedBrick& operator*() const { return *brick_; }
    DecodedBrick* operator->() const { return brick_.get(); }

private:
    std::vector<std::unique_ptr<DecodedBrick>>& idle_;
    std::mutex& mutex_;
    std::unique_ptr<DecodedBrick> brick_;
};

[[noreturn]] void damaged(const std::string& path, std::uint64_t offset, const std::string& what) {
    throw Error(what, path, "byte " + std::to_string(offset));
}

std::span<const std::byte> checkedPart(std::span<const std::byte> bytes, std::uint64_t offset, std::uint64_t length,
                                       std::uint64_t sum, const std::string& path, const char* what) {
    const auto part = bytes.subspan(offset, length);
    if (checksum(part) != sum) damaged(path, offset, std::string(what) + " is damaged (checksum)");
    return part;
}

/// Bricks of a grid whose sizes come from a file.
std::uint64_t checkedBrickCount(const volume::BrickGrid& grid, const std::string& path) {
    const glm::ivec3 count = grid.count();
    std::uint64_t bricks = 1;
    for (int axis = 0; axis < 3; ++axis) {
        bricks *= static_cast<std::uint64_t>(count[axis]);
        if (bricks > std::uint64_t(1) << 40) throw Error("impossibly many bricks", path, "metadata /data/lattice/size");
    }
    return bricks;
}

} // namespace

/// Bytes of a segment, once their checksum is found right.
std::span<const std::byte> Archive::Impl::segment(const Segment& segment) const {
    return checkedPart(file.bytes(), segment.offset, segment.length, segment.checksum, path, "a brick");
}

/// Flags of a brick at full resolution; empty where all samples are present.
std::vector<std::uint8_t> Archive::Impl::flags(const FrameRecord& frame, std::size_t brick) const {
    if (frame.mask < 0) return {};
    const MaskBrick& record = index.masks[std::size_t(frame.mask)].bricks[brick];
    const glm::ivec3 size = metadata.grid.brickSamples(brickIndex(metadata.grid, brick), 0);
    const std::size_t count = std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z);
    const std::uint64_t offset = record.segment.offset;
    if (record.present > count) damaged(path, offset, "a mask counts more samples than its brick has");
    const auto bytes = segment(record.segment);
    if (record.present == 0 || record.present == count) {
        if (!bytes.empty()) damaged(path, offset, "a uniform mask has bytes");
        return record.present == 0 ? std::vector<std::uint8_t>(count, 0) : std::vector<std::uint8_t>();
    }
    if (bytes.empty()) damaged(path, offset, "a mask is missing");
    const auto mode = static_cast<std::uint8_t>(bytes[0]);
    const auto body = bytes.subspan(1);
    Bytes bits((count + 7) / 8);
    if (mode == 0 && body.size() == bits.size())
        std::copy(body.begin(), body.end(), bits.begin());
    else if (mode != 1 || decompress(body, bits) != DecodeStatus::Ok)
        damaged(path, offset, "a mask cannot be decoded");
    std::vector<std::uint8_t> flags(count);
    std::size_t present = 0;
    for (std::size_t i = 0; i < count; ++i) {
        flags[i] = static_cast<std::uint8_t>(static_cast<unsigned>(bits[i / 8]) >> (i % 8) & 1u);
        present += flags[i];
    }
    if (present != record.present) damaged(path, offset, "a mask does not have the samples it counts");
    return flags;
}

/// The decoder of a model, kept for the next brick.
std::shared_ptr<const BandDecoder> Archive::Impl::decoder(std::int32_t model) const {
    const std::lock_guard lock(decodersMutex);
    for (auto at = decoders.begin(); at != decoders.end(); ++at)
        if (at->first == model) {
            decoders.splice(decoders.begin(), decoders, at);
            return at->second;
        }
    const Block& record = index.models[std::size_t(model)];
    const auto bytes = checkedPart(file.bytes(), record.offset, record.length, record.checksum, path, "a model");
    Model parsed;
    if (const DecodeStatus status = parseModel(bytes, metadata.grid.levels, parsed); status != DecodeStatus::Ok)
        damaged(path, record.offset, std::string("a model cannot be read: ") + reason(status));
    constexpr std::size_t kKept = 16;
    decoders.emplace_front(model, std::make_shared<const BandDecoder>(std::move(parsed)));
    if (decoders.size() > kKept) decoders.pop_back();
    return decoders.front().second;
}

void Archive::Impl::decode(const FrameRecord& frame, const BrickFormat& format, std::size_t brick, int level,
                           std::span<const std::uint8_t> present, DecodedBrick& out) const {
    std::vector<std::span<const std::byte>> segments;
    for (int s = 0; s < format.levels - level; ++s)
        segments.push_back(segment(frame.segments[std::size_t(s) * bricks + brick]));
    const DecodeStatus status = frame.model < 0
                                    ? decodeBrickV1(format, segments, level, present, out)
                                    : decodeBrick(format, segments, level, present, *decoder(frame.model), out);
    if (status != DecodeStatus::Ok)
        damaged(path, frame.segments[(segments.size() - 1) * bricks + brick].offset, reason(status));
}

volume::BrickSamples Archive::Impl::readComponent(int number, int component, const volume::BrickKey& key) const {
    const std::size_t brick = brickNumber(metadata.grid, key.index);
    const FrameRecord& record = holding(frame(number, component, key.time), brick);
    const BrickFormat format = brickFormat(metadata.grid, key.index, parameter(number).type, record);
    const std::vector<std::uint8_t> fine = flags(record, brick);
    const Lent decoded(*this);
    decode(record, format, brick, key.level, fine, *decoded);

    volume::BrickSamples out;
    out.size = decoded->size;
    out.values.resize(countOf(out.size));
    out.present = decoded->present;
    decoded->forRows([&](std::size_t first, auto row) {
        toValues(record.numbers, record.valueOffset, record.valueScale, row, out.values.data() + first);
    });
    for (const ExactSample& exact : decoded->exact)
        out.values[exact.index] =
            static_cast<float>(record.valueOffset + record.valueScale * double(std::bit_cast<float>(exact.bits)));

    std::int32_t infinite = 0;
    for (const float value : out.values)
        infinite |= (std::bit_cast<std::int32_t>(value) & 0x7fffffff) > 0x7f7fffff ? 1 : 0;
    if (infinite != 0 && out.present.empty()) out.present.assign(out.values.size(), 1);
    for (std::size_t i = 0; infinite != 0 && i < out.values.size(); ++i)
        if (!std::isfinite(out.values[i])) out.present[i] = 0, out.values[i] = 0;
    const FrameBrick& range = record.bricks[brick];
    if (key.level > 0 && range.min <= range.max)
        for (float& value : out.values) value = std::clamp(value, range.min, range.max);
    return out;
}

volume::BrickStats Archive::Impl::statsOf(int number, int component, const volume::BrickKey& key) const {
    const FrameRecord& record = frame(number, component, key.time);
    const std::size_t brick = brickNumber(metadata.grid, key.index);
    volume::BrickStats stats{record.bricks[brick].min, record.bricks[brick].max, 1};
    if (record.mask >= 0) {
        const glm::vec3 size(metadata.grid.brickSamples(key.index, 0));
        stats.presentFraction = static_cast<float>(index.masks[std::size_t(record.mask)].bricks[brick].present) /
                                (size.x * size.y * size.z);
    }
    return stats;
}

/// The steps between two times, of D4* from one frame of a parity to the next.
std::optional<volume::BrickChange> Archive::Impl::changeOf(int number, int component, const volume::BrickKey& key,
                                                           int toTime) const {
    const int step = metadata.alternating ? 2 : 1;
    const int first = std::min(key.time, toTime), last = std::max(key.time, toTime);
    if (first == last) return volume::BrickChange{};
    if (!hasNotes() || (last - first) % step != 0) return std::nullopt;
    const std::size_t brick = brickNumber(metadata.grid, key.index);
    volume::BrickChange sum;
    for (int time = first + step; time <= last; time += step) {
        const volume::BrickChange& change = frame(number, component, time).bricks[brick].notes.change;
        if (change.max == FrameBrick::kUnknown) return std::nullopt;
        sum = accumulated(sum, change);
    }
    return sum;
}

Archive::Archive(const std::string& path) {
    // A file that grows may name an end behind what was mapped a moment before.
    for (int attempt = 0; !impl_; ++attempt) {
        std::error_code failed;
        const std::uint64_t before = std::filesystem::file_size(path, failed);
        try {
            impl_ = std::make_unique<Impl>(path);
        } catch (const Error&) {
            constexpr int kAttempts = 8;
            if (failed || attempt == kAttempts || std::filesystem::file_size(path, failed) == before) throw;
        }
    }
    Impl& impl = *impl_;
    const auto bytes = impl.file.bytes();
    const Header& header = impl.header.header;
    const auto block = checkedPart(bytes, header.metadata.offset, header.metadata.length, header.metadata.checksum,
                                   path, "the metadata");
    impl.metadata = parseMetadata(block, header.version, path);
    impl.channels = impl.metadata.info.channels();
    impl.components = componentCount(impl.metadata.info);
    const std::uint64_t bricks = checkedBrickCount(impl.metadata.grid, path);
    impl.index = readIndex(bytes, header,
                           {impl.components, bricks, impl.metadata.grid.levels, impl.metadata.info.times.size()}, path);
    if (header.version >= kGrowingVersion) impl.metadata.info.times = impl.index.times;
    if (impl.metadata.alternating && impl.metadata.info.times.size() < 2)
        throw Error("d4 needs two times", path, "index");
    impl.bricks = bricks;
    for (std::size_t f = 0; f < impl.index.frames.size(); ++f) {
        const FrameRecord& frame = impl.index.frames[f];
        std::size_t component = f % impl.components, number = 0;
        while (component >= std::size_t(impl.metadata.info.parameters[number].components))
            component -= std::size_t(impl.metadata.info.parameters[number++].components);
        const bool isFloat = impl.metadata.info.parameters[number].type == volume::ScalarType::F32;
        if (isFloat == (frame.numbers.kind == NumberKind::Integer) || (frame.mask < 0 && frame.keepsAbsent))
            throw Error("a frame is coded in a way its type does not allow", path, "index");
        if (!isFloat && frame.model >= 0 && frame.codeBits != codeBitsOf(impl.metadata.info.parameters[number].type))
            throw Error("a frame states another width than its type has", path, "index");
    }
}

Archive::~Archive() = default;

const volume::DatasetInfo& Archive::info() const {
    return impl_->metadata.info;
}
const volume::BrickGrid& Archive::grid() const {
    return impl_->metadata.grid;
}
const Metadata& Archive::metadata() const {
    return impl_->metadata;
}
const std::string& Archive::path() const {
    return impl_->path;
}
std::uint32_t Archive::version() const {
    return impl_->header.header.version;
}
std::uint64_t Archive::fileBytes() const {
    return impl_->header.header.fileSize;
}
int Archive::commits() const {
    return static_cast<int>(impl_->index.pages.size());
}
bool Archive::outdated() const {
    try {
        const MappedFile now(impl_->path);
        return parseHeaders(now.bytes(), now.bytes().size(), impl_->path).header != impl_->header.header;
    } catch (const Error&) {
        return false; // gone or in the middle of a change: what is open stays good
    }
}
int Archive::maskCount() const {
    return static_cast<int>(impl_->index.masks.size());
}
std::uint64_t Archive::maskBytes() const {
    std::uint64_t sum = 0;
    for (const MaskRecord& mask : impl_->index.masks) sum += mask.length;
    return sum;
}
std::uint64_t Archive::levelBytes(int level) const {
    std::uint64_t sum = 0;
    const std::size_t first = std::size_t(impl_->metadata.grid.levels - 1 - level) * impl_->bricks;
    for (const FrameRecord& frame : impl_->index.frames)
        for (std::size_t b = 0; b < impl_->bricks; ++b) sum += frame.segments[first + b].length;
    return sum;
}

volume::BrickStats Archive::stats(const volume::BrickKey& key) const {
    const volume::Channel& channel = impl_->channelOf(key);
    if (!channel.magnitude) return impl_->statsOf(channel.parameter, channel.component, key);
    // Two at a time: |(|(x, y)|, z)| = |(x, y, z)| for any number of components.
    volume::BrickStats sum = impl_->statsOf(channel.parameter, 0, key);
    const volume::BrickStats nothing{0, 0, 1};
    for (int c = 1; c < channel.component; ++c)
        sum = volume::magnitudeStats(sum, impl_->statsOf(channel.parameter, c, key), nothing);
    return sum;
}

std::optional<volume::BrickImportance> Archive::importance(const volume::BrickKey& key) const {
    const volume::Channel& channel = impl_->channelOf(key);
    if (!impl_->hasNotes()) return std::nullopt;
    const std::size_t brick = brickNumber(impl_->metadata.grid, key.index);
    const auto of = [&](int component) {
        return impl_->frame(channel.parameter, component, key.time).bricks[brick].notes.importance;
    };
    if (!channel.magnitude) return of(channel.component);
    std::vector<volume::BrickImportance> components;
    for (int c = 0; c < channel.component; ++c) components.push_back(of(c));
    return volume::magnitudeImportance(components);
}

std::optional<volume::BrickChange> Archive::change(const volume::BrickKey& key, int toTime) const {
    const volume::Channel& channel = impl_->channelOf(key);
    if (toTime < 0 || std::size_t(toTime) >= impl_->metadata.info.times.size()) throw Error("no such time", path());
    if (!channel.magnitude) return impl_->changeOf(channel.parameter, channel.component, key, toTime);
    std::vector<volume::BrickChange> components;
    for (int c = 0; c < channel.component; ++c) {
        const auto change = impl_->changeOf(channel.parameter, c, key, toTime);
        if (!change) return std::nullopt;
        components.push_back(*change);
    }
    return volume::magnitudeChange(components);
}

Archive::Repeats Archive::repeats() const {
    Repeats sum;
    for (const FrameRecord& frame : impl_->index.frames)
        for (std::size_t b = 0; b < impl_->bricks; ++b) {
            if (frame.bricks[b].notes.repeats == 0) continue;
            ++sum.bricks;
            sum.bytes += impl_->bytesOf(frame, b);
        }
    return sum;
}

int Archive::repeats(const volume::BrickKey& key) const {
    return impl_->storedFrame(key).bricks[brickNumber(impl_->metadata.grid, key.index)].notes.repeats;
}

std::uint64_t Archive::brickBytes(const volume::BrickKey& key) const {
    return impl_->bytesOf(impl_->storedFrame(key), brickNumber(impl_->metadata.grid, key.index));
}

volume::BrickSamples Archive::read(const volume::BrickKey& key) const {
    const volume::Channel& channel = impl_->channelOf(key);
    if (!channel.magnitude) return impl_->readComponent(channel.parameter, channel.component, key);
    const auto part = [&](int c) { return impl_->readComponent(channel.parameter, c, key); };
    if (channel.component == 3) return volume::magnitude(part(0), part(1), part(2));
    volume::BrickSamples sum = part(0), nothing;
    nothing.size = sum.size;
    nothing.values.resize(sum.values.size());
    for (int c = 1; c < channel.component; ++c) sum = volume::magnitude(sum, part(c), nothing);
    return sum;
}

std::shared_ptr<const volume::BrickSource> openArchive(const std::string& path) {
    auto archive = std::make_shared<const Archive>(path);
    if (archive->metadata().alternating) return volume::makeAlternatingSource(std::move(archive));
    return archive;
}

volume::Field readField(const Archive& archive, int parameter, int component, int time) {
    const Archive::Impl& impl = *archive.impl_;
    const FrameRecord& shown = impl.frame(parameter, component, time);
    volume::Field field = volume::makeField(impl.metadata.info.lattice, impl.parameter(parameter).type);
    if (impl.metadata.alternating && time % 2 != 0) field.lattice.origin += 0.5 * field.lattice.spacing;
    field.offset = shown.valueOffset;
    field.scale = shown.valueScale;
    volume::Mask mask(shown.mask < 0 ? 0 : field.count(), 1);
    parallelFor(impl.bricks, [&](std::size_t brick) {
        const FrameRecord& frame = impl.holding(shown, brick);
        const glm::ivec3 at = brickIndex(impl.metadata.grid, brick);
        const BrickFormat format = brickFormat(impl.metadata.grid, at, field.type, frame);
        const std::vector<std::uint8_t> fine = impl.flags(frame, brick);
        const Lent decoded(impl);
        impl.decode(frame, format, brick, 0, fine, *decoded);
        const glm::ivec3 begin = impl.metadata.grid.begin(at), size = decoded->size;
        const auto placeOf = [&](std::size_t i) { // of a sample of the brick in the lattice
            const std::size_t nx = std::size_t(size.x), ny = std::size_t(size.y);
            return field.lattice.index(begin + glm::ivec3(int(i % nx), int(i / nx % ny), int(i / (nx * ny))));
        };
        volume::dispatch(field.type, [&]<class T>(T) {
            const auto out = field.as<T>();
            decoded->forRows(
                [&](std::size_t first, auto row) { toSamples(frame.numbers, row, out.data() + placeOf(first)); });
            const auto put = [&](std::size_t i, std::uint32_t bits) {
                if constexpr (std::same_as<T, float>)
                    out[placeOf(i)] = std::bit_cast<float>(bits);
                else
                    out[placeOf(i)] = static_cast<T>(bits);
            };
            for (const ExactSample& exact : decoded->exact) put(exact.index, exact.bits);
            // Absent samples: as stored, else a value that cannot be mistaken for data.
            std::size_t next = 0;
            for (std::size_t i = 0; i < fine.size(); ++i)
                if (fine[i] == 0)
                    put(i, frame.keepsAbsent ? decoded->absent[next++] : sizeof(T) == 4 ? 0x7fc00000u : 0u);
        });
        if (!fine.empty() && !mask.empty())
            forBrickRows(impl.metadata.grid, at, [&](std::size_t to, std::size_t from, std::size_t count) {
                std::copy_n(fine.begin() + std::ptrdiff_t(from), count, mask.begin() + std::ptrdiff_t(to));
            });
    });
    if (!mask.empty()) field.mask = std::make_shared<const volume::Mask>(std::move(mask));
    return field;
}

ArchiveState stateOf(const Archive& archive, bool withFrames) {
    const Archive::Impl& impl = *archive.impl_;
    ArchiveState state{impl.header.header,
                       impl.metadata.info.times.size(),
                       impl.components,
                       impl.index.models.size(),
                       impl.index.masks.size(),
                       {},
                       {},
                       {}};
    for (std::size_t c = 0; c < impl.components; ++c) {
        const std::int32_t number = impl.index.frames[(state.times - 1) * impl.components + c].model;
        std::size_t t = 0;
        while (impl.index.frames[t * impl.components + c].model != number) ++t;
        const FrameRecord& frame = impl.index.frames[t * impl.components + c];
        const Block& block = impl.index.models[std::size_t(number)];
        KnownModel known{number, {}, frame.wavelet, frame.numbers.kind, frame.codeBits, frame.bodyCentred};
        const auto bytes =
            checkedPart(impl.file.bytes(), block.offset, block.length, block.checksum, impl.path, "a model");
        if (const auto status = parseModel(bytes, impl.metadata.grid.levels, known.model); status != DecodeStatus::Ok)
            damaged(impl.path, block.offset, std::string("a model cannot be read: ") + reason(status));
        state.lastModels.push_back(std::move(known));
        const FrameRecord& last = impl.index.frames[(state.times - 1) * impl.components + c];
        const auto sameMask = [&](const auto& entry) { return entry.first == last.mask; };
        if (last.mask < 0 || std::any_of(state.lastMasks.begin(), state.lastMasks.end(), sameMask)) continue;
        volume::Mask mask(impl.metadata.info.lattice.count(), 1);
        parallelFor(impl.bricks, [&](std::size_t brick) {
            const std::vector<std::uint8_t> fine = impl.flags(last, brick);
            if (fine.empty()) return;
            forBrickRows(impl.metadata.grid, brickIndex(impl.metadata.grid, brick),
                         [&](std::size_t to, std::size_t from, std::size_t count) {
                             std::copy_n(fine.begin() + std::ptrdiff_t(from), count, mask.begin() + std::ptrdiff_t(to));
                         });
        });
        state.lastMasks.emplace_back(last.mask, std::move(mask));
    }
    const std::size_t step = impl.metadata.alternating ? 2 : 1;
    for (std::size_t t = state.times - std::min(state.times, step); withFrames && t < state.times; ++t)
        for (std::size_t p = 0, c = 0; p < impl.metadata.info.parameters.size(); ++p)
            for (int component = 0; component < impl.metadata.info.parameters[p].components; ++component, ++c) {
                const FrameRecord& last = impl.index.frames[t * impl.components + c];
                SeenFrame seen{
                    int(t), last.keepsAbsent, readField(archive, int(p), component, int(t)), last.bricks, {}};
                for (std::size_t b = 0; b < impl.bricks; ++b) seen.bytes.push_back(impl.bytesOf(last, b));
                state.lastFrames.emplace_back(c, std::move(seen));
            }
    return state;
}

/// The work of verifyArchive, with access to the parts of an archive.
struct Verifier {
    const Archive::Impl& impl;
    VerifyReport report;
    std::mutex mutex;

    void note(const std::string& what) {
        const std::lock_guard lock(mutex);
        ++report.damaged;
        if (report.damage.size() < 100) report.damage.push_back(what);
    }

    template <class Body> void guarded(const std::string& what, Body&& body) {
        try {
            body();
        } catch (const Error& error) {
            note(what + ": " + error.place() + ": " + error.reason());
        }
    }

    void frame(std::size_t number) {
        const FrameRecord& record = impl.index.frames[number];
        const std::size_t time = number / impl.components;
        std::size_t component = number % impl.components, parameter = 0;
        const auto& parameters = impl.metadata.info.parameters;
        while (component >= std::size_t(parameters[parameter].components))
            component -= std::size_t(parameters[parameter++].components);
        std::atomic<std::uint64_t> bytes = 0, samples = 0;
        parallelFor(impl.bricks, [&](std::size_t brick) {
            const glm::ivec3 at = brickIndex(impl.metadata.grid, brick);
            const std::string where = parameters[parameter].name + " component " + std::to_string(component) +
                                      " time " + std::to_string(time) + " brick " + std::to_string(at.x) + "," +
                                      std::to_string(at.y) + "," + std::to_string(at.z);
            guarded(where, [&] {
                if (record.bricks[brick].notes.repeats > 0) { // decoded with the one it repeats
                    samples += countOf(impl.metadata.grid.brickSamples(at, 0));
                    return;
                }
                const BrickFormat format = brickFormat(impl.metadata.grid, at, parameters[parameter].type, record);
                const std::vector<std::uint8_t> fine = impl.flags(record, brick);
                const Lent decoded(impl);
                for (int level = impl.metadata.grid.levels - 1; level >= 0; --level) {
                    impl.decode(record, format, brick, level, fine, *decoded);
                    if (level == 0) samples += countOf(decoded->size);
                    const std::size_t s = std::size_t(format.levels - 1 - level);
                    bytes += record.segments[s * impl.bricks + brick].length;
                }
            });
        });
        report.bricks += impl.bricks;
        report.samples += samples;
        report.bytes += bytes;
    }

    void headers() {
        if (impl.header.damaged) note("header: byte 0: one of its two copies is damaged");
    }

    void formerMetadata() {
        for (const Block& block : impl.index.retired) {
            guarded("former metadata", [&] {
                (void)checkedPart(impl.file.bytes(), block.offset, block.length, block.checksum, impl.path, "it");
            });
            report.bytes += block.length;
        }
    }

    void models() {
        for (std::size_t m = 0; m < impl.index.models.size(); ++m) {
            guarded("model " + std::to_string(m), [&] { (void)impl.decoder(static_cast<std::int32_t>(m)); });
            report.bytes += impl.index.models[m].length;
        }
    }

    /// Masks no brick above has read; their bytes are counted here.
    void masks() {
        for (std::size_t m = 0; m < impl.index.masks.size(); ++m) {
            FrameRecord user;
            user.mask = static_cast<std::int32_t>(m);
            for (std::size_t brick = 0; brick < impl.bricks; ++brick)
                guarded("mask " + std::to_string(m), [&] { (void)impl.flags(user, brick); });
            report.bytes += impl.index.masks[m].length;
        }
    }
};

VerifyReport verifyArchive(const Archive& archive, const Progress& progress) {
    // One header, metadata and index were checked when the archive was opened.
    const Archive::Impl& impl = *archive.impl_;
    Verifier verifier{impl, {}, {}};
    verifier.headers();
    verifier.formerMetadata();
    verifier.models();
    verifier.masks();
    const std::size_t frames = impl.index.frames.size();
    for (std::size_t f = 0; f < frames; ++f) {
        progress.advance(double(f) / double(frames));
        verifier.frame(f);
    }
    progress.advance(1);
    return std::move(verifier.report);
}

} // namespace tessera::codec
