#pragma once

#include "app/importer/dicom/dicom_frames.h"

#include <string>
#include <vector>

/// From frames in any order to a volume over time.
namespace tessera::importer {

inline constexpr std::size_t kNoFrame = static_cast<std::size_t>(-1);

struct DicomStack {
    glm::dvec3 corner{0}, columnStep{1, 0, 0}, rowStep{0, 1, 0}, sliceStep{0, 0, 1};
    std::size_t slices = 1;
    std::vector<double> uneven;              ///< places of the slices along `sliceStep`; empty = even
    std::vector<std::string> parameters{""}; ///< what tells them apart, "" where there is one
    std::vector<double> times;               ///< empty where there is one
    std::string timeName, timeUnit;
    std::vector<std::size_t> frames; ///< index by (time, parameter, slice), kNoFrame where there is none
    bool inMillimetres = true;
    std::vector<std::string> notes;

    std::size_t frameAt(std::size_t time, std::size_t parameter, std::size_t slice) const {
        return frames[(time * parameters.size() + parameter) * slices + slice];
    }
};

/// Lays out frames of one stack; `chosen` are their indices among all.
DicomStack stackDicom(const std::vector<DicomImage>& images, const std::vector<DicomFrame>& frames,
                      const std::vector<std::size_t>& chosen);

/// Where slices lie: places along an axis, in order, with the slice of each frame.
struct DicomPlaces {
    std::vector<double> at;
    std::vector<std::size_t> ofFrame; ///< index into `at`
};
DicomPlaces placesAlong(const std::vector<double>& along, double tolerance);

/// What tells the frames at one place apart, and the order of it.
struct DicomOrder {
    std::vector<double> times; ///< at least one
    std::vector<std::string> parameters{""};
    std::string timeName, timeUnit;
    std::vector<std::size_t> time, parameter; ///< of each frame; kNoFrame: it is left out
    std::vector<std::string> notes;
};
DicomOrder orderDicom(const std::vector<DicomImage>& images, const std::vector<DicomFrame>& frames,
                      const std::vector<std::size_t>& chosen, const DicomPlaces& places);

} // namespace tessera::importer
