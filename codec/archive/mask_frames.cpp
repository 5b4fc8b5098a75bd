#include "codec/archive/mask_frames.h"

#include "codec/archive/brick_access.h"
#include "codec/brick/coded_mask.h"
#include "volume/base/parallel.h"

namespace tessera::codec {

MaskRecord writeMask(const FrameSamples& samples, const volume::BrickGrid& grid, int zstdLevel, GrowingFile& file) {
    MaskRecord record;
    record.offset = file.position();
    samples.forSlabs([&](const volume::Field& part, Slab slab) {
        const volume::BrickGrid own = slab.grid(grid);
        std::vector<CodedMaskBrick> coded(own.brickCount());
        parallelRanges(coded.size(), [&](std::size_t begin, std::size_t end) {
            Compressor compressor(zstdLevel);
            std::vector<std::uint8_t> flags;
            for (std::size_t b = begin; b < end; ++b) {
                flags.clear();
                forBrickRows(own, own.indexOf(b), [&](std::size_t from, std::size_t, std::size_t n) {
                    for (std::size_t i = from; i < from + n; ++i) flags.push_back(part.present(i) ? 1 : 0);
                });
                coded[b] = encodeMask(flags, compressor);
            }
        });
        for (const CodedMaskBrick& brick : coded) {
            record.bricks.push_back(
                {{file.position(), static_cast<std::uint32_t>(brick.bytes.size()), checksum(brick.bytes)},
                 brick.present});
            file.append(brick.bytes);
        }
        return true;
    });
    record.length = file.position() - record.offset;
    return record;
}

} // namespace tessera::codec
