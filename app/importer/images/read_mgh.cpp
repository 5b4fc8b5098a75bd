// MGH and MGZ of FreeSurfer: a header of fixed places, samples, then times of the scanner; compressed as a whole in
// .mgz.
#include "app/importer/images/header_bytes.h"
#include "app/importer/images/sample_stream.h"
#include "app/importer/images/serve_stored.h"
#include "app/importer/readers/read_files.h"

#include <cmath>
#include <stdexcept>

namespace tessera::importer {

namespace {

constexpr std::size_t kMghHeader = 284;

volume::StoredType typeOfMgh(int code) {
    switch (code) {
    case 0:
        return volume::StoredType::U8;
    case 1:
        return volume::StoredType::I32;
    case 3:
        return volume::StoredType::F32;
    case 4:
        return volume::StoredType::I16;
    case 10:
        return volume::StoredType::U16;
    default:
        throw std::runtime_error("has samples of type " + std::to_string(code) +
                                 ", which is not read: write them as float (mri_convert -odt float)");
    }
}

/// The middle of the image lies at c; without directions it is coronal, of 1 mm, about the origin.
void placeMgh(const HeaderBytes& in, volume::StoredImage& image) {
    glm::dvec3 middle(0);
    image.grid.steps = {glm::dvec3(-1, 0, 0), glm::dvec3(0, 0, -1), glm::dvec3(0, 1, 0)};
    if (in.at<std::int16_t>(28) != 0) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (std::size_t row = 0; row < 3; ++row)
                image.grid.steps[int(axis)][int(row)] = in.real(30 + 4 * axis) * in.real(42 + 4 * (3 * axis + row));
        for (std::size_t row = 0; row < 3; ++row) middle[int(row)] = in.real(78 + 4 * row);
    } else {
        image.notes.emplace_back("the file states no orientation: FreeSurfer's usual one (coronal, 1 mm) is taken");
    }
    image.grid.origin = middle;
    for (int axis = 0; axis < 3; ++axis) image.grid.origin -= image.grid.steps[axis] * (image.grid.size[axis] / 2.0);
    image.notes.emplace_back("x, y and z run to the patient's right, anterior and superior");
}

} // namespace

void openMgh(Source& source) {
    HeaderBytes in{inflatedPart(source.path, kMghHeader), true}; // always big-endian
    if (in.bytes.size() < kMghHeader) throw std::runtime_error("ends within its header: truncated");
    if (in.at<std::int32_t>(0) != 1) throw std::runtime_error("is damaged or has another format");
    volume::StoredImage image;
    image.type = typeOfMgh(in.at<std::int32_t>(20));
    image.bigEndian = true;
    std::vector<volume::StoredAxis> axes;
    for (std::size_t i = 0; i < 4; ++i) {
        const auto size = in.at<std::int32_t>(4 + 4 * i);
        if (size < 1) throw std::runtime_error("states a size that is out of range");
        axes.push_back(
            {i < 3 ? volume::StoredAxis::Along::Space : volume::StoredAxis::Along::Times, std::size_t(size)});
    }
    volume::setAxes(image, axes);
    image.files.encoding = compressionOf(source.path);
    image.files.byteSkip = std::int64_t(kMghHeader);
    placeMgh(in, image);
    image.lengthUnit = "mm";
    volume::setChannels(image, "value", volume::ComponentKind::Channels);
    if (image.frames > 1) {
        image.times = volume::evenTimes(image.frames, 0, 1);
        image.notes.emplace_back("its frames are shown as times, which are counted");
    }
    serveStored(source, std::move(image));
}

} // namespace tessera::importer
