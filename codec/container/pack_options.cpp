#include "codec/container/pack_options.h"

namespace tessera::codec {

std::optional<PackOptions> PackOptions::preset(std::string_view name) {
    PackOptions options;
    if (name == "lossless") {
        options.lattice = StoredLattice::CC;
    } else if (name == "visual") {
        options.maxError = 1e-3;
    } else if (name == "small") {
        options.maxError = 1e-2;
        options.effort = 9;
        options.zstdLevel = 19;
    } else if (name == "thesis") {
        options.lattice = StoredLattice::BCC;
        options.wavelet = WaveletChoice::W22;
        options.brickSize = 16;
        options.levels = 3;
        options.bccTransform = BccTransform::Separable;
        options.threshold = {ThresholdChoice::Soft, 1.5 / 255, true};
    } else if (name != "none") {
        return std::nullopt;
    }
    return options;
}

bool PackOptions::presetHasLattice(std::string_view name) {
    return name == "lossless" || name == "thesis";
}

bool hasThreshold(const PackOptions& options) {
    return options.threshold.kind != ThresholdChoice::None && options.threshold.value > 0;
}

bool isExact(const PackOptions& options) {
    return options.maxError == 0 && options.absError == 0 && options.psnr == 0 && !hasThreshold(options);
}

bool isRelative(const PackOptions& options) {
    return options.maxError > 0 || options.psnr > 0 || hasThreshold(options) || options.discard > 0;
}

} // namespace tessera::codec
