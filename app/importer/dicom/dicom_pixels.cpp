#include "app/importer/dicom/dicom_pixels.h"

#include "app/importer/dicom/dicom_codecs.h"
#include "app/importer/readers/check_file.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string_view>

namespace tessera::importer {

namespace {

/// Bytes of one frame that is not encoded; of 1 bit for each number, frames need not begin at a byte.
double storedFrameBits(const DicomForm& form) {
    const double values = double(form.pixels()) * (form.photometric == "YBR_FULL_422" ? 2 : form.samples);
    return values * form.bits;
}

/// The encoded bytes of a frame: its fragment, or those from its start to the next one's.
std::vector<std::byte> encodedFrame(const DicomPixels& pixels, const DicomForm& form, int frame) {
    const auto& fragments = pixels.fragments;
    const auto count = std::size_t(form.frames), index = std::size_t(frame);
    std::size_t begin = index, end = index + 1;
    if (count == 1) {
        begin = 0;
        end = fragments.size();
    } else if (fragments.size() != count) {
        // Frames of several fragments each: by the table of offsets, else by how encoded frames begin.
        std::vector<std::size_t> starts;
        std::size_t place = 0;
        const bool table = pixels.offsets.size() >= 4 * count;
        for (std::size_t f = 0; f < fragments.size(); place += fragments[f].size() + 8, ++f) {
            bool starting = false;
            if (table && starts.size() < count) {
                std::uint32_t offset = 0;
                for (std::size_t b = 4; b-- > 0;)
                    offset = offset << 8 | std::to_integer<std::uint32_t>(pixels.offsets[4 * starts.size() + b]);
                starting = offset == place;
            } else if (!table && fragments[f].size() > 4) {
                const int first = std::to_integer<int>(fragments[f][0]), second = std::to_integer<int>(fragments[f][1]);
                starting = first == 0xff && (second == 0xd8 || second == 0x4f);
            }
            if (starting) starts.push_back(f);
        }
        if (starts.size() != count)
            throw std::runtime_error("has " + std::to_string(fragments.size()) +
                                     " compressed parts, which do not make up its " + std::to_string(count) +
                                     " frames");
        begin = starts[index];
        end = index + 1 < count ? starts[index + 1] : fragments.size();
    }
    std::vector<std::byte> out;
    for (std::size_t f = begin; f < end && f < fragments.size(); ++f)
        out.insert(out.end(), fragments[f].begin(), fragments[f].end());
    return out;
}

/// Numbers of `bits` bits to numbers: the used bits alone, with their sign.
template <class T>
void takeNumbers(std::span<const std::byte> bytes, const DicomForm& form, bool big, int used, int high,
                 std::vector<double>& out) {
    const int shift = std::max(0, high + 1 - used), unused = 64 - used;
    for (std::size_t i = 0; i < out.size(); ++i) {
        std::uint64_t stored = 0;
        for (std::size_t b = 0; b < sizeof(T); ++b)
            stored |= std::to_integer<std::uint64_t>(bytes[i * sizeof(T) + b]) << 8 * (big ? sizeof(T) - 1 - b : b);
        const std::uint64_t top = stored >> shift << unused;
        out[i] = form.isSigned ? double(std::int64_t(top) >> unused) : double(top >> unused);
    }
}

template <class T> void takeReals(std::span<const std::byte> bytes, bool big, std::vector<double>& out) {
    using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
    for (std::size_t i = 0; i < out.size(); ++i) {
        Bits stored = 0;
        for (std::size_t b = 0; b < sizeof(T); ++b)
            stored |= Bits(std::to_integer<std::uint8_t>(bytes[i * sizeof(T) + b]))
                      << 8 * (big ? sizeof(T) - 1 - b : b);
        out[i] = double(std::bit_cast<T>(stored));
    }
}

/// Two pixels share their colour: Y Y Cb Cr becomes Y Cb Cr, Y Cb Cr.
std::vector<std::byte> withFullColours(std::span<const std::byte> bytes) {
    std::vector<std::byte> out;
    for (std::size_t i = 0; i + 3 < bytes.size(); i += 4)
        for (const std::size_t y : {0u, 1u}) out.insert(out.end(), {bytes[i + y], bytes[i + 2], bytes[i + 3]});
    return out;
}

/// The numbers of each plane in turn become those of each pixel in turn.
void joinPlanes(std::vector<double>& numbers, std::size_t pixels, std::size_t samples) {
    std::vector<double> out(numbers.size());
    for (std::size_t i = 0; i < pixels; ++i)
        for (std::size_t c = 0; c < samples; ++c) out[i * samples + c] = numbers[c * pixels + i];
    numbers = std::move(out);
}

/// YBR_FULL (PS3.3, C.7.6.3.1.2) to red, green and blue.
void toRgb(std::vector<double>& numbers, int used) {
    const double most = std::ldexp(1.0, used) - 1, middle = std::ldexp(1.0, used - 1);
    for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) {
        const double y = numbers[i], b = numbers[i + 1] - middle, r = numbers[i + 2] - middle;
        const double rgb[3] = {y + 1.402 * r, y - 0.344136 * b - 0.714136 * r, y + 1.772 * b};
        for (std::size_t c = 0; c < 3; ++c) numbers[i + c] = std::clamp(std::round(rgb[c]), 0.0, most);
    }
}

void checkForm(const DicomForm& form) {
    static constexpr std::string_view kRead[] = {"MONOCHROME1",  "MONOCHROME2", "PALETTE COLOR", "RGB", "YBR_FULL",
                                                 "YBR_FULL_422", "YBR_RCT",     "YBR_ICT",       ""};
    if (form.rows < 1 || form.columns < 1 || form.frames < 1) throw std::runtime_error("has no rows and columns");
    if (std::ranges::find(kRead, form.photometric) == std::end(kRead) || (form.samples != 1 && form.samples != 3))
        throw DicomUnread("has colours of the kind " + form.photometric.substr(0, 20) +
                          ", which are not read: write them as RGB");
    const bool whole = form.bits == 1 || form.bits == 8 || form.bits == 16 || form.bits == 32;
    if (form.real ? form.bits != 32 && form.bits != 64 : !whole)
        throw DicomUnread("has numbers of " + std::to_string(form.bits) +
                          " bits, which are not read: write them with 8, 16 or 32");
    if (form.used < 1 || form.used > form.bits || form.high >= form.bits || form.high < form.used - 1)
        throw std::runtime_error("uses " + std::to_string(form.used) + " of " + std::to_string(form.bits) +
                                 " bits, the highest of them " + std::to_string(form.high) + ": damaged");
}

} // namespace

