#pragma once

#include "app/importer/pictures/tiff_file.h"
#include "app/importer/readers/source.h"

#include <array>
#include <limits>
#include <map>
#include <string>
#include <vector>

/// Pages of TIFF files as the slices, channels and times of a volume.
namespace tessera::importer {

/// Where the samples of one plane lie.
struct TiffPlane {
    std::size_t file = 0; ///< kNone: no file holds it
    std::size_t page = 0; ///< of that file
    std::size_t behind =
        0; ///< planes of this size that lie between the samples of the page and its own, without a page
    static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
    bool operator==(const TiffPlane&) const = default;
};

/// A file and its directories.
struct TiffFile {
    std::string path;
    std::vector<TiffPage> pages;
};

struct TiffStack {
    std::vector<TiffFile> files;
    TiffPage form; ///< of every plane
    std::size_t slices = 1, channels = 1, times = 1;
    std::vector<TiffPlane> planes;         ///< slices of the first channel, of the next channel, ..., of the next time
    std::vector<std::string> channelNames; ///< as stated; may be empty
    std::array<double, 3> spacing{1, 1, 1}, origin{0, 0, 0};
    bool statesDepth = false; ///< the spacing of slices
    /// Coefficients of the calibration of ImageJ: value = c0 + c1 * stored + c2 * stored^2 ...; empty = none.
    std::vector<double> calibration;
    std::string valueUnit;

    std::size_t planeAt(std::size_t time, std::size_t channel, std::size_t slice) const {
        return (time * channels + channel) * slices + slice;
    }
};

/// Sorts planes that come in an order of dimensions, "CZT" with the fastest first. False if their number differs.
bool arrangePlanes(TiffStack& stack, const std::vector<TiffPlane>& planes, const std::string& order);

/// The planes of one file, by what its first description says. Each gives false where it is not of this kind.
/// OME-XML (tiff_ome.cpp). Opens further files that it names, beside the first.
bool arrangeOme(TiffStack& stack, const std::string& description, Source& source);
/// ImageJ and Fiji (tiff_imagej.cpp). `file` is at its first directory.
bool arrangeImageJ(TiffStack& stack, const std::string& description, TIFF* file, Source& source);
/// The JSON of tifffile (tiff_shaped.cpp).
bool arrangeShaped(TiffStack& stack, const std::string& description, TIFF* file, Source& source);
/// Zeiss LSM and MetaMorph STK (tiff_microscopes.cpp).
bool arrangeMicroscope(TiffStack& stack, TIFF* file, Source& source);

/// The planes that lie behind the samples of a file's only page: `count` with that of the page. Throws if they are not
/// all there.
std::vector<TiffPlane> planesBehind(const TiffStack& stack, TIFF* file, std::size_t count);

/// All pages of the first file that fit the stack's form, and a note on the others.
std::vector<TiffPlane> fittingPages(TiffStack& stack, Source& source);

} // namespace tessera::importer
