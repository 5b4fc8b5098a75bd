// NIfTI-1 and NIfTI-2, in one file or in two (.hdr, .img), and Analyze 7.5, whose header NIfTI-1 extends.
// https://nifti.nimh.nih.gov: nifti1.h and nifti2.h state every field.
#include "app/importer/images/header_bytes.h"
#include "app/importer/images/sample_stream.h"
#include "app/importer/images/serve_stored.h"
#include "app/importer/readers/check_file.h"
#include "app/importer/readers/read_files.h"
#include "volume/base/trimmed.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <optional>
#include <stdexcept>

namespace tessera::importer {

namespace fs = std::filesystem;

namespace {

using volume::ComponentKind;
using volume::StoredAxis;
using volume::StoredImage;
using volume::StoredType;

constexpr int kIntentLabel = 1002, kIntentDisplacement = 1006, kIntentVector = 1007, kIntentColor = 2003,
              kIntentColorAlpha = 2004;

/// The fields of either version.
struct NiftiHeader {
    bool analyze = false, pair = false;
    int bytes = 348;
    std::array<double, 8> dim{}, pixdim{};
    int type = 0, intent = 0, units = 0, qform = 0, sform = 0;
    double begin = 0, slope = 0, intercept = 0, toffset = 0;
    std::array<double, 6> quaternion{}; ///< b, c, d, and the offset in x, y, z
    std::array<double, 12> rows{};      ///< of the affine matrix of sform
    std::string intentName;
    std::array<int, 3> originator{}; ///< of Analyze, by SPM: the sample at the origin, from 1
};

void readFields1(const HeaderBytes& in, NiftiHeader& header) {
    for (std::size_t i = 0; i < 8; ++i) {
        header.dim[i] = in.at<std::int16_t>(40 + 2 * i);
        header.pixdim[i] = in.real(76 + 4 * i);
    }
    header.type = in.at<std::int16_t>(70);
    header.begin = double(in.at<float>(108));
    header.slope = double(in.at<float>(112));
    const std::string magic = in.text(344, 4);
    header.pair = magic != "n+1";
    header.analyze = magic != "n+1" && magic != "ni1";
    if (header.analyze) {
        for (std::size_t i = 0; i < 3; ++i) header.originator[i] = in.at<std::int16_t>(253 + 2 * i);
        return;
    }
    header.intercept = double(in.at<float>(116));
    header.intent = in.at<std::int16_t>(68);
    header.units = static_cast<unsigned char>(in.bytes[123]);
    header.toffset = in.real(136);
    header.qform = in.at<std::int16_t>(252);
    header.sform = in.at<std::int16_t>(254);
    for (std::size_t i = 0; i < 6; ++i) header.quaternion[i] = in.real(256 + 4 * i);
    for (std::size_t i = 0; i < 12; ++i) header.rows[i] = in.real(280 + 4 * i);
    header.intentName = in.text(328, 16);
}

void readFields2(const HeaderBytes& in, NiftiHeader& header) {
    header.pair = in.text(4, 4) != "n+2";
    header.type = in.at<std::int16_t>(12);
    for (std::size_t i = 0; i < 8; ++i) {
        header.dim[i] = double(in.at<std::int64_t>(16 + 8 * i));
        header.pixdim[i] = in.at<double>(104 + 8 * i);
    }
    header.begin = double(in.at<std::int64_t>(168));
    header.slope = in.at<double>(176);
    header.intercept = in.at<double>(184);
    header.toffset = in.at<double>(216);
    header.qform = in.at<std::int32_t>(344);
    header.sform = in.at<std::int32_t>(348);
    for (std::size_t i = 0; i < 6; ++i) header.quaternion[i] = in.at<double>(352 + 8 * i);
    for (std::size_t i = 0; i < 12; ++i) header.rows[i] = in.at<double>(400 + 8 * i);
    header.units = in.at<std::int32_t>(500);
    header.intent = in.at<std::int32_t>(504);
    header.intentName = in.text(508, 16);
}

NiftiHeader readNiftiHeader(const std::string& path, bool& bigEndian) {
    HeaderBytes in{inflatedPart(path, 540)};
    NiftiHeader header;
    for (const bool big : {false, true}) {
        in.swap = big;
        const auto size = in.at<std::int32_t>(0);
        if (size != 348 && size != 540) continue;
        bigEndian = big;
        if (in.bytes.size() < std::size_t(size)) break;
        header.bytes = size;
        if (size == 348)
            readFields1(in, header);
        else
            readFields2(in, header);
        if (!(header.dim[0] >= 1 && header.dim[0] <= 7)) break;
        return header;
    }
    throw std::runtime_error(in.bytes.size() < 348 ? "ends within its header: truncated"
                                                   : "is damaged or has another format");
}

struct NiftiType {
    int code;
    StoredType type;
    int components;
    ComponentKind parts;
};

NiftiType typeOfNifti(int code) {
    static constexpr NiftiType kTypes[] = {
        {2, StoredType::U8, 1, ComponentKind::Channels},     {4, StoredType::I16, 1, ComponentKind::Channels},
        {8, StoredType::I32, 1, ComponentKind::Channels},    {16, StoredType::F32, 1, ComponentKind::Channels},
        {32, StoredType::F32, 2, ComponentKind::Complex},    {64, StoredType::F64, 1, ComponentKind::Channels},
        {128, StoredType::U8, 3, ComponentKind::Colors},     {256, StoredType::I8, 1, ComponentKind::Channels},
        {512, StoredType::U16, 1, ComponentKind::Channels},  {768, StoredType::U32, 1, ComponentKind::Channels},
        {1024, StoredType::I64, 1, ComponentKind::Channels}, {1280, StoredType::U64, 1, ComponentKind::Channels},
        {1792, StoredType::F64, 2, ComponentKind::Complex},  {2304, StoredType::U8, 4, ComponentKind::Colors}};
    for (const NiftiType& type : kTypes)
        if (type.code == code) return type;
    std::string what = "of unknown type " + std::to_string(code);
    if (code == 1) what = "of 1 bit";
    if (code == 1536 || code == 2048) what = "of 128 bits";
    throw std::runtime_error("has samples " + what +
                             ", which are not read: write them as float32 (nibabel: set_data_dtype)");
}

struct Affine {
    glm::dmat3 steps{1};
    glm::dvec3 origin{0};
};

bool isUsable(const Affine& affine) {
    for (int axis = 0; axis < 3; ++axis) {
        const double length = glm::length(affine.steps[axis]);
        if (!std::isfinite(length) || !(length > 0) || !std::isfinite(affine.origin[axis])) return false;
    }
    glm::dmat3 directions = affine.steps;
    for (int axis = 0; axis < 3; ++axis) directions[axis] = glm::normalize(directions[axis]);
    return std::abs(glm::determinant(directions)) > 1e-6;
}

double voxelSize(const NiftiHeader& header, std::size_t axis) {
    const double size = std::abs(header.pixdim[axis]);
    return std::isfinite(size) && size > 0 ? size : 1;
}

Affine ofSform(const NiftiHeader& header) {
    Affine out;
    for (int row = 0; row < 3; ++row) {
        for (int axis = 0; axis < 3; ++axis) out.steps[axis][row] = header.rows[std::size_t(4 * row + axis)];
        out.origin[row] = header.rows[std::size_t(4 * row + 3)];
    }
    return out;
}

/// Rotation by the quaternion (a, b, c, d); the third axis is turned round where pixdim[0] is negative.
Affine ofQform(const NiftiHeader& header) {
    double b = header.quaternion[0], c = header.quaternion[1], d = header.quaternion[2];
    const double rest = 1 - (b * b + c * c + d * d);
    double a = rest > 0 ? std::sqrt(rest) : 0;
    if (rest < 1e-7) { // half a turn
        const double length = std::sqrt(b * b + c * c + d * d);
        b /= length;
        c /= length;
        d /= length;
        a = 0;
    }
    Affine out;
    out.steps[0] = {a * a + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c)};
    out.steps[1] = {2 * (b * c - a * d), a * a + c * c - b * b - d * d, 2 * (c * d + a * b)};
    out.steps[2] = {2 * (b * d + a * c), 2 * (c * d - a * b), a * a + d * d - c * c - b * b};
    if (header.pixdim[0] < 0) out.steps[2] = -out.steps[2];
    for (int axis = 0; axis < 3; ++axis) out.steps[axis] *= voxelSize(header, std::size_t(axis) + 1);
    out.origin = {header.quaternion[3], header.quaternion[4], header.quaternion[5]};
    return out;
}

/// How far apart two placements put the corners of an image, in its smallest voxels.
double apart(const Affine& a, const Affine& b, const StoredImage& image, double voxel) {
    double most = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 at(corner & 1 ? image.grid.size.x - 1 : 0, corner & 2 ? image.grid.size.y - 1 : 0,
                            corner & 4 ? image.grid.size.z - 1 : 0);
        most = std::max(most, glm::length(a.steps * at + a.origin - b.steps * at - b.origin));
    }
    return most / voxel;
}

