// MRC and CCP4 maps of electron microscopy and crystallography: a header of 1024 bytes, an extended header, samples.
#include "app/importer/grids/grid_file.h"
#include "app/importer/readers/check_file.h"
#include "app/importer/readers/read_files.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <vtkPointData.h>

namespace tessera::importer {

namespace {

constexpr std::size_t kMrcHeader = 1024;

/// The header, by the words of MRC2014.
struct MrcForm {
    std::array<int, 3> size{}, start{}, cells{}, axes{};
    std::array<double, 3> cell{}, angles{}, origin{};
    int mode = 0, group = 0, extended = 0;
    double highest = 0;
    bool swapped = false;
    std::optional<bool> signedBytes; ///< as IMOD states it
    int volumes = 1;
    std::string name = "value";
};

class MrcHeader {
public:
    MrcHeader(const std::string& bytes, bool swapped) : bytes_(bytes), swapped_(swapped) {}

    int whole(std::size_t word) const { return std::bit_cast<std::int32_t>(raw(word)); }
    double real(std::size_t word) const { return double(std::bit_cast<float>(raw(word))); }

private:
    std::uint32_t raw(std::size_t word) const {
        std::uint32_t value = 0;
        std::memcpy(&value, bytes_.data() + 4 * word, 4);
        return swapped_ ? __builtin_bswap32(value) : value;
    }
    const std::string& bytes_;
    bool swapped_;
};

bool isLikelyMrc(const MrcHeader& header) {
    const int mode = header.whole(3);
    const bool known = (mode >= 0 && mode <= 4) || mode == 6 || mode == 12 || mode == 16 || mode == 101;
    return known && header.whole(0) > 0 && header.whole(1) > 0 && header.whole(2) > 0;
}

double plainLength(double value) { // of a float in the header: 0.1, not 0.10000000149
    return meantTime(value);
}

MrcForm formOfMrc(const std::string& path) {
    GridBytes file(path);
    const std::string bytes = file.part(0, kMrcHeader);
    if (bytes.size() < kMrcHeader) throw std::runtime_error("ends within its header, or is no MRC or CCP4 map");
    constexpr bool kLittle = std::endian::native == std::endian::little;
    const auto stamp = static_cast<unsigned char>(bytes[212]);
    const bool big = stamp == 0x11, stated = stamp == 0x44 || big;
    MrcForm form;
    form.swapped = stated && big == kLittle;
    if (!isLikelyMrc(MrcHeader(bytes, form.swapped))) form.swapped = !form.swapped;
    const MrcHeader header(bytes, form.swapped);
    if (!isLikelyMrc(header)) throw std::runtime_error("is no MRC or CCP4 map");
    for (std::size_t axis = 0; axis < 3; ++axis) {
        form.size[axis] = header.whole(axis);
        form.start[axis] = header.whole(4 + axis);
        form.cells[axis] = header.whole(7 + axis);
        form.cell[axis] = plainLength(header.real(10 + axis));
        form.angles[axis] = plainLength(header.real(13 + axis));
        form.axes[axis] = header.whole(16 + axis) - 1;
        form.origin[axis] = plainLength(header.real(49 + axis));
    }
    form.mode = header.whole(3);
    form.highest = header.real(20);
    form.group = header.whole(22);
    form.extended = header.whole(23);
    if (form.extended < 0) throw std::runtime_error("states an extended header of less than no bytes");
    constexpr int kImod = 1146047817;
    if (header.whole(38) == kImod) form.signedBytes = (header.whole(39) & 1) != 0;
    // Files from before MRC2014 have no origin there, and no word that tells.
    if (bytes.compare(208, 3, "MAP") != 0) form.origin = {};
    return form;
}

PixelForm sliceOfMrc(MrcForm& form, Source& source) {
    PixelForm slice{std::uint32_t(form.size[0]), std::uint32_t(form.size[1]), 8, 1, PixelNumbers::Signed};
    switch (form.mode) {
    case 0: {
        const bool guess = !form.signedBytes;
        const bool isSigned = form.signedBytes.value_or(form.highest <= 127);
        if (!isSigned) slice.numbers = PixelNumbers::Unsigned;
        if (guess && !isSigned)
            source.notes.emplace_back("Its bytes are read as 0 to 255, since its header states a maximum beyond 127.");
        break;
    }
    case 1:
        slice.bits = 16;
        break;
    case 2:
        slice.bits = 32;
        slice.numbers = PixelNumbers::Float;
        break;
    case 3:
        slice.bits = 16;
        slice.samples = 2; // real and imaginary part
        break;
    case 4:
        slice.bits = 64;
        slice.numbers = PixelNumbers::Complex;
        break;
    case 6:
        slice.bits = 16;
        slice.numbers = PixelNumbers::Unsigned;
        break;
    case 12:
        slice.bits = 16;
        slice.numbers = PixelNumbers::Float;
        break;
    case 16:
        slice.samples = 3;
        slice.numbers = PixelNumbers::Unsigned;
        source.notes.emplace_back("Its colours are read as separate parameters.");
        break;
    default: // 101: the lower half of a byte comes first
        slice.bits = 4;
        slice.numbers = PixelNumbers::Unsigned;
    }
    if (form.mode == 3 || form.mode == 4)
        source.notes.emplace_back("Its complex numbers are read as real and imaginary part.");
    return slice;
}

/// Steps along x, y and z of the cell, by its lengths and angles.
glm::dmat3 cellVectors(const MrcForm& form) {
    const auto radians = [](double degrees) {
        return (degrees > 0 && degrees < 180 ? degrees : 90.0) * std::numbers::pi / 180;
    };
    const auto cosine = [&](double degrees) {
        return degrees == 90 || degrees == 0 ? 0.0 : std::cos(radians(degrees));
    };
    const double a = form.cell[0], b = form.cell[1], c = form.cell[2];
    const double alpha = cosine(form.angles[0]), beta = cosine(form.angles[1]), gamma = cosine(form.angles[2]);
    const double sine = std::sqrt(1 - gamma * gamma), slant = (alpha - beta * gamma) / sine;
    return {{a, 0, 0},
            {b * gamma, b * sine, 0},
            {c * beta, c * slant, c * std::sqrt(std::max(0.0, 1 - beta * beta - slant * slant))}};
}

/// Fills in what a header leaves at zero, with notes.
void completeMrc(MrcForm& form, Source& source) {
    std::array<int, 3> sorted = form.axes;
    std::ranges::sort(sorted);
    if (sorted != std::array{0, 1, 2}) {
        if (form.axes != std::array{-1, -1, -1})
            source.notes.emplace_back(
                "Its header does not say which axis is which: columns are taken as x, rows as y.");
        form.axes = {0, 1, 2};
    }
    std::array<int, 3> sizes{}; // along x, y and z
    for (std::size_t s = 0; s < 3; ++s) sizes[std::size_t(form.axes[s])] = form.size[s];
    bool unsized = false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (form.cells[axis] <= 0) form.cells[axis] = sizes[axis];
        unsized = unsized || !(form.cell[axis] > 0) || !std::isfinite(form.cell[axis]);
    }
    source.lengthUnit = "angstrom";
    if (unsized) {
        source.notes.emplace_back("It states no size of its cell: the spacing is 1.");
        for (std::size_t axis = 0; axis < 3; ++axis) form.cell[axis] = form.cells[axis];
        form.angles = {90, 90, 90};
        source.lengthUnit.clear();
    }
    const int depth = form.cells[2];
    if (form.group >= 401 && form.group <= 630 && depth > 0 && form.size[2] % depth == 0 && form.size[2] > depth) {
        form.volumes = form.size[2] / depth;
        form.size[2] = depth;
        for (int v = 0; v < form.volumes; ++v) source.times.push_back(v);
        source.timeName = "volume";
    } else if (form.group == 0 && depth == 1 && form.size[2] > 1) {
        source.notes.emplace_back("It is a stack of pictures, which are read as slices: their distance means nothing.");
    }
}

vtkSmartPointer<vtkImageData> emptyMrc(const MrcForm& form) {
    const glm::dmat3 cell = cellVectors(form);
    glm::dmat3 steps(1);
    glm::dvec3 begin(0);
    for (int s = 0; s < 3; ++s) {
        const int axis = form.axes[std::size_t(s)];
        steps[s] = cell[axis] / double(form.cells[std::size_t(axis)]);
        begin += steps[s] * double(form.start[std::size_t(s)]);
    }
    const glm::dvec3 origin(form.origin[0], form.origin[1], form.origin[2]);
    const bool states = origin != glm::dvec3(0) && std::isfinite(origin.x + origin.y + origin.z);
    return gridImage({form.size[0], form.size[1], form.size[2]}, states ? origin : begin, steps);
}

void swapBytes(std::string& bytes, std::size_t each) {
    for (std::size_t at = 0; each > 1 && at + each <= bytes.size(); at += each)
        std::reverse(bytes.begin() + std::ptrdiff_t(at), bytes.begin() + std::ptrdiff_t(at + each));
}

vtkSmartPointer<vtkDataObject> readMrc(const std::string& path, const MrcForm& form, const PixelForm& slice,
                                       std::size_t volume) {
    auto image = emptyMrc(form);
    std::vector<std::string> names{"value"};
    if (form.mode == 3 || form.mode == 4) names = {"real", "imaginary"};
    if (form.mode == 16) names = {"red", "green", "blue"};
    const std::size_t pixels = std::size_t(slice.width) * slice.height, slices = std::size_t(form.size[2]);
    for (const std::string& name : names)
        image->GetPointData()->AddArray(pixelArray(vtkTypeOf(slice), pixels * slices, name));
    // Rows of 4 bits begin at whole bytes.
    const std::size_t bytes = slice.bytes(), begin = kMrcHeader + std::size_t(form.extended) + volume * slices * bytes;
    const auto each = std::size_t(slice.bits / 8 / slice.parts());
    GridBytes file(path);
    std::string rows(bytes, '\0');
    for (std::size_t z = 0; z < slices; ++z) {
        file.read(begin + z * bytes, bytes, rows.data());
        if (form.swapped) swapBytes(rows, each);
        if (form.mode == 101)
            for (char& byte : rows) byte = char((byte << 4) | ((byte >> 4) & 15));
        std::vector<void*> to;
        for (int a = 0; a < int(names.size()); ++a) {
            vtkDataArray* array = image->GetPointData()->GetArray(a);
            to.push_back(static_cast<char*>(array->GetVoidPointer(0)) +
                         z * pixels * std::size_t(array->GetDataTypeSize()));
        }
        for (int s = 0; s < slice.samples; ++s) {
            const auto first = to.begin() + std::ptrdiff_t(s) * slice.parts();
            unpackSample(rows.data(), slice, s, {first, first + slice.parts()});
        }
    }
    return image;
}

} // namespace

void openMrc(Source& source) {
    MrcForm form = formOfMrc(source.path);
    const PixelForm slice = sliceOfMrc(form, source);
    const double wanted = double(kMrcHeader) + form.extended + double(slice.bytes()) * form.size[2];
    const bool compressed = readPart(source.path, 0, 2) == "\x1f\x8b";
    if (!compressed) wantBytes(double(bytesIn(source.path)), wanted, {}, "bytes");
    refuseHollow(wanted, double(bytesIn(source.path)));
    if (form.origin != std::array<double, 3>{} && form.start != std::array<int, 3>{})
        source.notes.emplace_back("It states an origin and a first sample: the origin is taken.");
    completeMrc(form, source);
    source.read = [path = source.path, form, slice](std::size_t volume) { return readMrc(path, form, slice, volume); };
}

} // namespace tessera::importer
