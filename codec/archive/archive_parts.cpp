// Parts of parameters: which samples belong to them, and coarse levels that mix none.
#include "codec/archive/archive_impl.h"
#include "volume/bricks/parts_bricks.h"
#include "volume/field/part_masks.h"

#include <algorithm>
#include <functional>

namespace tessera::codec {

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
