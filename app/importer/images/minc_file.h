#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <vector>

/// What the two versions of MINC state in files of different libraries: NetCDF (version 1) and HDF5 (version 2).
namespace tessera::importer {

struct MincAxis {
    std::string name, unit; ///< "xspace", "time", "vector_dimension"
    std::size_t size = 1;
    double start = 0, step = 0; ///< step 0: not stated
    std::vector<double> cosines;
    std::vector<double> places; ///< of an irregular time
};

struct MincImage {
    std::vector<MincAxis> axes; ///< slowest first
    bool floats = false;        ///< real numbers as they stand; else integers that are scaled
    double lowest = -std::numeric_limits<double>::infinity();
    double highest = std::numeric_limits<double>::infinity(); ///< stored numbers beyond are none
    /// The real values of the lowest and highest stored number, one for each place along the first `scaledAxes` axes.
    std::vector<double> lows, highs;
    std::size_t scaledAxes = 0;
    double stored = 0; ///< bytes of the file
    /// Reads stored numbers of a box, in the order of the axes.
    std::function<std::vector<double>(const std::vector<std::size_t>& start, const std::vector<std::size_t>& count)>
        read;
};

MincImage openMinc1(const std::string& path);
MincImage openMinc2(const std::string& path);

} // namespace tessera::importer
