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

std::string exactnessText(const Metadata& metadata) {
    const bool resampled = isResampled(metadata);
    std::string out;
    if (!metadata.lossless)
        out = "error within " + text("%.3g", metadata.maxError) + " of range";
    else if (!resampled)
        out = "lossless: every sample is exact";
    else
        out = std::string("every sample of the ") +
              (metadata.alternating                                     ? "D4*"
               : metadata.info.lattice.kind == volume::LatticeKind::BCC ? "BCC"
                                                                        : "CC") +
              " grid is exact";
    if (!resampled) return out;
    out += metadata.lossless ? "; the source was resampled" : " in addition to resampling";
    double least = std::numeric_limits<double>::infinity();
    std::size_t known = 0;
    for (std::size_t p = 0; p < metadata.resampled.size() && p < metadata.info.parameters.size(); ++p) {
        if (!metadata.resampled[p] || metadata.info.parameters[p].categorical) continue;
        ++known;
        least = std::min(least, psnrOf(*metadata.resampled[p], extentOf(metadata.info.parameters[p])));
    }
    if (known == 0) return out + " (with an unknown error)";
    if (!std::isfinite(least)) return out + " (without error)";
    return out + " (PSNR " + text("%.1f", least) + (known > 1 ? " dB or more)" : " dB)");
}

std::string resampledText(const Metadata& metadata, std::size_t parameter) {
    if (parameter >= metadata.resampled.size() || !metadata.resampled[parameter]) return {};
    const ResampleError& error = *metadata.resampled[parameter];
    const volume::Parameter& about = metadata.info.parameters[parameter];
    std::string out = "resampled: ";
    if (error.samples == 0) return out + "no sample to compare";
    if (about.categorical) {
        out += text("%.3g", 100 * error.meanSquare) + " % of the samples have another label";
    } else if (error.meanSquare == 0) {
        out += "without error";
    } else {
        out += "PSNR " + text("%.1f", psnrOf(error, extentOf(about))) + " dB, error at most " +
               text("%.4g", error.largest) + (about.unit.empty() ? "" : " " + about.unit);
    }
    if (error.share < 1) out += ", in " + text("%.2g", 100 * error.share) + " % of the slices";
    return out;
}

} // namespace tessera::codec
