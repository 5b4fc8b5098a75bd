#include "tests/codec/plain/decoder.h"

#include "tests/codec/plain/codes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <xxhash.h>

namespace tessera::codec::plain {

/// 4.6
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
    if (bytes.empty()) {
        model.tableOf.assign(std::size_t(8 * levels_), std::vector<std::uint32_t>(32));
        model.tables.assign(1, std::vector<std::uint32_t>(141));
        model.tables[0][0] = model.tables[0][140] = 2048;
        return model;
    }
    model.shift = bits(6);
    model.fitted = bits(1) == 1;
    need(!model.fitted || knowsFits_, "fitted predictions");
    model.byBand = bits(1) == 1;
    need(!model.byBand || knowsBands_, "contexts by band");
    const std::uint32_t tables = bits(8);
    std::uint32_t last = 0;
    std::vector<std::uint32_t> ofClasses(32);
    for (int level = 0; level < levels_; ++level)
        for (int kind = 0; kind < 8; ++kind) {
            const bool apart = kind == 0 || (model.byBand && level < 2);
            if (apart && (!model.byBand || bits(1) == 1))
                for (std::uint32_t& table : ofClasses) {
                    if (bits(1) == 1) last = bits(8);
                    table = last;
                }
            model.tableOf.push_back(ofClasses);
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
    if (model.fitted) { // 4.11
        constexpr std::size_t kTaps[] = {26, 28, 34, 40};
        for (std::size_t i = 0; i < 12; ++i) {
            if (bits(1) == 0) continue;
            std::vector<std::int32_t> weights(kTaps[i % 4] + 1);
            weights[0] = weights[1] = 128;
            for (int c = 0; c < 32; ++c) {
                const int width = int(bits(5));
                for (std::int32_t& weight : weights) weight += std::int32_t(unzigzag(bits(width)));
                model.weights[i].push_back(weights);
            }
        }
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
        if (in.number(8) != XXH3_64bits(file_.data() + at, 72) || version != 3 ||
            (features & ~(1023u | 2048u | 4096u | 8192u | 16384u)) != 0)
            return false;
        if (end > file_.size()) return false;
        if (end <= end_) return true; // the other copy is as good or better
        hasNotes_ = features % 2 == 1;
        compact_ = features / 2 % 2 == 1;
        knowsBands_ = features / 4 % 2 == 1;
        hasStatistics_ = features / 8 % 2 == 1;
        knowsSteps_ = features / 16 % 2 == 1;
        knowsSubsamples_ = features / 32 % 2 == 1;
        knowsPredictions_ = features / 64 % 2 == 1;
        knowsFits_ = features / 128 % 2 == 1;
        knowsMixed_ = features / 256 % 2 == 1;
        knowsCorrections_ = features / 512 % 2 == 1;
        knowsParts_ = features / 2048 % 2 == 1;
        knowsSteppedIntegers_ = features / 4096 % 2 == 1;
        knowsNumbers_ = features / 8192 % 2 == 1;
        end_ = end;
        std::copy(found, found + 2, parts);
        return true;
    };
    const bool first = readHeader(0);
    need(readHeader(80) || first, "header");
    need(parts[1].offset + parts[1].length == end_, "parts");

    // 1.2, 1.3
    Octets json = checked(parts[0]);
    if (compact_) {
        json = piece(json);
    } else {
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
    std::size_t pageBytes = 0;
    for (Piece page = parts[1];;) {
        pages.insert(pages.begin(), compact_ ? piece(checked(page)) : checked(page));
        covered.push_back(page);
        pageBytes += pages.front().size();
        need(!compact_ || pageBytes <= (std::size_t(1) << 22) + 16 * end_, "too many pages");
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
    metadata_["data"]["times"] = times;
    need(frames.size() == types_.size() * metadata_["data"]["times"].size(), "frames");
    frames_.resize(frames.size());
    std::vector<bool> known(frames.size());
    for (auto& [number, frame] : frames) {
        need(number < frames.size() && !known[number], "frame number");
        known[number] = true;
        frames_[number] = std::move(frame);
    }

    // 1.7
    if (metadata_.contains("corrections")) {
        need(knowsCorrections_, "corrections");
        for (const auto& range : metadata_["corrections"]) {
            const std::size_t offset = range["offset"], length = range["length"];
            need(offset <= end_ && length <= end_ - offset, "corrections");
            covered.push_back({offset, length, 0});
            const auto begin = file_.begin() + std::ptrdiff_t(offset);
            corrections_.emplace_back(std::vector<char>(begin, begin + std::ptrdiff_t(length)));
            const Decoder& inner = corrections_.back();
            need(inner.end_ == length && inner.corrections_.empty() && !inner.bcc_, "corrections");
            need(inner.size_ == metadata_["source"]["size"].get<Size>(), "corrections");
        }
    }

    // 1.8: they are not needed for samples
    if (metadata_.contains("numbers")) {
        need(knowsNumbers_, "numbers");
        for (const auto& range : metadata_["numbers"]) {
            const std::size_t offset = range["offset"], length = range["length"];
            need(length > 8 && offset <= end_ && length <= end_ - offset, "numbers");
            covered.push_back({offset, length, 0});
            std::uint64_t stated = 0;
            for (std::size_t i = 8; i-- > 0;) stated = stated << 8 | file_[offset + i];
            need(XXH3_64bits(file_.data() + offset + 8, length - 8) == stated, "numbers");
        }
    }

    // There are no gaps.
    std::sort(covered.begin(), covered.end(), [](const Piece& a, const Piece& b) {
        return std::pair(a.offset, a.length) < std::pair(b.offset, b.length);
    });
    std::size_t at = 160;
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
    (void)table.take(48);
    const std::size_t timeCount = table.u32(), maskCount = table.u32(), frameCount = table.u32();
    const std::size_t modelCount = table.u32();
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
        const std::size_t time = table.u32(), number = time * types_.size() + table.u32();
        std::size_t at = table.number(8);
        const std::size_t length = table.number(8), end = at + length;
        covered.push_back({at, length, 0});
        frame.numbers = int(table.number(1));
        frame.wavelet = int(table.number(1));
        const auto kept = table.number(1);
        frame.keepsAbsent = kept % 2 == 1;
        frame.bodyCentred = kept / 2 % 2 == 1;
        frame.subsampled = kept / 4 % 2 == 1;
        frame.predicted = kept / 8 % 2 == 1;
        frame.parted = kept / 32 == 1;
        need(hasNotes_ || !frame.bodyCentred, "frame");
        need((knowsSubsamples_ && levels_ > 1) || !frame.subsampled, "frame");
        need(!frame.predicted || (knowsPredictions_ && frame.numbers == 4 && time > 0), "frame");
        need(!frame.parted || (knowsParts_ && frame.numbers == 4 && metadata_["data"]["lattice"]["kind"] == "cc"),
             "frame");
        need(kept < 64 && kept / 16 % 2 == 0, "frame");
        frame.codeBits = int(table.number(1));
        need(frame.numbers < (knowsSteps_ ? 5 : 4) && frame.wavelet < 12, "frame");
        const bool isInteger = types_[number % types_.size()] != "float32";
        need(isInteger ? frame.numbers == 0 || (frame.numbers == 4 && knowsSteppedIntegers_) : frame.numbers > 0,
             "frame");
        frame.mask = int(table.u32());
        frame.model = table.u32();
        need(frame.mask < int(masks_.size()) && frame.model < models_.size(), "frame");
        frame.origin = table.f64();
        frame.step = table.f64();
        need(!isInteger || frame.numbers == 0 || (std::isfinite(frame.origin) && std::isfinite(frame.step)), "frame");
        frame.valueOffset = table.f64();
        frame.valueScale = table.f64();
        for (std::size_t b = 0; b < bricks; ++b) {
            const float min = std::bit_cast<float>(table.u32()), max = std::bit_cast<float>(table.u32());
            frame.ranges.push_back({min, max});
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
    const Octets bits = table.take(hasStatistics_ ? std::size_t(table.end - table.at) : 0);
    std::size_t at = 0;
    for (std::size_t f = frames.size() - frameCount; hasStatistics_ && f < frames.size(); ++f)
        readStatistics(bits, frames[f].second, at);
    need((at + 7) / 8 == bits.size(), "statistics");
    need(at % 8 == 0 || bits.back() >> (at % 8) == 0, "statistics");
    need(table.at == table.end, "index");
}

/// 1.6
void Decoder::readStatistics(const Octets& bits, Frame& frame, std::size_t& at) const {
    const auto take = [&](std::size_t count) {
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < count; ++i, ++at) {
            need(at < 8 * bits.size(), "statistics");
            value |= std::uint32_t(bits[at / 8] >> (at % 8) & 1) << i;
        }
        return value;
    };
    const auto bitsOf = [](std::uint64_t n) {
        std::size_t count = 0;
        for (; n > 0; n /= 2) ++count;
        return count;
    };
    for (std::size_t b = 0; b < frame.ranges.size(); ++b) {
        Statistics& brick = frame.statistics.emplace_back();
        const auto [min, max] = frame.ranges[b];
        if ((hasNotes_ && frame.repeats[b] > 0) || !(min <= max)) continue;
        const Size size = fineSize(int(b));
        brick.samples = std::uint64_t(size[0]) * std::uint64_t(size[1]) * std::uint64_t(size[2]);
        if (frame.mask >= 0) brick.samples = masks_[std::size_t(frame.mask)].present[b];
        if (frame.numbers > 0 && take(1) == 1) {
            const std::uint64_t others = take(bitsOf(brick.samples));
            need(others > 0 && others < brick.samples, "statistics");
            brick.samples -= others;
        }
        brick.mean = double(min);
        if (!std::isfinite(min) || !std::isfinite(max) || min == max) {
            brick.counts = {std::uint32_t(brick.samples)};
            continue;
        }
        brick.mean += (double(max) - double(min)) * take(24) / double(0xffffff);
        const std::size_t width = bitsOf(brick.samples) / 2;
        std::vector<std::uint32_t> parts{std::uint32_t(brick.samples)};
        // Depth first: the next part to divide is the first one that is too long.
        std::vector<std::size_t> lengths{std::size_t(1) << std::min<std::size_t>(width < 4 ? 0 : width - 4, 5)};
        for (std::size_t p = 0; p < parts.size();) {
            if (lengths[p] == 1) {
                ++p;
                continue;
            }
            const std::uint32_t low = parts[p] == 0 ? 0 : take(bitsOf(parts[p]));
            need(low <= parts[p], "statistics");
            const auto place = std::ptrdiff_t(p);
            parts.insert(parts.begin() + place, low);
            parts[p + 1] -= low;
            lengths.insert(lengths.begin() + place, lengths[p] / 2);
            lengths[p + 1] /= 2;
        }
        brick.counts = parts;
    }
}

Statistics Decoder::statistics(std::size_t frame, int number) const {
    const std::size_t repeats = frames_[frame].repeats[std::size_t(number)] * types_.size();
    return frames_[frame - repeats].statistics[std::size_t(number)];
}

std::vector<std::uint8_t> Decoder::checked(const Piece& piece) const {
    need(piece.offset <= file_.size() && piece.length <= file_.size() - piece.offset, "outside");
    const std::uint8_t* at = file_.data() + piece.offset;
    need(XXH3_64bits(at, piece.length) == piece.checksum, "checksum");
    return {at, at + piece.length};
}

} // namespace tessera::codec::plain
