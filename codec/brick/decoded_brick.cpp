#include "codec/brick/decoded_brick.h"

#include "codec/bytes/entropy.h"

#include <algorithm>

namespace tessera::codec {

DecodeStatus decodeExtras(const BrickFormat& format, std::span<const std::uint8_t> present,
                          std::span<const std::byte>& in, DecodedBrick& out) {
    if (format.keepsAbsent) {
        out.absent.resize(std::size_t(std::count(present.begin(), present.end(), std::uint8_t(0))));
        if (const DecodeStatus status = decodeStream(in, out.absent); status != DecodeStatus::Ok) return status;
    }
    if (!format.canHaveExact()) return DecodeStatus::Ok;
    if (in.size() < 4) return DecodeStatus::Truncated;
    const std::size_t exact = readU32(in.data());
    in = in.subspan(4);
    if (exact > countOf(format.size)) return DecodeStatus::BadLength;
    std::vector<std::uint32_t> index(exact), bits(exact);
    if (const DecodeStatus status = decodeStream(in, index); status != DecodeStatus::Ok) return status;
    if (const DecodeStatus status = decodeStream(in, bits); status != DecodeStatus::Ok) return status;
    for (std::size_t k = 0; k < exact; ++k) {
        if (index[k] >= countOf(format.size)) return DecodeStatus::BadLength;
        out.exact.push_back({index[k], bits[k]});
    }
    return DecodeStatus::Ok;
}

void DecodedBrick::begin(const BrickFormat& format, int level) {
    size = samplesAt(format, level);
    sublattices = format.sublattices();
    narrow = false;
    present.clear();
    subsamples.clear();
    exact.clear();
    absent.clear();
}

std::vector<std::uint32_t> DecodedBrick::codes() const {
    std::vector<std::uint32_t> all(countOf(size));
    forRows([&](std::size_t first, auto row) {
        for (std::size_t i = 0; i < row.size(); ++i)
            all[first + i] = static_cast<std::uint32_t>(static_cast<std::int32_t>(row[i]));
    });
    return all;
}

} // namespace tessera::codec
