#include "codec/brick/frame_samples.h"

#include "volume/field/part_masks.h"

#include <algorithm>

namespace tessera::codec {

namespace {

using volume::Field;

int slicesOfLayer(const volume::BrickGrid& grid) {
    return grid.brickSize * (grid.lattice.kind == volume::LatticeKind::BCC ? 2 : 1);
}

std::size_t sliceSize(const volume::Lattice& lattice) {
    return std::size_t(lattice.size.x) * std::size_t(lattice.size.y);
}

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

void FrameSamples::Stored::put(const Field& part, int first) {
    const std::size_t at = sliceSize(lattice) * std::size_t(first);
    file.write(at * volume::byteSize(type), part.samples);
    const volume::Mask present = part.mask ? *part.mask : volume::Mask(part.count(), 1);
    masked = masked || std::find(present.begin(), present.end(), std::uint8_t(0)) != present.end();
    file.write(lattice.count() * volume::byteSize(type) + at, std::as_bytes(std::span(present)));
    offset = part.offset;
    scale = part.scale;
}

FrameSamples::FrameSamples(volume::SlicedFrame frame, const volume::BrickGrid& grid, const SlabStore& store,
                           const Progress& progress) {
    if (frame.whole) {
        own_ = volume::withoutParts(std::move(*frame.whole));
        return;
    }
    stored_ = std::make_unique<Stored>(store);
    stored_->lattice = frame.lattice;
    stored_->slices = store.layers * slicesOfLayer(grid);
    const int size = frame.lattice.size.z;
    for (int first = 0; first < size; first += stored_->slices) {
        progress.advance(double(first) / size);
        const Field part = volume::withoutParts(frame.read(first, std::min(stored_->slices, size - first)));
        stored_->type = part.type;
        stored_->put(part, first);
    }
}

bool FrameSamples::forSlabs(const std::function<bool(const Field&, Slab)>& visit) const {
    const int size = lattice().size.z;
    if (whole()) return visit(*whole(), {0, size});
    for (int first = 0; first < size; first += stored_->slices) {
        const Slab slab{first, std::min(stored_->slices, size - first)};
        if (!visit(slices(slab.first, slab.count), slab)) return false;
    }
    return true;
}

void FrameSamples::change(const std::function<void(Field&, Slab)>& visit) {
    if (borrowed_) own_ = *std::exchange(borrowed_, nullptr);
    if (own_) return visit(*own_, {0, own_->lattice.size.z});
    Stored& stored = *stored_;
    const bool wasMasked = stored.masked;
    const double offset = stored.offset, scale = stored.scale;
    bool isMasked = false;
    for (int first = 0; first < stored.lattice.size.z; first += stored.slices) {
        const Slab slab{first, std::min(stored.slices, stored.lattice.size.z - first)};
        stored.masked = wasMasked, stored.offset = offset, stored.scale = scale; // as when the slab was written
        Field part = slices(slab.first, slab.count);
        visit(part, slab);
        stored.masked = isMasked;
        stored.put(part, slab.first);
        isMasked = stored.masked;
    }
}

Field FrameSamples::slices(int first, int count) const {
    if (whole()) return volume::slicesOf(*whole(), first, count);
    Field part = volume::makeField(volume::slicesOf(stored_->lattice, first, count), stored_->type);
    part.offset = stored_->offset;
    part.scale = stored_->scale;
    volume::Mask mask(stored_->masked ? part.count() : 0);
    read(sliceSize(stored_->lattice) * std::size_t(first), part.count(), part.samples.data(),
         mask.empty() ? nullptr : mask.data());
    if (std::find(mask.begin(), mask.end(), std::uint8_t(0)) != mask.end())
        part.mask = std::make_shared<const volume::Mask>(std::move(mask));
    return part;
}

void FrameSamples::read(std::size_t at, std::size_t n, std::byte* samples, std::uint8_t* present) const {
    const std::size_t bytes = volume::byteSize(stored_->type);
    stored_->file.read(at * bytes, {samples, n * bytes});
    if (present)
        stored_->file.read(stored_->lattice.count() * bytes + at, std::as_writable_bytes(std::span(present, n)));
}

std::vector<volume::BrickImportance> importanceOfBricks(const volume::BrickGrid& grid, const FrameSamples& samples,
                                                        Range range, bool categorical,
                                                        const volume::ImportanceOptions& options) {
    if (samples.whole()) return volume::importanceOfBricks(grid, *samples.whole(), range, categorical, options);
    return volume::importanceOfBricks(
        grid, [&](int first, int count) { return samples.slices(first, count); }, samples.store()->layers, range,
        categorical, options);
}

} // namespace tessera::codec
