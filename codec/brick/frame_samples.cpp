#include "codec/brick/frame_samples.h"

#include "volume/field/part_masks.h"
#include "volume/system/free_memory.h"

#include <algorithm>
#include <cstring>

namespace tessera::codec {

namespace {

using volume::Field;

int slicesOfLayer(const volume::BrickGrid& grid) {
    return grid.brickSize * (grid.lattice.kind == volume::LatticeKind::BCC ? 2 : 1);
}

std::size_t sliceSize(const volume::Lattice& lattice) {
    return std::size_t(lattice.size.x) * std::size_t(lattice.size.y);
}

/// The flags of a slab, 1 where samples are present.
volume::Mask flagsOf(const Field& part) {
    return part.mask ? *part.mask : volume::Mask(part.count(), 1);
}
bool hasGaps(const volume::Mask& flags) {
    return std::find(flags.begin(), flags.end(), std::uint8_t(0)) != flags.end();
}

/// Follows the samples and flags of a slab in a file of its own.
struct AboutSlab {
    double offset = 0, scale = 1;
    volume::ScalarType type{};
    bool masked = false;
};

} // namespace

Slab layerOf(const volume::BrickGrid& grid, int layer) {
    const int slices = slicesOfLayer(grid), first = layer * slices;
    return {first, std::min(slices, grid.lattice.size.z - first)};
}

std::pair<std::size_t, std::size_t> Slab::bricks(const volume::BrickGrid& grid) const {
    const glm::ivec3 all = grid.count();
    const std::size_t perLayer = std::size_t(all.x) * std::size_t(all.y);
    const int slices = slicesOfLayer(grid);
    return {perLayer * std::size_t(first / slices), perLayer * std::size_t((first + count + slices - 1) / slices)};
}

volume::BrickGrid Slab::grid(volume::BrickGrid whole) const {
    whole.lattice = volume::slicesOf(whole.lattice, first, count);
    return whole;
}

std::size_t FrameSamples::Stored::slabCount() const {
    return std::size_t((lattice.size.z + slices - 1) / slices);
}

Slab FrameSamples::Stored::slab(std::size_t number) const {
    const int first = int(number) * slices;
    return {first, std::min(slices, lattice.size.z - first)};
}

void FrameSamples::Stored::put(const Field& part, int first) {
    const std::size_t at = sliceSize(lattice) * std::size_t(first);
    file->write(at * volume::byteSize(type), part.samples);
    const volume::Mask present = flagsOf(part);
    masked = masked || hasGaps(present);
    file->write(lattice.count() * volume::byteSize(type) + at, std::as_bytes(std::span(present)));
    offset = part.offset;
    scale = part.scale;
}

void FrameSamples::Stored::fill(const char* step, const std::function<Field(Slab)>& made) {
    if (store.team) return fillTogether(step, made);
    const bool wasMasked = masked;
    const double wasOffset = offset, wasScale = scale;
    bool isMasked = false;
    for (std::size_t number = 0; number < slabCount(); ++number) {
        masked = wasMasked, offset = wasOffset, scale = wasScale; // as when the slab was written
        const Field part = made(slab(number));
        type = part.type;
        masked = isMasked;
        put(part, slab(number).first);
        isMasked = masked;
    }
}

/// Each slab becomes a file: its samples, one flag each if any is absent, and how they are to be read.
void FrameSamples::Stored::fillTogether(const char* step, const std::function<Field(Slab)>& made) {
    auto files = store.team->share(step, slabCount(), [&](std::size_t number, const SlabTeam::Write& write) {
        const Field part = made(slab(number));
        const volume::Mask present = part.mask ? *part.mask : volume::Mask();
        const AboutSlab about{part.offset, part.scale, part.type, hasGaps(present)};
        write(part.samples);
        if (about.masked) write(std::as_bytes(std::span(present)));
        write(std::as_bytes(std::span(&about, 1)));
    });
    masked = false;
    maskedSlabs.clear();
    slabs.clear();
    for (SharedResult& each : files) {
        AboutSlab about;
        each.file->read(each.size - sizeof about, std::as_writable_bytes(std::span(&about, 1)));
        slabs.push_back(std::move(each.file));
        masked = masked || about.masked;
        maskedSlabs.push_back(about.masked ? 1 : 0);
        type = about.type, offset = about.offset, scale = about.scale;
    }
}

FrameSamples::FrameSamples(volume::SlicedFrame frame, const volume::BrickGrid& grid, const SlabStore& store,
                           const Progress& progress) {
    if (frame.whole) {
        own_ = volume::withoutParts(std::move(*frame.whole));
        return;
    }
    stored_ = std::make_unique<Stored>();
    stored_->store = store;
    stored_->lattice = frame.lattice;
    stored_->slices = store.layers * slicesOfLayer(grid);
    if (!store.team) stored_->file = std::make_unique<volume::ScratchFile>(store.folder);
    stored_->fill("samples", [&](Slab slab) {
        progress.advance(double(slab.first) / frame.lattice.size.z);
        return volume::withoutParts(frame.read(slab.first, slab.count));
    });
}

std::size_t FrameSamples::slabCount() const {
    return stored_ ? stored_->slabCount() : 1;
}

Slab FrameSamples::slab(std::size_t number) const {
    return stored_ ? stored_->slab(number) : Slab{0, lattice().size.z};
}

bool FrameSamples::forSlabs(const std::function<bool(const Field&, Slab)>& visit) const {
    if (whole()) return visit(*whole(), slab(0));
    Field part;
    for (std::size_t number = 0; number < slabCount(); ++number) {
        const Slab own = slab(number);
        take(own.first, own.count, part);
        if (!visit(part, own)) return false;
    }
    return true;
}

void FrameSamples::change(const std::function<void(Field&, Slab)>& visit) {
    if (borrowed_) own_ = *std::exchange(borrowed_, nullptr);
    if (own_) return visit(*own_, slab(0));
    stored_->fill("changed-samples", [&](Slab slab) {
        Field part = slices(slab.first, slab.count);
        visit(part, slab);
        return part;
    });
}

FrameSamples FrameSamples::changed(const char* step, const std::function<Field(Field, Slab)>& of) const {
    if (whole()) return FrameSamples(of(*whole(), slab(0)));
    FrameSamples other;
    other.stored_ = std::make_unique<Stored>();
    other.stored_->lattice = stored_->lattice;
    other.stored_->store = stored_->store;
    other.stored_->slices = stored_->slices;
    if (!team()) other.stored_->file = std::make_unique<volume::ScratchFile>(stored_->store.folder);
    other.stored_->fill(step, [&](Slab slab) { return of(slices(slab.first, slab.count), slab); });
    return other;
}

Field FrameSamples::slices(int first, int count) const {
    Field part;
    take(first, count, part);
    return part;
}

void FrameSamples::take(int first, int count, Field& part) const {
    if (whole()) {
        part = volume::slicesOf(*whole(), first, count);
        return;
    }
    part.lattice = volume::slicesOf(stored_->lattice, first, count);
    part.type = stored_->type;
    part.offset = stored_->offset;
    part.scale = stored_->scale;
    const std::size_t bytes = part.count() * volume::byteSize(part.type);
    volume::reserveLarge(part.samples, bytes);
    part.samples.resize(bytes);
    part.mask.reset();
    volume::Mask mask(stored_->masked ? part.count() : 0);
    read(sliceSize(stored_->lattice) * std::size_t(first), part.count(), part.samples.data(),
         mask.empty() ? nullptr : mask.data());
    if (hasGaps(mask)) part.mask = std::make_shared<const volume::Mask>(std::move(mask));
}

void FrameSamples::read(std::size_t at, std::size_t n, std::byte* samples, std::uint8_t* present) const {
    const std::size_t bytes = volume::byteSize(type());
    if (const Field* const field = whole()) {
        std::memcpy(samples, field->samples.data() + at * bytes, n * bytes);
        for (std::size_t i = 0; present && i < n; ++i) present[i] = field->present(at + i) ? 1 : 0;
        return;
    }
    const auto readFrom = [&](const volume::ScratchFile& file, std::size_t all, std::size_t from, std::size_t count,
                              std::uint8_t* flags) {
        file.read(from * bytes, {samples, count * bytes});
        if (flags) file.read(all * bytes + from, std::as_writable_bytes(std::span(flags, count)));
    };
    if (stored_->file) return readFrom(*stored_->file, stored_->lattice.count(), at, n, present);
    const std::size_t perSlice = sliceSize(stored_->lattice), perSlab = perSlice * std::size_t(stored_->slices);
    while (n > 0) {
        const std::size_t number = at / perSlab, from = at % perSlab, count = std::min(n, perSlab - from);
        const bool masked = stored_->maskedSlabs[number] != 0;
        readFrom(*stored_->slabs[number], perSlice * std::size_t(stored_->slab(number).count), from, count,
                 masked ? present : nullptr);
        if (present && !masked) std::fill_n(present, count, std::uint8_t(1));
        samples += count * bytes;
        if (present) present += count;
        at += count, n -= count;
    }
}

std::vector<volume::BrickImportance> importanceOfBricks(const volume::BrickGrid& grid, const FrameSamples& samples,
                                                        Range range, bool categorical,
                                                        const volume::ImportanceOptions& options) {
    if (samples.whole()) return volume::importanceOfBricks(grid, *samples.whole(), range, categorical, options);
    const auto read = [&](int first, int count, Field& part) { samples.take(first, count, part); };
    return volume::importanceOfBricks(grid, read, samples.store()->layers, range, categorical, options,
                                      samples.team() ? samples.team()->pieces("importance") : Pieces(piecesHere));
}

} // namespace tessera::codec
