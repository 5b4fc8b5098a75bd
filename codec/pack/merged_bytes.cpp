#include "codec/pack/merged_bytes.h"

#include "codec/archive/archive_impl.h"
#include "codec/archive/brick_input.h"
#include "codec/archive/frame_model.h"
#include "volume/base/parallel.h"

#include <mutex>

namespace tessera::codec {

namespace {

/// The bricks of a box, x fastest.
template <class Visit> void forBricksOf(const volume::MergedBrick& box, Visit&& visit) {
    glm::ivec3 at;
    for (at.z = box.begin.z; at.z < box.end.z; ++at.z)
        for (at.y = box.begin.y; at.y < box.end.y; ++at.y)
            for (at.x = box.begin.x; at.x < box.end.x; ++at.x) visit(at);
}

/// Boxes of one frame to be coded.
struct BoxesOfFrame {
    const volume::BrickGrid& grid;
    const volume::Field& field;
    const FrameRecord& frame;

    BrickFormat take(const volume::MergedBrick& box, BrickInput& input) const {
        BrickFormat format = brickFormat(grid, box.begin, field.type, frame);
        const glm::ivec3 begin = grid.begin(box.begin);
        format.size = grid.end(box.end - 1) - begin;
        input.take(grid, begin, format.size, field, field.mask != nullptr);
        return format;
    }

    /// The model of the archive, unless quantised coefficients need none, or a new one if that saves bytes including
    /// its own.
    Model modelFor(std::span<const volume::MergedBrick> boxes, const std::vector<std::uint8_t>& wanted,
                   const Model& known, std::uint64_t& bytes) const {
        constexpr int kMostTables = 24;
        if (frame.numbers.kind == NumberKind::Stepped) return known;
        Histogram tokens(grid.levels, known.contexts);
        std::mutex mutex;
        parallelRanges(boxes.size(), [&](std::size_t first, std::size_t last) {
            Histogram own(grid.levels, known.contexts);
            BrickInput input;
            SplitMemory memory;
            for (std::size_t b = first; b < last; ++b) {
                if (wanted[b] == 0) continue;
                const BrickFormat format = take(boxes[b], input);
                countBrick(
                    prepareBrick(format, input.samples, input.present, 0, known.contexts, memory, {}, &known.fitted),
                    own);
            }
            const std::lock_guard lock(mutex);
            tokens.add(own);
        });
        Model fresh = makeModel(tokens, kMostTables);
        fresh.fitted = known.fitted;
        const std::size_t own = serialise(fresh).size();
        if (bitsWith(fresh, tokens) + 8.0 * double(own) >= bitsWith(known, tokens)) return known;
        bytes += own;
        return fresh;
    }
};

} // namespace

std::vector<MergedBytes> bytesOfMerged(const Archive& archive, std::span<const volume::MergedBrick> boxes,
                                       const Progress& progress) {
    const Archive::Impl& impl = *archive.impl_;
    const volume::BrickGrid& grid = impl.metadata.grid;
    std::vector<MergedBytes> sums(boxes.size());
    for (std::size_t f = 0; !boxes.empty() && f < impl.index.frames.size(); ++f) {
        progress.advance(double(f) / double(impl.index.frames.size()), "merging");
        FrameRecord frame = impl.index.frames[f];
        if (frame.numbers.kind == NumberKind::Stepped) frame.steps = impl.steps(frame);
        std::size_t component = f % impl.components, parameter = 0;
        while (component >= std::size_t(impl.metadata.info.parameters[parameter].components))
            component -= std::size_t(impl.metadata.info.parameters[parameter++].components);
        const volume::Field field = readField(archive, int(parameter), int(component), int(f / impl.components));
        std::vector<std::uint8_t> wanted(boxes.size(), 0);
        for (std::size_t b = 0; b < boxes.size(); ++b)
            forBricksOf(boxes[b], [&](glm::ivec3 at) {
                const std::size_t brick = grid.numberOf(at);
                if (frame.bricks[brick].notes.repeats > 0) return;
                sums[b].apart += impl.bytesOf(frame, brick);
                wanted[b] = 1;
            });
        const BoxesOfFrame work{grid, field, frame};
        const auto decoder = impl.decoder(frame);
        const BandEncoder encoder(work.modelFor(boxes, wanted, decoder->model(), sums.front().together));
        parallelRanges(boxes.size(), [&](std::size_t first, std::size_t last) {
            Compressor compressor(zstdLevelFor(field, impl.metadata.options.zstdLevel, impl.metadata.options.effort),
                                  (impl.header.header.features & kCompact) != 0);
            BrickInput input;
            SplitMemory memory;
            for (std::size_t b = first; b < last; ++b) {
                if (wanted[b] == 0) continue;
                const BrickFormat format = work.take(boxes[b], input);
                const double maxError = format.isStepped() ? boundOf(format.numbers) : 0;
                const PreparedBrick brick = prepareBrick(format, input.samples, input.present, maxError,
                                                         encoder.model().contexts, memory, {}, &encoder.model().fitted);
                for (const Bytes& segment :
                     encodeBrick(format, brick, input.samples, input.present, compressor, encoder))
                    sums[b].together += segment.size();
            }
        });
    }
    progress.advance(1);
    return sums;
}

} // namespace tessera::codec
