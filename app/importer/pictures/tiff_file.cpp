#include "app/importer/pictures/tiff_file.h"

#include "app/importer/readers/source.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

namespace tessera::importer {

namespace {

std::string libraryError; // the first since it was last cleared

void noteError(const char*, const char* format, va_list arguments) {
    char text[300];
    std::vsnprintf(text, sizeof text, format, arguments);
    if (libraryError.empty()) libraryError = text;
}

[[noreturn]] void failTiff() {
    throw std::runtime_error("ends early or is damaged" + (libraryError.empty() ? "" : ": " + libraryError));
}

PixelNumbers numbersOf(std::uint16_t format) {
    switch (format) {
    case SAMPLEFORMAT_INT:
        return PixelNumbers::Signed;
    case SAMPLEFORMAT_IEEEFP:
        return PixelNumbers::Float;
    case SAMPLEFORMAT_COMPLEXIEEEFP:
        return PixelNumbers::Complex;
    case SAMPLEFORMAT_COMPLEXINT:
        throw std::runtime_error("has complex whole numbers, which are not read: write them as two channels");
    default: // not stated, or "void"
        return PixelNumbers::Unsigned;
    }
}

TiffPage pageOf(TIFF* file) {
    TiffPage page;
    std::uint16_t bits = 1, samples = 1, format = SAMPLEFORMAT_UINT, planar = PLANARCONFIG_CONTIG, extras = 0;
    std::uint32_t depth = 1, kind = 0;
    TIFFGetField(file, TIFFTAG_IMAGEWIDTH, &page.form.width);
    TIFFGetField(file, TIFFTAG_IMAGELENGTH, &page.form.height);
    TIFFGetFieldDefaulted(file, TIFFTAG_BITSPERSAMPLE, &bits);
    TIFFGetFieldDefaulted(file, TIFFTAG_SAMPLESPERPIXEL, &samples);
    TIFFGetFieldDefaulted(file, TIFFTAG_SAMPLEFORMAT, &format);
    TIFFGetFieldDefaulted(file, TIFFTAG_PLANARCONFIG, &planar);
    TIFFGetFieldDefaulted(file, TIFFTAG_COMPRESSION, &page.compression);
    TIFFGetFieldDefaulted(file, TIFFTAG_IMAGEDEPTH, &depth);
    TIFFGetFieldDefaulted(file, TIFFTAG_SUBFILETYPE, &kind);
    TIFFGetField(file, TIFFTAG_PHOTOMETRIC, &page.photometric);
    std::uint16_t* extra = nullptr;
    if (TIFFGetField(file, TIFFTAG_EXTRASAMPLES, &extras, &extra) != 0 && extras > 0) page.extra = extra[0];
    if (depth > 1)
        throw std::runtime_error("has several slices in one page, which are not read: write a page for each");
    page.form.bits = bits;
    page.form.samples = samples;
    page.form.numbers = numbersOf(format);
    page.planes = planar == PLANARCONFIG_SEPARATE && samples > 1;
    page.reduced = (kind & FILETYPE_REDUCEDIMAGE) != 0;
    page.tiled = TIFFIsTiled(file) != 0;
    page.directory = TIFFCurrentDirOffset(file);
    return page;
}

/// Decodes one plane (all samples where they lie pixel by pixel).
void readPlane(TIFF* file, const PixelForm& form, std::uint16_t plane, char* to) {
    const std::size_t row = form.rowBytes(), all = form.bytes();
    if (TIFFIsTiled(file) != 0) {
        std::uint32_t width = 0, height = 0;
        TIFFGetField(file, TIFFTAG_TILEWIDTH, &width);
        TIFFGetField(file, TIFFTAG_TILELENGTH, &height);
        PixelForm tile = form;
        tile.width = width;
        tile.height = height;
        const auto tileBytes = std::size_t(std::max<tmsize_t>(TIFFTileSize(file), 0));
        constexpr std::size_t kHarmless = 16 << 20; // a tile may be larger than the page, but not by far
        const std::size_t pixelBits = std::size_t(form.samples) * std::size_t(form.bits);
        if (width == 0 || height == 0 || width * pixelBits % 8 != 0 || tileBytes < tile.bytes() ||
            tileBytes / 4 > kHarmless + all)
            throw std::runtime_error("has tiles that do not fit its pages");
        std::vector<char> bytes(tileBytes);
        for (std::uint32_t y = 0; y < form.height; y += height)
            for (std::uint32_t x = 0; x < form.width; x += width) {
                if (TIFFReadTile(file, bytes.data(), x, y, 0, plane) < 0) failTiff();
                const std::size_t begin = std::size_t(x) * pixelBits / 8,
                                  count = std::min(tile.rowBytes(), row - begin);
                for (std::uint32_t line = 0; line < std::min(height, form.height - y); ++line)
                    std::memcpy(to + std::size_t(y + line) * row + begin, bytes.data() + line * tile.rowBytes(), count);
            }
        return;
    }
    if (std::size_t(std::max<tmsize_t>(TIFFScanlineSize(file), 0)) != row)
        throw std::runtime_error("has rows that do not fit its pages");
    std::uint32_t rows = 0;
    TIFFGetFieldDefaulted(file, TIFFTAG_ROWSPERSTRIP, &rows);
    rows = std::min(std::max(rows, 1u), form.height);
    const std::uint32_t strips = (form.height + rows - 1) / rows;
    for (std::uint32_t s = 0; s < strips; ++s) {
        const std::size_t begin = std::size_t(s) * rows * row, wanted = std::min(std::size_t(rows) * row, all - begin);
        const tmsize_t got = TIFFReadEncodedStrip(file, plane * strips + s, to + begin, tmsize_t(wanted));
        if (got < 0 || std::size_t(got) != wanted) failTiff();
    }
}

/// Pages that libtiff can only give as 8-bit colours: subsampled ones.
void readColours(TIFF* file, const TiffPage& page, const std::vector<void*>& to) {
    const std::size_t width = page.form.width, height = page.form.height;
    std::vector<std::uint32_t> pixels(width * height);
    if (TIFFReadRGBAImageOriented(file, page.form.width, page.form.height, pixels.data(), ORIENTATION_TOPLEFT, 1) == 0)
        failTiff();
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        static_cast<std::uint8_t*>(to[0])[i] = std::uint8_t(TIFFGetR(pixels[i]));
        static_cast<std::uint8_t*>(to[1])[i] = std::uint8_t(TIFFGetG(pixels[i]));
        static_cast<std::uint8_t*>(to[2])[i] = std::uint8_t(TIFFGetB(pixels[i]));
    }
}

bool isSubsampled(const TiffPage& page) {
    return page.photometric == PHOTOMETRIC_YCBCR && page.form.samples == 3 && page.form.bits == 8;
}

} // namespace

