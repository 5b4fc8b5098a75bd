#include "volume/sources/source_difference.h"

#include "volume/reconstruct/sample_grid.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace tessera::volume {

namespace {

class DifferenceSum {
public:
    void add(std::span<const float> a, std::span<const std::uint8_t> inA, std::span<const float> b,
             std::span<const std::uint8_t> inB) {
        for (std::size_t i = 0; i < a.size(); ++i) {
            const bool hereA = inA.empty() || inA[i] != 0, hereB = inB.empty() || inB[i] != 0;
            if (hereA != hereB) ++out_.differing;
            if (!hereA || !hereB) continue;
            const double apart = std::abs(double(a[i]) - double(b[i]));
            ++out_.samples;
            if (a[i] != b[i]) ++out_.differing;
            out_.largest = std::max(out_.largest, apart);
            squares_ += apart * apart;
        }
    }
    SourceDifference result() const {
        SourceDifference out = out_;
        if (out.samples > 0) out.rms = std::sqrt(squares_ / double(out.samples));
        return out;
    }

private:
    SourceDifference out_;
    double squares_ = 0;
};

} // namespace

std::optional<SourceDifference> sourceDifference(const SourcePart& a, const SourcePart& b, const Progress& progress) {
    const BrickGrid &left = a.source.grid(), &right = b.source.grid();
    if (!(left.lattice == right.lattice)) return std::nullopt;
    DifferenceSum sum;
    if (left.brickSize != right.brickSize) {
        const SampleGrid one = readSamples(a.source, a.channel, a.time, 0, progress.part(0, 0.5));
        const SampleGrid other = readSamples(b.source, b.channel, b.time, 0, progress.part(0.5, 1));
        sum.add(one.values, one.present, other.values, other.present);
        return sum.result();
    }
    const std::size_t bricks = left.brickCount();
    for (std::size_t i = 0; i < bricks; ++i) {
        if (progress.stop.stop_requested()) throw Cancelled();
        const glm::ivec3 at = left.indexOf(i);
        const BrickSamples one = a.source.read({a.channel, a.time, 0, at}),
                           other = b.source.read({b.channel, b.time, 0, at});
        sum.add(one.values, one.present, other.values, other.present);
        progress.advance(double(i + 1) / double(bricks));
    }
    return sum.result();
}

} // namespace tessera::volume
