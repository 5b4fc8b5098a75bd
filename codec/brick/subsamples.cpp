#include "codec/brick/subsamples.h"

#include "volume/field/field.h"

#include <algorithm>
#include <bit>
#include <concepts>
#include <cstring>

namespace tessera::codec {

std::vector<std::uint32_t> subsamplesOf(const BrickFormat& format, std::span<const std::byte> samples,
                                        std::span<const std::uint8_t> present) {
    std::vector<std::uint32_t> numbers;
    volume::dispatch(format.type, [&]<class T>(T) {
        forLevel(format, format.levels - 1, [&](std::size_t at) {
            T number{};
            if (volume::isPresent(present, at)) std::memcpy(&number, samples.data() + at * sizeof(T), sizeof(T));
            if constexpr (std::same_as<T, float>)
                numbers.push_back(std::bit_cast<std::uint32_t>(number));
            else
                numbers.push_back(static_cast<std::uint32_t>(static_cast<std::int32_t>(number)));
        });
    });
    return numbers;
}

void addSubsamples(const BrickFormat& format, std::span<const std::byte> samples, std::span<const std::uint8_t> present,
                   Compressor& compressor, std::vector<Bytes>& segments) {
    const std::vector<std::uint32_t> all = subsamplesOf(format, samples, present);
    const std::vector<std::uint8_t> flags = maskAt(format, present, format.levels - 1);
    std::vector<std::uint32_t> numbers;
    for (std::size_t i = 0; i < all.size(); ++i)
        if (volume::isPresent(flags, i)) numbers.push_back(all[i]);
    Bytes stream;
    encodeStream(numbers, compressor, stream);
    segments[0].insert(segments[0].begin(), stream.begin(), stream.end());
}

DecodeStatus takeSubsamples(const BrickFormat& format, std::span<const std::uint8_t> present,
                            std::span<const std::byte>& in, std::vector<std::uint32_t>& numbers) {
    const std::vector<std::uint8_t> flags = maskAt(format, present, format.levels - 1);
    const std::size_t all = countOf(samplesAt(format, format.levels - 1)),
                      absent = std::size_t(std::count(flags.begin(), flags.end(), std::uint8_t(0)));
    std::vector<std::uint32_t> stored(all - absent);
    if (const DecodeStatus status = decodeStream(in, stored); status != DecodeStatus::Ok) return status;
    numbers.assign(all, 0);
    std::size_t next = 0;
    for (std::size_t i = 0; i < all; ++i)
        if (volume::isPresent(flags, i)) numbers[i] = stored[next++];
    return DecodeStatus::Ok;
}

} // namespace tessera::codec