TiffHandle openTiffFile(const std::string& path) {
    TIFFSetErrorHandler(noteError);
    TIFFSetWarningHandler(nullptr);
    libraryError.clear();
    TiffHandle file(TIFFOpen(path.c_str(), "rm"), TIFFClose); // not mapped, which would count as memory
    if (file == nullptr) throw std::runtime_error(libraryError.empty() ? "is not a TIFF file" : libraryError);
    return file;
}

std::vector<TiffPage> pagesOf(TIFF* file) {
    std::vector<TiffPage> pages;
    while (true) {
        pages.push_back(pageOf(file));
        if (TIFFLastDirectory(file) != 0) return pages;
        if (TIFFReadDirectory(file) == 0)
            throw std::runtime_error("ends early: page " + std::to_string(pages.size() + 1) +
                                     " is announced and cannot be read");
    }
}

std::string tiffText(TIFF* file, std::uint32_t tag) {
    char* words = nullptr;
    return TIFFGetField(file, tag, &words) != 0 && words != nullptr ? words : "";
}

std::vector<std::uint8_t> tiffBytes(TIFF* file, std::uint32_t tag, std::size_t bytesOfOne) {
    const TIFFField* field = TIFFFindField(file, tag, TIFF_ANY);
    if (field == nullptr || TIFFFieldReadCount(field) != TIFF_VARIABLE2) return {};
    if (std::size_t(std::max(TIFFDataWidth(TIFFFieldDataType(field)), 0)) != bytesOfOne) return {};
    std::uint32_t count = 0;
    void* data = nullptr;
    if (TIFFGetField(file, tag, &count, &data) == 0 || data == nullptr) return {};
    const auto* bytes = static_cast<const std::uint8_t*>(data);
    return {bytes, bytes + count * bytesOfOne};
}

