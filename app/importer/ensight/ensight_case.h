#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// Case files of EnSight Gold and EnSight 6: what is stored where, at which times.
namespace tessera::importer {

/// A time set: its times, and the numbers that stand for the asterisks in file names.
struct EnSightTimes {
    std::vector<double> values;
    std::vector<long> files;
};

/// A file, or one for each step where its name has asterisks. Steps of a file set lie in fewer files, several in each.
struct EnSightFile {
    std::string name;
    int timeSet = -1, fileSet = -1; ///< their numbers in the case, -1: none stated
};

struct EnSightVariable {
    enum class Kind { Scalar, Vector, Symmetric, Tensor };
    std::string name;
    Kind kind = Kind::Scalar;
    bool ofCells = false;
    EnSightFile file;
};

struct EnSightConstant {
    std::string name;
    int timeSet = -1;
    std::vector<double> values;
};

struct EnSightCase {
    std::string path;
    bool gold = true;
    EnSightFile geometry;
    bool coordinatesOnly = false; ///< only points change; cells may be stored at one step alone
    std::size_t cellsAt = 0;      ///< that step
    std::vector<EnSightVariable> variables;
    std::vector<EnSightConstant> constants;
    std::map<int, EnSightTimes> times;
    std::map<int, std::vector<std::pair<std::string, std::size_t>>> fileSets; ///< numbers of files, steps in each
    std::vector<std::string> notes;                                           ///< about what is not read
};

/// Where the numbers of a step are.
struct EnSightPlace {
    std::string path;
    std::size_t step = 0; ///< of those in this file
};

/// Reads a case file. Keywords may have any case, and the last line needs no line end. Throws std::runtime_error with
/// one line of reason.
EnSightCase readEnSightCase(const std::string& path);

/// The times of a file; null if it is the same at all times.
const EnSightTimes* timesOf(const EnSightCase& about, const EnSightFile& file);

/// The step of a file at a time, by its own time set: nothing if it has none there. With `held` the last step until
/// then, or its first.
std::optional<std::size_t> stepAt(const EnSightCase& about, const EnSightFile& file, double time, bool held);

/// The place of a step of a file.
EnSightPlace placeOf(const EnSightCase& about, const EnSightFile& file, std::size_t step);

/// The times of all time sets of these files and constants; those that differ by rounding only once.
std::vector<double> allTimes(const EnSightCase& about);

/// The case files that a server file (.sos) names, each with a part of the same data.
std::vector<std::string> casesOfServers(const std::string& path);

} // namespace tessera::importer
