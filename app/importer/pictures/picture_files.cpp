// PNG by libpng and JPEG by libjpeg, with the numbers as stored: nothing is scaled to 8 bits.
#include "app/importer/pictures/picture_files.h"

#include "app/importer/readers/check_file.h"

#include <algorithm>
#include <bit>
#include <csetjmp>
#include <cstdio>
#include <memory>
#include <stdexcept>

#include <jpeglib.h>
#include <png.h>

namespace tessera::importer {

namespace {

using OpenedPicture = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

OpenedPicture openPictureFile(const std::string& path) {
    OpenedPicture file(std::fopen(path.c_str(), "rb"), std::fclose);
    if (file == nullptr) throw std::runtime_error("cannot be read");
    return file;
}

/// Errors of libpng come back by a jump, which no object of C++ may lie in the way of.
struct PngReader {
    png_structp png = nullptr;
    png_infop info = nullptr;
    std::string text; ///< of the error
    PngReader() {
        const auto fail = [](png_structp reader, png_const_charp words) {
            static_cast<PngReader*>(png_get_error_ptr(reader))->text = words;
            std::longjmp(png_jmpbuf(reader), 1);
        };
        png = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, fail, [](png_structp, png_const_charp) {});
        if (png != nullptr) info = png_create_info_struct(png);
    }
    ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;
};

bool startPng(PngReader& reader, std::FILE* file) {
    if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
    png_init_io(reader.png, file);
    png_read_info(reader.png, reader.info);
    if (png_get_bit_depth(reader.png, reader.info) < 8) png_set_packing(reader.png); // one byte each, not scaled
    if (png_get_bit_depth(reader.png, reader.info) == 16 && std::endian::native == std::endian::little)
        png_set_swap(reader.png);
    png_set_interlace_handling(reader.png);
    png_read_update_info(reader.png, reader.info);
    return true;
}

bool decodePngRows(PngReader& reader, png_bytep* rows) {
    if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
    png_read_image(reader.png, rows);
    png_read_end(reader.png, nullptr);
    return true;
}

/// Errors of libjpeg come back as exceptions of C++, thrown after its own frames have been left.
struct JpegReader {
    jpeg_decompress_struct jpeg{};
    jpeg_error_mgr errors{};
    std::jmp_buf back{};
    char text[JMSG_LENGTH_MAX] = {};
    JpegReader() {
        jpeg.err = jpeg_std_error(&errors);
        jpeg.client_data = this;
        errors.error_exit = [](j_common_ptr common) {
            auto* self = static_cast<JpegReader*>(common->client_data);
            common->err->format_message(common, self->text);
            std::longjmp(self->back, 1);
        };
        errors.output_message = [](j_common_ptr) {};
        errors.emit_message = [](j_common_ptr common, int level) { // warnings: of files that end early, too
            if (level < 0) common->err->error_exit(common);
        };
        jpeg_create_decompress(&jpeg);
    }
    ~JpegReader() { jpeg_destroy_decompress(&jpeg); }
    JpegReader(const JpegReader&) = delete;
    JpegReader& operator=(const JpegReader&) = delete;
};

/// Reads the header of a JPEG file; false with a text after an error. Holds no object of C++ that a jump would skip.
bool startJpeg(JpegReader& reader, std::FILE* file) {
    if (setjmp(reader.back) != 0) return false;
    jpeg_stdio_src(&reader.jpeg, file);
    jpeg_read_header(&reader.jpeg, TRUE);
    if (reader.jpeg.num_components == 3) reader.jpeg.out_color_space = JCS_RGB;
    jpeg_calc_output_dimensions(&reader.jpeg);
    return true;
}

bool decodeJpeg(JpegReader& reader, char* rows, std::size_t rowBytes) {
    if (setjmp(reader.back) != 0) return false;
    jpeg_start_decompress(&reader.jpeg);
    while (reader.jpeg.output_scanline < reader.jpeg.output_height) {
        auto* row = reinterpret_cast<JSAMPROW>(rows + std::size_t(reader.jpeg.output_scanline) * rowBytes);
        jpeg_read_scanlines(&reader.jpeg, &row, 1);
    }
    jpeg_finish_decompress(&reader.jpeg);
    return true;
}

} // namespace

