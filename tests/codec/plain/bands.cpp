#include "tests/codec/plain/bands.h"

#include <algorithm>
#include <array>

namespace tessera::codec::plain {

std::uint32_t classOf(std::uint32_t sum) {
    std::uint32_t exponent = 0;
    while ((sum + 1) >> (exponent + 1) != 0) ++exponent;
    // Of sum + 1 = 2^exponent (1 + fraction): is the fraction at least a half?
    const bool upper = exponent > 0 && ((sum + 1) >> (exponent - 1) & 1) != 0;
    return 2 * exponent + (upper ? 1 : 0);
}

void decodeBands(const Octets& bytes, std::vector<Band>& bands, std::size_t level, const Decoder::Model& model,
                 const Foresee& foresee) {
    Reader in(bytes);
    const Octets raw = in.take(in.length());
    std::size_t rawAt = 0;
    const auto takeBits = [&](int count) {
        std::uint32_t value = 0;
        for (int i = 0; i < count; ++i, ++rawAt) {
            need(rawAt < 8 * raw.size(), "raw bits");
            value |= std::uint32_t(raw[rawAt / 8] >> (rawAt % 8) & 1) << i;
        }
        return value;
    };
    std::size_t chunks = 0, widest = 0;
    int maxY = 0, maxZ = 0;
    for (Band& band : bands) {
        band.magnitudes.resize(std::size_t(band.size(0)) * std::size_t(band.size(1)) * std::size_t(band.size(2)));
        chunks += std::size_t((band.size(0) + 15) / 16) * std::size_t(band.size(1)) * std::size_t(band.size(2));
        widest = std::max(widest, std::size_t(band.size(0)));
        maxY = std::max(maxY, band.size(1));
        maxZ = std::max(maxZ, band.size(2));
    }
    const std::size_t groups = chunks >= 8192 ? 4 : chunks >= 1024 ? 2 : 1;
    std::vector<std::uint32_t> states(64, 65536);
    for (std::size_t i = 0; i < (groups > 1 ? 16 * groups : std::min<std::size_t>(16, widest)); ++i)
        states[i] = in.u32();
    std::vector<std::array<int, 3>> rows; // z, y, band
    for (std::size_t turn = 0; turn < (foresee ? bands.size() : 1); ++turn)
        for (int z = 0; z < maxZ; ++z)
            for (int y = 0; y < maxY; ++y)
                for (std::size_t b = 0; b < bands.size(); ++b)
                    if (y < bands[b].size(1) && z < bands[b].size(2) && (!foresee || b == turn))
                        rows.push_back({z, y, int(b)});
    std::size_t chunk = 0;
    for (const auto& [z, y, number] : rows) {
        Band& band = bands[std::size_t(number)];
        for (int x = 0; x < band.size(0); ++x) {
            const std::size_t group = (chunk + std::size_t(x) / 16) % groups;
            const Size place{band.lo[0] + x * band.step[0], band.lo[1] + y * band.step[1],
                             band.lo[2] + z * band.step[2]};
            Cell& cell = band.box->at(place);
            if (!foresee && !cell) continue;
            std::uint32_t sum = 2 * band.magnitude(x, y - 1, z) + band.magnitude(x - 1, y - 1, z) +
                                band.magnitude(x + 1, y - 1, z) + 2 * band.magnitude(x, y, z - 1) +
                                band.magnitude(x, y - 1, z - 1) + band.magnitude(x, y + 1, z - 1);
            if (model.byBand)
                sum += band.magnitude(x, y - 1, z) + band.magnitude(x, y, z - 1) + band.magnitude(x - 1, y, z - 1) +
                       band.magnitude(x + 1, y, z - 1);
            Foreseen foreseen;
            if (foresee) foreseen = foresee(std::size_t(number), place);
            sum += foreseen.activity / 2;
            const auto& tables = model.tableOf[8 * level + std::size_t(band.kind)];
            const auto& table = model.tables[tables[classOf(sum)]];
            std::uint32_t& state = states[16 * group + std::size_t(x) % 16];
            std::uint32_t slot = state % 4096, token = 0;
            for (; slot >= table[token]; ++token) slot -= table[token];
            state = table[token] * (state / 4096) + slot;
            if (state < 65536) state = state * 65536 + std::uint32_t(in.number(2));
            std::uint32_t symbol = token;
            if (token == 140) {
                symbol = takeBits(32);
            } else if (token >= 32) {
                const int count = int(token - 32) / 4 + 3;
                symbol = (4 + (token - 32) % 4) << count;
                symbol |= takeBits(count);
            }
            cell = unzigzag(symbol);
            const std::int64_t value = asSigned(*cell);
            const auto magnitude = std::uint32_t(value < 0 ? -value : value) >> model.shift;
            band.magnitudes[(std::size_t(z) * std::size_t(band.size(1)) + std::size_t(y)) * std::size_t(band.size(0)) +
                            std::size_t(x)] = std::min<std::uint32_t>(magnitude, 4095);
            cell = *cell + std::uint32_t(foreseen.value);
        }
        chunk += std::size_t(band.size(0) + 15) / 16;
    }
    need(in.at == in.end && (rawAt + 7) / 8 == raw.size(), "trailing");
    for (const std::uint32_t state : states) need(state == 65536, "states");
}

} // namespace tessera::codec::plain
