#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

/// Checks that a file holds all that its own words announce. VTK's readers fill what a truncated file lacks with
/// whatever was in memory, or with zeros. Each check throws std::runtime_error with one line of reason.
namespace tessera::importer {

/// Path of a file that `file` names: from its folder.
std::string besides(const std::string& file, const std::string& name);

/// Bytes [begin, begin + count) of a file, fewer where it ends.
std::string readPart(const std::string& path, std::size_t begin, std::size_t count);
std::string readWhole(const std::string& path);
std::size_t bytesIn(const std::string& path);

/// Text whose numbers may be cut: its last line must have a line end.
void checkLastLine(std::string_view text);

/// The last tag of a VTK XML file, and of all files that it names.
void checkXml(const std::string& path);

/// The zlib or gzip stream at `begin` must end, and hold at least `wanted` bytes once inflated.
void checkDeflated(const std::string& path, std::size_t begin, double wanted);

void checkMetaImage(const std::string& path);
void checkNifti(const std::string& path);
void checkNrrd(const std::string& path);

/// The samples of a NRRD file that are written as text, in it or in the file that it names; nothing where they are not,
/// or in several files. Throws where the last line is cut.
std::optional<std::string> textOfNrrd(const std::string& path);

/// NetCDF of the classic formats (CDF 1, 2 and 5): where the header says its last value lies. HDF5 files are left to
/// their library.
void checkNetCdf(const std::string& path);

/// The files of a case that are read at one time.
/// OpenFOAM: brackets that all close, fields with their boundary, compressed streams that end.
void checkFoam(const std::string& path, double time);
/// EnSight Gold, step of so many: the geometry's parts, and in each variable a value for each point or cell.
void checkEnSight(const std::string& path, std::size_t step, std::size_t steps);

/// Legacy files: the reader stops at the end of a truncated one without a word. `arrays` is what it gave. Nothing in
/// such a file says how many arrays it has (but for those of a FIELD): one cut exactly between two is one of fewer.
void checkLegacy(const std::string& path, std::size_t arrays);

} // namespace tessera::importer
