#include "vis/image/image_io.h"

#include "volume/base/error.h"
#include "volume/system/atomic_file.h"
#include "volume/system/input_file.h"

#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <png.h>

namespace tessera::vis {

namespace {

constexpr std::size_t kMaxPixels = std::size_t(1) << 28; // 1 GiB of RGBA; a larger size indicates a damaged header
constexpr double kMetresPerInch = 0.0254;
constexpr png_alloc_size_t kMaxChunk = std::size_t(1) << 28; // bytes of an inflated text chunk

/// State shared with libpng's callbacks. libpng reports errors by longjmp, so all objects that own memory live here or
/// in callers, never in a stack frame that the jump skips.
struct Stream {
    std::vector<std::uint8_t> bytes;
    std::size_t at = 0;
    std::string error;
};

void onError(png_structp png, png_const_charp message) {
    static_cast<Stream*>(png_get_error_ptr(png))->error = message;
    std::longjmp(png_jmpbuf(png), 1);
}

void onWarning(png_structp, png_const_charp) {}

void onWrite(png_structp png, png_bytep data, std::size_t size) {
    auto& stream = *static_cast<Stream*>(png_get_io_ptr(png));
    stream.bytes.insert(stream.bytes.end(), data, data + size);
}

void onRead(png_structp png, png_bytep data, std::size_t size) {
    auto& stream = *static_cast<Stream*>(png_get_io_ptr(png));
    if (size > stream.bytes.size() - stream.at) png_error(png, "the file ends too early");
    std::memcpy(data, stream.bytes.data() + stream.at, size);
    stream.at += size;
}

/// Encodes into `stream`; false when libpng refused, with the reason in stream.error.
bool encode(Stream& stream, const Image& image, std::vector<png_text>& texts, std::vector<png_const_bytep>& rows,
            bool opaque) {
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &stream, onError, onWarning);
    png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
    if (info == nullptr) {
        stream.error = "not enough memory";
        png_destroy_write_struct(&png, nullptr);
        return false;
    }
    if (setjmp(png_jmpbuf(png)) != 0) {
        png_destroy_write_struct(&png, &info);
        return false;
    }
    png_set_write_fn(png, &stream, onWrite, nullptr);
    png_set_IHDR(png, info, static_cast<png_uint_32>(image.size.x), static_cast<png_uint_32>(image.size.y), 8,
                 opaque ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_RGBA, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    if (image.dpi > 0) {
        const auto perMetre = static_cast<png_uint_32>(image.dpi / kMetresPerInch + 0.5);
        png_set_pHYs(png, info, perMetre, perMetre, PNG_RESOLUTION_METER);
    }
    if (!texts.empty()) png_set_text(png, info, texts.data(), static_cast<int>(texts.size()));
    png_write_info(png, info);
    if (opaque) png_set_filler(png, 0, PNG_FILLER_AFTER);
    for (png_const_bytep row : rows) png_write_row(png, row);
    png_write_end(png, nullptr);
    png_destroy_write_struct(&png, &info);
    return true;
}

/// Reads everything after the header of a PNG. A separate function that is never inlined: the frame of `setjmp` must
/// hold no C++ objects that a jump could leave half constructed (gcc would warn).
[[gnu::noinline]] void readPicture(png_structp png, png_infop info, Image& image, std::vector<png_bytep>& rows,
                                   std::map<std::string, std::string>* texts) {
    png_read_info(png, info);
    const png_uint_32 width = png_get_image_width(png, info), height = png_get_image_height(png, info);
    if (std::size_t(width) * height > kMaxPixels) png_error(png, "the picture is larger than 2^28 pixels");
    png_set_expand(png);
    png_set_scale_16(png);
    png_set_gray_to_rgb(png);
    png_set_add_alpha(png, 0xff, PNG_FILLER_AFTER);
    png_set_interlace_handling(png);
    png_read_update_info(png, info);
    if (png_get_rowbytes(png, info) != std::size_t(width) * 4) png_error(png, "unknown kind of pixels");
    image.size = {static_cast<int>(width), static_cast<int>(height)};
    // 0 where the chunk is absent, has another unit, or pixels that are not square.
    image.dpi = double(png_get_pixels_per_meter(png, info)) * kMetresPerInch;
    image.rgba.resize(std::size_t(width) * height * 4);
    rows.resize(height);
    for (std::size_t y = 0; y < height; ++y) rows[y] = image.rgba.data() + y * std::size_t(width) * 4;
    png_read_image(png, rows.data());
    png_read_end(png, info);
    if (texts == nullptr) return;
    png_textp found = nullptr;
    const int count = png_get_text(png, info, &found, nullptr);
    for (int i = 0; i < count; ++i) {
        const bool international = found[i].compression >= PNG_ITXT_COMPRESSION_NONE;
        (*texts)[found[i].key] =
            std::string(found[i].text, international ? found[i].itxt_length : found[i].text_length);
    }
}

/// Decodes `stream`; false when libpng refused, with the reason in stream.error.
bool decode(Stream& stream, Image& image, std::vector<png_bytep>& rows, std::map<std::string, std::string>* texts) {
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &stream, onError, onWarning);
    png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
    if (info == nullptr) {
        stream.error = "not enough memory";
        png_destroy_read_struct(&png, nullptr, nullptr);
        return false;
    }
    if (setjmp(png_jmpbuf(png)) != 0) {
        png_destroy_read_struct(&png, &info, nullptr);
        return false;
    }
    png_set_read_fn(png, &stream, onRead);
    // A corrupt text chunk would be a damaged session, so refuse it like a corrupt picture.
    png_set_crc_action(png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
    png_set_chunk_malloc_max(png, kMaxChunk);
    readPicture(png, info, image, rows, texts);
    png_destroy_read_struct(&png, &info, nullptr);
    return true;
}

} // namespace

std::vector<std::uint8_t> encodePng(const Image& image, const std::map<std::string, std::string>& texts,
                                    const std::string& name) {
    const std::size_t pixels = std::size_t(std::max(image.size.x, 0)) * std::size_t(std::max(image.size.y, 0));
    if (pixels == 0 || image.rgba.size() != pixels * 4)
        throw Error("a picture of " + std::to_string(image.size.x) + " x " + std::to_string(image.size.y) +
                        " cannot be written",
                    name);
    std::vector<png_const_bytep> rows;
    for (std::size_t y = 0; y < std::size_t(image.size.y); ++y)
        rows.push_back(image.rgba.data() + y * std::size_t(image.size.x) * 4);
    bool opaque = true;
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) opaque = opaque && image.rgba[i] == 255;
    std::vector<png_text> chunks;
    std::string empty;
    for (const auto& [key, text] : texts) {
        png_text chunk{};
        chunk.compression = PNG_ITXT_COMPRESSION_zTXt;
        chunk.key = const_cast<char*>(key.c_str()); // libpng does not modify them
        chunk.text = const_cast<char*>(text.c_str());
        chunk.itxt_length = text.size();
        chunk.lang = chunk.lang_key = empty.data();
        chunks.push_back(chunk);
    }
    Stream stream;
    if (!encode(stream, image, chunks, rows, opaque)) throw Error(stream.error, name);
    return {stream.bytes.begin(), stream.bytes.end()};
}