double DicomForm::lowest() const {
    if (real) return -std::numeric_limits<double>::infinity();
    return isSigned ? -std::ldexp(1.0, used - 1) : 0;
}

double DicomForm::highest() const {
    if (real) return std::numeric_limits<double>::infinity();
    return std::ldexp(1.0, isSigned ? used - 1 : used) - 1;
}

DicomForm dicomForm(const DicomFile& file) {
    const DicomItem& data = file.data();
    const DicomPixels& pixels = file.pixels();
    const auto number = [&](DicomTag tag, int otherwise) {
        const double value = data.number(tag, otherwise);
        return value > 2e9 || value < -2e9 ? 0 : int(value);
    };
    DicomForm form;
    form.rows = number(0x00280010, 0);
    form.columns = number(0x00280011, 0);
    form.frames = std::max(1, number(0x00280008, 1));
    form.samples = number(0x00280002, 1);
    form.bits = number(0x00280100, 16);
    form.used = number(0x00280101, form.bits);
    form.high = number(0x00280102, form.used - 1);
    form.isSigned = number(0x00280103, 0) == 1;
    form.planar = number(0x00280006, 0) == 1 && form.samples > 1;
    form.photometric = data.text(0x00280004);
    form.real = pixels.tag == dicom_tag::kFloatPixels || pixels.tag == dicom_tag::kDoublePixels;
    if (form.real) {
        form.bits = form.used = pixels.tag == dicom_tag::kFloatPixels ? 32 : 64;
        form.high = form.bits - 1;
    }
    checkForm(form);
    refuseUnreadSyntax(file.syntax());
    if (pixels.tag == 0) throw std::runtime_error("ends before its samples: truncated, or not an image");
    if (pixels.encapsulated) {
        double encoded = 0;
        for (const auto& fragment : pixels.fragments) encoded += double(fragment.size());
        refuseHollow(double(form.pixels()) * form.samples * form.frames * form.bits / 8, encoded);
        if (pixels.fragments.empty()) throw std::runtime_error("has an empty compressed frame");
    } else {
        wantBytes(double(pixels.bytes.size()), std::ceil(storedFrameBits(form) * form.frames / 8));
    }
    return form;
}

