#pragma once

#include <span>
#include <string>
#include <string_view>

/// The file formats known: the rows of volume/import/files/format_rows.inc.
namespace tessera::volume {

struct FileFormat {
    std::string_view name;       ///< as `tessera info` says it
    std::string_view suffixes;   ///< in small letters, separated by blanks; the longest that fits a file counts
    std::string_view advice;     ///< for formats without a reader: which one the program that wrote it can write
    std::string_view lengthUnit; ///< of every file of this format; "": each file may state one
    bool slices = false;         ///< files numbered alike are slices of one volume (single-page TIFF, DICOM)
};

std::span<const FileFormat> fileFormats();

/// The format by the suffix of a file name; null if no row has it.
const FileFormat* formatOf(std::string_view path);

/// The format by its name, as stored in FileBlock.
const FileFormat* formatNamed(std::string_view name);

/// The format of a file by its name, else by its first bytes (DICOM files need no suffix).
const FileFormat* formatOfFile(const std::string& path);

/// Whether a folder is a data set in itself, one of Zarr: by its ending, or by the files of its description.
bool isZarrFolder(const std::string& path);

/// Whether a folder is a case of OpenFOAM: it has system/controlDict, packed by gzip or not, or a mesh.
bool isFoamCase(const std::string& folder);

/// Whether a file stands for the case around it: case.foam, case.OpenFOAM, system/controlDict.
bool namesFoamCase(const std::string& path);

/// Whether a file is a single slice of a volume: a TIFF file only if it has one page.
bool isSlice(const FileFormat& format, const std::string& path);

/// Whether files of a format are pictures first of all, which stand beside data of other formats (PNG, JPEG, ...).
bool isPicture(const FileFormat& format);

/// All suffixes with a reader, separated by blanks.
std::string readableSuffixes();

} // namespace tessera::volume
