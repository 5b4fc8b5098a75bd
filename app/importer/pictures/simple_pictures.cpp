// BMP and the formats of Netpbm (PBM, PGM, PPM, PFM), which are simple enough to be read here.
#include "app/importer/pictures/picture_files.h"
#include "app/importer/readers/check_file.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <string_view>

namespace tessera::importer {

namespace {

constexpr std::size_t kMostPicture = std::size_t(4) << 30;

std::string bytesOfPicture(const std::string& path) {
    if (bytesIn(path) > kMostPicture) throw std::runtime_error("is too large for a picture");
    return readWhole(path);
}

std::uint32_t littleEndian(const std::string& bytes, std::size_t at, std::size_t count) {
    std::uint32_t value = 0;
    for (std::size_t i = count; i-- > 0;)
        value = value * 256 + (at + i < bytes.size() ? static_cast<unsigned char>(bytes[at + i]) : 0u);
    return value;
}

/// The numbers of the header of a Netpbm file, which may have comments between them.
class NetpbmWords {
public:
    NetpbmWords(const std::string& bytes, std::size_t at) : bytes_(bytes), at_(at) {}

    std::string_view next() {
        while (at_ < bytes_.size()) {
            if (bytes_[at_] == '#')
                at_ = std::min(bytes_.size(), bytes_.find('\n', at_));
            else if (std::isspace(static_cast<unsigned char>(bytes_[at_])) != 0)
                ++at_;
            else
                break;
        }
        const std::size_t begin = at_;
        while (at_ < bytes_.size() && std::isspace(static_cast<unsigned char>(bytes_[at_])) == 0) ++at_;
        return std::string_view(bytes_).substr(begin, at_ - begin);
    }
    std::uint32_t number() {
        const std::string_view word = next();
        std::uint32_t value = 0;
        const auto parsed = std::from_chars(word.data(), word.data() + word.size(), value);
        if (word.empty() || parsed.ec != std::errc() || parsed.ptr != word.data() + word.size())
            throw std::runtime_error("ends early or has \"" + std::string(word.substr(0, 20)) +
                                     "\" where a number belongs");
        return value;
    }
    /// A digit of a PBM file in ASCII, which may stand beside the next.
    char digit() {
        while (at_ < bytes_.size() && std::isspace(static_cast<unsigned char>(bytes_[at_])) != 0) ++at_;
        return at_ < bytes_.size() ? bytes_[at_++] : '\0';
    }
    std::size_t samplesAt() const { return at_ + 1; } ///< after one blank
private:
    const std::string& bytes_;
    std::size_t at_;
};

template <class T> void putSample(std::vector<char>& rows, std::size_t index, T value) {
    const char* bytes = reinterpret_cast<const char*>(&value);
    std::copy_n(bytes, sizeof value, rows.begin() + std::ptrdiff_t(index * sizeof value));
}

/// Samples as words of a text.
void readTextSamples(NetpbmWords& words, char kind, std::uint32_t most, Picture& picture) {
    const std::size_t count = std::size_t(picture.form.width) * picture.form.height * std::size_t(picture.form.samples);
    for (std::size_t i = 0; i < count; ++i) {
        std::uint32_t value = 0;
        if (kind == '1') {
            const char digit = words.digit();
            if (digit != '0' && digit != '1') throw std::runtime_error("holds fewer samples than it announces");
            value = digit == '1' ? 1 : 0;
        } else {
            value = words.number();
        }
        if (value > most) throw std::runtime_error("has a sample beyond its highest value");
        if (picture.form.bits == 16)
            putSample(picture.rows, i, std::uint16_t(value));
        else
            putSample(picture.rows, i, std::uint8_t(value));
    }
}

/// PFM: floats of 32 bits, the lowest row first; a negative scale means little-endian.
Picture readFloats(const std::string& bytes, int samples) {
    NetpbmWords words(bytes, 2);
    Picture picture;
    picture.form = {words.number(), words.number(), 32, samples, PixelNumbers::Float};
    const double scale = std::strtod(std::string(words.next()).c_str(), nullptr);
    const std::size_t begin = words.samplesAt(), row = picture.form.rowBytes();
    wantBytes(double(bytes.size()) - double(begin), double(row) * picture.form.height);
    picture.rows.resize(picture.form.bytes());
    for (std::size_t y = 0; y < picture.form.height; ++y)
        std::copy_n(bytes.begin() + std::ptrdiff_t(begin + y * row), row,
                    picture.rows.begin() + std::ptrdiff_t((picture.form.height - 1 - y) * row));
    if ((scale < 0) != (std::endian::native == std::endian::little))
        for (std::size_t i = 0; i + 4 <= picture.rows.size(); i += 4)
            std::reverse(picture.rows.begin() + std::ptrdiff_t(i), picture.rows.begin() + std::ptrdiff_t(i + 4));
    return picture;
}

/// The header of a BMP file.
struct BmpForm {
    std::uint32_t width = 0, height = 0, bits = 0, colours = 0, samplesAt = 0, paletteAt = 0, paletteStep = 4;
    bool topDown = false;
};

BmpForm formOfBmp(const std::string& bytes) {
    if (bytes.size() < 30 || !bytes.starts_with("BM")) throw std::runtime_error("is no BMP picture");
    BmpForm form;
    form.samplesAt = littleEndian(bytes, 10, 4);
    const std::uint32_t header = littleEndian(bytes, 14, 4);
    form.paletteAt = 14 + header;
    std::uint32_t method = 0;
    if (header == 12) { // the oldest form
        form.width = littleEndian(bytes, 18, 2);
        form.height = littleEndian(bytes, 20, 2);
        form.bits = littleEndian(bytes, 24, 2);
        form.paletteStep = 3;
    } else {
        form.width = littleEndian(bytes, 18, 4);
        const auto height = static_cast<std::int32_t>(littleEndian(bytes, 22, 4));
        form.topDown = height < 0;
        form.height = std::uint32_t(std::abs(std::int64_t(height)));
        form.bits = littleEndian(bytes, 28, 2);
        method = littleEndian(bytes, 30, 4);
        form.colours = littleEndian(bytes, 46, 4);
    }
    const bool known = form.bits == 1 || form.bits == 4 || form.bits == 8 || form.bits == 24 || form.bits == 32;
    constexpr std::uint32_t kMasks = 3; // of 32 bits, which programs write in the usual order
    if (!known || (method != 0 && !(method == kMasks && form.bits == 32)))
        throw std::runtime_error("is a compressed BMP, or has " + std::to_string(form.bits) +
                                 " bits a pixel, which is not read: write it as PNG");
    constexpr std::uint32_t kMostSide = 1u << 20;
    if (form.width == 0 || form.height == 0 || form.width > kMostSide || form.height > kMostSide)
        throw std::runtime_error("states an impossible size");
    return form;
}

} // namespace

Picture readPnm(const std::string& path) {
    const std::string bytes = bytesOfPicture(path);
    const char kind = bytes.size() > 2 && bytes[0] == 'P' ? bytes[1] : '\0';
    Picture picture;
    if (kind == 'f' || kind == 'F') {
        picture = readFloats(bytes, kind == 'F' ? 3 : 1);
        picture.names = pictureNames(picture.form.samples);
        return picture;
    }
    if (kind < '1' || kind > '6') throw std::runtime_error("is no picture of Netpbm (P1 to P6, Pf, PF)");
    const bool bitmap = kind == '1' || kind == '4', text = kind <= '3';
    NetpbmWords words(bytes, 2);
    picture.form.width = words.number();
    picture.form.height = words.number();
    const std::uint32_t most = bitmap ? 1 : words.number();
    if (most < 1 || most > 65535) throw std::runtime_error("states an impossible highest value");
    picture.form.samples = kind == '3' || kind == '6' ? 3 : 1;
    picture.form.bits = bitmap && !text ? 1 : most > 255 ? 16 : 8;
    picture.names = pictureNames(picture.form.samples);
    if (bitmap) picture.note = "The numbers are as stored, where 1 stands for black.";
    if (text) {
        wantBytes(double(bytes.size()), double(picture.form.width) * picture.form.height * picture.form.samples);
        picture.rows.resize(picture.form.bytes());
        readTextSamples(words, kind, most, picture);
        return picture;
    }
    const std::size_t begin = words.samplesAt();
    wantBytes(double(bytes.size()) - double(begin), double(picture.form.rowBytes()) * picture.form.height);
    picture.rows.assign(bytes.begin() + std::ptrdiff_t(begin),
                        bytes.begin() + std::ptrdiff_t(begin + picture.form.bytes()));
    if (picture.form.bits == 16 && std::endian::native == std::endian::little)
        for (std::size_t i = 0; i + 1 < picture.rows.size(); i += 2) std::swap(picture.rows[i], picture.rows[i + 1]);
    return picture;
}

Picture readBmp(const std::string& path) {
    const std::string bytes = bytesOfPicture(path);
    const BmpForm form = formOfBmp(bytes);
    const std::size_t row = (std::size_t(form.width) * form.bits + 31) / 32 * 4;
    wantBytes(double(bytes.size()) - double(form.samplesAt), double(row) * form.height);
    Picture picture;
    picture.form = {form.width, form.height, 8, form.bits == 32 ? 4 : form.bits == 24 ? 3 : 1, PixelNumbers::Unsigned};
    picture.rows.resize(picture.form.bytes());
    for (std::size_t y = 0; y < form.height; ++y) {
        const std::size_t from = form.samplesAt + (form.topDown ? y : form.height - 1 - y) * row;
        char* to = picture.rows.data() + y * picture.form.rowBytes();
        for (std::size_t x = 0; x < form.width; ++x) {
            if (form.bits >= 24) { // blue, green, red
                const std::size_t step = form.bits / 8;
                for (std::size_t c = 0; c < step; ++c) to[x * step + c] = bytes[from + x * step + (c < 3 ? 2 - c : c)];
                continue;
            }
            const std::size_t bit = x * form.bits;
            const auto byte = static_cast<unsigned char>(bytes[from + bit / 8]);
            to[x] = static_cast<char>((byte >> (8 - form.bits - bit % 8)) & ((1u << form.bits) - 1u));
        }
    }
    picture.names = pictureNames(picture.form.samples);
    if (form.bits <= 8) {
        const std::uint32_t most = 1u << form.bits, count = form.colours == 0 ? most : std::min(form.colours, most);
        std::vector<unsigned char> palette;
        for (std::uint32_t i = 0; i < count; ++i)
            for (const std::uint32_t c : {2u, 1u, 0u})
                palette.push_back(static_cast<unsigned char>(
                    littleEndian(bytes, std::size_t(form.paletteAt) + std::size_t(i) * form.paletteStep + c, 1)));
        applyPalette(picture, palette);
    }
    return picture;
}

} // namespace tessera::importer
