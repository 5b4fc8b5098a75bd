#include "volume/sources/source_difference.h"

#include "volume/reconstruct/sample_grid.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tessera::volume {

namespace {

class DifferenceSum {
public:
    void add(const BrickSamples& a, const BrickSamples& b) {
        for (std::size_t i = 0; i < a.values.size(); ++i) {
            const bool hereA = a.isPresent(i), hereB = b.isPresent(i);
            if (hereA != hereB) ++out_.differing;
            if (!hereA || !hereB) continue;
            const double apart = std::abs(a.exact(i) - b.exact(i));
            ++out_.samples;
            if (a.exact(i) != b.exact(i)) ++out_.differing;
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
        const auto whole = [](const SourcePart& of, const Progress& part) {
            SampleGrid all = readSamples(of.source, of.channel, of.time, 0, part);
            return BrickSamples{all.lattice.size, std::move(all.values), std::move(all.present)};
        };
        const BrickSamples one = whole(a, progress.part(0, 0.5)), other = whole(b, progress.part(0.5, 1));
        sum.add(one, other);
        return sum.result();
    }
    const std::size_t bricks = left.brickCount();
    for (std::size_t i = 0; i < bricks; ++i) {
        if (progress.stop.stop_requested()) throw Cancelled();
        const glm::ivec3 at = left.indexOf(i);
        const BrickSamples one = a.source.read({a.channel, a.time, 0, at}),
                           other = b.source.read({b.channel, b.time, 0, at});
        sum.add(one, other);
        progress.advance(double(i + 1) / double(bricks));
    }
    return sum.result();
}

} // namespace tessera::volume
