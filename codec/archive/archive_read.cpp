#include "codec/archive/archive_impl.h"
#include "codec/brick/coded_mask.h"
#include "codec/brick/subsamples.h"
#include "volume/base/parallel.h"
#include "volume/bricks/magnitude.h"
#include "volume/field/slices.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <concepts>

namespace tessera::codec {

namespace {

/// Whether all codes of a frame decode to finite values.
bool isAlwaysFinite(const FrameRecord& frame) {
    constexpr double kLargestCode = 4294967296.0, kLargest = 3e38;
    if (frame.numbers.kind == NumberKind::Float) return false;
    const double unit = frame.numbers.kind == NumberKind::Scaled    ? 1 / std::abs(frame.numbers.step)
                        : frame.numbers.kind == NumberKind::Integer ? 1
                                                                    : std::abs(frame.numbers.step);
    const double number = std::abs(frame.numbers.origin) + unit * kLargestCode;
    return number < kLargest && std::abs(frame.valueOffset) + std::abs(frame.valueScale) * number < kLargest;
}

/// Marks values that are not finite as absent.
void leaveOutInfinite(volume::BrickSamples& brick) {
    std::int32_t infinite = 0;
    for (const float value : brick.values)
        infinite |= (std::bit_cast<std::int32_t>(value) & 0x7fffffff) > 0x7f7fffff ? 1 : 0;
    if (infinite == 0) return;
    if (brick.present.empty()) brick.present.assign(brick.values.size(), 1);
    for (std::size_t i = 0; i < brick.values.size(); ++i)
        if (!std::isfinite(brick.values[i])) brick.present[i] = 0, brick.values[i] = 0;
}

} // namespace

/// The bytes of a segment; throws Error when their checksum is wrong.
FilePart Archive::Impl::segment(const Segment& segment) const {
    return checkedPart(*bytes, {segment.offset, segment.length, segment.checksum}, path, "a brick");
}

/// Presence flags of a brick at full resolution; empty if all samples are present.
std::vector<std::uint8_t> Archive::Impl::flags(const FrameRecord& frame, std::size_t brick) const {
    if (frame.mask < 0) return {};
    const MaskBrick& record = index.masks[std::size_t(frame.mask)].bricks[brick];
    const glm::ivec3 size = metadata.grid.brickSamples(metadata.grid.indexOf(brick), 0);
    const std::size_t count = std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z);
    const std::uint64_t offset = record.segment.offset;
    if (record.present > count) damaged(path, offset, "a mask has more samples than its brick");
    const FilePart part = segment(record.segment);
    const auto stored = part.bytes();
    if (record.present == 0 || record.present == count) {
        if (!stored.empty()) damaged(path, offset, "a uniform mask has bytes");
        return record.present == 0 ? std::vector<std::uint8_t>(count, 0) : std::vector<std::uint8_t>();
    }
    if (stored.empty()) damaged(path, offset, "a mask is missing");
    const auto mode = static_cast<std::uint8_t>(stored[0]);
    const auto body = stored.subspan(1);
    Bytes bits((count + 7) / 8);
    if (mode == 0 && body.size() == bits.size())
        std::copy(body.begin(), body.end(), bits.begin());
    else if (mode != 1 || decompress(body, bits) != DecodeStatus::Ok)
        damaged(path, offset, "a mask cannot be decoded");
    std::vector<std::uint8_t> flags(count);
    if (takeBits(bits, flags) != record.present)
        damaged(path, offset, "a mask does not have the number of samples that it states");
    return flags;
}

StepChoice Archive::Impl::steps(const FrameRecord& frame) const {
    const Block& record = index.models[std::size_t(frame.model)];
    const FilePart part = checkedPart(*bytes, record, path, "a model");
    StepChoice parsed;
    if (const DecodeStatus status = parseSteps(part.bytes(), parsed); status != DecodeStatus::Ok)
        damaged(path, record.offset, std::string("steps cannot be read: ") + reason(status));
    return parsed;
}

