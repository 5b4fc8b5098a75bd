#pragma once

#include "codec/container/metadata.h"

#include <string>

/// Accuracy of the samples of an archive.
namespace tessera::codec {

/// Whether the stored samples were resampled from those of the source.
bool isResampled(const Metadata& metadata);

/// Text on the accuracy of an archive's samples at those of the source: "lossless: every sample is exact"; "error
/// within 0.001 of range"; "resampled to BCC and back to the samples of the source (largest error 0.4 % of range,
/// PSNR 38.9 dB); labels and absent samples are exact". Of archives without corrections it says what is true of the
/// stored samples.
std::string exactnessText(const Metadata& metadata);
/// The same for one parameter: "resampled: PSNR 38.9 dB, error at most 2734 HU at the samples of the source"; "" if it
/// was not resampled or the error is unknown.
std::string resampledText(const Metadata& metadata, std::size_t parameter);

} // namespace tessera::codec
