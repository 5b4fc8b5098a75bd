#include "app/importer/images/sample_stream.h"

#include "app/importer/readers/check_file.h"
#include "volume/base/error.h"
#include "volume/system/input_file.h"

#include <algorithm>
#include <bzlib.h>
#include <cctype>
#include <charconv>
#include <cstring>
#include <limits>
#include <memory>
#include <vector>
#include <zlib.h>

namespace tessera::importer {

namespace {

using volume::SampleEncoding;
using volume::SamplePart;
using volume::StoredImage;
using volume::StoredType;

constexpr std::size_t kPiece = 1 << 16;

/// Bytes that come one after the other.
class Decoder {
public:
    Decoder() = default;
    Decoder(const Decoder&) = delete;
    Decoder& operator=(const Decoder&) = delete;
    virtual ~Decoder() = default;
    /// Fills `to`, or as much of it as there is.
    virtual std::size_t take(std::span<char> to) = 0;
};

/// A file in pieces.
struct Pieces {
    std::ifstream in;
    std::vector<char> bytes = std::vector<char>(kPiece);

    Pieces(const std::string& path, std::uint64_t begin) : in(openInput(path)) { in.seekg(std::streamoff(begin)); }
    std::span<char> next() {
        in.read(bytes.data(), std::streamsize(bytes.size()));
        return std::span(bytes).first(std::size_t(std::max<std::streamsize>(in.gcount(), 0)));
    }
};

[[noreturn]] void throwDamaged() {
    throw Error("its compressed samples end early: truncated or damaged");
}

/// gzip (also several streams in a row) or zlib.
class Inflater : public Decoder {
public:
    Inflater(const std::string& path, std::uint64_t begin) : pieces_(path, begin) {
        constexpr int kAnyHeader = 15 + 32;
        if (inflateInit2(&stream_, kAnyHeader) != Z_OK) throw Error("cannot be decompressed");
    }
    ~Inflater() override { inflateEnd(&stream_); }
    std::size_t take(std::span<char> to) override {
        std::size_t got = 0;
        while (got < to.size()) {
            if (stream_.avail_in == 0) {
                const std::span<char> more = pieces_.next();
                stream_.next_in = reinterpret_cast<Bytef*>(more.data());
                stream_.avail_in = unsigned(more.size());
                if (more.empty() && ended_) return got;
                if (more.empty()) throwDamaged();
            }
            if (ended_) {
                if (*stream_.next_in != 0x1f) return got; // something else follows
                inflateReset(&stream_);
                ended_ = false;
            }
            const std::size_t room = std::min<std::size_t>(to.size() - got, 1u << 30);
            stream_.next_out = reinterpret_cast<Bytef*>(to.data() + got);
            stream_.avail_out = unsigned(room);
            const int status = inflate(&stream_, Z_NO_FLUSH);
            got += room - stream_.avail_out;
            ended_ = status == Z_STREAM_END;
            if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR) throwDamaged();
        }
        return got;
    }

private:
    Pieces pieces_;
    z_stream stream_{};
    bool ended_ = false;
};

class Bunzipper : public Decoder {
public:
    Bunzipper(const std::string& path, std::uint64_t begin) : pieces_(path, begin) { start(); }
    ~Bunzipper() override { BZ2_bzDecompressEnd(&stream_); }
    std::size_t take(std::span<char> to) override {
        std::size_t got = 0;
        while (got < to.size()) {
            if (stream_.avail_in == 0) {
                const std::span<char> more = pieces_.next();
                stream_.next_in = more.data();
                stream_.avail_in = unsigned(more.size());
                if (more.empty() && ended_) return got;
                if (more.empty()) throwDamaged();
            }
            if (ended_) {
                if (*stream_.next_in != 'B') return got;
                const bz_stream rest = stream_;
                BZ2_bzDecompressEnd(&stream_);
                start();
                stream_.next_in = rest.next_in;
                stream_.avail_in = rest.avail_in;
                ended_ = false;
            }
            const std::size_t room = std::min<std::size_t>(to.size() - got, 1u << 30);
            stream_.next_out = to.data() + got;
            stream_.avail_out = unsigned(room);
            const int status = BZ2_bzDecompress(&stream_);
            got += room - stream_.avail_out;
            ended_ = status == BZ_STREAM_END;
            if (status != BZ_OK && status != BZ_STREAM_END) throwDamaged();
        }
        return got;
    }

private:
    void start() {
        stream_ = bz_stream{};
        if (BZ2_bzDecompressInit(&stream_, 0, 0) != BZ_OK) throw Error("cannot be decompressed");
    }
    Pieces pieces_;
    bz_stream stream_{};
    bool ended_ = false;
};

/// Two hexadecimal digits for each byte, with white space anywhere.
class HexDigits : public Decoder {
public:
    HexDigits(const std::string& path, std::uint64_t begin) : pieces_(path, begin) {}
    std::size_t take(std::span<char> to) override {
        for (std::size_t got = 0; got < to.size(); ++got) {
            const int high = digit(), low = digit();
            if (low < 0) return got;
            to[got] = char(high * 16 + low);
        }
        return to.size();
    }

private:
    /// -1 at the end.
    int digit() {
        while (true) {
            if (rest_.empty()) rest_ = pieces_.next();
            if (rest_.empty()) return -1;
            const char c = rest_.front();
            rest_ = rest_.subspan(1);
            if (std::isspace(static_cast<unsigned char>(c)) != 0) continue;
            if (std::isxdigit(static_cast<unsigned char>(c)) == 0)
                throw Error("has \"" + std::string(1, c) + "\" where a hexadecimal digit belongs");
            return c <= '9' ? c - '0' : (c | 0x20) - 'a' + 10;
        }
    }
    Pieces pieces_;
    std::span<char> rest_;
};

/// Bytes that have been decoded before.
class Decoded : public Decoder {
public:
    explicit Decoded(std::shared_ptr<const std::vector<char>> bytes) : bytes_(std::move(bytes)) {}
    std::size_t take(std::span<char> to) override {
        const std::size_t count = std::min(to.size(), bytes_->size() - at_);
        std::copy_n(bytes_->begin() + std::ptrdiff_t(at_), count, to.begin());
        at_ += count;
        return count;
    }

private:
    std::shared_ptr<const std::vector<char>> bytes_;
    std::size_t at_ = 0;
};

template <class T> void appendNumber(std::string_view word, std::vector<char>& out) {
    const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
    const char *begin = digits.data(), *end = begin + digits.size();
    T value{};
    auto parsed = std::from_chars(begin, end, value);
    if constexpr (std::is_integral_v<T>)
        if (parsed.ec == std::errc() && parsed.ptr != end) { // "3.0" and "3e2" are integers, too
            double real = 0;
            parsed = std::from_chars(begin, end, real);
            if (real >= double(std::numeric_limits<T>::min()) && real <= double(std::numeric_limits<T>::max()) &&
                double(T(real)) == real)
                value = T(real);
            else
                parsed.ec = std::errc::result_out_of_range;
        }
    if constexpr (!std::is_integral_v<T>)
        if (parsed.ec == std::errc::result_out_of_range) { // too small or too large for the type: 0 or infinity
            value = T(std::strtod(std::string(digits).c_str(), nullptr));
            parsed.ec = std::errc();
        }
    if (parsed.ec == std::errc::result_out_of_range)
        throw Error("has \"" + std::string(word.substr(0, 40)) + "\", which its type of samples does not hold");
    if (parsed.ec != std::errc() || parsed.ptr != end)
        throw Error("has \"" + std::string(word.substr(0, 40)) + "\" where a number belongs");
    const std::size_t at = out.size();
    out.resize(at + sizeof(T));
    std::memcpy(out.data() + at, &value, sizeof(T));
}

/// Numbers between white space or commas, as bytes in the order of this machine: so many at most.
std::vector<char> numbersOf(std::string_view text, StoredType type, std::size_t most) {
    constexpr std::string_view kBetween = " \t\r\n\f\v,";
    std::vector<char> out;
    std::size_t count = 0;
    for (std::size_t at = text.find_first_not_of(kBetween); at != std::string_view::npos && count < most;
         at = text.find_first_not_of(kBetween, at), ++count) {
        const std::size_t end = std::min(text.find_first_of(kBetween, at), text.size());
        const std::string_view word = text.substr(at, end - at);
        at = end;
        switch (type) {
        case StoredType::I8:
            appendNumber<std::int8_t>(word, out);
            break;
        case StoredType::U8:
            appendNumber<std::uint8_t>(word, out);
            break;
        case StoredType::I16:
            appendNumber<std::int16_t>(word, out);
            break;
        case StoredType::U16:
            appendNumber<std::uint16_t>(word, out);
            break;
        case StoredType::I32:
            appendNumber<std::int32_t>(word, out);
            break;
        case StoredType::U32:
            appendNumber<std::uint32_t>(word, out);
            break;
        case StoredType::I64:
            appendNumber<std::int64_t>(word, out);
            break;
        case StoredType::U64:
            appendNumber<std::uint64_t>(word, out);
            break;
        case StoredType::F32:
            appendNumber<float>(word, out);
            break;
        case StoredType::F64:
            appendNumber<double>(word, out);
            break;
        }
    }
    return out;
}

/// The samples of one file after the other, each read forwards.
class Streams {
public:
    Streams(const StoredImage& image, std::vector<SamplePart> parts)
        : type_(image.type), files_(image.files), parts_(std::move(parts)),
          each_(std::uint64_t(image.bytes()) / parts_.size()) {}

