#pragma once

#include "codec/container/metadata.h"

#include <string>

/// Accuracy of the samples of an archive.
namespace tessera::codec {

/// Whether the stored samples were resampled from those of the source.
bool isResampled(const Metadata& metadata);

/// Text on the accuracy of stored samples relative to the source: "every sample is exact"; "every sample of the BCC
/// grid is exact; the source was resampled (PSNR 38.9 dB)".
std::string exactnessText(const Metadata& metadata);
/// The same for one parameter: "resampled: PSNR 38.9 dB, error at most 2734 HU"; "" if it was not resampled or the
/// error is unknown.
std::string resampledText(const Metadata& metadata, std::size_t parameter);

} // namespace tessera::codec
