#include "codec/pack.h"

namespace tessera::codec {

PackOptions resolved(PackOptions options) {
    const PackOptions defaults;
    const auto set = [](auto& value, const auto& before, const auto& wanted) {
        if (value == before) value = wanted;
    };
    switch (options.preset) {
    case PackPreset::None:
        break;
    case PackPreset::Lossless:
        set(options.lattice, defaults.lattice, StoredLattice::CC);
        break;
    case PackPreset::Visual:
        set(options.maxError, defaults.maxError, 1e-3);
        break;
    case PackPreset::Small:
        set(options.maxError, defaults.maxError, 1e-2);
        set(options.zstdLevel, defaults.zstdLevel, 19);
        break;
    case PackPreset::Thesis:
        set(options.wavelet, defaults.wavelet, WaveletChoice::W22);
        set(options.brickSize, defaults.brickSize, 16);
        set(options.levels, defaults.levels, 3);
        set(options.bccTransform, defaults.bccTransform, BccTransform::Separable);
        set(options.threshold, defaults.threshold, ThresholdOptions{ThresholdChoice::Soft, 1.5 / 255, true});
        break;
    }
    options.preset = PackPreset::None;
    return options;
}

} // namespace tessera::codec
