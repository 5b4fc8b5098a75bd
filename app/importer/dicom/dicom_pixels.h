#pragma once

#include "app/importer/dicom/dicom_elements.h"

#include <string>
#include <vector>

/// The stored numbers of one frame, whatever their encoding.
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

/// Throws unless the file has samples that are read here, and as many bytes of them as its header says.
DicomForm dicomForm(const DicomFile& file);

/// The stored numbers of a frame, top row first; colours as red, green and blue of each pixel.
std::vector<double> dicomNumbers(const DicomFile& file, const DicomForm& form, int frame);

} // namespace tessera::importer
