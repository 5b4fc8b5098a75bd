#pragma once

#include "volume/field/dataset.h"
#include "volume/field/slices.h"

#include <optional>
#include <string>
#include <vector>

/// What resampling to BCC cost: the stored lattice interpolated back at the samples of the source, as unpacking does.
namespace tessera::codec {

struct Metadata;

/// Of one parameter, all components and times together, in its unit. Of labels a sample counts 1 where its label is
/// another. Samples that are absent on either side do not count.
struct ResampleError {
    double meanSquare = 0, largest = 0;
    double samples = 0; ///< compared
    double share = 1;   ///< of the samples of the source that were looked at

    void add(const ResampleError& more);
    bool operator==(const ResampleError&) const = default;
};

/// Peak signal-to-noise ratio, dB, of a range; infinite without an error.
double psnrOf(const ResampleError& error, double extent);

/// At most, of samples that were resampled twice: errors add up.
ResampleError joined(const std::optional<ResampleError>& before, const ResampleError& then);

/// Compares a frame with what was made of it. Small frames of up to 32 slices are looked at as one, others in blocks of
/// 8 slices, at most 32 that are evenly spread along z; no more than a block and the stored slices around it are in
/// memory then. Throws Cancelled and what reading throws.
ResampleError resampleError(const volume::Field& source, const volume::Field& stored, bool categorical);
ResampleError resampleError(const volume::Lattice& source, const volume::SliceReader& readSource,
                            const volume::Lattice& stored, const volume::SliceReader& readStored, bool categorical);

/// Whether the stored samples are others than those of the source, errors of coding apart.
bool isResampled(const Metadata& metadata);

/// How the stored samples came from those of the source, and how exact they are, in words:
/// "every sample is exact"; "every sample of the BCC grid is exact; the source was resampled (PSNR 38.9 dB)".
std::string exactnessText(const Metadata& metadata);
/// Of one parameter: "resampled: PSNR 38.9 dB, error at most 2734 HU"; "" where nothing was resampled or noted.
std::string resampledText(const Metadata& metadata, std::size_t parameter);

} // namespace tessera::codec
