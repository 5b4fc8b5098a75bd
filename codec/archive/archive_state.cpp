#include "codec/archive/archive_state.h"

#include "codec/archive/archive_impl.h"
#include "volume/base/parallel.h"

#include <algorithm>

namespace tessera::codec {

namespace {

/// Presence flags of a layer of bricks.
volume::Mask flagsOfLayer(const auto& impl, const FrameRecord& frame, int layer) {
    const volume::BrickGrid& grid = impl.metadata.grid;
    const glm::ivec3 count = grid.count(), corner(0, 0, layer);
    const std::size_t begin = grid.lattice.index({0, 0, grid.begin(corner).z}),
                      end = grid.lattice.index({0, 0, grid.end(corner).z}), first = grid.numberOf(corner);
    volume::Mask mask(end - begin, 1);
    parallelFor(std::size_t(count.x) * std::size_t(count.y), [&](std::size_t i) {
        const std::vector<std::uint8_t> fine = impl.flags(frame, first + i);
        if (fine.empty()) return;
        forBrickRows(grid, grid.indexOf(first + i), [&](std::size_t to, std::size_t from, std::size_t n) {
            std::copy_n(fine.begin() + std::ptrdiff_t(from), n, mask.begin() + std::ptrdiff_t(to - begin));
        });
    });
    return mask;
}

} // namespace

MaskHash::Value maskHashOf(const Archive& archive, const FrameRecord& frame) {
    MaskHash hash;
    for (int layer = 0; layer < archive.grid().count().z; ++layer) hash.add(flagsOfLayer(*archive.impl_, frame, layer));
    return hash.value();
}

ArchiveState stateOf(const Archive& archive, bool withFrames) {
    const Archive::Impl& impl = *archive.impl_;
    ArchiveState state{impl.header.header,
                       impl.index.pageBytes,
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
        state.lastModels.push_back({number, impl.model(frame), frame.wavelet, frame.numbers.kind, frame.codeBits,
                                    frame.bodyCentred,
                                    frame.numbers.kind == NumberKind::Stepped ? impl.steps(frame) : StepChoice(), 0});
        const FrameRecord& last = impl.index.frames[(state.times - 1) * impl.components + c];
        state.lastModels.back().quantum = quantumOf(last, state.lastModels.back().steps);
        state.lastModels.back().parted = last.parted;
        const auto sameMask = [&](const auto& entry) { return entry.first == last.mask; };
        if (last.mask < 0 || std::any_of(state.lastMasks.begin(), state.lastMasks.end(), sameMask)) continue;
        state.lastMasks.emplace_back(last.mask, maskHashOf(archive, last));
    }
    const std::size_t step = impl.metadata.alternating ? 2 : 1;
    for (std::size_t t = state.times - std::min(state.times, step); withFrames && t < state.times; ++t)
        for (std::size_t p = 0, c = 0; p < impl.metadata.info.parameters.size(); ++p)
            for (int component = 0; component < impl.metadata.info.parameters[p].components; ++component, ++c) {
                const FrameRecord& last = impl.index.frames[t * impl.components + c];
                SeenFrame seen{
                    int(t), last.keepsAbsent, last.mask, readField(archive, int(p), component, int(t)), last.bricks, {},
                    {}};
                for (std::size_t b = 0; b < impl.bricks; ++b) {
                    seen.bytes.push_back(impl.bytesOf(last, b));
                    seen.depth.push_back(impl.depthOf(impl.holding(last, b), b));
                }
                state.lastFrames.emplace_back(c, std::move(seen));
            }
    return state;
}

} // namespace tessera::codec
