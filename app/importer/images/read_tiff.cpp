// TIFF: the pages of a file, or single pages of numbered files, as the slices of a volume. Not read by VTK, whose
// reader does not report the library's errors.
#include "app/importer/readers/check_file.h"
#include "app/importer/readers/read_files.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <memory>
#include <stdexcept>
#include <tiffio.h>
#include <vector>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>

namespace tessera::importer {

namespace {

std::string libraryError; // the first since it was last cleared

void noteError(const char*, const char* format, va_list arguments) {
    char text[300];
    std::vsnprintf(text, sizeof text, format, arguments);
    if (libraryError.empty()) libraryError = text;
}

struct Page {
    std::uint32_t width = 0, height = 0;
    std::uint16_t bits = 1, samples = 1, form = SAMPLEFORMAT_UINT, planar = PLANARCONFIG_CONTIG, photometric = 0;
    bool operator==(const Page&) const = default;
};

using File = std::unique_ptr<TIFF, decltype(&TIFFClose)>;

File openFile(const std::string& path) {
    libraryError.clear();
    File file(TIFFOpen(path.c_str(), "r"), TIFFClose);
    if (file == nullptr) throw std::runtime_error(libraryError.empty() ? "is not a TIFF file" : libraryError);
    return file;
}

Page pageOf(TIFF* file) {
    Page page;
    TIFFGetField(file, TIFFTAG_IMAGEWIDTH, &page.width);
    TIFFGetField(file, TIFFTAG_IMAGELENGTH, &page.height);
    TIFFGetFieldDefaulted(file, TIFFTAG_BITSPERSAMPLE, &page.bits);
    TIFFGetFieldDefaulted(file, TIFFTAG_SAMPLESPERPIXEL, &page.samples);
    TIFFGetFieldDefaulted(file, TIFFTAG_SAMPLEFORMAT, &page.form);
    TIFFGetFieldDefaulted(file, TIFFTAG_PLANARCONFIG, &page.planar);
    TIFFGetField(file, TIFFTAG_PHOTOMETRIC, &page.photometric);
    if (page.form == SAMPLEFORMAT_VOID) page.form = SAMPLEFORMAT_UINT;
    return page;
}

int vtkTypeOf(const Page& page) {
    if (page.form == SAMPLEFORMAT_IEEEFP && page.bits == 32) return VTK_FLOAT;
    if (page.form == SAMPLEFORMAT_IEEEFP && page.bits == 64) return VTK_DOUBLE;
    const bool isSigned = page.form == SAMPLEFORMAT_INT;
    if (page.bits == 8) return isSigned ? VTK_SIGNED_CHAR : VTK_UNSIGNED_CHAR;
    if (page.bits == 16) return isSigned ? VTK_SHORT : VTK_UNSIGNED_SHORT;
    if (page.bits == 32 && page.form != SAMPLEFORMAT_IEEEFP) return isSigned ? VTK_INT : VTK_UNSIGNED_INT;
    throw std::runtime_error("has samples of " + std::to_string(page.bits) +
                             " bits, which are not read: write them with 8, 16 or 32");
}

/// The samples of a page: top row first, the samples of a pixel interleaved.
void readPage(TIFF* file, const Page& page, char* to) {
    libraryError.clear();
    const auto fail = [] {
        throw std::runtime_error("ends early or is damaged" + (libraryError.empty() ? "" : ": " + libraryError));
    };
    const std::size_t pixel = std::size_t(page.samples) * (page.bits / 8u), row = pixel * page.width;
    if (TIFFIsTiled(file) != 0) {
        std::uint32_t width = 0, height = 0;
        TIFFGetField(file, TIFFTAG_TILEWIDTH, &width);
        TIFFGetField(file, TIFFTAG_TILELENGTH, &height);
        const auto tileBytes = std::size_t(std::max<tmsize_t>(TIFFTileSize(file), 0));
        constexpr std::size_t kHarmless = 16 << 20; // a tile may be larger than the page, but not by far
        if (tileBytes < std::size_t(width) * height * pixel || tileBytes / 4 > kHarmless + row * page.height)
            throw std::runtime_error("has tiles that do not fit its pages");
        std::vector<char> tile(tileBytes);
        for (std::uint32_t y = 0; y < page.height; y += height)
            for (std::uint32_t x = 0; x < page.width; x += width) {
                if (TIFFReadTile(file, tile.data(), x, y, 0, 0) < 0) fail();
                const std::size_t columns = std::min(width, page.width - x);
                for (std::uint32_t line = 0; line < std::min(height, page.height - y); ++line)
                    std::copy_n(tile.data() + std::size_t(line) * width * pixel, columns * pixel,
                                to + (y + line) * row + x * pixel);
            }
        return;
    }
    std::vector<char> line(std::max<std::size_t>(std::size_t(TIFFScanlineSize(file)), row));
    for (std::uint32_t y = 0; y < page.height; ++y) {
        if (TIFFReadScanline(file, line.data(), y, 0) < 0) fail();
        std::copy_n(line.data(), row, to + y * row);
    }
}

/// The value of a key in ImageJ's description ("slices=30"), or "".
std::string described(const std::string& text, const std::string& key) {
    const std::size_t at = ("\n" + text).find("\n" + key + "=");
    if (at == std::string::npos) return {};
    const std::size_t begin = at + key.size() + 1;
    return text.substr(begin, text.find('\n', begin) - begin);
}

struct Stack {
    std::vector<std::string> files;
    std::vector<std::pair<std::size_t, tdir_t>> pages; ///< file and directory of each
    Page form;
    std::size_t slices = 0;
    double spacing[3] = {1, 1, 1};
};

std::string slicePrefix(const Stack& stack, std::size_t index) {
    if (stack.files.size() == 1) return {};
    return "its slice " + stack.files[index].substr(stack.files[index].rfind('/') + 1) + " ";
}

File openSlice(const Stack& stack, std::size_t index) {
    try {
        return openFile(stack.files[index]);
    } catch (const std::runtime_error& error) {
        throw std::runtime_error(slicePrefix(stack, index) + error.what());
    }
}

void readDescription(TIFF* file, Stack& stack, Source& source) {
    char* words = nullptr;
    if (TIFFGetField(file, TIFFTAG_IMAGEDESCRIPTION, &words) == 0 || words == nullptr) return;
    const std::string text = words;
    if (!text.starts_with("ImageJ=")) return;
    const auto number = [&](const char* key, double otherwise) {
        const std::string word = described(text, key);
        return word.empty() ? otherwise : std::strtod(word.c_str(), nullptr);
    };
    const double images = number("images", 1), frames = number("frames", 1), channels = number("channels", 1);
    if (images != double(stack.pages.size()))
        throw std::runtime_error("announces " + described(text, "images") + " images, holds " +
                                 std::to_string(stack.pages.size()));
    if (channels > 1)
        throw std::runtime_error(
            "has several channels per pixel, which is not supported: write each as a file of its own");
    if (frames > 1 && frames <= images && std::size_t(images) % std::size_t(frames) == 0) {
        stack.slices = std::size_t(images / frames);
        for (int t = 0; t < int(frames); ++t) source.times.push_back(t * number("finterval", 1));
        source.timeUnit = described(text, "finterval").empty() ? "step" : "s";
    }
    float resolution = 0;
    std::string unit = described(text, "unit");
    if (unit == "micron" || unit == "\\u00B5m") unit = "um";
    if (unit.empty() || unit == "pixel") return;
    if (TIFFGetField(file, TIFFTAG_XRESOLUTION, &resolution) != 0 && resolution > 0) stack.spacing[0] = 1 / resolution;
    if (TIFFGetField(file, TIFFTAG_YRESOLUTION, &resolution) != 0 && resolution > 0) stack.spacing[1] = 1 / resolution;
    stack.spacing[2] = number("spacing", stack.spacing[0]);
    source.lengthUnit = unit;
}

vtkSmartPointer<vtkDataObject> readStack(const Stack& stack, std::size_t time) {
    const Page& form = stack.form;
    vtkNew<vtkImageData> image;
    image->SetDimensions(int(form.width), int(form.height), int(stack.slices));
    image->SetSpacing(stack.spacing);
    auto all = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(vtkTypeOf(form)));
    all->SetNumberOfComponents(form.samples);
    all->SetNumberOfTuples(image->GetNumberOfPoints());
    const std::size_t bytes = std::size_t(form.width) * form.height * form.samples * (form.bits / 8u);
    File file(nullptr, TIFFClose);
    std::size_t opened = stack.files.size();
    for (std::size_t slice = 0; slice < stack.slices; ++slice) {
        const auto& [index, directory] = stack.pages[time * stack.slices + slice];
        if (index != opened) file = openSlice(stack, index);
        opened = index;
        if (TIFFCurrentDirectory(file.get()) != directory && TIFFSetDirectory(file.get(), directory) == 0)
            throw std::runtime_error("page " + std::to_string(directory + 1) + " cannot be read");
        if (pageOf(file.get()) != form) throw std::runtime_error("has pages of different size or type");
        try {
            readPage(file.get(), form, static_cast<char*>(all->GetVoidPointer(0)) + slice * bytes);
        } catch (const std::runtime_error& error) {
            throw std::runtime_error(slicePrefix(stack, index) + error.what());
        }
    }
    static constexpr const char* kColors[] = {"red", "green", "blue", "alpha"};
    for (int c = 0; c < form.samples; ++c) {
        auto one = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(vtkTypeOf(form)));
        one->SetNumberOfTuples(all->GetNumberOfTuples());
        one->CopyComponent(0, all, c);
        one->SetName(form.samples == 1 ? "value" : c < 4 ? kColors[c] : ("channel " + std::to_string(c)).c_str());
        image->GetPointData()->AddArray(one);
    }
    return image;
}

} // namespace

