// DICOM: uncompressed images; the files of a series are slices, ordered by position.
#include "app/importer/readers/check_file.h"
#include "app/importer/readers/read_files.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <vtkDataArray.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>

namespace tessera::importer {

namespace {

constexpr std::uint32_t kPixels = 0x7fe00010, kUndefined = 0xffffffff;

/// Parses the elements of a file: little-endian, with explicit or implicit types. Skips sequences.
class Elements {
public:
    explicit Elements(const std::string& path) : bytes_(readWhole(path)) {
        if (bytes_.size() < 132 || bytes_.compare(128, 4, "DICM") != 0)
            throw std::runtime_error("is truncated or not a DICOM file");
        at_ = 132;
        read(2, true); // the meta group, which states the encoding of the rest
        std::string syntax = text(0x00020010);
        syntax.erase(std::min(syntax.size(), syntax.find_first_of(std::string_view("\0 ", 2))));
        if (syntax != "1.2.840.10008.1.2" && syntax != "1.2.840.10008.1.2.1")
            throw std::runtime_error("is compressed DICOM (" + syntax +
                                     "), which is not read: write it uncompressed (gdcmconv --raw, or dcmdjpeg)");
        read(0xffff, syntax == "1.2.840.10008.1.2.1");
        if (!found_.contains(kPixels)) throw std::runtime_error("ends before its samples: truncated, or not an image");
    }
    std::string text(std::uint32_t tag) const {
        const auto at = found_.find(tag);
        return at == found_.end() ? std::string() : bytes_.substr(at->second.first, at->second.second);
    }
    int number(std::uint32_t tag, int otherwise) const {
        const std::string word = text(tag);
        return word.size() < 2 ? otherwise
                               : static_cast<unsigned char>(word[0]) + 256 * static_cast<unsigned char>(word[1]);
    }
    /// Decimal numbers separated by backslashes.
    std::vector<double> decimals(std::uint32_t tag) const {
        std::string word = text(tag);
        std::vector<double> out;
        for (std::size_t at = 0; at < word.size();) {
            char* end = nullptr;
            out.push_back(std::strtod(word.c_str() + at, &end));
            if (end == word.c_str() + at) return {};
            at = std::min(word.size(), word.find('\\', static_cast<std::size_t>(end - word.c_str())));
            at += at < word.size() ? 1 : 0;
            if (word.find_first_not_of(std::string_view(" \0", 2), at) == std::string::npos) break;
        }
        return out;
    }

private:
    std::uint32_t take(std::size_t count) {
        if (bytes_.size() - at_ < count) throw std::runtime_error("ends early: truncated");
        std::uint32_t value = 0;
        for (std::size_t i = count; i-- > 0;) value = value * 256 + static_cast<unsigned char>(bytes_[at_ + i]);
        at_ += count;
        return value;
    }
    /// Reads elements up to a group; with `depth` > 0 those of an item, up to its end mark.
    void read(std::uint32_t lastGroup, bool typed, int depth = 0) {
        if (depth > 16) throw std::runtime_error("has sequences nested too deep");
        while (at_ < bytes_.size()) {
            const std::size_t begin = at_;
            const std::uint32_t group = take(2), tag = group << 16 | take(2);
            if (depth == 0 && group > lastGroup) {
                at_ = begin;
                return;
            }
            std::uint32_t length = 0;
            if (group == 0xfffe || !typed) {
                length = take(4);
            } else {
                const std::string type = bytes_.substr(at_, 2);
                take(2);
                static constexpr std::string_view kLong = "OB OD OF OL OV OW SQ SV UC UN UR UT UV";
                if (kLong.find(type) != std::string_view::npos) {
                    take(2);
                    length = take(4);
                } else {
                    length = take(2);
                }
            }
            if (tag == 0xfffee00d || tag == 0xfffee0dd) return; // end of an item or a sequence
            if (length == kUndefined) {
                if (tag == kPixels)
                    throw std::runtime_error("is compressed DICOM, which is not read: write it uncompressed");
                read(lastGroup, typed, depth + 1); // a sequence, or an item of it
                continue;
            }
            if (bytes_.size() - at_ < length)
                throw std::runtime_error(tag == kPixels ? "has " + std::to_string(bytes_.size() - at_) +
                                                              " bytes of samples, but its header announces " +
                                                              std::to_string(length)
                                                        : "ends early: truncated");
            if (depth == 0) found_[tag] = {at_, length};
            at_ += length;
        }
        if (depth > 0) throw std::runtime_error("ends early: truncated");
    }
    std::string bytes_;
    std::size_t at_ = 0;
    std::map<std::uint32_t, std::pair<std::size_t, std::size_t>> found_;
};

struct Slice {
    std::string path;
    int columns = 0, rows = 0, frames = 1, bits = 16;
    bool isSigned = false;
    double slope = 1, intercept = 0, place = 0, thickness = 1;
    std::array<double, 3> corner{0, 0, 0};
    double across = 1, down = 1; ///< steps in mm
};

Slice describe(const Elements& file, const std::string& path) {
    Slice slice;
    slice.path = path;
    slice.rows = file.number(0x00280010, 0);
    slice.columns = file.number(0x00280011, 0);
    slice.bits = file.number(0x00280100, 16);
    slice.isSigned = file.number(0x00280103, 0) == 1;
    if (file.number(0x00280002, 1) != 1)
        throw std::runtime_error("has colours, which are not supported: write it in grey");
    if (slice.rows < 1 || slice.columns < 1 || (slice.bits != 8 && slice.bits != 16))
        throw std::runtime_error("has no rows and columns of 8 or 16 bits");
    const auto first = [&](std::uint32_t tag, double otherwise) {
        const std::vector<double> values = file.decimals(tag);
        return values.empty() ? otherwise : values[0];
    };
    slice.frames = std::max(1, static_cast<int>(first(0x00280008, 1)));
    slice.slope = first(0x00281053, 1);
    slice.intercept = first(0x00281052, 0);
    slice.thickness = first(0x00180088, first(0x00180050, 1));
    if (const std::vector<double> steps = file.decimals(0x00280030); steps.size() == 2) {
        slice.down = steps[0];
        slice.across = steps[1];
    }
    std::array<double, 3> normal{0, 0, 1};
    if (const std::vector<double> o = file.decimals(0x00200037); o.size() == 6)
        normal = {o[1] * o[5] - o[2] * o[4], o[2] * o[3] - o[0] * o[5], o[0] * o[4] - o[1] * o[3]};
    if (const std::vector<double> corner = file.decimals(0x00200032); corner.size() == 3) {
        slice.corner = {corner[0], corner[1], corner[2]};
        slice.place = corner[0] * normal[0] + corner[1] * normal[1] + corner[2] * normal[2];
    } else {
        slice.place = first(0x00200013, 0) * slice.thickness; // the instance number
    }
    wantBytes(double(file.text(kPixels).size()), double(slice.rows) * slice.columns * slice.frames * slice.bits / 8);
    return slice;
}

vtkSmartPointer<vtkDataObject> readSlices(const std::vector<Slice>& slices, double step) {
    const Slice& first = slices.front();
    const int depth = slices.size() > 1 ? int(slices.size()) : first.frames;
    vtkNew<vtkImageData> image;
    image->SetDimensions(first.columns, first.rows, depth);
    image->SetSpacing(first.across, first.down, step);
    image->SetOrigin(first.corner[0], first.corner[1], slices.size() > 1 ? first.place : first.corner[2]);
    const bool scaled = std::any_of(slices.begin(), slices.end(), [](const Slice& s) {
        return s.slope != 1 || s.intercept != std::floor(s.intercept);
    });
    const bool shifted = std::any_of(slices.begin(), slices.end(), [](const Slice& s) { return s.intercept != 0; });
    const int type = scaled || (shifted && !first.isSigned && first.bits == 16) ? VTK_FLOAT
                     : shifted || (first.bits == 16 && first.isSigned)          ? VTK_SHORT
                     : first.bits == 16                                         ? VTK_UNSIGNED_SHORT
                     : first.isSigned                                           ? VTK_SHORT
                                                                                : VTK_UNSIGNED_CHAR;
    auto values = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
    values->SetName("value");
    values->SetNumberOfTuples(image->GetNumberOfPoints());
    vtkIdType to = 0;
    for (const Slice& slice : slices) {
        const std::string pixels = Elements(slice.path).text(kPixels);
        const std::size_t count = std::size_t(slice.columns) * slice.rows * (slices.size() > 1 ? 1 : slice.frames);
        for (std::size_t i = 0; i < count; ++i) {
            int stored = static_cast<unsigned char>(pixels[slice.bits == 16 ? 2 * i : i]);
            if (slice.bits == 16) stored += 256 * static_cast<unsigned char>(pixels[2 * i + 1]);
            if (slice.isSigned) stored = slice.bits == 16 ? std::int16_t(stored) : std::int8_t(stored);
            values->SetComponent(to++, 0, slice.intercept + slice.slope * stored);
        }
    }
    image->GetPointData()->AddArray(values);
    return image;
}

} // namespace

void openDicom(Source& source) {
    const std::vector<std::string> files = source.files.empty() ? std::vector<std::string>{source.path} : source.files;
    auto slices = std::make_shared<std::vector<Slice>>();
    std::string series, modality;
    for (const std::string& path : files) {
        const Elements file(path);
        try {
            slices->push_back(describe(file, path));
        } catch (const std::runtime_error& error) {
            if (files.size() == 1) throw;
            throw std::runtime_error("its slice " + path.substr(path.rfind('/') + 1) + " " + error.what());
        }
        const std::string own = file.text(0x0020000e);
        if (slices->size() == 1) series = own;
        modality = file.text(0x00080060);
        if (own != series)
            throw std::runtime_error("lies in a folder of several series: put each into a folder of its own");
        const Slice &one = slices->back(), &first = slices->front();
        if (one.rows != first.rows || one.columns != first.columns || one.bits != first.bits ||
            one.frames != first.frames)
            throw std::runtime_error("lies in a folder of images of several sizes");
    }
    std::sort(slices->begin(), slices->end(), [](const Slice& a, const Slice& b) { return a.place < b.place; });
    double step = slices->front().thickness;
    if (slices->size() > 1) {
        if (slices->front().frames > 1) throw std::runtime_error("lies in a folder of several volumes: name one file");
        step = (slices->back().place - slices->front().place) / double(slices->size() - 1);
        for (std::size_t i = 1; i < slices->size(); ++i) {
            const double gap = (*slices)[i].place - (*slices)[i - 1].place;
            if (!(std::abs(gap - step) <= 0.05 * step) || !(gap > 0))
                throw std::runtime_error("has slices at uneven distances: one is missing or present twice");
        }
    }
    if (!(step > 0)) step = 1;
    source.lengthUnit = "mm";
    if (modality.starts_with("CT")) source.units["value"] = "HU";
    source.read = [slices, step](std::size_t) { return readSlices(*slices, step); };
}

} // namespace tessera::importer
