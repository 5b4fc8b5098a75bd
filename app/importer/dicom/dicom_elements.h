#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

/// The elements of a DICOM file (PS3.5 and PS3.10). They are read here and not by GDCM, whose parser takes a file that
/// ends early for a whole one, takes memory for lengths before it looks whether the file is that long, and ends the
/// program at what it does not expect; GDCM decodes the frames (dicom_codecs.h).
namespace tessera::importer {

using DicomTag = std::uint32_t; ///< group << 16 | element

/// A whole file that is not read, of which others can do without.
class DicomUnread : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

namespace dicom_tag {
inline constexpr DicomTag kPixels = 0x7fe00010, kFloatPixels = 0x7fe00008, kDoublePixels = 0x7fe00009;
} // namespace dicom_tag

struct DicomElement;

/// Elements of a data set, or of an item of a sequence. What is not there is "", nothing, or no items.
struct DicomItem {
    std::vector<DicomElement> elements;

    const DicomElement* find(DicomTag tag) const;
    /// Text without blanks at its ends.
    std::string text(DicomTag tag) const;
    /// The words between backslashes.
    std::vector<std::string> words(DicomTag tag) const;
    /// Numbers in text or in binary; none if one of them is not finite.
    std::vector<double> numbers(DicomTag tag) const;
    std::optional<double> number(DicomTag tag) const;
    double number(DicomTag tag, double otherwise) const { return number(tag).value_or(otherwise); }
    const std::vector<DicomItem>& items(DicomTag tag) const;
    /// The first item of a sequence, or null.
    const DicomItem* item(DicomTag tag) const;
};

struct DicomElement {
    DicomTag tag = 0;
    char type[2] = {}; ///< the value representation; zeros where the file does not state it
    bool big = false;  ///< numbers have their high byte first
    std::span<const std::byte> value;
    std::vector<DicomItem> items;
};

/// The samples of a file as they are stored: in one piece, or as fragments of encoded frames.
struct DicomPixels {
    DicomTag tag = 0; ///< 0 = none
    char type[2] = {};
    bool encapsulated = false, big = false, whole = false;
    std::span<const std::byte> bytes;
    std::span<const std::byte> offsets; ///< where frames begin among the fragments; may be empty
    std::vector<std::span<const std::byte>> fragments;
};

/// A file whose elements have been found; spans point into it and live as long.
class DicomFile {
public:
    /// Throws std::runtime_error unless all elements up to the samples lie within the file.
    explicit DicomFile(const std::string& path);

    const std::string& syntax() const { return syntax_; } ///< UID of the transfer syntax
    const DicomItem& data() const { return data_; }
    const DicomPixels& pixels() const { return pixels_; }

private:
    std::shared_ptr<const void> owner_; ///< the mapped file, or its inflated bytes
    std::string syntax_;
    DicomItem data_;
    DicomPixels pixels_;
};

} // namespace tessera::importer