void writePng(const std::string& path, const Image& image, const std::map<std::string, std::string>& texts) {
    const std::vector<std::uint8_t> bytes = encodePng(image, texts, path);
    AtomicFile file(path);
    file.write(bytes.data(), bytes.size());
    file.commit();
}

std::vector<std::uint8_t> readBytes(const std::string& path) {
    constexpr std::uintmax_t kMost =
        1'000'000'000; // as many pixels as one of surroundings may have take half of it at most
    const std::string bytes = readInput(path, kMost);
    return {bytes.begin(), bytes.end()};
}

Image decodePng(std::span<const std::uint8_t> bytes, const std::string& name,
                std::map<std::string, std::string>* texts) {
    Stream stream;
    stream.bytes.assign(bytes.begin(), bytes.end());
    if (stream.bytes.size() < 8 || png_sig_cmp(stream.bytes.data(), 0, 8) != 0) throw Error("is not a PNG", name);
    Image image;
    std::vector<png_bytep> rows;
    std::map<std::string, std::string> found;
    if (!decode(stream, image, rows, texts != nullptr ? &found : nullptr))
        throw Error("damaged PNG: " + stream.error, name, "byte " + std::to_string(stream.at));
    if (texts != nullptr) *texts = std::move(found);
    return image;
}

Image readPng(const std::string& path, std::map<std::string, std::string>* texts) {
    return decodePng(readBytes(path), path, texts);
}

} // namespace tessera::vis
