#pragma once

#include "codec/archive/archive.h"
#include "tests/codec/plain/decoder.h"
#include "volume/bricks/parts_bricks.h"

namespace tessera::codec::testing {

/// A brick as the second decoder reads it; coarser levels of labels, which a reader makes of level 0 (FORMAT.md 1.3),
/// of what it reads there.
inline plain::Brick plainBrick(const plain::Decoder& decoder, const Archive& archive, const volume::BrickKey& key,
                               std::size_t frame, int number) {
    const volume::Channel channel = archive.info().channel(key.channel);
    if (key.level == 0 || !archive.info().parameters[std::size_t(channel.parameter)].categorical)
        return decoder.brick(frame, number, key.level);
    const plain::Brick fine = decoder.brick(frame, number, 0);
    volume::BrickSamples labels;
    labels.size = {fine.size[0], fine.size[1], fine.size[2]};
    for (std::size_t i = 0; i < fine.values.size(); ++i) {
        labels.values.push_back(float(fine.values[i]));
        labels.present.push_back(fine.present[i] ? 1 : 0);
    }
    const volume::BrickSamples coarse = volume::coarserLabels(archive.grid(), key, labels);
    plain::Brick out;
    out.size = {coarse.size.x, coarse.size.y, coarse.size.z};
    for (std::size_t i = 0; i < coarse.values.size(); ++i) {
        out.values.push_back(double(coarse.values[i]));
        out.present.push_back(coarse.isPresent(i));
    }
    return out;
}

} // namespace tessera::codec::testing
