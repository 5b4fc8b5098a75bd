#include "codec/archive/archive.h"

#include "codec/archive/archive_impl.h"
#include "codec/container/coded_numbers.h"
#include "volume/bricks/magnitude.h"
#include "volume/bricks/parts_bricks.h"
#include "volume/field/part_masks.h"
#include "volume/field/quantities.h"
#include "volume/sources/alternating_source.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>

namespace tessera::codec {

void damaged(const std::string& path, std::uint64_t offset, const std::string& what) {
    throw Error(what, path, "byte " + std::to_string(offset));
}

FilePart checkedPart(const FileBytes& file, const Block& block, const std::string& path, const char* what) {
    std::optional<FilePart> part = wholePart(file, block, path);
    if (!part) damaged(path, block.offset, std::string(what) + " is damaged (checksum)");
    return std::move(*part);
}

namespace {

/// Number of bricks of a grid from a file; throws Error when it is too large.
std::uint64_t checkedBrickCount(const volume::BrickGrid& grid, const std::string& path) {
    const glm::ivec3 count = grid.count();
    std::uint64_t bricks = 1;
    for (int axis = 0; axis < 3; ++axis) {
        bricks *= static_cast<std::uint64_t>(count[axis]);
        if (bricks > std::uint64_t(1) << 40) throw Error("too many bricks", path, "metadata /data/lattice/size");
    }
    return bricks;
}

} // namespace

volume::BrickStats Archive::Impl::statsOf(int number, int component, const volume::BrickKey& key) const {
    const FrameRecord& record = frame(number, component, key.time);
    const std::size_t brick = metadata.grid.numberOf(key.index);
    volume::BrickStats stats{record.bricks[brick].min, record.bricks[brick].max, 1};
    if (record.mask >= 0) {
        const glm::vec3 size(metadata.grid.brickSamples(key.index, 0));
        stats.presentFraction = static_cast<float>(index.masks[std::size_t(record.mask)].bricks[brick].present) /
                                (size.x * size.y * size.z);
    }
    return stats;
}

/// Number of time steps between two times; on D4* between frames of the same parity.
std::optional<volume::BrickChange> Archive::Impl::changeOf(int number, int component, const volume::BrickKey& key,
                                                           int toTime) const {
    const int step = metadata.alternating ? 2 : 1;
    const int first = std::min(key.time, toTime), last = std::max(key.time, toTime);
    if (first == last) return volume::BrickChange{};
    if (!hasNotes() || (last - first) % step != 0) return std::nullopt;
    const std::size_t brick = metadata.grid.numberOf(key.index);
    volume::BrickChange sum;
    for (int time = first + step; time <= last; time += step) {
        const volume::BrickChange& change = frame(number, component, time).bricks[brick].notes.change;
        if (change.max == FrameBrick::kUnknown) return std::nullopt;
        sum = accumulated(sum, change);
    }
    return sum;
}

Archive::Archive(const std::string& path, const RemoteOptions& remote) {
    // The header of a growing file can name an end beyond the part that was mapped: try again.
    for (int attempt = 0; !impl_; ++attempt) {
        std::error_code failed;
        const std::uint64_t before = std::filesystem::file_size(path, failed);
        try {
            impl_ = std::make_unique<Impl>(path, remote);
        } catch (const Error&) {
            constexpr int kAttempts = 8;
            if (failed || attempt == kAttempts || std::filesystem::file_size(path, failed) == before) throw;
        }
    }
    impl_->load();
}

Archive::Archive(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

void Archive::Impl::load() {
    const Header& named = header.header;
    if (named.metadata.length > kMostMetadata) throw Error("the metadata are too long", path, "byte 24");
    const FileRange ahead[] = {{named.metadata.offset, named.metadata.length},
                               {named.index.offset, named.index.length}};
    bytes->readAhead(ahead);
    metadata = parseMetadata(checkedPart(*bytes, named.metadata, path, "the metadata").bytes(), named.features, path);
    metadata.info.remote = isRemote(path);
    if (metadata.info.name.empty()) metadata.info.name = std::filesystem::path(path).stem().string();
    components = componentCount(metadata.info);
    bricks = checkedBrickCount(metadata.grid, path);
    index = readIndex(*bytes, named, {components, bricks, metadata.grid, metadata.corrections, metadata.numbers}, path);
    metadata.info.times = index.times;
    // The numbers of times in metadata and index can differ in a growing archive.
    const auto fit = [](std::vector<volume::Quantity>& quantities, std::size_t times) {
        for (volume::Quantity& quantity : quantities)
            quantity.values.resize(times, std::numeric_limits<double>::quiet_NaN());
    };
    fit(metadata.info.quantities, metadata.info.times.size());
    fit(metadata.sourceQuantities, metadata.sourceTimes.size());
    if (metadata.alternating)
        metadata.info.quantities =
            volume::atTimes(metadata.sourceQuantities, metadata.sourceTimes, metadata.info.times);
    if (metadata.alternating && metadata.info.times.size() < 2) throw Error("d4 needs two times", path, "index");
    settle();
}

void Archive::Impl::settle() {
    channels = metadata.info.channels();
    components = componentCount(metadata.info);
    bricks = metadata.grid.brickCount();
    for (std::size_t f = 0; f < index.frames.size(); ++f) {
        const FrameRecord& frame = index.frames[f];
        const volume::Parameter& parameter = metadata.info.parameters[parameterOf(metadata.info, f % components)];
        const bool isFloat = parameter.type == volume::ScalarType::F32;
        const bool isInteger = frame.numbers.kind == NumberKind::Integer;
        const bool mayStep = frame.numbers.kind == NumberKind::Stepped &&
                             (header.header.features & kSteppedIntegers) != 0 && std::isfinite(frame.numbers.origin) &&
                             std::isfinite(frame.numbers.step);
        if ((isFloat ? isInteger : !isInteger && !mayStep) || (frame.mask < 0 && frame.keepsAbsent))
            throw Error("a frame is coded in a way its type does not allow", path, "index");
        if (frame.parted &&
            (volume::labelOf(metadata.info, parameter) < 0 || parameter.parts.count() > volume::kMostParts ||
             metadata.info.lattice.kind != volume::LatticeKind::CC || metadata.alternating))
            throw Error("parts of a frame are coded that it has not", path, "index");
        if (isInteger && frame.codeBits != codeBitsOf(parameter.type))
            throw Error("a frame states another width than its type has", path, "index");
    }
}

std::vector<std::shared_ptr<const Archive>> Archive::corrections() const {
    const std::lock_guard lock(impl_->correctionsMutex);
    if (impl_->corrections) return *impl_->corrections;
    std::vector<std::shared_ptr<const Archive>> all;
    for (const FileRange& range : impl_->metadata.corrections) {
        auto window = std::make_shared<const FileWindow>(impl_->bytes, range);
        std::unique_ptr<Impl> impl = std::make_unique<Impl>(impl_->path, impl_->remote, std::move(window));
        impl->load();
        const Metadata& inner = impl->metadata;
        if (impl->header.header.fileSize != range.length || !inner.corrections.empty() || inner.alternating ||
            inner.info.lattice.kind != volume::LatticeKind::CC ||
            inner.info.lattice.size != impl_->metadata.source.size)
            throw Error("the corrections do not fit the archive", impl_->path, "byte " + std::to_string(range.offset));
        all.push_back(std::shared_ptr<const Archive>(new Archive(std::move(impl))));
    }
    impl_->corrections = std::move(all);
    return *impl_->corrections;
}

std::shared_ptr<const StoredNumbers> Archive::numbers() const {
    const std::lock_guard lock(impl_->numbersMutex);
    if (impl_->ofRegions || impl_->metadata.numbers.empty()) return impl_->ofRegions;
    auto all = std::make_shared<StoredNumbers>();
    for (const FileRange& range : impl_->metadata.numbers) {
        try {
            addNumbers(decodeNumbers(impl_->bytes->part(range).bytes(), all->shape), all->numbers);
        } catch (const ReadError&) {
            throw;
        } catch (const Error& error) {
            damaged(impl_->path, range.offset, error.reason());
        }
    }
    return impl_->ofRegions = std::move(all);
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
std::uint64_t Archive::fingerprint() const {
    return checksum(serialise(impl_->header.header));
}
int Archive::commits() const {
    return static_cast<int>(impl_->index.pages.size());
}
bool Archive::outdated() const {
    try {
        return Impl(impl_->path, impl_->remote).header.header != impl_->header.header;
    } catch (const Error&) {
        return false; // removed or being replaced: the open archive remains valid
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
    // Combined in pairs: |(|(x, y)|, z)| = |(x, y, z)| for any number of components.
    volume::BrickStats sum = impl_->statsOf(channel.parameter, 0, key);
    const volume::BrickStats nothing{0, 0, 1};
    for (int c = 1; c < channel.component; ++c)
        sum = volume::magnitudeStats(sum, impl_->statsOf(channel.parameter, c, key), nothing);
    return sum;
}

std::optional<volume::BrickDistribution> Archive::distribution(const volume::BrickKey& key) const {
    const volume::Channel& channel = impl_->channelOf(key);
    if (!impl_->hasStatistics() || channel.magnitude) return std::nullopt;
    const std::size_t brick = impl_->metadata.grid.numberOf(key.index);
    const FrameRecord& frame = impl_->holding(impl_->frame(channel.parameter, channel.component, key.time), brick);
    const bool isFloat = impl_->parameter(channel.parameter).type == volume::ScalarType::F32;
    const FrameBrick& about = frame.bricks[brick];
    return distributionOf(about.min, about.max, isFloat ? 0 : std::abs(frame.valueScale), about.histogram);
}

std::optional<volume::BrickImportance> Archive::importance(const volume::BrickKey& key) const {
    const volume::Channel& channel = impl_->channelOf(key);
    if (!impl_->hasNotes()) return std::nullopt;
    const std::size_t brick = impl_->metadata.grid.numberOf(key.index);
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
    return impl_->storedFrame(key).bricks[impl_->metadata.grid.numberOf(key.index)].notes.repeats;
}

std::uint64_t Archive::brickBytes(const volume::BrickKey& key) const {
    return impl_->bytesOf(impl_->storedFrame(key), impl_->metadata.grid.numberOf(key.index));
}

std::shared_ptr<const volume::BrickSource> openArchive(const std::string& path, const RemoteOptions& remote) {
    auto archive = std::make_shared<const Archive>(path, remote);
    if (archive->metadata().alternating)
        return volume::makeAlternatingSource(std::move(archive), volume::TimeFilter::Cubic);
    return archive;
}

// Parts of parameters: which samples belong to them, and coarse levels that mix none.

std::vector<std::uint8_t> Archive::Impl::partsOf(const FrameRecord& frame, std::size_t brick) const {
    const volume::Parameter& own = parameter(int(parameterOf(metadata.info, frame.component)));
    const int label = volume::labelOf(metadata.info, own);
    const glm::ivec3 at = metadata.grid.indexOf(brick);
    const volume::BrickKey key{0, int(frame.time), 0, at};
    if (const volume::BrickStats stats = statsOf(label, 0, key); stats.min == stats.max && stats.presentFraction == 1)
        return {};
    const FrameRecord& labels = holding(this->frame(label, 0, int(frame.time)), brick);
    const BrickFormat format = brickFormat(metadata.grid, at, parameter(label).type, labels);
    const std::vector<std::uint8_t> present = flags(labels, brick);
    const KeptNumbers::Key place{std::size_t(labels.time) * components + labels.component, brick, 0};
    KeptNumbers::Numbers numbers = kept.find(place);
    if (!numbers) {
        fetchBrick(labels, brick, metadata.grid.levels);
        const PooledBrick decoded(*this);
        decode(labels, format, brick, 0, present, *decoded);
        numbers = std::make_shared<const Bytes>(numbersOf(labels, format.type, *decoded));
        kept.keep(place, numbers);
    }
    volume::Field field;
    field.lattice = {volume::LatticeKind::CC, format.size, {1, 1, 1}, {0, 0, 0}};
    field.type = format.type;
    field.samples.assign(numbers->begin(), numbers->end());
    field.offset = labels.valueOffset;
    field.scale = labels.valueScale;
    if (!present.empty()) field.mask = std::make_shared<const volume::Mask>(present);
    return volume::partsOf(field, own.parts);
}

volume::BrickSamples Archive::Impl::readOfParts(int number, int component, const volume::BrickKey& key) const {
    const bool isLabel = parameter(number).categorical && parameter(number).components == 1;
    const int label = isLabel ? number : volume::labelOf(metadata.info, parameter(number));
    if (key.level == 0 || label < 0) return readComponent(number, component, key);
    if (const volume::BrickStats stats = statsOf(label, 0, key); stats.min == stats.max && stats.presentFraction == 1)
        return readComponent(number, component, key);
    const std::size_t brick = metadata.grid.numberOf(key.index);
    if (key.level + 1 == metadata.grid.levels && holding(frame(number, component, key.time), brick).subsampled)
        return readSubsamples(number, component, key);
    volume::BrickKey fine = key;
    fine.level = 0;
    const volume::BrickSamples labels = readComponent(label, 0, fine);
    if (isLabel) return volume::coarserLabels(metadata.grid, key, labels);
    const volume::Parts& parts = parameter(number).parts;
    const std::vector<std::uint8_t> own = volume::partsOfSamples(labels, parts);
    if (std::adjacent_find(own.begin(), own.end(), std::not_equal_to<>()) == own.end())
        return readComponent(number, component, key);
    return volume::coarserOfParts(metadata.grid, key.level, readComponent(number, component, fine), labels,
                                  volume::coarserLabels(metadata.grid, key, labels), parts);
}

} // namespace tessera::codec