Model Archive::Impl::model(const FrameRecord& frame) const {
    if (frame.numbers.kind == NumberKind::Stepped) return makeModel(Histogram(metadata.grid.levels, {}), 1);
    const Block& record = index.models[std::size_t(frame.model)];
    const FilePart part = checkedPart(*bytes, record, path, "a model");
    Model parsed;
    if (const DecodeStatus status = parseModel(part.bytes(), metadata.grid.levels, parsed); status != DecodeStatus::Ok)
        damaged(path, record.offset, std::string("a model cannot be read: ") + reason(status));
    if (parsed.contexts.byBand && (header.header.features & kBandContexts) == 0)
        damaged(path, record.offset, "a model has contexts that the archive does not declare");
    if (!parsed.fitted.empty() && (header.header.features & kFittedModels) == 0)
        damaged(path, record.offset, "a model has predictions that the archive does not declare");
    return parsed;
}

/// Returns the cached decoder of a model.
std::shared_ptr<const BandDecoder> Archive::Impl::decoder(const FrameRecord& frame) const {
    const std::int32_t number = frame.numbers.kind == NumberKind::Stepped ? -1 : frame.model;
    const std::lock_guard lock(decodersMutex);
    for (auto at = decoders.begin(); at != decoders.end(); ++at)
        if (at->first == number) {
            decoders.splice(decoders.begin(), decoders, at);
            return at->second;
        }
    constexpr std::size_t kKept = 16;
    decoders.emplace_front(number, std::make_shared<const BandDecoder>(model(frame)));
    if (decoders.size() > kKept) decoders.pop_back();
    return decoders.front().second;
}

/// Asks another machine for the mask, the model and the first segments of a brick at once. Coarse levels of a frame lie
/// together: where they are small, they are asked for as a whole, as other bricks need theirs soon.
void Archive::Impl::fetchBrick(const FrameRecord& frame, std::size_t brick, int segments) const {
    constexpr std::uint64_t kWhole = std::uint64_t(1) << 20;
    std::vector<FileRange> ranges;
    const auto add = [&](const auto& part) { ranges.push_back({part.offset, part.length}); };
    if (frame.mask >= 0) {
        const MaskRecord& mask = index.masks[std::size_t(frame.mask)];
        mask.length <= kWhole ? add(mask) : add(mask.bricks[brick].segment);
    }
    const FrameRecord* needed = &frame;
    for (int n = 0; needed && n <= kMostPredicted; ++n) {
        const FrameRecord& held = holding(*needed, brick);
        add(index.models[std::size_t(held.model)]);
        for (int s = 0; s < segments; ++s) {
            const auto first = held.segments.begin() + std::ptrdiff_t(std::size_t(s) * bricks);
            const Segment& last = first[std::ptrdiff_t(bricks) - 1];
            const std::uint64_t level = last.offset + last.length - first->offset;
            if (level <= kWhole)
                ranges.push_back({first->offset, level});
            else
                add(first[std::ptrdiff_t(brick)]);
        }
        needed = held.predicted ? before(held) : nullptr;
    }
    bytes->readAhead(ranges);
}

const FrameRecord* Archive::Impl::before(const FrameRecord& frame) const {
    const std::size_t step = metadata.alternating ? 2 : 1, time = frame.time;
    return time < step ? nullptr : &index.frames[(time - step) * components + frame.component];
}

std::uint8_t Archive::Impl::depthOf(const FrameRecord& frame, std::size_t brick) const {
    if (!frame.predicted) return 0;
    const FilePart part = segment(frame.segments[brick]);
    const auto stored = part.bytes();
    const std::uint64_t offset = frame.segments[brick].offset;
    if (stored.empty()) damaged(path, offset, "a predicted brick has no bytes");
    const auto depth = static_cast<std::uint8_t>(stored[0]);
    if (depth > kMostPredicted) damaged(path, offset, "a brick is predicted from too many others");
    return depth;
}

