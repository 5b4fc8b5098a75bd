#pragma once

#include "volume/import/files/file_names.h"
#include "volume/import/files/named_path.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

/// Which files belong together: directories, patterns, .pvd, .series and numbered files become a flat list.
namespace tessera::volume {

/// One file to open, with information from its directory or list file.
struct SeriesFile {
    std::string path;
    std::optional<double> time;   ///< stated by a .pvd or .series
    std::optional<double> number; ///< last run of digits in the name
    /// Files of the same group are consecutive times; different groups are different parts or parameters of the same
    /// data. The name with its last number replaced by '#', or the part of the .pvd.
    std::string group;
    std::string part; ///< name of the part in a .pvd, "" = none
    /// Additional numbers that a .pvd or .series states for the file, by name: voltage="0.7".
    std::vector<std::pair<std::string, double>> numbers = {};
    /// All files of a volume whose slices are files, `path` first; else empty.
    std::vector<std::string> slices = {};
    /// Further files of the group may come later: alone, too, it is one time, at its number if it states none.
    bool growing = false;
    bool operator==(const SeriesFile&) const = default;
};

/// Expands the paths given by the user: a directory (of Zarr, an OpenFOAM case, its single .pvd or .series, or its
/// files of the most frequent known suffix), a pattern with * or ?, a ParaView .pvd or .series file, or files. Groups
/// keep the order of their first file; files of a group are sorted by time, then number. Duplicate paths are ignored.
/// Files that a list names and that do not exist are left out and said in `missing`, a sentence each; without it, and
/// where the list has no other, they are an Error. Throws Error for paths that do not exist or cannot be read, and for
/// lists of files elsewhere if that is refused.
std::vector<SeriesFile> expandPaths(const std::vector<std::string>& paths, Outside outside = Outside::Refused,
                                    std::vector<std::string>* missing = nullptr);

/// The files that a pattern with * or ? fits, in alphabetical order; empty if there is none.
std::vector<std::string> filesOfPattern(const std::string& pattern);

/// Contents of a .pvd (XML Collection). `file` names it in errors; paths are relative to its folder.
std::vector<SeriesFile> parsePvd(const std::string& xml, const std::string& file, Outside outside = Outside::Refused);

/// Contents of a .series (ParaView's JSON: {"files": [{"name": .., "time": ..}]}).
std::vector<SeriesFile> parseSeries(const std::string& json, const std::string& file,
                                    Outside outside = Outside::Refused);

/// The number of a slice in the name of its file, and that of its time where it has one: those that follow a letter z
/// and a letter t of their own ("run_t03_z012_c1.tif"), else the last. `volume` is the name without the number of the
/// slice, `series` without that of the time, too.
struct SliceName {
    std::string volume, series;
    std::optional<double> slice, time;
};
SliceName sliceName(const std::string& path);

} // namespace tessera::volume
