#include "codec/container/exactness.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace tessera::codec {

namespace {

std::string text(const char* format, double value) {
    char out[64];
    std::snprintf(out, sizeof out, format, value);
    return out;
}

} // namespace

bool isResampled(const Metadata& metadata) {
    return metadata.alternating || !metadata.resampled.empty() ||
           (metadata.info.lattice.kind == volume::LatticeKind::BCC && metadata.source.kind == volume::LatticeKind::CC);
}

namespace {

const char* latticeName(const Metadata& metadata) {
    if (metadata.alternating) return "D4*";
    return metadata.info.lattice.kind == volume::LatticeKind::BCC ? "BCC" : "CC";
}

/// What resampling changed, over all numbers: "(largest error 0.4 % of range, PSNR 38.9 dB or more)".
std::string resampledTogether(const Metadata& metadata) {
    double least = std::numeric_limits<double>::infinity(), largest = 0;
    std::size_t known = 0;
    for (std::size_t p = 0; p < metadata.resampled.size() && p < metadata.info.parameters.size(); ++p) {
        const volume::Parameter& about = metadata.info.parameters[p];
        if (!metadata.resampled[p] || about.categorical) continue;
        ++known;
        const double extent = extentOf(about);
        least = std::min(least, psnrOf(*metadata.resampled[p], extent));
        if (extent > 0) largest = std::max(largest, metadata.resampled[p]->largest / extent);
    }
    if (known == 0) return " (with an unknown error)";
    if (!std::isfinite(least)) return " (without error)";
    return " (largest error " + text("%.3g", 100 * largest) + " % of range, PSNR " + text("%.1f", least) +
           (known > 1 ? " dB or more)" : " dB)");
}

} // namespace

std::string exactnessText(const Metadata& metadata) {
    const std::string bound = "error within " + text("%.3g", metadata.maxError) + " of range";
    if (!isResampled(metadata)) return metadata.lossless ? "lossless: every sample is exact" : bound;
    const std::string name = latticeName(metadata);
    if (metadata.corrections.empty())
        return (metadata.lossless ? "every sample of the " + name + " grid is exact; the source was resampled"
                                  : bound + " at the samples of the " + name + " grid, in addition to resampling") +
               resampledTogether(metadata) +
               (name == "CC" ? "" : "; labels and absent samples are those of the " + name + " grid");
    if (!metadata.lossless && metadata.resampled.empty())
        return bound + " at every sample of the source, stored on " + name + " with corrections";
    return "resampled to " + name + " and back to the samples of the source" + resampledTogether(metadata) +
           "; labels and absent samples are exact";
}

std::string resampledText(const Metadata& metadata, std::size_t parameter) {
    const volume::Parameter& about = metadata.info.parameters[parameter];
    if (about.categorical && !metadata.corrections.empty()) return "exact";
    if (parameter >= metadata.resampled.size() || !metadata.resampled[parameter]) return {};
    const ResampleError& error = *metadata.resampled[parameter];
    std::string out = "resampled: ";
    if (error.samples == 0) return out + "no sample to compare";
    if (about.categorical) {
        out += text("%.3g", 100 * error.meanSquare) + " % of the samples have another label";
    } else if (error.meanSquare == 0) {
        out += "without error";
    } else {
        out += "PSNR " + text("%.1f", psnrOf(error, extentOf(about))) + " dB, error at most " +
               text("%.4g", error.largest) + (about.unit.empty() ? "" : " " + about.unit) +
               " at the samples of the source";
    }
    if (error.share < 1) out += ", in " + text("%.2g", 100 * error.share) + " % of the slices";
    return out;
}

} // namespace tessera::codec