/// Decodes the bricks that a predicted one follows, from the last that is not predicted, or is kept, to its own.
void Archive::Impl::decode(const FrameRecord& frame, const BrickFormat& format, std::size_t brick, int level,
                           std::span<const std::uint8_t> present, DecodedBrick& out) const {
    const auto numberOf = [&](const FrameRecord& one) { return std::size_t(one.time) * components + one.component; };
    const auto keyOf = [&](const FrameRecord& one) { return KeptNumbers::Key{numberOf(one), brick, level}; };
    const auto continues = [&](const FrameRecord& one) {
        const std::size_t next = numberOf(one) + (metadata.alternating ? 2 : 1) * components;
        return next < index.frames.size() && index.frames[next].predicted;
    };
    std::vector<const FrameRecord*> chain{&frame}; // latest first
    KeptNumbers::Numbers numbers;                  // of the one that the last of the chain is predicted from
    for (int depth = depthOf(frame, brick); depth > 0;) {
        const FrameRecord& after = *chain.back();
        const std::uint64_t offset = after.segments[brick].offset;
        const FrameRecord* const last = before(after);
        if (!last || last->mask != after.mask) damaged(path, offset, "a brick is predicted from one of another shape");
        const FrameRecord& held = holding(*last, brick);
        if (held.valueOffset != after.valueOffset || held.valueScale != after.valueScale)
            damaged(path, offset, "a brick is predicted from one with another scale");
        numbers = kept.find(keyOf(held));
        if (numbers) break;
        const int next = depthOf(held, brick);
        if (next >= depth) damaged(path, offset, "a brick is predicted from too many others");
        chain.push_back(&held);
        depth = next;
    }
    for (std::size_t i = chain.size(); i-- > 0;) {
        const FrameRecord& one = *chain[i];
        decodeOwn(one, i == 0 ? format : brickFormat(format, one), brick, level, present, out);
        if (numbers) addPrediction(predictionFrom(one.numbers, format.type, *numbers), out);
        if (i == 0 && !continues(frame)) return;
        numbers = std::make_shared<const Bytes>(numbersOf(one, format.type, out));
        kept.keep(keyOf(one), numbers);
    }
}

void Archive::Impl::decodeOwn(const FrameRecord& frame, const BrickFormat& format, std::size_t brick, int level,
                              std::span<const std::uint8_t> present, DecodedBrick& out) const {
    std::vector<FilePart> parts; // which the segments are views of
    std::vector<std::span<const std::byte>> segments;
    for (int s = 0; s < format.levels - level; ++s) {
        parts.push_back(segment(frame.segments[std::size_t(s) * bricks + brick]));
        segments.push_back(parts.back().bytes());
    }
    if (frame.predicted && !segments[0].empty()) segments[0] = segments[0].subspan(1); // its depth
    BrickFormat whole = format;
    if (format.isStepped()) whole.steps = steps(frame);
    const DecodeStatus status = decodeBrick(whole, segments, level, present, *decoder(frame), out,
                                            frame.parted ? partsOf(frame, brick) : std::vector<std::uint8_t>());
    if (status != DecodeStatus::Ok)
        damaged(path, frame.segments[(segments.size() - 1) * bricks + brick].offset, reason(status));
}

Bytes Archive::Impl::numbersOf(const FrameRecord& frame, volume::ScalarType type, const DecodedBrick& decoded) const {
    Bytes numbers(countOf(decoded.size) * volume::byteSize(type));
    volume::dispatch(type, [&]<class T>(T) {
        T* const out = reinterpret_cast<T*>(numbers.data());
        decoded.forRows([&](std::size_t first, auto row) { toSamples(frame.numbers, row, out + first); });
        if constexpr (std::same_as<T, float>)
            for (const ExactSample& exact : decoded.exact) out[exact.index] = std::bit_cast<float>(exact.bits);
    });
    return numbers;
}

