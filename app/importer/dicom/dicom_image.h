#pragma once

#include "app/importer/dicom/dicom_form.h"

#include <cstddef>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <string>

namespace tessera::importer {

/// What tells images at one place apart, what states it best first.
enum class DicomAxis {
    Temporal,
    Trigger,
    Reference,
    Slot,
    FrameTime,
    BValue,
    Echo,
    Inversion,
    Flip,
    Energy,
    Detector,
    View,
    Index0, ///< dimensions that only a file's own index tells
    Index1,
    Index2,
    Acquired, ///< weak ones: they differ between the slices of one time, too
    Content,
    Acquisition,
};
struct DicomAxisWords {
    const char *name, *unit;
};
DicomAxisWords wordsOf(DicomAxis axis);

/// What all frames of a file share.
struct DicomImage {
    std::string path, series, seriesName, modality, kind; ///< `kind`: ImageType
    std::string doseUnit, activityUnit;
    DicomForm form;
    std::optional<double> number;                ///< of the series
    std::optional<double> padding, paddingLimit; ///< stored numbers
    std::optional<double> temporalStep;          ///< ms
    bool localizer = false, lookUp = false, overlays = false, mosaic = false;
    std::map<int, std::string> segments; ///< names by number; of a segmentation alone
    std::string segmentation;            ///< BINARY, FRACTIONAL, LABELMAP
    double mostFraction = 1;
};

struct DicomFrame {
    std::size_t image = 0; ///< which file
    int index = 0;         ///< of the frame in it
    std::string stack;     ///< stacks differ in this
    std::optional<glm::dvec3> corner;
    glm::dvec3 across{1, 0, 0}, down{0, 1, 0};
    double columnStep = 0, rowStep = 0; ///< 0 = not stated
    double thickness = 0, between = 0;  ///< of slices, 0 = not stated
    double slope = 1, intercept = 0;
    bool rescaled = false, atDetector = false;
    bool guessed = false;    ///< its place is a guess
    std::string rescaleType; ///< unit of the scaled numbers as the file writes it
    std::optional<double> location;
    double number = 0; ///< order of last resort
    std::map<DicomAxis, double> axes;
    std::string kind; ///< of image: magnitude, phase, water, ...
    int segment = 0;
};

} // namespace tessera::importer