void openTiff(Source& source) {
    TIFFSetErrorHandler(noteError);
    TIFFSetWarningHandler(nullptr);
    auto stack = std::make_shared<Stack>();
    stack->files = source.files.empty() ? std::vector<std::string>{source.path} : source.files;
    for (std::size_t f = 0; f < stack->files.size(); ++f) {
        const File file = openSlice(*stack, f);
        while (true) {
            const Page page = pageOf(file.get());
            if (stack->pages.empty()) stack->form = page;
            if (page != stack->form)
                throw std::runtime_error("page " + std::to_string(stack->pages.size() + 1) +
                                         " differs in size or type from the first");
            stack->pages.emplace_back(f, TIFFCurrentDirectory(file.get()));
            if (TIFFLastDirectory(file.get()) != 0) break;
            if (TIFFReadDirectory(file.get()) == 0)
                throw std::runtime_error("ends early: page " + std::to_string(stack->pages.size() + 1) +
                                         " is announced and cannot be read");
        }
        stack->slices = stack->pages.size();
        if (f == 0 && stack->files.size() == 1) {
            TIFFSetDirectory(file.get(), 0);
            readDescription(file.get(), *stack, source);
        }
    }
    const Page& form = stack->form;
    vtkTypeOf(form);
    if (std::max(form.width, form.height) > std::uint32_t(std::numeric_limits<int>::max()))
        throw std::runtime_error("has pages of " + std::to_string(form.width) + " x " + std::to_string(form.height));
    double stored = 0;
    for (const std::string& file : stack->files) stored += double(bytesIn(file));
    refuseHollow(double(form.width) * form.height * form.samples * (form.bits / 8.0) * double(stack->pages.size()),
                 stored);
    if (form.planar != PLANARCONFIG_CONTIG && form.samples > 1)
        throw std::runtime_error(
            "has its colours in separate planes, which is not supported: write them pixel by pixel");
    if (form.photometric == PHOTOMETRIC_PALETTE)
        throw std::runtime_error("has a colour palette instead of values: write it in grey");
    source.read = [stack](std::size_t time) { return readStack(*stack, time); };
}

} // namespace tessera::importer