volume::BrickSamples Archive::Impl::readComponent(int number, int component, const volume::BrickKey& key) const {
    const std::size_t brick = metadata.grid.numberOf(key.index);
    const FrameRecord& record = holding(frame(number, component, key.time), brick);
    const BrickFormat format = brickFormat(metadata.grid, key.index, parameter(number).type, record);
    fetchBrick(record, brick, metadata.grid.levels - key.level);
    const std::vector<std::uint8_t> fine = flags(record, brick);
    const PooledBrick decoded(*this);
    decode(record, format, brick, key.level, fine, *decoded);

    volume::BrickSamples out;
    out.size = decoded->size;
    out.values.resize(countOf(out.size));
    out.present = decoded->present;
    // Clamp coarse levels to the range of the samples, row by row while they are in the cache.
    const FrameBrick& range = record.bricks[brick];
    const bool isHeld = key.level > 0 && range.min <= range.max, isFinite = isAlwaysFinite(record);
    const auto hold = [&](std::span<float> values) {
        for (float& value : values) value = std::min(std::max(value, range.min), range.max);
    };
    decoded->forRows([&](std::size_t first, auto row) {
        float* const values = out.values.data() + first;
        toValues(record.numbers, format.type, record.valueOffset, record.valueScale, row, values);
        if (isHeld && isFinite) hold({values, row.size()});
    });
    for (const ExactSample& exact : decoded->exact) // at full resolution
        out.values[exact.index] =
            static_cast<float>(record.valueOffset + record.valueScale * double(std::bit_cast<float>(exact.bits)));
    if (parameter(number).type == volume::ScalarType::I32 && key.level == 0) {
        const Bytes numbers = numbersOf(record, volume::ScalarType::I32, *decoded);
        const auto* const stored = reinterpret_cast<const std::int32_t*>(numbers.data());
        volume::keepRest(out,
                         [&](std::size_t i) { return record.valueOffset + record.valueScale * double(stored[i]); });
    }
    if (isFinite && decoded->exact.empty()) return out;
    leaveOutInfinite(out);
    if (isHeld) hold(out.values);
    return out;
}

volume::BrickSamples Archive::Impl::readSubsamples(int number, int component, const volume::BrickKey& key) const {
    const std::size_t brick = metadata.grid.numberOf(key.index);
    const FrameRecord& record = holding(frame(number, component, key.time), brick);
    const volume::ScalarType type = parameter(number).type;
    const BrickFormat format = brickFormat(metadata.grid, key.index, type, record);
    fetchBrick(record, brick, 1);
    const std::vector<std::uint8_t> fine = flags(record, brick);
    const Segment& first = record.segments[brick];
    const FilePart part = segment(first);
    std::span<const std::byte> in = part.bytes();
    if (record.predicted && !in.empty()) in = in.subspan(1); // its depth
    std::vector<std::uint32_t> numbers;
    if (const DecodeStatus status = takeSubsamples(format, fine, in, numbers); status != DecodeStatus::Ok)
        damaged(path, first.offset, reason(status));

    volume::BrickSamples out;
    out.size = samplesAt(format, key.level);
    out.present = maskAt(format, fine, key.level);
    for (const std::uint32_t bits : numbers) {
        const double stored = type == volume::ScalarType::F32 ? double(std::bit_cast<float>(bits))
                                                              : double(static_cast<std::int32_t>(bits));
        out.values.push_back(static_cast<float>(record.valueOffset + record.valueScale * stored));
    }
    leaveOutInfinite(out);
    return out;
}

volume::BrickSamples Archive::read(const volume::BrickKey& key) const {
    const volume::Channel& channel = impl_->channelOf(key);
    if (!channel.magnitude) return impl_->readOfParts(channel.parameter, channel.component, key);
    const auto part = [&](int c) { return impl_->readOfParts(channel.parameter, c, key); };
    if (channel.component == 3) return volume::magnitude(part(0), part(1), part(2));
    volume::BrickSamples sum = part(0), nothing;
    nothing.size = sum.size;
    nothing.values.resize(sum.values.size());
    for (int c = 1; c < channel.component; ++c) sum = volume::magnitude(sum, part(c), nothing);
    return sum;
}

