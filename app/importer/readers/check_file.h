#pragma once

#include "volume/import/files/named_path.h"

#include <cstddef>
#include <string>
#include <string_view>

/// Checks for truncated files: VTK's readers fill what is missing with uninitialised memory or zeros. Each check throws
/// std::runtime_error with one line of reason.
namespace tessera::importer {

/// Whether files may name others outside of their folders: from now on, in the whole process. Refused at first.
void letNameOutside(volume::Outside outside);
volume::Outside outsideOfFolders();

/// The path of what `file` names, which is no pipe or device if it is there. Throws for what lies outside of the folder
/// of `file` unless that is allowed. Every name of another file that stands in a file goes through this.
std::string besides(const std::string& file, const std::string& name);
/// The same for a name from a folder.
std::string besidesIn(const std::string& folder, const std::string& name);

/// Bytes [begin, begin + count) of a file, fewer where it ends.
std::string readPart(const std::string& path, std::size_t begin, std::size_t count);
std::string readWhole(const std::string& path);
std::size_t bytesIn(const std::string& path);

/// A file that has fewer bytes than its header announces. `where`: another file that has them, "" = this one.
void wantBytes(double has, double wanted, const std::string& where = {}, const char* what = "bytes of samples");

/// A file that states far more bytes of samples than can be in the bytes that it stores, so that they would fill the
/// memory for nothing. `what` states them: "" = the file itself.
void refuseHollow(double stated, double stored, const std::string& what = {});

/// For text, whose last number might be cut: the last line must have a line end.
void checkLastLine(std::string_view text);

/// A VTK XML file, and all files that it names, must have their closing tag, and grids all samples of their extents.
/// `gaps`: the caller takes care of those that the file itself lacks (readers/piece_cover.h).
void checkXml(const std::string& path, bool gaps);

/// The zlib or gzip stream at `begin` must end, and hold at least `wanted` bytes once inflated.
void checkDeflated(const std::string& path, std::size_t begin, double wanted);

/// NetCDF in the classic formats (CDF 1, 2 and 5): the file must reach the last value that its header states. HDF5
/// files are checked by their library.
void checkNetCdf(const std::string& path);

/// Legacy VTK files: the reader silently stops at the end of a truncated one. `arrays` is the number it read. Such a
/// file does not state its number of arrays (except in a FIELD), so one cut exactly between two arrays is not detected.
void checkLegacy(const std::string& path, std::size_t arrays);

} // namespace tessera::importer
