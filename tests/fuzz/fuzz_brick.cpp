// A coded brick of any format: the first bytes say which, the rest are its segments and mask.
#include "codec/brick/brick_codec.h"
#include "tests/fuzz/fuzz_model.h"

#include <cstdint>
#include <cstdlib>

using namespace tessera;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr std::size_t kHead = 12;
    if (size < kHead) return 0;
    codec::BrickFormat format;
    format.kind = data[0] % 2 == 0 ? volume::LatticeKind::CC : volume::LatticeKind::BCC;
    format.size = {1 + data[1] % 17, 1 + data[2] % 17, 1 + data[3] % 34};
    format.levels = 1 + data[4] % 5;
    format.wavelet = static_cast<codec::Wavelet>(data[5] % std::size(codec::kWaveletNames));
    format.type = static_cast<volume::ScalarType>(data[6] % 5);
    format.keepsAbsent = data[7] % 2 != 0;
    if (format.type == volume::ScalarType::F32)
        format.numbers = {data[8] < 128 ? static_cast<codec::NumberKind>(1 + data[8] % 3) : codec::NumberKind::Stepped,
                          1, 0.5};
    else if (data[8] >= 128)
        format.numbers = {codec::NumberKind::Stepped, data[8] % 2 == 0 ? 3.0 : 1e300, data[7] % 2 == 0 ? 0.25 : 1e308};
    format.subsampled = format.levels > 1 && data[7] / 4 % 4 == 1;
    format.mixed = data[7] / 16 == 2;
    format.steps = {{data[8] % 8, 2 + data[8] / 8 % 8}, 1u << data[6] % 29};
    const std::size_t count = std::size_t(format.size.x) * std::size_t(format.size.y) * std::size_t(format.size.z);
    std::vector<std::uint8_t> present;
    if (data[9] % 2 != 0)
        for (std::size_t i = 0; i < count; ++i) present.push_back((data[10] >> (i * 7 % 8) & 1) != 0);

    std::vector<std::uint8_t> parts; // of stepped bricks
    if (data[9] / 2 % 2 != 0 && format.kind == volume::LatticeKind::CC)
        for (std::size_t i = 0; i < count; ++i) parts.push_back(std::uint8_t(i * 3 / count + i % 7 / 6));

    const bool fitted = data[7] / 16 == 1;
    if (fitted) format.bodyCentred = true;
    // Every segment gets a share of the rest, or as many bytes as two of it say, copied so that a read beyond its end
    // is seen.
    const auto bytes = std::as_bytes(std::span(data + kHead, size - kHead));
    std::vector<codec::Bytes> segments;
    std::size_t at = 0;
    for (std::size_t s = 0, levels = std::size_t(format.levels); s < levels; ++s) {
        std::size_t begin =
            bytes.size() * s * (data[11] % 4 == 0 ? s : 1) / (levels * (data[11] % 4 == 0 ? levels : 1));
        std::size_t end = s + 1 == levels ? bytes.size()
                                          : bytes.size() * (s + 1) * (data[11] % 4 == 0 ? s + 1 : 1) /
                                                (levels * (data[11] % 4 == 0 ? levels : 1));
        if (fitted) {
            begin = std::min(bytes.size(), s + 1 == levels ? at : at + 2);
            const std::size_t length = s + 1 < levels && begin == at + 2
                                           ? std::size_t(bytes[at]) + 256 * std::size_t(bytes[at + 1])
                                           : bytes.size();
            at = end = std::min(bytes.size(), begin + length);
        }
        segments.emplace_back(bytes.begin() + std::ptrdiff_t(begin), bytes.begin() + std::ptrdiff_t(end));
    }
    if (format.numbers.kind == codec::NumberKind::Integer) format.codeBits = codec::codeBitsOf(format.type);
    const codec::BandDecoder decoder(fitted ? codec::fuzzFittedModel(format.levels)
                                            : codec::fuzzModel(format.levels, data[7] / 2 % 2 != 0));
    for (int level = 0; level < format.levels; ++level) {
        const std::vector<std::span<const std::byte>> views(segments.begin(), segments.end() - level);
        codec::DecodedBrick decoded;
        const codec::DecodeStatus status = codec::decodeBrick(format, views, level, present, decoder, decoded, parts);
        if (status == codec::DecodeStatus::Ok && level == 0 && decoded.codes().size() != count) std::abort();
        if (status != codec::DecodeStatus::Ok) continue;
        std::vector<float> values(codec::countOf(decoded.size));
        decoded.forRows([&](std::size_t first, auto row) {
            codec::toValues(format.numbers, format.type, 0.5, 2, row, values.data() + first);
        });
    }
    return 0;
}
