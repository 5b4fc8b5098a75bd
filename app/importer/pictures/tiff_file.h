#pragma once

#include "app/importer/pictures/pixels.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <tiffio.h>
#include <vector>

/// TIFF files by libtiff: their directories, and the samples of one.
namespace tessera::importer {

using TiffHandle = std::unique_ptr<TIFF, decltype(&TIFFClose)>;

/// One directory of a file.
struct TiffPage {
    PixelForm form;                           ///< samples of all planes count
    std::uint64_t directory = 0;              ///< where it lies
    std::uint16_t photometric = 0;            ///< what the samples mean
    std::uint16_t compression = 1, extra = 0; ///< the first of its extra samples
    bool planes = false;                      ///< samples lie in planes, one after another
    bool reduced = false;                     ///< a smaller picture of another page
    bool tiled = false;
    bool operator==(const TiffPage&) const = default;

    /// Whether both are slices of one stack.
    bool fits(const TiffPage& other) const {
        return form == other.form && photometric == other.photometric && extra == other.extra;
    }
};

/// Throws std::runtime_error where a file is none of TIFF.
TiffHandle openTiffFile(const std::string& path);

/// All pages of the main chain, in order. Throws where one is announced that cannot be read.
std::vector<TiffPage> pagesOf(TIFF* file);

/// A description or another text of the current directory; "" where there is none.
std::string tiffText(TIFF* file, std::uint32_t tag);

/// The bytes of a tag that libtiff does not know, of the current directory.
std::vector<std::uint8_t> tiffBytes(TIFF* file, std::uint32_t tag, std::size_t bytesOfOne);

/// Lengths of a pixel of the current directory and the unit in which its resolution is stated: "in", "cm" or "".
/// None where it states none.
struct TiffResolution {
    double x = 1, y = 1;
    std::string unit;
};
std::optional<TiffResolution> resolutionOf(TIFF* file);

/// Where the samples of the current directory begin, and whether they lie as they are, in one piece.
std::optional<std::uint64_t> plainSamplesAt(TIFF* file, const TiffPage& page);

/// Reads the samples of a page, one array for each of its samples (two for a complex one).
void readTiffPage(TIFF* file, const TiffPage& page, const std::vector<void*>& to);

/// What the samples of a page are called: red, green, blue.
std::vector<std::string> sampleNames(const TiffPage& page);

/// For the user: what is made of the colours of a page; "" = nothing to say.
std::string noteOnColours(const TiffPage& page);

} // namespace tessera::importer