void placeNifti(const NiftiHeader& header, StoredImage& image) {
    std::optional<Affine> sform, qform;
    if (header.sform > 0) sform = ofSform(header);
    if (header.qform > 0) qform = ofQform(header);
    if (sform && !isUsable(*sform)) {
        sform.reset();
        image.notes.emplace_back("its sform is no placement in space and was left out");
    }
    if (qform && !isUsable(*qform)) {
        qform.reset();
        image.notes.emplace_back("its qform is no placement in space and was left out");
    }
    const double voxel = std::min({voxelSize(header, 1), voxelSize(header, 2), voxelSize(header, 3)});
    Affine used;
    if (sform && qform)
        if (const double off = apart(*sform, *qform, image, voxel); off > 0.01) {
            char text[160];
            std::snprintf(text, sizeof text,
                          "its sform and qform place samples differently, up to %.3g voxels apart: sform is taken",
                          off);
            image.notes.emplace_back(text);
        }
    if (sform) {
        used = *sform;
    } else if (qform) {
        used = *qform;
    } else {
        for (int axis = 0; axis < 3; ++axis) used.steps[axis][axis] = voxelSize(header, std::size_t(axis) + 1);
        if (header.analyze) {
            const std::array<int, 3>& from = header.originator;
            if (from[0] > 0 || from[1] > 0 || from[2] > 0)
                for (int axis = 0; axis < 3; ++axis)
                    used.origin[axis] = -used.steps[axis][axis] * (from[std::size_t(axis)] - 1);
            image.notes.emplace_back("Analyze 7.5 states no orientation: axes are shown as stored, so that left and "
                                     "right may be exchanged");
        } else {
            image.notes.emplace_back("the file states no orientation (neither sform nor qform): axes are shown as "
                                     "stored, by the sizes of its voxels");
        }
    }
    if (sform || qform) image.notes.emplace_back("x, y and z run to the patient's right, anterior and superior");
    image.grid.steps = used.steps;
    image.grid.origin = used.origin;
}

