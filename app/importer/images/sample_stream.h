#pragma once

#include "volume/import/files/stored_image.h"

#include <string>

/// Decoded bytes of the samples of images, whatever their encoding.
namespace tessera::importer {

/// Reads the samples of an image: from place to place where they are raw, else forwards, and anew from the beginning of
/// a file where what is asked for lies behind. Throws Error, at first for files that are missing or shorter than the
/// header announces.
volume::ReadBytes samplesOf(const volume::StoredImage& image, const std::string& header);

/// The first bytes of a file, inflated if it is compressed (gzip or bzip2).
std::string inflatedPart(const std::string& path, std::size_t count);

/// How a file is compressed as a whole, by its first bytes.
volume::SampleEncoding compressionOf(const std::string& path);

} // namespace tessera::importer
