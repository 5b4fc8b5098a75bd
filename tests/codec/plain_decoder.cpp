#include "tests/codec/plain_decoder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <xxhash.h>
#include <zstd.h>

namespace tessera::codec::plain {

using Octets = std::vector<std::uint8_t>;

namespace {

void need(bool condition, const char* what) {
    if (!condition) throw std::runtime_error(what);
}

} // namespace

/// Reads little-endian numbers from the front.
struct Reader {
    const std::uint8_t* at;
    const std::uint8_t* end;

    explicit Reader(const Octets& bytes) : at(bytes.data()), end(bytes.data() + bytes.size()) {}
    std::uint64_t number(int bytes) {
        need(end - at >= bytes, "truncated");
        std::uint64_t value = 0;
        for (int i = 0; i < bytes; ++i) value |= std::uint64_t(*at++) << (8 * i);
        return value;
    }
    std::uint32_t u32() { return std::uint32_t(number(4)); }
    double f64() { return std::bit_cast<double>(number(8)); }
    Octets take(std::size_t count) {
        need(std::size_t(end - at) >= count, "truncated");
        Octets bytes(at, at + count);
        at += count;
        return bytes;
    }
};

namespace {

Octets unzstd(const Octets& packed, std::size_t size) {
    Octets out(size);
    need(ZSTD_decompress(out.data(), size, packed.data(), packed.size()) == size, "zstd");
    return out;
}

/// 4.2
std::vector<std::uint32_t> stream(Reader& in, std::size_t count) {
    std::vector<std::uint32_t> symbols(count);
    if (count == 0) return symbols;
    const auto mode = in.number(1);
    if (mode == 0) return symbols;
    if (mode == 1) return std::vector<std::uint32_t>(count, in.u32());
    need(mode == 2 || mode == 3, "mode");
    const auto width = std::size_t(in.number(1));
    need(width >= 1 && width <= 4, "width");
    Octets planes;
    if (mode == 2) {
        planes = in.take(width * count);
    } else {
        const std::size_t length = in.u32();
        planes = unzstd(in.take(length), width * count);
    }
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t p = 0; p < width; ++p) symbols[i] |= std::uint32_t(planes[p * count + i]) << (8 * p);
    return symbols;
}

std::uint32_t unzigzag(std::uint32_t symbol) {
    return symbol % 2 == 0 ? symbol / 2 : ~(symbol / 2);
}

/// A place of the lattice or a coefficient: nothing where absent.
using Cell = std::optional<std::uint32_t>;

std::int64_t asSigned(std::uint32_t code) {
    return std::int32_t(code);
}

float floatOf(std::uint32_t code) {
    return std::bit_cast<float>(code < 0x80000000u ? code : ~(code ^ 0x80000000u));
}

std::uint32_t codeOf(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    return bits < 0x80000000u ? bits : ~bits ^ 0x80000000u;
}

/// 4.3: P and U of one wavelet.
struct Taps {
    int center = 0;
    std::vector<int> weights;
    int shift = 0;
    bool antisymmetric = false;
};

struct Line {
    std::vector<Cell> even, odd;
    static Cell at(const std::vector<Cell>& cells, int i) {
        return i < 0 || i >= int(cells.size()) ? Cell() : cells[std::size_t(i)];
    }
    Cell e(int i) const { return at(even, i); }
    Cell d(int i) const { return at(odd, i); }
};

std::uint32_t finish(std::int64_t sum, int shift) {
    const std::int64_t divisor = std::int64_t(1) << shift;
    sum += shift > 0 ? divisor / 2 : 0;
    return std::uint32_t(sum >= 0 ? sum / divisor : -((-sum + divisor - 1) / divisor));
}

std::uint32_t predict(const Line& line, int i, int wavelet, bool asFloat) {
    const bool mean = wavelet == 1 || wavelet >= 5, cubic = wavelet >= 8;
    const Cell left = line.e(i);
    if (!mean) return left.value_or(0);
    const Cell right = line.e(i + 1);
    if (!left && !right) return 0;
    const std::uint32_t a = left ? *left : *right, b = right ? *right : *left;
    if (cubic) { // 9 and -1 sixteenths; the pair further out, or the inner one again
        const Cell farLeft = line.e(i - 1), farRight = line.e(i + 2);
        const bool whole = farLeft && farRight;
        const std::int64_t inner = asSigned(a) + asSigned(b);
        return finish(9 * inner - (whole ? asSigned(*farLeft) + asSigned(*farRight) : inner), 4);
    }
    if (!asFloat) return finish(asSigned(a) + asSigned(b), 1);
    const float half = 0.5f * floatOf(a), other = 0.5f * floatOf(b), sum = half + other;
    return std::isfinite(sum) ? codeOf(sum) : 0;
}

std::uint32_t update(const Line& line, int i, int wavelet) {
    static const Taps kTaps[] = {{1, {}, 1, false},
                                 {8, {-1}, 4, true},
                                 {128, {-22, 3}, 8, true},
                                 {0, {1}, 2, false},
                                 {0, {19, -3}, 6, false},
                                 {0, {162, -39, 5}, 9, false},
                                 {}, // 4,0
                                 {0, {1}, 2, false},
                                 {0, {9, -1}, 5, false},
                                 {0, {306, -59, 9}, 10, false}};
    const Taps& taps = kTaps[wavelet - 2];
    // A detail, if it was predicted from all its even samples.
    const auto detail = [&](int k) {
        const bool whole = line.e(k) && (taps.antisymmetric || line.e(k + 1));
        return whole ? line.d(k) : Cell();
    };
    std::int64_t sum = 0;
    if (taps.center != 0) {
        if (!line.d(i)) return 0;
        sum = taps.center * asSigned(*line.d(i));
    }
    std::int64_t pair = 0; // of the last whole pair
    bool broken = false;
    for (std::size_t j = 0; j < taps.weights.size(); ++j) {
        const int n = int(j);
        const Cell left = detail(i - 1 - n), right = detail(taps.antisymmetric ? i + 1 + n : i + n);
        if (taps.antisymmetric) {
            if (!left || !right) break;
            sum += taps.weights[j] * (asSigned(*right) - asSigned(*left));
            continue;
        }
        if (j == 0) {
            if (!left && !right) return 0;
            pair = asSigned(left ? *left : *right) + asSigned(right ? *right : *left);
        } else if (!broken && left && right) {
            pair = asSigned(*left) + asSigned(*right);
        } else {
            broken = true;
        }
        sum += taps.weights[j] * pair;
    }
    return finish(sum, taps.shift);
}

bool updates(int wavelet) {
    return wavelet >= 2 && wavelet != 8;
}

/// The opposite of undo.
std::vector<Cell> redo(const std::vector<Cell>& cells, int wavelet, bool asFloat) {
    if (cells.size() == 1) return cells;
    Line line;
    for (std::size_t i = 0; i < cells.size(); ++i) (i % 2 == 0 ? line.even : line.odd).push_back(cells[i]);
    for (std::size_t i = 0; i < line.odd.size(); ++i)
        if (line.odd[i]) line.odd[i] = *line.odd[i] - predict(line, int(i), wavelet, asFloat);
    std::vector<Cell> updated = line.even;
    for (std::size_t i = 0; updates(wavelet) && i < updated.size(); ++i)
        if (updated[i]) updated[i] = *updated[i] + update(line, int(i), wavelet);
    updated.insert(updated.end(), line.odd.begin(), line.odd.end());
    return updated;
}

std::vector<Cell> undo(const std::vector<Cell>& cells, int wavelet, bool asFloat) {
    const std::size_t n = cells.size(), evens = (n + 1) / 2;
    if (n == 1) return cells;
    Line line{{cells.begin(), cells.begin() + std::ptrdiff_t(evens)},
              {cells.begin() + std::ptrdiff_t(evens), cells.end()}};
    if (updates(wavelet)) {
        std::vector<Cell> updated = line.even;
        for (std::size_t i = 0; i < evens; ++i)
            if (updated[i]) updated[i] = *updated[i] - update(line, int(i), wavelet);
        line.even = updated;
    }
    for (std::size_t i = 0; i < line.odd.size(); ++i)
        if (line.odd[i]) line.odd[i] = *line.odd[i] + predict(line, int(i), wavelet, asFloat);
    std::vector<Cell> out;
    for (std::size_t i = 0; i < n; ++i) out.push_back(i % 2 == 0 ? line.even[i / 2] : line.odd[i / 2]);
    return out;
}

Size half(const Size& size) {
    return {(size[0] + 1) / 2, (size[1] + 1) / 2, (size[2] + 1) / 2};
}

/// A box of cells, x fastest.
struct Box {
    Size size{};
    std::vector<Cell> cells;
    Cell& at(int x, int y, int z) {
        return cells[(std::size_t(z) * std::size_t(size[1]) + std::size_t(y)) * std::size_t(size[0]) + std::size_t(x)];
    }
    Cell& at(const Size& p) { return at(p[0], p[1], p[2]); }
};

Box makeBox(const Size& size) {
    return {size, std::vector<Cell>(std::size_t(size[0]) * std::size_t(size[1]) * std::size_t(size[2]))};
}

/// Calls `visit` with each place of [lo, hi), x fastest.
template <class Visit> void places(const Size& lo, const Size& hi, Visit&& visit) {
    for (int z = lo[2]; z < hi[2]; ++z)
        for (int y = lo[1]; y < hi[1]; ++y)
            for (int x = lo[0]; x < hi[0]; ++x) visit(Size{x, y, z});
}

/// The flags of a box in the places of the coded order: `steps` splits of what is left.
void split(Box& flags, int steps) {
    Size part = flags.size;
    for (int step = 0; step < steps; ++step, part = half(part)) {
        Box from = flags;
        places({0, 0, 0}, part, [&](const Size& p) {
            Size to;
            for (std::size_t a = 0; a < 3; ++a) to[a] = p[a] % 2 == 0 ? p[a] / 2 : (part[a] + 1) / 2 + p[a] / 2;
            flags.at(to) = from.at(p);
        });
    }
}

/// 4.7: adds to odd samples at full resolution what their even neighbours foresee, or makes those of a coarser level.
void predictOdd(Box& even, Box& odd, int level) {
    const auto power = std::int64_t(2) << level;
    const std::int64_t far[] = {-1, 9, 9, -1}, near[] = {0, power - 1, 1, 0};
    const std::int64_t* const weights = level == 0 ? far : near;
    const std::int64_t one = level == 0 ? 16 : power, whole = one * one * one;
    // An even sample, beyond the ends as the level says.
    const auto sampleAt = [&](auto&& self, Size at, std::size_t axis) -> std::int64_t {
        if (axis == 3) return asSigned(*even.at(at));
        const int last = even.size[axis] - 1;
        if (at[axis] >= 0 && at[axis] <= last) return self(self, at, axis + 1);
        const bool goesOn = level > 0 && at[axis] > last && last > 0;
        at[axis] = at[axis] < 0 ? 0 : last;
        const std::int64_t end = self(self, at, axis + 1);
        if (!goesOn) return end;
        --at[axis];
        return 2 * end - self(self, at, axis + 1);
    };
    places({0, 0, 0}, odd.size, [&](const Size& p) {
        std::int64_t sum = whole / 2;
        places({0, 0, 0}, {4, 4, 4}, [&](const Size& tap) {
            const std::int64_t weight = weights[tap[0]] * weights[tap[1]] * weights[tap[2]];
            if (weight != 0)
                sum += weight * sampleAt(sampleAt, {p[0] - 1 + tap[0], p[1] - 1 + tap[1], p[2] - 1 + tap[2]}, 0);
        });
        const auto foreseen = std::uint32_t(sum >= 0 ? sum / whole : -((-sum + whole - 1) / whole));
        odd.at(p) = level == 0 ? *odd.at(p) + foreseen : foreseen;
    });
}

/// 4.5
struct Band {
    Box* box = nullptr;
    Size lo{}, hi{};
    std::vector<std::uint32_t> magnitudes{};
    int size(std::size_t axis) const { return hi[axis] - lo[axis]; }
    std::uint32_t magnitude(int x, int y, int z) const {
        if (x < 0 || y < 0 || z < 0 || x >= size(0) || y >= size(1) || z >= size(2)) return 0;
        return magnitudes[(std::size_t(z) * std::size_t(size(1)) + std::size_t(y)) * std::size_t(size(0)) +
                          std::size_t(x)];
    }
};

std::uint32_t classOf(std::uint32_t sum) {
    std::uint32_t exponent = 0;
    while ((sum + 1) >> (exponent + 1) != 0) ++exponent;
    // Of sum + 1 = 2^exponent (1 + fraction): is the fraction at least a half?
    const bool upper = exponent > 0 && ((sum + 1) >> (exponent - 1) & 1) != 0;
    return 2 * exponent + (upper ? 1 : 0);
}

void decodeBands(const Octets& bytes, std::vector<Band>& bands, std::size_t level, const Decoder::Model& model) {
    Reader in(bytes);
    std::size_t rawBytes = 0;
    for (int shift = 0;; shift += 7) {
        const auto byte = in.number(1);
        rawBytes |= std::size_t(byte & 127) << shift;
        if (byte < 128) break;
    }
    const Octets raw = in.take(rawBytes);
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
    std::size_t chunk = 0;
    for (int z = 0; z < maxZ; ++z)
        for (int y = 0; y < maxY; ++y)
            for (Band& band : bands) {
                if (y >= band.size(1) || z >= band.size(2)) continue;
                for (int x = 0; x < band.size(0); ++x) {
                    const std::size_t group = (chunk + std::size_t(x) / 16) % groups;
                    Cell& cell = band.box->at(band.lo[0] + x, band.lo[1] + y, band.lo[2] + z);
                    if (!cell) continue;
                    const std::uint32_t sum = 2 * band.magnitude(x, y - 1, z) + band.magnitude(x - 1, y - 1, z) +
                                              band.magnitude(x + 1, y - 1, z) + 2 * band.magnitude(x, y, z - 1) +
                                              band.magnitude(x, y - 1, z - 1) + band.magnitude(x, y + 1, z - 1);
                    const auto& table = model.tables[model.tableOf[level * 32 + classOf(sum)]];
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
                    band.magnitudes[(std::size_t(z) * std::size_t(band.size(1)) + std::size_t(y)) *
                                        std::size_t(band.size(0)) +
                                    std::size_t(x)] = std::min<std::uint32_t>(magnitude, 4095);
                }
                chunk += std::size_t(band.size(0) + 15) / 16;
            }
    need(in.at == in.end && (rawAt + 7) / 8 == raw.size(), "trailing");
    for (const std::uint32_t state : states) need(state == 65536, "states");
}

} // namespace