void setUnits(const NiftiHeader& header, StoredImage& image) {
    constexpr int kSpace = 7, kTime = 56;
    static constexpr const char* kLengths[] = {"", "m", "mm", "um"};
    if ((header.units & kSpace) < 4) image.lengthUnit = kLengths[header.units & kSpace];
    if (header.analyze) image.lengthUnit = "mm";
    if (image.frames < 2) return;
    struct Unit {
        const char *unit, *name;
    };
    static constexpr Unit kTimes[] = {
        {"", ""}, {"s", ""}, {"ms", ""}, {"us", ""}, {"Hz", "frequency"}, {"ppm", "shift"}, {"rad/s", "frequency"},
        {"", ""}};
    const Unit& unit = kTimes[(header.units & kTime) / 8];
    image.timeUnit = unit.unit;
    image.timeName = unit.name;
    const double step = header.pixdim[4];
    const bool stated = std::isfinite(step) && step > 0;
    const double first = std::isfinite(header.toffset) ? header.toffset : 0;
    image.times = volume::evenTimes(image.frames, first, stated ? step : 1);
    if (!stated) image.notes.emplace_back("the file states no step between its times: they are counted");
}

/// The file of the samples, of a pair the one beside the header.
std::string samplesBeside(const std::string& header) {
    const fs::path path(header);
    std::string stem = path.filename().string(), packed;
    if (stem.ends_with(".gz")) {
        stem.resize(stem.size() - 3);
        packed = ".gz";
    }
    const bool big = stem.ends_with(".HDR");
    stem.erase(stem.size() - std::min<std::size_t>(stem.size(), 4));
    for (const std::string& ending : {packed, packed.empty() ? std::string(".gz") : std::string()}) {
        const std::string name = stem + (big ? ".IMG" : ".img") + ending;
        if (fs::exists(path.parent_path() / name)) return name;
    }
    throw std::runtime_error("its samples' file " + stem + ".img is missing");
}

