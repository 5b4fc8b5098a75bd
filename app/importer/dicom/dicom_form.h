#pragma once

#include <cstddef>
#include <string>

namespace tessera::importer {

/// How the samples of a file are stored.
struct DicomForm {
    int columns = 0, rows = 0, frames = 1, samples = 1;
    int bits = 16, used = 16, high = 15; ///< allocated and used for each number, and the highest used
    bool isSigned = false, planar = false;
    std::string photometric; ///< "MONOCHROME2", "RGB", ...

    bool isReal() const { return real; }
    bool real = false; ///< floating point of 32 or 64 bits
    std::size_t pixels() const { return std::size_t(columns) * std::size_t(rows); }
    /// The lowest and highest number that can be stored.
    double lowest() const;
    double highest() const;
    bool operator==(const DicomForm&) const = default;
};

} // namespace tessera::importer