/// 1.5
Decoder::Model Decoder::parseModel(const Piece& piece) const {
    const Octets bytes = checked(piece);
    std::size_t at = 0;
    const auto bits = [&](int count) {
        std::uint32_t value = 0;
        for (int i = 0; i < count; ++i, ++at) {
            need(at < 8 * bytes.size(), "model");
            value |= std::uint32_t(bytes[at / 8] >> (at % 8) & 1) << i;
        }
        return value;
    };
    Model model;
    model.shift = bits(8);
    const std::uint32_t tables = bits(8);
    std::uint32_t last = 0;
    for (int c = 0; c < 32 * levels_; ++c) {
        if (bits(1) == 1) last = bits(8);
        model.tableOf.push_back(last);
    }
    for (std::uint32_t t = 0; t < tables; ++t) {
        std::vector<std::uint32_t> table(141);
        std::uint32_t left = 4096;
        const std::uint32_t used = bits(8);
        for (std::uint32_t i = 0; i < used; ++i) {
            const int width = int(bits(4));
            if (width > 0) table[i] = (1u << (width - 1)) + bits(width - 1);
            left -= table[i];
        }
        table[140] = left;
        model.tables.push_back(table);
    }
    need((at + 7) / 8 == bytes.size(), "model");
    return model;
}