/// The header of a file that was opened by its samples (.img).
std::string headerOf(const std::string& path) {
    std::string name = path;
    const std::size_t dot = name.ends_with(".gz") ? name.size() - 7 : name.size() - 4;
    if (name.size() < 8) return path;
    const std::string ending = name.substr(dot, 4);
    if (ending != ".img" && ending != ".IMG") return path;
    name.replace(dot, 4, ending == ".img" ? ".hdr" : ".HDR");
    if (fs::exists(name)) return name;
    const std::string other = name.ends_with(".gz") ? name.substr(0, name.size() - 3) : name + ".gz";
    if (fs::exists(other)) return other;
    throw std::runtime_error("its header " + fs::path(name).filename().string() + " is missing");
}

void setAxesOfNifti(const NiftiHeader& header, int components, StoredImage& image) {
    std::vector<StoredAxis> axes{{StoredAxis::Along::Components, std::size_t(components)}};
    for (std::size_t i = 1; i <= 7; ++i) {
        double size = i <= std::size_t(header.dim[0]) ? header.dim[i] : 1;
        if (i > 3 && size == 0) size = 1; // some writers leave axes without meaning at 0
        if (!(size >= 1 && size <= 1e9)) throw std::runtime_error("states a size that is out of range");
        axes.push_back({i < 4   ? StoredAxis::Along::Space
                        : i > 4 ? StoredAxis::Along::Components
                                : StoredAxis::Along::Times,
                        std::size_t(size)});
    }
    volume::setAxes(image, axes);
}

ComponentKind partsOfNifti(const NiftiHeader& header, const NiftiType& type, const StoredImage& image) {
    if (type.components > 1)
        return image.offsets.size() == std::size_t(type.components) || type.parts == ComponentKind::Complex
                   ? type.parts
                   : ComponentKind::Channels;
    if (header.intent == kIntentColor || header.intent == kIntentColorAlpha) return ComponentKind::Colors;
    const bool vector = header.intent == kIntentVector || header.intent == kIntentDisplacement;
    return vector || (header.intent == 0 && image.offsets.size() == 3) ? ComponentKind::Vector
                                                                       : ComponentKind::Channels;
}

} // namespace

void openNifti(Source& source) {
    source.path = headerOf(source.path);
    StoredImage image;
    const NiftiHeader header = readNiftiHeader(source.path, image.bigEndian);
    const NiftiType type = typeOfNifti(header.type);
    image.type = type.type;
    setAxesOfNifti(header, type.components, image);
    std::string samples = source.path;
    if (header.pair) {
        image.files.names = {samplesBeside(source.path)};
        samples = besides(source.path, image.files.names[0]);
    }
    image.files.encoding = compressionOf(samples);
    // In one file the samples lie behind the header and the four bytes that tell of extensions.
    const double least = header.pair ? 0 : double(header.bytes) + 4;
    const double begin = std::isfinite(header.begin) ? std::max(header.begin, least) : least;
    if (!(begin < 1e15)) throw std::runtime_error("states a place of its samples that is out of range");
    image.files.byteSkip = std::int64_t(begin);
    placeNifti(header, image);
    setUnits(header, image);
    std::string name(volume::trimmed(header.intentName));
    if (name.empty()) name = header.intent == kIntentLabel ? "label" : "value";
    volume::setChannels(image, name, partsOfNifti(header, type, image));
    if (std::isfinite(header.slope) && header.slope != 0 && type.parts != ComponentKind::Colors) {
        image.scale = header.slope;
        image.offset = std::isfinite(header.intercept) ? header.intercept : 0;
        if (header.analyze && header.slope != 1)
            image.notes.emplace_back("stored numbers are scaled by the factor in the header, as SPM writes it");
    }
    serveStored(source, std::move(image));
}

} // namespace tessera::importer
