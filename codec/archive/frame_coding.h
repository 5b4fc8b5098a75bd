#pragma once

#include "codec/archive/archive_state.h"
#include "codec/archive/brick_access.h"
#include "codec/archive/brick_input.h"
#include "codec/archive/frame_model.h"
#include "codec/archive/frame_steps.h"

#include <optional>
#include <utility>
#include <vector>

namespace tessera::codec {

/// A frame being coded: the coding parameters of its bricks, and their statistics.
struct FrameCoding {
    const volume::BrickGrid& grid;
    FrameRecord frame;
    double maxError = 0;                ///< of its samples
    const SeenFrame* before = nullptr;  ///< earlier frame whose bricks may be repeated
    std::vector<std::uint8_t> repeated; ///< flag per brick
    std::vector<std::uint8_t> whole;    ///< flag per brick: no token was coded
    std::vector<std::uint8_t> mixed;    ///< flag per brick
    std::vector<volume::BrickImportance> importance;
    Taken taken;
    Model model;
    const FrameSamples* samples = nullptr; ///< that are coded
    const FrameSamples* parts = nullptr;   ///< numbers of their parts; null: there is one
    std::optional<SteppedFrame> steps;     ///< if coefficients are quantised
    /// The frame as it would be with rounded samples.
    struct Rounded {
        FrameRecord frame;
        const FrameSamples* samples = nullptr;
        const SeenFrame* before = nullptr;
        std::vector<std::uint8_t> repeated;
    } rounded;
    std::vector<SampleErrors> errors; ///< by brick, if the mean error is bounded and coefficients are quantised
    int step = 1;                     ///< times since `before`
    bool statistics = false;          ///< store statistics of bricks
    bool keeps = false;               ///< keep samples and sizes for later frames
    int mostPredicted = 0;
    SeenFrame seen;

    explicit FrameCoding(const volume::BrickGrid& of) : grid(of) {}

    /// What brick `brick` of the frame is predicted from, as codes; empty if it is coded by itself.
    std::vector<std::uint32_t> prediction(std::size_t brick) const;
    bool measures() const { return steps && steps->mean; }
    /// Sums of squared errors of the bricks coded and of those repeated.
    std::pair<double, double> squares() const;
    /// Prepares for coding all bricks again, with another quantum. False: there is no such coding.
    bool restart(double quantum);
    /// The same, with rounded samples.
    void restartRounded(double maxError);

    /// Codes brick `brick` of `part` (a slab with grid `own`, where its index is `ownNumber`) into segments.
    std::vector<Bytes> code(std::size_t brick, const volume::Field& part, const volume::BrickGrid& own,
                            std::size_t ownNumber, const BandEncoder& encoder, Compressor& compressor,
                            BrickInput& input, SplitMemory& memory);
};

} // namespace tessera::codec