Decoder::Decoder(std::vector<char> file) : file_(file.begin(), file.end()) {
    // 1.1
    need(file_.size() >= 80, "no header");
    Piece parts[2];
    const auto readHeader = [&](std::size_t at) {
        const std::uint8_t magic[] = {0x89, 0x54, 0x53, 0x52, 0x0d, 0x0a, 0x1a, 0x0a};
        if (file_.size() < at + 80 || std::memcmp(file_.data() + at, magic, 8) != 0) return false;
        const Octets header(file_.begin() + std::ptrdiff_t(at), file_.begin() + std::ptrdiff_t(at) + 80);
        Reader in(header);
        (void)in.number(8);
        const std::uint32_t version = in.u32();
        const std::uint32_t features = in.u32();
        const std::uint64_t end = in.number(8);
        Piece found[2];
        for (Piece& part : found) part = readPiece(in);
        if (in.number(8) != XXH3_64bits(file_.data() + at, 72) || version < 1 || version > 3 ||
            features > (version < 3 ? 0 : 1))
            return false;
        if (version < 3 ? at > 0 || end != file_.size() : end > file_.size()) return false;
        if (end <= end_) return true; // the other copy is as good or better
        version_ = version;
        hasNotes_ = features == 1;
        end_ = end;
        std::copy(found, found + 2, parts);
        return true;
    };
    const bool first = readHeader(0);
    if (!first || version_ == 3) need(readHeader(80) || first, "header");
    need(parts[1].offset + parts[1].length == end_, "parts");
    if (version_ < 3) need(parts[0].offset + parts[0].length == parts[1].offset, "parts");

    // 1.2, 1.3
    Octets json = checked(parts[0]);
    if (version_ == 3) {
        Reader in(json);
        const std::size_t length = in.u32();
        json = in.take(std::size_t(in.end - in.at));
        if (json.size() != length) json = unzstd(json, length);
    }
    metadata_ = nlohmann::json::parse(json.begin(), json.end());
    const auto& lattice = metadata_["data"]["lattice"];
    bcc_ = lattice["kind"] == "bcc";
    size_ = lattice["size"].get<Size>();
    brickSize_ = metadata_["grid"]["brickSize"];
    levels_ = metadata_["grid"]["levels"];
    for (std::size_t a = 0; a < 3; ++a) {
        const int covered = brickSize_ * (a == 2 && bcc_ ? 2 : 1);
        bricks_[a] = (size_[a] + covered - 1) / covered;
    }
    for (const auto& parameter : metadata_["data"]["parameters"])
        for (int c = 0; c < parameter["components"].get<int>(); ++c) types_.push_back(parameter["type"]);

    // 1.4: pages, the last one first
    std::vector<Piece> covered{parts[0]};
    std::vector<Octets> pages;
    for (Piece page = parts[1];;) {
        pages.insert(pages.begin(), checked(page));
        covered.push_back(page);
        if (version_ < 3) break;
        Reader in(pages.front());
        const Piece before = readPiece(in), formerMetadata = readPiece(in);
        if (formerMetadata.offset > 0) {
            (void)checked(formerMetadata);
            covered.push_back(formerMetadata);
        }
        if (before.offset == 0) break;
        need(before.offset + before.length <= page.offset, "pages");
        page = before;
    }
    std::vector<double> times;
    std::vector<std::pair<std::size_t, Frame>> frames;
    for (const Octets& page : pages) readPage(page, times, frames, covered);
    if (version_ == 3) metadata_["data"]["times"] = times;
    need(frames.size() == types_.size() * metadata_["data"]["times"].size(), "frames");
    frames_.resize(frames.size());
    std::vector<bool> known(frames.size());
    for (auto& [number, frame] : frames) {
        need(number < frames.size() && !known[number], "frame number");
        known[number] = true;
        frames_[number] = std::move(frame);
    }

    // There are no gaps.
    std::sort(covered.begin(), covered.end(), [](const Piece& a, const Piece& b) {
        return std::pair(a.offset, a.length) < std::pair(b.offset, b.length);
    });
    std::size_t at = version_ < 3 ? 80 : 160;
    for (const Piece& piece : covered) {
        need(piece.offset == at, "gap");
        at += piece.length;
    }
    need(at == end_, "gap");
}

