#include "tests/codec/plain/steps.h"

#include "tests/codec/plain/bits.h"

#include <algorithm>
#include <map>

namespace tessera::codec::plain {

namespace {

struct Number {
    std::map<int, Chance> longer, next;
    std::uint64_t read(Bits& bits) {
        int n = 0;
        while (n < 31 && bits.bit(longer[n])) ++n;
        if (n == 0) return 0;
        const std::uint64_t top = 2 + (bits.bit(next[n]) ? 1 : 0);
        return (top << (n - 1)) + bits.raw(n - 1) - 1;
    }
};

/// A subband in a box.
struct Part {
    Size lo{}, hi{}, halvings{};
    std::array<bool, 3> high{};
    int highs() const { return int(std::count(high.begin(), high.end(), true)); }
};

struct Contexts {
    std::map<std::array<int, 2>, Chance> rows, significant;
    std::map<std::array<int, 3>, Chance> larger;
    std::map<int, Number> rest;
    Number coarse, count, gap, times;
};

int log2Of(std::int64_t value) {
    int bits = 0;
    while (value >> (bits + 1) > 0) ++bits;
    return bits;
}

std::int64_t coefficient(Bits& bits, Contexts& contexts, int highs, int level, std::int64_t sum) {
    const int e = log2Of(sum + 1), half = e > 0 && 2 * (sum + 1) >= std::int64_t(3) << e ? 1 : 0;
    const int about = 2 * e + half, low = std::max(0, e - 5), pool = 2 * highs + (level > 0 ? 1 : 0);
    std::uint64_t size = 0;
    if (low == 0) {
        if (!bits.bit(contexts.significant[{4 * highs + std::min(level, 3), about}])) return 0;
        size = 1;
    }
    int step = 0;
    while (step < 20 && bits.bit(contexts.larger[{pool, about, step}])) ++size, ++step;
    if (step == 20) size += contexts.rest[pool].read(bits);
    size = (size << low) + bits.raw(low);
    if (size == 0) return 0;
    return bits.raw(1) != 0 ? -std::int64_t(size) : std::int64_t(size);
}

void readBand(Bits& bits, Contexts& contexts, Box& box, const Part& part, int level) {
    Box sizes = makeBox({part.hi[0] - part.lo[0], part.hi[1] - part.lo[1], part.hi[2] - part.lo[2]});
    std::map<std::array<int, 2>, bool> filled;
    const auto sizeAt = [&](int x, int y, int z) -> std::int64_t {
        const Size p{x, y, z};
        for (std::size_t a = 0; a < 3; ++a)
            if (p[a] < 0 || p[a] >= sizes.size[a]) return 0;
        return sizes.at(p).value_or(0);
    };
    for (int z = 0; z < sizes.size[2]; ++z)
        for (int y = 0; y < sizes.size[1]; ++y) {
            std::vector<std::int64_t> around;
            bool quiet = true;
            for (int x = 0; x < sizes.size[0]; ++x) {
                around.push_back(2 * sizeAt(x, y - 1, z) + 2 * sizeAt(x, y, z - 1) + sizeAt(x - 1, y - 1, z) +
                                 sizeAt(x + 1, y - 1, z) + sizeAt(x, y - 1, z - 1) + sizeAt(x, y + 1, z - 1) +
                                 sizeAt(x - 1, y, z - 1) + sizeAt(x + 1, y, z - 1));
                quiet = quiet && around.back() == 0;
            }
            bool row = true;
            if (quiet) {
                const int about =
                    (filled[{y - 1, z}] ? 1 : 0) + (filled[{y, z - 1}] ? 2 : 0) + (filled[{y + 1, z - 1}] ? 4 : 0);
                row = bits.bit(contexts.rows[{4 * part.highs() + std::min(level, 3), about}]);
            }
            filled[{y, z}] = row;
            for (int x = 0; x < sizes.size[0]; ++x) {
                Cell& cell = box.at(part.lo[0] + x, part.lo[1] + y, part.lo[2] + z);
                if (!row || !cell) continue;
                const std::int64_t value =
                    coefficient(bits, contexts, part.highs(), level, around[std::size_t(x)] + 2 * sizeAt(x - 1, y, z));
                cell = std::uint32_t(value);
                const auto size = std::uint32_t(value < 0 ? -value : value);
                sizes.at(x, y, z) = std::min(size & 0x80000000u ? 0u - size : size, 4095u);
            }
        }
}

std::uint32_t stepOf(const Part& part, std::uint64_t quantum) {
    static const std::uint64_t kLow[] = {256, 328, 459, 648, 917, 1296, 1833, 2592, 3666};
    static const std::uint64_t kHigh[] = {0, 207, 248, 343, 484, 685, 968, 1369, 1936};
    std::uint64_t gain = 1;
    for (std::size_t a = 0; a < 3; ++a) {
        const int h = std::min(part.halvings[a], 8);
        gain *= part.high[a] ? kHigh[h] : kLow[h];
    }
    return std::uint32_t(std::max<std::uint64_t>(1, (quantum << 20) / gain));
}

/// Lengths of the parts of an axis that are split again.
std::vector<int> splitLengths(int length, int least) {
    std::vector<int> lengths;
    for (; length >= least; length = (length + 1) / 2) lengths.push_back(length);
    return lengths;
}

/// Changes all lines of [lo, hi) along an axis.
void changeLines(Box& box, const Size& lo, const Size& hi, std::size_t axis, auto&& change) {
    Size lines = hi;
    lines[axis] = lo[axis] + 1;
    places(lo, lines, [&](Size p) {
        std::vector<Cell> line;
        for (p[axis] = lo[axis]; p[axis] < hi[axis]; ++p[axis]) line.push_back(box.at(p));
        line = change(line);
        for (p[axis] = lo[axis]; p[axis] < hi[axis]; ++p[axis]) box.at(p) = line[std::size_t(p[axis] - lo[axis])];
    });
}

/// A detail subband, split further: its parts in coded order.
std::vector<Part> partsOf(const Part& whole, int axes, int least) {
    std::vector<Part> parts{whole};
    for (std::size_t a = 0; a < 3; ++a) {
        if ((axes >> a & 1) == 0 || whole.high[a]) continue;
        std::vector<int> lengths = splitLengths(whole.hi[a], least);
        std::vector<Part> finer;
        int length = whole.hi[a], halvings = whole.halvings[a];
        std::vector<Part> highs; // finest first
        for (const int from : lengths) {
            length = (from + 1) / 2;
            Part high;
            high.lo[a] = length, high.hi[a] = from, high.halvings[a] = ++halvings, high.high[a] = true;
            highs.push_back(high);
        }
        Part low;
        low.hi[a] = length, low.halvings[a] = halvings;
        highs.push_back(low);
        for (std::size_t i = highs.size(); i-- > 0;)
            for (const Part& part : parts) {
                Part one = part;
                one.lo[a] = highs[i].lo[a], one.hi[a] = highs[i].hi[a];
                one.halvings[a] = highs[i].halvings[a], one.high[a] = highs[i].high[a];
                finer.push_back(one);
            }
        parts = finer;
    }
    return parts;
}

} // namespace

std::vector<std::pair<std::size_t, std::int64_t>>
readStepped(const SteppedShape& shape, const std::vector<Octets>& segments, std::vector<Box>& boxes) {
    std::vector<std::pair<std::size_t, std::int64_t>> corrections;
    Contexts contexts;
    Reader chunk(shape.steps);
    const int axes = int(chunk.number(1)), least = int(chunk.number(1));
    const std::uint64_t quantum = chunk.length();
    need(axes < 8 && least >= 2 && quantum >= 1 && quantum <= 1u << 28 && chunk.at == chunk.end, "steps");
    for (int s = 0; s < int(segments.size()); ++s) {
        const int l = shape.levels - 1 - s;
        const Octets& bytes = segments[std::size_t(s)];
        // Subbands, with the flags of those that are split further moved to their places.
        std::vector<std::pair<Box*, Part>> parts, details;
        for (Box& box : boxes) {
            Size part = box.size;
            if (shape.centred && &box == &boxes[1]) {
                if (l == 0) parts.push_back({&box, Part{{}, part, {}, {}}});
                continue;
            }
            for (int i = shape.level; i < l; ++i) part = half(part);
            if (s == 0) {
                parts.push_back({&box, Part{{}, part, {l, l, l}, {}}});
                continue;
            }
            const Size low = half(part);
            for (int kind = 1; kind < 8; ++kind) {
                Part whole{{}, low, {l + 1, l + 1, l + 1}, {}};
                bool empty = false;
                for (std::size_t a = 0; a < 3; ++a) {
                    if ((kind >> a & 1) != 0) whole.lo[a] = low[a], whole.hi[a] = part[a], whole.high[a] = true;
                    empty = empty || whole.lo[a] >= whole.hi[a];
                }
                if (empty) continue;
                details.push_back({&box, whole});
                for (std::size_t a = 0; a < 3; ++a)
                    if ((axes >> a & 1) != 0 && !whole.high[a])
                        for (const int length : splitLengths(whole.hi[a], least)) {
                            Size hi = whole.hi;
                            hi[a] = length;
                            changeLines(box, whole.lo, hi, a, [](const std::vector<Cell>& line) {
                                std::vector<Cell> out;
                                for (std::size_t i = 0; i < line.size(); i += 2) out.push_back(line[i]);
                                for (std::size_t i = 1; i < line.size(); i += 2) out.push_back(line[i]);
                                return out;
                            });
                        }
                for (const Part& one : partsOf(whole, axes, least)) parts.push_back({&box, one});
            }
        }
        if (!bytes.empty()) {
            Bits bits(bytes);
            if (l == 0) {
                std::uint64_t next = 0;
                const std::uint64_t count = contexts.count.read(bits);
                need(count <= shape.samples, "corrections");
                for (std::uint64_t i = 0; i < count; ++i, ++next) {
                    next += contexts.gap.read(bits);
                    need(next < shape.samples, "correction");
                    const bool negative = bits.raw(1) != 0;
                    const auto times = std::int64_t(contexts.times.read(bits)) + 1;
                    corrections.push_back({std::size_t(next), negative ? -times : times});
                }
            }
            std::uint32_t before = 0;
            for (auto& [box, part] : parts) {
                if (s > 0) {
                    readBand(bits, contexts, *box, part, l);
                    continue;
                }
                Box& to = *box;
                places(part.lo, part.hi, [&](const Size& p) {
                    if (to.at(p)) to.at(p) = before += unzigzag(std::uint32_t(contexts.coarse.read(bits)));
                });
            }
            bits.finish();
        }
        for (auto& [box, part] : parts) {
            const std::uint32_t step = stepOf(part, quantum);
            Box& to = *box;
            places(part.lo, part.hi, [&](const Size& p) {
                if (to.at(p)) to.at(p) = *to.at(p) * step;
            });
        }
        for (auto& [box, whole] : details)
            for (std::size_t a = 3; a-- > 0;) {
                if ((axes >> a & 1) == 0 || whole.high[a]) continue;
                std::vector<int> lengths = splitLengths(whole.hi[a], least);
                std::reverse(lengths.begin(), lengths.end());
                for (const int length : lengths) {
                    Size hi = whole.hi;
                    hi[a] = length;
                    changeLines(*box, whole.lo, hi, a,
                                [&](const std::vector<Cell>& line) { return undo(line, shape.wavelet, false); });
                }
            }
    }
    return corrections;
}

} // namespace tessera::codec::plain