std::vector<std::string> pictureNames(int samples) {
    static const std::vector<std::string> kColours{"red", "green", "blue"};
    std::vector<std::string> names;
    if (samples >= 3) names = kColours;
    if (samples == 2) names = {"value"};
    if (samples == 2 || samples == 4) names.emplace_back("alpha");
    names.resize(std::size_t(samples));
    return distinctNames(names);
}

void applyPalette(Picture& picture, const std::vector<unsigned char>& palette) {
    const std::size_t count = palette.size() / 3;
    bool grey = count > 0, same = true;
    for (std::size_t i = 0; i < count; ++i) {
        grey = grey && palette[3 * i] == palette[3 * i + 1] && palette[3 * i] == palette[3 * i + 2];
        same = same && palette[3 * i] == i;
    }
    if (grey && same) return;
    if (!grey) {
        picture.note = "The values are the indices of a palette; its colours are left out.";
        return;
    }
    for (char& index : picture.rows) {
        const std::size_t i = static_cast<unsigned char>(index);
        if (i < count) index = static_cast<char>(palette[3 * i]);
    }
}

Picture readPng(const std::string& path) {
    const OpenedPicture file = openPictureFile(path);
    PngReader reader;
    if (reader.png == nullptr || reader.info == nullptr) throw std::bad_alloc();
    const auto fail = [&] { throw std::runtime_error("is no PNG, ends early or is damaged: " + reader.text); };
    if (!startPng(reader, file.get())) fail();
    Picture picture;
    picture.form.width = png_get_image_width(reader.png, reader.info);
    picture.form.height = png_get_image_height(reader.png, reader.info);
    picture.form.samples = png_get_channels(reader.png, reader.info);
    picture.form.bits = png_get_bit_depth(reader.png, reader.info);
    refuseHollow(double(picture.form.bytes()), double(bytesIn(path)));
    if (png_get_rowbytes(reader.png, reader.info) != picture.form.rowBytes())
        throw std::runtime_error("has rows that do not fit its size");
    picture.rows.resize(picture.form.bytes());
    std::vector<png_bytep> rows;
    for (std::size_t y = 0; y < picture.form.height; ++y)
        rows.push_back(reinterpret_cast<png_bytep>(picture.rows.data() + y * picture.form.rowBytes()));
    if (!decodePngRows(reader, rows.data())) fail();
    picture.names = pictureNames(picture.form.samples);
    png_colorp palette = nullptr;
    int count = 0;
    if (png_get_color_type(reader.png, reader.info) == PNG_COLOR_TYPE_PALETTE &&
        png_get_PLTE(reader.png, reader.info, &palette, &count) != 0) {
        std::vector<unsigned char> colours;
        for (int i = 0; i < count; ++i)
            colours.insert(colours.end(), {palette[i].red, palette[i].green, palette[i].blue});
        applyPalette(picture, colours);
    }
    return picture;
}

Picture readJpeg(const std::string& path) {
    const OpenedPicture file = openPictureFile(path);
    JpegReader reader;
    Picture picture;
    const auto fail = [&] { throw std::runtime_error("ends early or is damaged: " + std::string(reader.text)); };
    if (!startJpeg(reader, file.get())) fail();
    picture.form.width = reader.jpeg.output_width;
    picture.form.height = reader.jpeg.output_height;
    picture.form.samples = reader.jpeg.out_color_components;
    refuseHollow(double(picture.form.bytes()), double(bytesIn(path)));
    picture.rows.resize(picture.form.bytes());
    if (!decodeJpeg(reader, picture.rows.data(), picture.form.rowBytes())) fail();
    picture.names = picture.form.samples == 4 ? std::vector<std::string>{"cyan", "magenta", "yellow", "black"}
                                              : pictureNames(picture.form.samples);
    return picture;
}

} // namespace tessera::importer