Decoder::Piece Decoder::readPiece(Reader& in) {
    const std::size_t offset = in.number(8), length = in.number(8);
    return {offset, length, in.number(8)};
}

void Decoder::readPage(const Octets& page, std::vector<double>& times,
                       std::vector<std::pair<std::size_t, Frame>>& frames, std::vector<Piece>& covered) {
    Reader table(page);
    if (version_ == 3) (void)table.take(48);
    const std::size_t timeCount = version_ == 3 ? table.u32() : 0, maskCount = table.u32(), frameCount = table.u32();
    const std::size_t modelCount = version_ > 1 ? table.u32() : 0;
    const std::size_t bricks = std::size_t(bricks_[0]) * std::size_t(bricks_[1]) * std::size_t(bricks_[2]);
    for (std::size_t t = 0; t < timeCount; ++t) times.push_back(table.f64());
    for (std::size_t m = 0; m < modelCount; ++m) {
        models_.push_back(readPiece(table));
        covered.push_back(models_.back());
    }
    for (std::size_t m = 0; m < maskCount; ++m) {
        Mask mask;
        std::size_t at = table.number(8);
        const std::size_t length = table.number(8), end = at + length;
        covered.push_back({at, length, 0});
        for (std::size_t b = 0; b < bricks; ++b) {
            const std::size_t bytes = table.u32();
            mask.present.push_back(table.u32());
            mask.pieces.push_back({at, bytes, table.number(8)});
            at += bytes;
        }
        need(at == end, "mask chunk");
        masks_.push_back(mask);
    }
    for (std::size_t f = 0; f < frameCount; ++f) {
        Frame frame;
        std::size_t number = frames.size();
        if (version_ == 3) {
            const std::size_t time = table.u32();
            number = time * types_.size() + table.u32();
        }
        std::size_t at = table.number(8);
        const std::size_t length = table.number(8), end = at + length;
        covered.push_back({at, length, 0});
        frame.numbers = int(table.number(1));
        frame.wavelet = int(table.number(1));
        const auto kept = table.number(1);
        frame.keepsAbsent = kept % 2 == 1;
        frame.bodyCentred = kept / 2 == 1;
        need(kept < (hasNotes_ ? 4u : 2u), "frame");
        (void)table.number(1); // width of the codes: what a fast reader wants to know
        need(frame.numbers < 4 && frame.wavelet < 12, "frame");
        frame.mask = int(table.u32());
        if (version_ > 1) frame.model = table.u32();
        need(frame.mask < int(masks_.size()) && (version_ == 1 || frame.model < models_.size()), "frame");
        frame.origin = table.f64();
        frame.step = table.f64();
        frame.valueOffset = table.f64();
        frame.valueScale = table.f64();
        for (std::size_t b = 0; b < bricks; ++b) {
            (void)table.number(8); // min, max
            if (!hasNotes_) continue;
            (void)table.take(10); // importance, detail, change
            frame.repeats.push_back(table.number(2));
        }
        for (std::size_t s = 0; s < bricks * std::size_t(levels_); ++s) {
            const std::size_t bytes = table.u32();
            frame.pieces.push_back({at, bytes, table.number(8)});
            at += bytes;
        }
        need(at == end, "frame chunk");
        frames.emplace_back(number, std::move(frame));
    }
    need(table.at == table.end, "index");
}

