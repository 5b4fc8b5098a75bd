#pragma once

#include "codec/archive/archive.h"
#include "codec/archive/brick_input.h"
#include "codec/bands/rans_model.h"
#include "codec/container/index.h"
#include "codec/container/mask_hash.h"

#include <cmath>
#include <utility>
#include <vector>

/// The state that a writer needs to continue an archive with the same bytes as in a single run.
namespace tessera::codec {

/// The model or the steps of a component's last frame, and the frame it was made for; tried first for later frames with
/// the same code width.
struct KnownModel {
    std::int32_t number = -1;
    Model model;
    Wavelet wavelet{};
    NumberKind kind{};
    int codeBits = 0;
    bool bodyCentred = false;
    StepChoice steps;    ///< for Stepped, whose model is idle
    double quantum = 0;  ///< quantumOf the component's latest frame
    bool parted = false; ///< it

    bool resembles(const FrameRecord& frame) const {
        return kind == frame.numbers.kind && codeBits - frame.codeBits <= 1 && frame.codeBits - codeBits <= 1;
    }
};

/// The quantum of a frame of kind Stepped in the unit of the parameter; 0: another kind.
inline double quantumOf(const FrameRecord& frame, const StepChoice& steps) {
    constexpr double kSixteenths = 16;
    if (frame.numbers.kind != NumberKind::Stepped) return 0;
    return steps.quantum / kSixteenths * frame.numbers.step * std::abs(frame.valueScale);
}

struct ArchiveState {
    Header header;
    std::uint64_t pageBytes = 0; ///< of the index, decompressed
    std::size_t times = 0, components = 0, models = 0, masks = 0;
    std::vector<KnownModel> lastModels;                        ///< per component
    std::vector<std::pair<int, MaskHash::Value>> lastMasks;    ///< at the last time
    std::vector<std::pair<std::size_t, SeenFrame>> lastFrames; ///< per component, on D4* two of each
};

/// Hash of the mask of a frame of an archive. Throws Error when it is damaged.
MaskHash::Value maskHashOf(const Archive& archive, const FrameRecord& frame);

/// `withFrames`: also read the last frames. Throws Error when a model, a mask or a brick of a last frame is damaged.
ArchiveState stateOf(const Archive& archive, bool withFrames);

} // namespace tessera::codec
