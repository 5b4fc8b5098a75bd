#pragma once

#include "tests/codec/plain/wavelet.h"

/// Fitted predictions (FORMAT.md 4.11).
namespace tessera::codec::plain {

struct FittedBrick {
    int levels = 0, level = 0;        ///< of the archive, and the one that is read
    std::int64_t least = 0, most = 0; ///< of the codes
    const Decoder::Model& model;
};

/// `segments` are those after segment 0, without what is stored in addition; the first box has the samples of segment 0
/// in its low corner. Fills the boxes.
void readFitted(const FittedBrick& of, const std::vector<Octets>& segments, std::vector<Box>& boxes);

} // namespace tessera::codec::plain