std::vector<std::uint8_t> Decoder::checked(const Piece& piece) const {
    need(piece.offset <= file_.size() && piece.length <= file_.size() - piece.offset, "outside");
    const std::uint8_t* at = file_.data() + piece.offset;
    need(XXH3_64bits(at, piece.length) == piece.checksum, "checksum");
    return {at, at + piece.length};
}

Size Decoder::fineSize(int number) const {
    const Size index{number % bricks_[0], number / bricks_[0] % bricks_[1], number / (bricks_[0] * bricks_[1])};
    Size size;
    for (std::size_t a = 0; a < 3; ++a) {
        const int covered = brickSize_ * (a == 2 && bcc_ ? 2 : 1);
        size[a] = std::min(size_[a] - index[a] * covered, covered);
    }
    return size;
}

/// 2
std::vector<bool> Decoder::fineFlags(const Frame& frame, int number, const Size& size) const {
    const std::size_t count = std::size_t(size[0]) * std::size_t(size[1]) * std::size_t(size[2]);
    if (frame.mask < 0) return std::vector<bool>(count, true);
    const Mask& mask = masks_[std::size_t(frame.mask)];
    const std::uint32_t present = mask.present[std::size_t(number)];
    const Octets bytes = checked(mask.pieces[std::size_t(number)]);
    if (present == 0 || present == count) return std::vector<bool>(count, present != 0);
    Octets bits(bytes.begin() + 1, bytes.end());
    if (bytes[0] == 1) bits = unzstd(bits, (count + 7) / 8);
    std::vector<bool> flags;
    for (std::size_t i = 0; i < count; ++i) flags.push_back((bits[i / 8] >> (i % 8) & 1) != 0);
    return flags;
}

