#include "codec/archive/frame_steps.h"

#include "codec/archive/brick_access.h"
#include "codec/archive/frame_model.h"
#include "volume/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <vector>

namespace tessera::codec {

namespace {

constexpr std::size_t kMostBoxes = 2, kWholeBrick = 1 << 17; // samples of the largest brick tried as a whole
constexpr int kBoxOfBrick = 64;                              // edge of the box tried of a larger brick
constexpr double kUsualQuantum = 3;                          // in units of the error bound
constexpr double kHopeless = 1.6;                            // factor on the bytes beyond which trials end

std::uint32_t quantumOf(double bounds) {
    constexpr double kSixteenths = 16;
    return static_cast<std::uint32_t>(std::lround(bounds * kSixteenths * (kReach + 0.5)));
}

/// Boxes of a frame, coded in different ways.
class StepTrials {
public:
    StepTrials(const volume::BrickGrid& grid, const FrameSamples& samples, const FrameRecord& frame,
               const FrameOptions& options)
        : type_(samples.type()), maxError_(boundOf(frame, options)) {
        const std::size_t bricks = grid.brickCount(), count = std::min(bricks, kMostBoxes);
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t number = (2 * i + 1) * bricks / (2 * count);
            const glm::ivec3 brick = grid.indexOf(number);
            Box box;
            box.format = brickFormat(grid, brick, type_, frame);
            glm::ivec3 begin(0);
            if (countOf(box.format.size) > kWholeBrick) {
                const int step = box.format.sublattices();
                const glm::ivec3 most(kBoxOfBrick, kBoxOfBrick, kBoxOfBrick * step),
                    size = glm::min(box.format.size, most);
                begin = (box.format.size - size) / 2;
                begin.z -= begin.z % step; // start on an even slice
                box.format.size = size;
            }
            box.input.take(grid, grid.begin(brick) + begin, box.format.size, samples, frame.mask >= 0);
            share_ += double(countOf(box.format.size));
            boxes_.push_back(std::move(box));
        }
        share_ /= double(samples.count());
    }

    /// The part of the frame that is tried.
    double share() const { return share_; }

    double bytesOfSamples(const Model& model) const {
        const BandEncoder encoder(model);
        return sum([&](const Box& box) {
            Compressor compressor(3);
            return encodeBrick(box.format, box.input.samples, box.input.present, maxError_, compressor, encoder);
        });
    }

    double bytesOf(const SteppedFrame& how) const {
        static const BandEncoder idle(makeModel(Histogram(1, {}), 1)); // codes nothing
        return sum([&](const Box& box) {
            Compressor compressor(3);
            BrickFormat format = box.format;
            format.numbers = how.numbers;
            format.wavelet = how.wavelet;
            format.codeBits = how.codeBits;
            format.steps = how.steps;
            SplitMemory memory;
            const PreparedBrick brick =
                prepareBrick(format, box.input.samples, box.input.present, maxError_, {}, memory);
            return encodeBrick(format, brick, box.input.samples, box.input.present, compressor, idle);
        });
    }

private:
    struct Box {
        BrickFormat format;
        BrickInput input;
    };
    template <class Encode> double sum(const Encode& encode) const {
        std::atomic<std::uint64_t> bytes = 0;
        parallelFor(boxes_.size(), [&](std::size_t i) {
            for (const Bytes& segment : encode(boxes_[i])) bytes += segment.size();
        });
        return double(bytes.load());
    }

    volume::ScalarType type_;
    double maxError_, share_ = 0;
    std::vector<Box> boxes_;
};

} // namespace

StepChoice usualSteps() {
    return {{7, 4}, quantumOf(kUsualQuantum)};
}

std::optional<SteppedFrame> chooseSteps(const volume::BrickGrid& grid, const FrameSamples& samples,
                                        const FrameRecord& frame, const Model& model, const FrameOptions& options,
                                        const StepChoice* before) {
    if (frame.numbers.kind != NumberKind::Quantised || options.numbers || options.keepsSquares) return std::nullopt;
    constexpr int kMostBits = 29;
    constexpr double kApart = 1.4; // factor between quanta
    const std::optional<NumberCoding> numbers = steppedCoding(samples, boundOf(frame, options));
    if (!numbers) return std::nullopt;
    SteppedFrame how{*numbers, frame.wavelet, 0, before ? *before : usualSteps()};
    how.codeBits = codeBitsOf(samples, how.numbers) + 1;
    if (how.codeBits > kMostBits) return std::nullopt;
    const StepTrials trials(grid, samples, frame, options);
    const double ofModel = frame.model < 0 ? double(serialise(model).size()) : 0;
    const double limit = trials.bytesOfSamples(model) + ofModel * trials.share();
    std::optional<SteppedFrame> best;
    double least = std::numeric_limits<double>::infinity();
    const auto attempt = [&](const SteppedFrame& tried) {
        const double bytes = trials.bytesOf(tried);
        if (bytes >= least) return false;
        least = bytes;
        best = tried;
        return true;
    };
    how.wavelet = options.wavelet.value_or(Wavelet::W44);
    attempt(how);
    if (before || least > kHopeless * limit) return least < limit ? best : std::nullopt;
    for (int axis = 0; axis < 3; ++axis) {
        how = *best;
        how.steps.split.axes &= ~(1 << axis);
        attempt(how);
    }
    for (const int length : {2, 10}) {
        how = *best;
        how.steps.split.least = length;
        if (attempt(how)) break;
    }
    const auto scale = [&](double bounds) {
        how = *best;
        how.steps.quantum = quantumOf(bounds);
        return attempt(how);
    };
    if (scale(kUsualQuantum * kApart)) {
        scale(kUsualQuantum * kApart * kApart);
    } else {
        scale(kUsualQuantum / kApart);
    }
    return least < limit ? best : std::nullopt;
}

void useSteps(const SteppedFrame& steps, FrameRecord& frame) {
    frame.numbers = steps.numbers;
    frame.wavelet = steps.wavelet;
    frame.codeBits = steps.codeBits;
    frame.steps = steps.steps;
}

} // namespace tessera::codec
