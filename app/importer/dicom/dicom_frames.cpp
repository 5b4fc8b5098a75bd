#include "app/importer/dicom/dicom_frames.h"

#include "app/importer/dicom/dicom_axes.h"
#include "app/importer/dicom/dicom_pixels.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <stdexcept>

namespace tessera::importer {

namespace {

glm::dvec3 vectorOf(const std::vector<double>& numbers, std::size_t from = 0) {
    return {numbers[from], numbers[from + 1], numbers[from + 2]};
}

void takePlane(const DicomGroups& groups, DicomFrame& frame) {
    std::vector<double> corner = groups.numbers(0x00209113, 0x00200032);
    if (corner.size() != 3) corner = groups.numbers(0x0020930e, 0x00209301); // of ultrasound volumes
    if (corner.size() != 3) corner = groups.numbers(0x00540022, 0x00200032); // of detectors
    if (corner.size() == 3) frame.corner = vectorOf(corner);
    std::vector<double> turn = groups.numbers(0x00209116, 0x00200037);
    if (turn.size() != 6) turn = groups.numbers(0x0020930f, 0x00209302);
    if (turn.size() != 6) turn = groups.numbers(0x00540022, 0x00200037);
    if (turn.size() == 6) {
        const glm::dvec3 across = vectorOf(turn), down = vectorOf(turn, 3);
        if (glm::length(across) > 0 && glm::length(down) > 0 && glm::length(glm::cross(across, down)) > 0) {
            frame.across = glm::normalize(across);
            frame.down = glm::normalize(down);
        }
    }
}

/// Spacing of ultrasound: of the first region whose unit is a length; cm to mm.
std::vector<double> regionSpacing(const DicomItem& data) {
    for (const DicomItem& region : data.items(0x00186011))
        if (region.number(0x00186024, 0) == 3 && region.number(0x00186026, 0) == 3)
            return {10 * std::abs(region.number(0x0018602e, 0)), 10 * std::abs(region.number(0x0018602c, 0))};
    return {};
}

void takeSpacing(const DicomGroups& groups, DicomFrame& frame) {
    constexpr DicomTag kMeasures = 0x00289110;
    std::vector<double> steps = groups.numbers(kMeasures, 0x00280030);
    if (steps.size() != 2) {
        steps = groups.root().numbers(0x00181164); // at the detector, not at the patient
        frame.atDetector = steps.size() == 2;
    }
    if (steps.size() != 2) steps = groups.root().numbers(0x00182010);
    if (steps.size() != 2) steps = regionSpacing(groups.root());
    if (steps.size() == 2 && steps[0] > 0 && steps[1] > 0) {
        frame.rowStep = steps[0];
        frame.columnStep = steps[1];
    }
    frame.thickness = std::max(0.0, groups.number(kMeasures, 0x00180050).value_or(0));
    frame.between = groups.number(kMeasures, 0x00180088).value_or(0);
}

void takeScaling(const DicomGroups& groups, const DicomImage& image, DicomFrame& frame) {
    constexpr DicomTag kTransformation = 0x00289145;
    const std::optional<double> slope = groups.number(kTransformation, 0x00281053);
    const std::optional<double> intercept = groups.number(kTransformation, 0x00281052);
    const std::optional<double> dose = groups.root().number(0x3004000e);
    if (dose && *dose > 0) {
        frame.slope = *dose;
        frame.rescaled = true;
    } else if (slope || intercept) {
        frame.slope = slope.value_or(1);
        frame.intercept = intercept.value_or(0);
        frame.rescaled = frame.slope != 0;
        frame.rescaleType = groups.text(kTransformation, 0x00281054);
    } else if (const DicomItem* real = groups.item(0x00409096);
               real != nullptr && real->number(0x00409225).value_or(0) != 0 && !image.lookUp) {
        frame.slope = *real->number(0x00409225);
        frame.intercept = real->number(0x00409224, 0);
        frame.rescaled = true;
        if (const DicomItem* unit = real->item(0x004008ea)) frame.rescaleType = unit->text(0x00080100);
    }
    if (frame.slope == 0) {
        frame.slope = 1;
        frame.intercept = 0;
    }
}

/// Frames that must lie on one grid: of one series, size and orientation.
std::string stackOf(const DicomImage& image, const DicomFrame& frame, const std::string& own) {
    char text[300];
    const auto rounded = [](double value) { return std::round(value * 500) / 500 + 0.0; };
    std::snprintf(text, sizeof text, "|%dx%dx%d|%d|%d|%g %g %g %g %g %g|%.4g %.4g|%d", image.form.columns,
                  image.form.rows, image.form.samples, int(image.localizer), int(frame.corner.has_value()),
                  rounded(frame.across.x), rounded(frame.across.y), rounded(frame.across.z), rounded(frame.down.x),
                  rounded(frame.down.y), rounded(frame.down.z), frame.columnStep, frame.rowStep, int(image.form.real));
    return image.series + text + "|" + own;
}

/// Places of the frames of a file that states one for all: a dose's list, or steps along the normal.
void placeFrames(const DicomItem& data, std::vector<DicomFrame>& frames, std::size_t begin) {
    const std::vector<double> offsets = data.numbers(0x3004000c), slices = data.numbers(0x00540080);
    const auto count = frames.size() - begin;
    const bool timed = std::any_of(frames.begin() + std::ptrdiff_t(begin), frames.end(),
                                   [&](const DicomFrame& frame) { return frame.axes != frames[begin].axes; });
    for (std::size_t f = 0; f < count; ++f) {
        DicomFrame& frame = frames[begin + f];
        const glm::dvec3 normal = glm::cross(frame.across, frame.down);
        const double step = frame.between != 0 ? frame.between : frame.thickness > 0 ? frame.thickness : 1;
        std::optional<double> along;
        if (offsets.size() == count)
            along = offsets[0] == 0 || !frame.corner ? offsets[f] : offsets[f] - frame.corner->z; // those are z itself
        else if (slices.size() == count)
            along = (slices[f] - 1) * step;
        else if (!timed) {
            along = double(f) * step;
            frame.guessed = true;
        }
        if (!along && frame.corner) continue;
        if (frame.corner)
            *frame.corner += normal * along.value_or(0);
        else
            frame.location = along.value_or(0);
    }
}

} // namespace

std::string notAnImage(const DicomFile& file) {
    const DicomItem& data = file.data();
    if (file.pixels().tag != 0) return {};
    if (data.find(0x00041220) != nullptr) return "DICOMDIR";
    const std::string modality = data.text(0x00080060);
    if (data.find(0x00280010) != nullptr) return {}; // an image that has lost its samples
    return modality.empty() || modality.size() > 16 ? "no image" : modality;
}

DicomImage describeDicom(const DicomFile& file, const std::string& path, std::size_t number,
                         std::vector<DicomFrame>& frames) {
    const DicomItem& data = file.data();
    DicomImage image;
    image.path = path;
    image.form = dicomForm(file);
    image.series = data.text(0x0020000e);
    image.seriesName = data.text(0x0008103e);
    image.number = data.number(0x00200011);
    image.modality = data.text(0x00080060);
    image.kind = data.text(0x00080008);
    image.lookUp = data.find(0x00283000) != nullptr;
    image.temporalStep = data.number(0x00200110);
    if (data.find(0x3004000e) != nullptr) image.doseUnit = data.text(0x30040002);
    if (image.modality == "PT") image.activityUnit = data.text(0x00541001);
    image.mosaic = image.kind.find("MOSAIC") != std::string::npos;
    image.localizer = image.kind.find("LOCALIZER") != std::string::npos;
    image.overlays = std::ranges::any_of(data.elements,
                                         [](const DicomElement& one) { return (one.tag & 0xff01ffff) == 0x60003000; });
    const DicomForm& form = image.form;
    const auto stored = [&](DicomTag tag) {
        std::optional<double> value = data.number(tag);
        // Written as an unsigned number, whatever the samples are.
        if (value && form.isSigned && !form.real && *value > form.highest()) *value -= std::ldexp(1.0, form.bits);
        if (value && form.isSigned && !form.real && *value > form.highest()) value.reset();
        return value;
    };
    image.padding = stored(form.real ? form.bits == 32 ? 0x00280122 : 0x00280123 : 0x00280120);
    image.paddingLimit = stored(form.real ? form.bits == 32 ? 0x00280124 : 0x00280125 : 0x00280121);
    image.segmentation = data.text(0x00620001);
    image.mostFraction = std::max(1.0, data.number(0x0062000e, 1));
    if (!image.segmentation.empty())
        for (const DicomItem& segment : data.items(0x00620002))
            image.segments[int(segment.number(0x00620004, 0))] = segment.text(0x00620005);
    const std::size_t begin = frames.size();
    const double instance = data.number(0x00200013, 0);
    bool placed = false;
    for (int f = 0; f < form.frames; ++f) {
        const DicomGroups groups(data, std::size_t(f));
        DicomFrame frame;
        frame.image = number;
        frame.index = f;
        frame.number = form.frames > 1 ? instance * 1e6 + f : instance;
        takePlane(groups, frame);
        takeSpacing(groups, frame);
        takeScaling(groups, image, frame);
        takeAxes(groups, form.frames > 1, f, image, frame);
        frame.location = data.number(0x00201041);
        placed = placed || groups.ownHas(0x00209113) || groups.ownHas(0x0020930e);
        const std::string frameKind = groups.kind();
        frame.kind = frameKind.empty() ? image.kind : frameKind;
        if (frameKind.find("LOCALIZER") != std::string::npos) image.localizer = true;
        frame.segment = int(groups.number(0x0062000a, 0x0062000b).value_or(0));
        frame.stack = stackOf(image, frame, groups.text(0x00209111, 0x00209056));
        frames.push_back(std::move(frame));
    }
    if (form.frames > 1 && !placed) placeFrames(data, frames, begin);
    return image;
}

} // namespace tessera::importer