Brick Decoder::brick(std::size_t frameNumber, int number, int level) const {
    const std::size_t repeats = hasNotes_ ? frames_[frameNumber].repeats[std::size_t(number)] * types_.size() : 0;
    need(repeats <= frameNumber, "repeats");
    const Frame& frame = frames_[frameNumber - repeats];
    need(repeats == 0 || frame.repeats[std::size_t(number)] == 0, "repeats");
    const std::string& type = types_[frameNumber % types_.size()];
    const Size fine = fineSize(number);
    const std::vector<bool> flags = fineFlags(frame, number, fine);
    const std::size_t bricks = std::size_t(bricks_[0]) * std::size_t(bricks_[1]) * std::size_t(bricks_[2]);
    const int sublattices = bcc_ ? 2 : 1;

    // The boxes of both sublattices at the wanted level, with flags where they are present.
    std::vector<Box> boxes;
    for (int s = 0; s < sublattices; ++s) {
        const Size whole{fine[0], fine[1], (fine[2] + sublattices - 1 - s) / sublattices};
        Size size = whole;
        for (int l = 0; l < level; ++l) size = half(size);
        Box box = makeBox(size);
        places({0, 0, 0}, size, [&](const Size& p) {
            const int z = (p[2] << level) * sublattices + s;
            const std::size_t at =
                (std::size_t(z) * std::size_t(fine[1]) + std::size_t(p[1] << level)) * std::size_t(fine[0]) +
                std::size_t(p[0] << level);
            if (flags[at]) box.at(p) = 0u;
        });
        split(box, levels_ - 1 - level);
        boxes.push_back(std::move(box));
    }

    // 4.1: every coefficient to its place.
    std::vector<std::uint32_t> absentBits, exactIndex, exactBits;
    const auto extras = [&](Reader& in) {
        if (frame.keepsAbsent) {
            std::size_t absent = 0;
            for (const bool flag : flags) absent += flag ? 0 : 1;
            absentBits = stream(in, absent);
        }
        if (frame.numbers == 1 || frame.numbers == 3) {
            const std::size_t exact = in.u32();
            exactIndex = stream(in, exact);
            exactBits = stream(in, exact);
        }
    };
    const bool centred = frame.bodyCentred && bcc_ && levels_ > 1 && fine[2] > 1 && frame.numbers != 2 &&
                         std::find(flags.begin(), flags.end(), false) == flags.end();
    bool whole = false;
    for (int segment = 0; segment < levels_ - level; ++segment) {
        const Octets bytes = checked(frame.pieces[std::size_t(segment) * bricks + std::size_t(number)]);
        Reader in(bytes);
        std::vector<Cell*> order;
        std::vector<Band> bands;
        for (Box& box : boxes) {
            if (centred && &box == &boxes[1]) { // undivided in the last segment, in no other
                if (segment < levels_ - 1) continue;
                bands.push_back({&box, {}, box.size});
                places({0, 0, 0}, box.size, [&](const Size& p) { order.push_back(&box.at(p)); });
                continue;
            }
            Size part = box.size;
            for (int l = level; l < levels_ - 1 - segment; ++l) part = half(part);
            const Size low = half(part);
            for (int band = segment == 0 ? 0 : 1; band < (segment == 0 ? 1 : 8); ++band) {
                Size lo{}, hi = segment == 0 ? part : low;
                for (std::size_t a = 0; a < 3; ++a)
                    if ((band >> a & 1) != 0) lo[a] = low[a], hi[a] = part[a];
                if (hi[0] > lo[0] && hi[1] > lo[1] && hi[2] > lo[2]) bands.push_back({&box, lo, hi});
                places(lo, hi, [&](const Size& p) {
                    if (box.at(p)) order.push_back(&box.at(p));
                });
            }
        }
        if (version_ == 1) {
            std::uint32_t code = segment == 0 && !order.empty() ? in.u32() : 0;
            if (segment == 0 && !order.empty()) *order[0] = code;
            const std::size_t first = segment == 0 && !order.empty() ? 1 : 0;
            const auto symbols = stream(in, order.size() - first);
            for (std::size_t i = first; i < order.size(); ++i)
                *order[i] = segment == 0 ? code += unzigzag(symbols[i - 1]) : unzigzag(symbols[i]);
            if (segment == levels_ - 1) extras(in);
            need(in.at == in.end, "trailing bytes");
            continue;
        }
        if (segment == levels_ - 1) extras(in);
        if (whole) {
            need(in.at == in.end, "trailing bytes");
            continue;
        }
        if (in.at == in.end && bands.empty()) continue;
        need(in.at < in.end, "no mode");
        if ((*in.at == 5 || *in.at == 6) && segment == 0) {
            whole = true;
            const bool indexed = in.number(1) == 6;
            std::vector<std::uint32_t> colours;
            if (indexed)
                for (const auto step : stream(in, std::size_t(in.number(1)) + 1))
                    colours.push_back(colours.empty() ? unzigzag(step) : colours.back() + step);
            std::size_t present = 0;
            for (const bool flag : flags) present += flag ? 1 : 0;
            const auto symbols = stream(in, present);
            need(in.at == in.end, "trailing bytes");
            const auto codeOf = [&](auto symbol) {
                need(!indexed || symbol < colours.size(), "index");
                return indexed ? colours[symbol] : unzigzag(symbol);
            };
            std::size_t next = 0;
            for (int s = 0; s < sublattices; ++s)
                boxes[std::size_t(s)] = makeBox({fine[0], fine[1], (fine[2] + sublattices - 1 - s) / sublattices});
            places({0, 0, 0}, fine, [&](const Size& p) {
                const std::size_t at =
                    (std::size_t(p[2]) * std::size_t(fine[1]) + std::size_t(p[1])) * std::size_t(fine[0]) +
                    std::size_t(p[0]);
                if (flags[at])
                    boxes[std::size_t(p[2] % sublattices)].at(p[0], p[1], p[2] / sublattices) = codeOf(symbols[next++]);
            });
        } else if (*in.at == 4) {
            (void)in.number(1);
            decodeBands(in.take(std::size_t(in.end - in.at)), bands, std::size_t(levels_ - 1 - segment),
                        parseModel(models_[frame.model]));
        } else if (order.empty()) {
            need(in.number(1) == 0, "mode");
        } else {
            const auto symbols = stream(in, order.size());
            for (std::size_t i = 0; i < order.size(); ++i) *order[i] = unzigzag(symbols[i]);
        }
        std::uint32_t code = 0;
        if (segment == 0 && !whole)
            for (Cell* cell : order) *cell = code += **cell;
        need(in.at == in.end, "trailing bytes");
    }

    // 4.3
    const bool asFloat = frame.numbers == 2;
    int wavelet = frame.wavelet;
    if (asFloat) wavelet = wavelet == 0 || (wavelet >= 2 && wavelet <= 4) ? 0 : 1;
    const auto alongLines = [&](Box& box, const Size& part, std::size_t axis, auto&& change) {
        const Size low = half(part);
        Size lines = part;
        lines[axis] = 1;
        places({0, 0, 0}, lines, [&](const Size& start) {
            bool samples = asFloat;
            for (std::size_t earlier = 0; earlier < axis; ++earlier) samples = samples && start[earlier] < low[earlier];
            std::vector<Cell> line;
            Size p = start;
            for (p[axis] = 0; p[axis] < part[axis]; ++p[axis]) line.push_back(box.at(p));
            line = change(line, wavelet, samples);
            for (p[axis] = 0; p[axis] < part[axis]; ++p[axis]) box.at(p) = line[std::size_t(p[axis])];
        });
    };
    for (Box& box : boxes) {
        if (whole) { // 4.4: the coarse samples are made again
            Size part = box.size;
            for (int step = 0; step < level; ++step, part = half(part))
                for (const std::size_t axis : {0u, 1u, 2u}) alongLines(box, part, axis, redo);
            Box coarse = makeBox(part);
            places({0, 0, 0}, part, [&](const Size& p) { coarse.at(p) = box.at(p); });
            box = coarse;
            if (centred && level > 0 && &box == &boxes[1]) predictOdd(boxes[0], box, level);
            continue;
        }
        if (centred && &box == &boxes[1]) {
            predictOdd(boxes[0], box, level);
            continue;
        }
        std::vector<Size> parts{box.size};
        for (int step = 0; step < levels_ - 1 - level; ++step) parts.push_back(half(parts.back()));
        for (std::size_t step = parts.size() - 1; step-- > 0;) {
            for (const std::size_t axis : {2u, 1u, 0u}) alongLines(box, parts[step], axis, undo);
        }
    }

    // 3, in storage order
    Brick out;
    out.size = boxes[0].size;
    if (bcc_) out.size[2] += boxes[1].size[2];
    std::size_t nextAbsent = 0;
    places({0, 0, 0}, out.size, [&](const Size& p) {
        const Cell cell = boxes[std::size_t(p[2] % sublattices)].at(p[0], p[1], p[2] / sublattices);
        const std::size_t at = out.values.size();
        out.present.push_back(cell.has_value());
        const std::uint32_t code = cell.value_or(0);
        double stored = double(asSigned(code));
        std::uint32_t bits = code;
        if (type == "float32") {
            float value = 0;
            if (frame.numbers == 1) value = float(stored / frame.step);
            if (frame.numbers == 2) value = floatOf(code);
            if (frame.numbers == 3) value = float(frame.origin + frame.step * stored);
            if (level == 0)
                for (std::size_t e = 0; e < exactIndex.size(); ++e)
                    if (exactIndex[e] == at) value = std::bit_cast<float>(exactBits[e]);
            stored = double(value);
            bits = std::bit_cast<std::uint32_t>(value);
        }
        if (!cell && level == 0 && frame.keepsAbsent) bits = absentBits[nextAbsent++];
        out.values.push_back(cell ? frame.valueOffset + frame.valueScale * stored : 0);
        out.bits.push_back(bits);
    });
    return out;
}

} // namespace tessera::codec::plain