std::vector<double> dicomNumbers(const DicomFile& file, const DicomForm& form, int frame) {
    const DicomPixels& pixels = file.pixels();
    std::vector<double> out(form.pixels() * std::size_t(form.samples));
    std::vector<std::byte> own;
    std::span<const std::byte> bytes;
    int bits = form.bits, used = form.used, high = form.high;
    bool big = pixels.big, planar = form.planar;
    const bool raw = !pixels.encapsulated || file.syntax() == "1.2.840.10008.1.2.1.98";
    if (pixels.encapsulated) own = encodedFrame(pixels, form, frame);
    if (pixels.encapsulated && !raw) {
        const DicomDecoded decoded = decodeDicomFrame(file.syntax(), form, own);
        own = decoded.bytes;
        bits = decoded.bits;
        used = std::min(used, bits);
        high = std::min(high, bits - 1);
        big = false;
        planar = false;
        bytes = own;
    } else {
        const double frameBits = storedFrameBits(form), begin = frameBits * frame;
        const std::span<const std::byte> all = pixels.encapsulated ? std::span<const std::byte>(own) : pixels.bytes;
        const double from = pixels.encapsulated ? 0 : begin;
        wantBytes(double(all.size()), std::ceil((from + frameBits) / 8));
        if (bits == 1) { // the lowest bit of a byte comes first
            for (std::size_t i = 0; i < out.size(); ++i) {
                const std::size_t bit = std::size_t(from) + i;
                out[i] = double(std::to_integer<int>(all[bit / 8]) >> bit % 8 & 1);
            }
            return out;
        }
        bytes = all.subspan(std::size_t(from / 8), std::size_t(frameBits / 8));
        if (big && bits == 8 && pixels.type[1] == 'W') { // bytes are stored as words
            own.assign(bytes.begin(), bytes.end());
            for (std::size_t i = 0; i + 1 < own.size(); i += 2) std::swap(own[i], own[i + 1]);
            bytes = own;
        }
        if (form.photometric == "YBR_FULL_422") {
            own = withFullColours(bytes);
            bytes = own;
            planar = false;
        }
    }
    wantBytes(double(bytes.size()), double(out.size()) * bits / 8);
    if (form.real && bits == 32)
        takeReals<float>(bytes, big, out);
    else if (form.real)
        takeReals<double>(bytes, big, out);
    else if (bits == 8)
        takeNumbers<std::uint8_t>(bytes, form, big, used, high, out);
    else if (bits == 16)
        takeNumbers<std::uint16_t>(bytes, form, big, used, high, out);
    else
        takeNumbers<std::uint32_t>(bytes, form, big, used, high, out);
    if (planar) joinPlanes(out, form.pixels(), std::size_t(form.samples));
    if (form.samples == 3 && form.photometric.starts_with("YBR_FULL")) toRgb(out, used);
    return out;
}

} // namespace tessera::importer