std::optional<TiffResolution> resolutionOf(TIFF* file) {
    float x = 0, y = 0;
    std::uint16_t unit = RESUNIT_INCH;
    TIFFGetFieldDefaulted(file, TIFFTAG_RESOLUTIONUNIT, &unit);
    const bool has =
        TIFFGetField(file, TIFFTAG_XRESOLUTION, &x) != 0 && TIFFGetField(file, TIFFTAG_YRESOLUTION, &y) != 0;
    const auto lengthOf = [](float pixels) { // of a rational number that libtiff gives as a float
        const double length = 1 / meantTime(double(pixels));
        char text[32];
        std::snprintf(text, sizeof text, "%.6g", length);
        const double round = std::strtod(text, nullptr);
        return std::abs(round - length) < 2e-7 * length ? round : length;
    };
    if (!has || !(x > 0) || !(y > 0) || !std::isfinite(x) || !std::isfinite(y)) return std::nullopt;
    return TiffResolution{lengthOf(x), lengthOf(y),
                          unit == RESUNIT_INCH         ? "in"
                          : unit == RESUNIT_CENTIMETER ? "cm"
                                                       : ""};
}

std::optional<std::uint64_t> plainSamplesAt(TIFF* file, const TiffPage& page) {
    if (page.compression != COMPRESSION_NONE || page.tiled || (page.planes && page.form.samples > 1))
        return std::nullopt;
    const std::uint32_t strips = TIFFNumberOfStrips(file);
    std::uint64_t next = TIFFGetStrileOffset(file, 0);
    const std::uint64_t begin = next;
    for (std::uint32_t s = 0; s < strips; ++s) {
        if (TIFFGetStrileOffset(file, s) != next) return std::nullopt;
        next += TIFFGetStrileByteCount(file, s);
    }
    return begin;
}

void readTiffPage(TIFF* file, const TiffPage& page, const std::vector<void*>& to) {
    libraryError.clear();
    if (TIFFIsCODECConfigured(page.compression) == 0)
        throw std::runtime_error("is compressed by method " + std::to_string(page.compression) +
                                 " of TIFF, which is not read: write it with LZW, deflate or none");
    if (isSubsampled(page)) {
        if (page.compression != COMPRESSION_JPEG) return readColours(file, page, to);
        TIFFSetField(file, TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
    }
    PixelForm form = page.form;
    if (page.planes) form.samples = 1;
    const int parts = form.parts();
    if (isPlain(form) && !page.planes) return readPlane(file, form, 0, static_cast<char*>(to[0]));
    std::vector<char> rows(form.bytes());
    for (int plane = 0; plane < (page.planes ? page.form.samples : 1); ++plane) {
        readPlane(file, form, std::uint16_t(plane), rows.data());
        for (int sample = 0; sample < form.samples; ++sample) {
            const auto first = to.begin() + std::ptrdiff_t(parts) * (plane + sample);
            unpackSample(rows.data(), form, sample, {first, first + parts});
        }
    }
}

std::vector<std::string> sampleNames(const TiffPage& page) {
    const auto count = std::size_t(page.form.samples);
    std::vector<std::string> names;
    if (page.photometric == PHOTOMETRIC_RGB || page.photometric == PHOTOMETRIC_YCBCR)
        names = {"red", "green", "blue"};
    else if (page.photometric == PHOTOMETRIC_SEPARATED)
        names = {"cyan", "magenta", "yellow", "black"};
    else if (page.photometric >= PHOTOMETRIC_CIELAB && page.photometric <= PHOTOMETRIC_ITULAB)
        names = {"L", "a", "b"};
    else if (count == 2 && page.extra != EXTRASAMPLE_UNSPECIFIED)
        names = {"value"};
    if (count > names.size() && page.extra != EXTRASAMPLE_UNSPECIFIED) names.emplace_back("alpha");
    names.resize(count);
    if (count == 1) names = {"value"};
    return distinctNames(names);
}

std::string noteOnColours(const TiffPage& page) {
    switch (page.photometric) {
    case PHOTOMETRIC_PALETTE:
        return "The values are the indices of a palette; its colours are left out.";
    case PHOTOMETRIC_MINISWHITE:
        return "The numbers are as stored, where 0 stands for white.";
    case PHOTOMETRIC_RGB:
        return page.form.samples < 3 ? "" : "Its colours are read as separate parameters.";
    case PHOTOMETRIC_YCBCR:
        return "Its colours are converted from YCbCr and read as red, green and blue.";
    default:
        return "";
    }
}

} // namespace tessera::importer