    void read(std::uint64_t offset, std::span<char> to) {
        while (!to.empty()) {
            const auto part = std::size_t(offset / each_);
            const std::uint64_t within = offset % each_;
            if (part >= parts_.size()) throw Error("ends early");
            if (decoder_ == nullptr || part != part_ || at_ > within) open(part);
            for (std::vector<char> skipped(kPiece); at_ < within;)
                fill(std::span(skipped).first(std::size_t(std::min<std::uint64_t>(kPiece, within - at_))));
            const auto count = std::size_t(std::min<std::uint64_t>(to.size(), each_ - within));
            fill(to.first(count));
            offset += count;
            to = to.subspan(count);
        }
    }

private:
    void open(std::size_t part) {
        part_ = part;
        at_ = 0;
        decoder_ = makeDecoder(part);
        if (!isPacked()) return;
        std::vector<char> skipped(kPiece);
        for (std::uint64_t left = bytesBefore(part); left > 0;) {
            const auto count = std::size_t(std::min<std::uint64_t>(left, kPiece));
            if (decoder_->take(std::span(skipped).first(count)) != count) throwShort();
            left -= count;
        }
    }

    /// Decoded bytes to skip, which only the whole stream tells where they are stated from its end.
    std::uint64_t bytesBefore(std::size_t part) {
        if (files_.byteSkip >= 0) return std::uint64_t(files_.byteSkip);
        std::vector<char> piece(kPiece);
        std::uint64_t all = 0;
        for (std::size_t got = kPiece; got == kPiece; all += got) got = decoder_->take(piece);
        decoder_ = makeDecoder(part);
        const std::uint64_t wanted = each_ + std::uint64_t(-(files_.byteSkip + 1));
        if (all < wanted) throwShort();
        return all - wanted;
    }

