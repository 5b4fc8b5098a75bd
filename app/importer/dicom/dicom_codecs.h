#pragma once

#include "app/importer/dicom/dicom_form.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

/// Compressed frames, by GDCM's codecs.
namespace tessera::importer {

/// Throws, with a way out, for a transfer syntax that is not read.
void refuseUnreadSyntax(const std::string& syntax);

/// Numbers of a decoded frame: the samples of a pixel beside each other, low byte first.
struct DicomDecoded {
    std::vector<std::byte> bytes;
    int bits = 8; ///< of each number
};

/// Decodes a frame of JPEG, JPEG-LS, JPEG 2000 or RLE whose encoded bytes are these.
DicomDecoded decodeDicomFrame(const std::string& syntax, const DicomForm& form, std::span<const std::byte> encoded);

} // namespace tessera::importer
