#include "app/importer/dicom/dicom_codecs.h"

#include "app/importer/dicom/dicom_elements.h"

#include <algorithm>
#include <gdcmByteValue.h>
#include <gdcmFragment.h>
#include <gdcmImage.h>
#include <gdcmSequenceOfFragments.h>
#include <gdcmTrace.h>
#include <map>
#include <optional>
#include <stdexcept>
#include <string_view>

namespace tessera::importer {

namespace {

/// What an encoded frame says of itself.
struct EncodedSize {
    int columns = 0, rows = 0, bits = 0, samples = 0;
};

int wordAt(std::span<const std::byte> bytes, std::size_t at, std::size_t count) {
    int value = 0;
    for (std::size_t i = 0; i < count; ++i)
        value = value << 8 | (at + i < bytes.size() ? std::to_integer<int>(bytes[at + i]) : 0);
    return value;
}

/// The frame header of JPEG and JPEG-LS, and that of JPEG 2000, which may stand in a box.
std::optional<EncodedSize> encodedSize(std::span<const std::byte> bytes) {
    const auto at = [&](std::size_t i, std::size_t count) { return wordAt(bytes, i, count); };
    if (at(0, 2) == 0xffd8) {
        for (std::size_t i = 2; i + 9 < bytes.size();) {
            const int mark = at(i, 2);
            if (mark == 0xffff) {
                ++i;
                continue;
            }
            if (mark < 0xff01) return std::nullopt;
            const bool frame =
                (mark >= 0xffc0 && mark <= 0xffcf && mark != 0xffc4 && mark != 0xffc8 && mark != 0xffcc) ||
                mark == 0xfff7;
            if (frame) return EncodedSize{at(i + 7, 2), at(i + 5, 2), at(i + 4, 1), at(i + 9, 1)};
            i += 2 + std::size_t(at(i + 2, 2));
        }
        return std::nullopt;
    }
    const std::size_t most = std::min<std::size_t>(bytes.size(), 4096);
    for (std::size_t i = 0; i + 45 < most; ++i) // the start of a code stream, then its size
        if (at(i, 4) == int(0xff4fff51)) {
            const std::size_t size = i + 8; // behind the marks, the length and the capabilities
            const auto extent = [&](std::size_t axis) { return at(size + axis, 4) - at(size + 8 + axis, 4); };
            return EncodedSize{extent(0), extent(4), (at(size + 34, 1) & 0x7f) + 1, at(size + 32, 2)};
        }
    return std::nullopt;
}

/// RLE (PS3.5, annex G), of which GDCM mixes up the bytes of colours with 16 bits: one packed segment for each byte of
/// a pixel, the high one first.
DicomDecoded decodeRle(std::span<const std::byte> from, const DicomForm& form) {
    const auto offset = [&](std::size_t i) {
        std::uint32_t value = 0;
        for (std::size_t b = 4; b-- > 0;) value = value << 8 | std::to_integer<std::uint32_t>(from[4 * i + b]);
        return std::size_t(value);
    };
    const std::size_t each = std::size_t(form.bits) / 8, all = each * std::size_t(form.samples);
    bool whole = from.size() >= 64 && all <= 15 && offset(0) == all;
    DicomDecoded out{std::vector<std::byte>(form.pixels() * all), form.bits};
    for (std::size_t s = 0; whole && s < all; ++s) {
        std::size_t at = offset(s + 1), pixel = 0;
        const std::size_t end = s + 1 < all ? std::min(offset(s + 2), from.size()) : from.size();
        const std::size_t place = s / each * each + each - 1 - s % each;
        const auto put = [&](std::byte value) { out.bytes[pixel++ * all + place] = value; };
        while (at < end && pixel < form.pixels()) {
            const int code = std::to_integer<int>(from[at++]);
            if (code == 128) continue;
            if (code < 128)
                for (int i = 0; i <= code && at < end && pixel < form.pixels(); ++i) put(from[at++]);
            else if (at < end) {
                for (int i = 0; i < 257 - code && pixel < form.pixels(); ++i) put(from[at]);
                ++at;
            }
        }
        whole = pixel == form.pixels();
    }
    if (!whole) throw std::runtime_error("has a damaged compressed frame");
    return out;
}

gdcm::PhotometricInterpretation photometricOf(const DicomForm& form) {
    if (form.samples == 1) return gdcm::PhotometricInterpretation::MONOCHROME2;
    const auto type = gdcm::PhotometricInterpretation::GetPIType(form.photometric.c_str());
    using PI = gdcm::PhotometricInterpretation;
    const bool known = type == PI::RGB || type == PI::YBR_FULL || type == PI::YBR_FULL_422 || type == PI::YBR_RCT ||
                       type == PI::YBR_ICT;
    return known ? type : PI::RGB;
}

} // namespace

void refuseUnreadSyntax(const std::string& syntax) {
    static const std::string kRoot = "1.2.840.10008.1.2";
    if (syntax.empty() || syntax == kRoot || syntax == "1.2.840.113619.5.2") return;
    const std::string tail = syntax.starts_with(kRoot + ".") ? syntax.substr(kRoot.size() + 1) : "";
    if (tail == "1" || tail == "1.99" || tail == "1.98" || tail == "2" || tail == "5") return;
    const auto number = [&]() -> int {
        if (!tail.starts_with("4.") || tail.size() > 5) return 0;
        int value = 0;
        for (const char c : tail.substr(2)) value = c >= '0' && c <= '9' ? value * 10 + c - '0' : 1000;
        return value;
    }();
    if ((number >= 50 && number <= 70) || number == 80 || number == 81 || (number >= 90 && number <= 93)) return;
    if (number >= 100 && number <= 108)
        throw DicomUnread("holds a video, which is not read: take it out (gdcmraw -i FILE -o video.mpg), and "
                          "write its frames as TIFF (ffmpeg -i video.mpg frame_%04d.tif)");
    if (number == 94 || number == 95)
        throw DicomUnread("keeps its samples on a server (JPIP), not in the file: fetch it uncompressed");
    throw DicomUnread("is compressed in a way that is not read (" + syntax +
                      "): write it uncompressed (Explicit VR Little Endian) by the program that it comes from");
}

DicomDecoded decodeDicomFrame(const std::string& syntax, const DicomForm& form, std::span<const std::byte> encoded) {
    static const bool quiet = [] {
        gdcm::Trace::DebugOff();
        gdcm::Trace::WarningOff();
        gdcm::Trace::ErrorOff();
        return true;
    }();
    if (!quiet || encoded.empty()) throw std::runtime_error("has an empty compressed frame");
    if (syntax == "1.2.840.10008.1.2.5") return decodeRle(encoded, form);
    const std::optional<EncodedSize> size = encodedSize(encoded);
    if (!size || size->columns < 1 || size->rows < 1) throw std::runtime_error("has a damaged compressed frame");
    if (size->columns != form.columns || size->rows != form.rows || size->samples != form.samples)
        throw std::runtime_error("has compressed frames of " + std::to_string(size->columns) + " x " +
                                 std::to_string(size->rows) + ", but its header announces " +
                                 std::to_string(form.columns) + " x " + std::to_string(form.rows));
    if (size->bits < 2 || size->bits > 16)
        throw std::runtime_error("has compressed numbers of " + std::to_string(size->bits) +
                                 " bits, which are not read: write it uncompressed or as RLE");
    const int used = size->bits, bits = used <= 8 ? 8 : 16, high = used - 1;
    const auto small = [](int value) { return static_cast<unsigned short>(value); };
    gdcm::Image image;
    image.SetNumberOfDimensions(2);
    image.SetDimension(0, unsigned(form.columns));
    image.SetDimension(1, unsigned(form.rows));
    image.SetPixelFormat(
        gdcm::PixelFormat(small(form.samples), small(bits), small(used), small(high), small(form.isSigned ? 1 : 0)));
    image.SetPhotometricInterpretation(photometricOf(form));
    image.SetPlanarConfiguration(0);
    image.SetTransferSyntax(gdcm::TransferSyntax::GetTSType(syntax.c_str()));
    gdcm::Fragment fragment;
    fragment.SetByteValue(reinterpret_cast<const char*>(encoded.data()), gdcm::VL(std::uint32_t(encoded.size())));
    gdcm::SmartPointer<gdcm::SequenceOfFragments> fragments = new gdcm::SequenceOfFragments;
    fragments->AddFragment(fragment);
    gdcm::DataElement samples(gdcm::Tag(0x7fe0, 0x0010));
    samples.SetVR(gdcm::VR::OB);
    samples.SetValue(*fragments);
    image.SetDataElement(samples);
    DicomDecoded out;
    out.bytes.resize(std::max<std::size_t>(image.GetBufferLength(), form.pixels() * std::size_t(form.samples)));
    bool decoded = false;
    try {
        decoded = image.GetBuffer(reinterpret_cast<char*>(out.bytes.data()));
    } catch (const std::exception&) { // told below
    }
    if (!decoded) throw std::runtime_error("has a damaged compressed frame");
    out.bits = image.GetPixelFormat().GetBitsAllocated();
    out.bytes.resize(form.pixels() * std::size_t(form.samples) * std::size_t(out.bits / 8));
    return out;
}

} // namespace tessera::importer