    std::unique_ptr<Decoder> makeDecoder(std::size_t part) {
        const SamplePart& from = parts_[part];
        if (files_.encoding == SampleEncoding::Deflate) return std::make_unique<Inflater>(from.path, from.begin);
        if (files_.encoding == SampleEncoding::Bzip2) return std::make_unique<Bunzipper>(from.path, from.begin);
        if (files_.encoding == SampleEncoding::Hex) return std::make_unique<HexDigits>(from.path, from.begin);
        if (text_ == nullptr || textOf_ != part) {
            const std::string text = readPart(from.path, std::size_t(from.begin), std::size_t(from.size));
            text_ = std::make_shared<const std::vector<char>>(
                numbersOf(text, type_, std::size_t(each_ / volume::sizeOf(type_))));
            textOf_ = part;
        }
        return std::make_unique<Decoded>(text_);
    }

    void fill(std::span<char> to) {
        if (decoder_->take(to) != to.size()) throwShort();
        at_ += to.size();
        if (at_ == each_ && isPacked()) finish();
    }

    /// Reads on to the end of the stream, whose checksum tells of samples that are not those that were stored.
    void finish() {
        constexpr std::size_t kMostRest = std::size_t(64) << 20; // what follows the samples is not read without end
        std::vector<char> rest(kPiece);
        for (std::size_t left = kMostRest; left > 0 && decoder_->take(rest) == rest.size();) left -= rest.size();
    }

    bool isPacked() const {
        return files_.encoding == SampleEncoding::Deflate || files_.encoding == SampleEncoding::Bzip2;
    }

    [[noreturn]] void throwShort() {
        decoder_ = nullptr;
        const std::string& name = parts_[part_].name;
        throw Error((name.empty() ? "" : "its file " + name + " ") + "holds fewer samples than it announces");
    }

    StoredType type_;
    volume::SampleFiles files_;
    std::vector<SamplePart> parts_;
    std::uint64_t each_;
    std::unique_ptr<Decoder> decoder_;
    std::size_t part_ = 0, textOf_ = 0;
    std::uint64_t at_ = 0; ///< decoded bytes of the part that have been taken
    std::shared_ptr<const std::vector<char>> text_;
};

} // namespace

volume::ReadBytes samplesOf(const StoredImage& image, const std::string& header) {
    std::vector<SamplePart> parts = volume::partsOf(image, header);
    if (image.files.encoding == SampleEncoding::Raw) return volume::readerOf(image, std::move(parts));
    double stored = 0;
    for (const SamplePart& part : parts) stored += double(part.size);
    refuseHollow(image.bytes(), stored);
    const bool text = image.files.encoding == SampleEncoding::Text || image.files.encoding == SampleEncoding::Hex;
    if (text && double(image.samples()) > stored) // of text at least a digit each
        throw Error("holds fewer samples than it announces");
    auto streams = std::make_shared<Streams>(image, std::move(parts));
    return [streams](std::uint64_t offset, std::span<char> to) { streams->read(offset, to); };
}

SampleEncoding compressionOf(const std::string& path) {
    const std::string head = readPart(path, 0, 3);
    if (head.starts_with("\x1f\x8b")) return SampleEncoding::Deflate;
    return head == "BZh" ? SampleEncoding::Bzip2 : SampleEncoding::Raw;
}

std::string inflatedPart(const std::string& path, std::size_t count) {
    const SampleEncoding packed = compressionOf(path);
    if (packed == SampleEncoding::Raw) return readPart(path, 0, count);
    std::string bytes(count, '\0');
    if (packed == SampleEncoding::Deflate)
        bytes.resize(Inflater(path, 0).take(bytes));
    else
        bytes.resize(Bunzipper(path, 0).take(bytes));
    return bytes;
}

} // namespace tessera::importer