volume::Field readField(const Archive& archive, int parameter, int component, int time) {
    return readLayers(archive, parameter, component, time, 0, archive.grid().count().z);
}

volume::Field readLayers(const Archive& archive, int parameter, int component, int time, int layer, int end) {
    const Archive::Impl& impl = *archive.impl_;
    const volume::BrickGrid& grid = impl.metadata.grid;
    const FrameRecord& shown = impl.frame(parameter, component, time);
    const int first = grid.begin({0, 0, layer}).z, last = grid.end({0, 0, end - 1}).z;
    const std::size_t firstBrick = grid.numberOf({0, 0, layer}), bricks = grid.numberOf({0, 0, end}) - firstBrick;
    volume::Field field =
        volume::makeField(volume::slicesOf(grid.lattice, first, last - first), impl.parameter(parameter).type);
    const volume::BrickGrid own{field.lattice, grid.brickSize, grid.levels, grid.phase}; // of these layers only
    if (impl.metadata.alternating && time % 2 != 0) field.lattice.origin += 0.5 * field.lattice.spacing;
    field.offset = shown.valueOffset;
    field.scale = shown.valueScale;
    volume::Mask mask(shown.mask < 0 ? 0 : field.count(), 1);
    parallelFor(bricks, [&](std::size_t number) {
        const std::size_t brick = firstBrick + number;
        const FrameRecord& frame = impl.holding(shown, brick);
        const glm::ivec3 index = own.indexOf(number);
        const BrickFormat format = brickFormat(own, index, field.type, frame);
        impl.fetchBrick(frame, brick, own.levels);
        const std::vector<std::uint8_t> fine = impl.flags(frame, brick);
        const PooledBrick decoded(impl);
        impl.decode(frame, format, brick, 0, fine, *decoded);
        const glm::ivec3 begin = own.begin(index), size = decoded->size;
        const auto placeOf = [&](std::size_t i) { // position in the lattice of a sample of the brick
            const std::size_t nx = std::size_t(size.x), ny = std::size_t(size.y);
            return field.lattice.index(begin + glm::ivec3(int(i % nx), int(i / nx % ny), int(i / (nx * ny))));
        };
        volume::dispatch(field.type, [&]<class T>(T) {
            const auto out = field.as<T>();
            glm::ivec3 place = begin; // first position of the row
            decoded->forRows([&](std::size_t, auto row) {
                toSamples(frame.numbers, row, out.data() + field.lattice.index(place));
                if (++place.y == begin.y + size.y) ++place.z, place.y = begin.y;
            });
            const auto put = [&](std::size_t i, std::uint32_t bits) {
                if constexpr (std::same_as<T, float>)
                    out[placeOf(i)] = std::bit_cast<float>(bits);
                else
                    out[placeOf(i)] = static_cast<T>(bits);
            };
            for (const ExactSample& exact : decoded->exact) put(exact.index, exact.bits);
            // Absent samples get their stored value, or else one that cannot be mistaken for data.
            std::size_t next = 0;
            for (std::size_t i = 0; i < fine.size(); ++i)
                if (fine[i] == 0)
                    put(i, frame.keepsAbsent ? decoded->absent[next++] : sizeof(T) == 4 ? 0x7fc00000u : 0u);
        });
        if (!fine.empty() && !mask.empty())
            forBrickRows(own, index, [&](std::size_t to, std::size_t from, std::size_t count) {
                std::copy_n(fine.begin() + std::ptrdiff_t(from), count, mask.begin() + std::ptrdiff_t(to));
            });
    });
    if (!mask.empty()) field.mask = std::make_shared<const volume::Mask>(std::move(mask));
    return field;
}

} // namespace tessera::codec
