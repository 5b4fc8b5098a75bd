#include "volume/reconstruct/cubic.h"

#include "volume/base/parallel.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace tessera::volume {

namespace {

constexpr double kStepsOnCc[] = {1, 1, 2}, kStepsOnBcc[] = {1, 1, 1.5, 2, 4};

/// Weights of the samples from `first` on along an axis.
struct Taps {
    int first;
    std::vector<float> weights;
};
const Taps kOwn{-1, {1.0f / 6, 4.0f / 6, 1.0f / 6}};
const std::vector<float> kBetween{1.0f / 48, 23.0f / 48, 23.0f / 48, 1.0f / 48};

/// The samples of one sublattice.
struct Plain {
    glm::ivec3 size{0};
    std::vector<float> values;

    explicit Plain(glm::ivec3 of) : size(of), values(std::size_t(of.x) * std::size_t(of.y) * std::size_t(of.z)) {}
    const float* row(int y, int z) const {
        y = std::clamp(y, 0, size.y - 1);
        z = std::clamp(z, 0, size.z - 1);
        return values.data() + (std::size_t(z) * std::size_t(size.y) + std::size_t(y)) * std::size_t(size.x);
    }
    float* row(int y, int z) { return const_cast<float*>(std::as_const(*this).row(y, z)); }
};

/// Along an axis, the outermost samples repeated; what depends on these is cut off in the end.
Plain along(const Plain& from, int axis, const Taps& taps) {
    Plain out(from.size);
    const int width = from.size.x, count = int(taps.weights.size());
    parallelFor(std::size_t(from.size.z), [&](std::size_t slice) {
        const int z = int(slice);
        std::vector<float> longer(std::size_t(width + count));
        for (int y = 0; y < from.size.y; ++y) {
            float* to = out.row(y, z);
            if (axis == 0) {
                const float* row = from.row(y, z);
                for (int x = 0; x < width + count - 1; ++x)
                    longer[std::size_t(x)] = row[std::clamp(x + taps.first, 0, width - 1)];
            }
            for (int n = 0; n < count; ++n) {
                const float weight = taps.weights[std::size_t(n)];
                const float* row = axis == 0   ? longer.data() + n
                                   : axis == 1 ? from.row(y + taps.first + n, z)
                                               : from.row(y, z + taps.first + n);
                for (int x = 0; x < width; ++x) to[x] += weight * row[x];
            }
        }
    });
    return out;
}

Plain alongAll(const Plain& from, const Taps& taps) {
    return along(along(along(from, 0, taps), 1, taps), 2, taps);
}

/// What the kernel makes of samples at their own places.
std::vector<Plain> smoothed(const std::vector<Plain>& from, bool bcc) {
    std::vector<Plain> out;
    for (std::size_t s = 0; s < from.size(); ++s) {
        out.push_back(alongAll(from[s], kOwn));
        if (!bcc) continue;
        const Plain other = alongAll(from[1 - s], {s == 0 ? -2 : -1, kBetween});
        for (std::size_t i = 0; i < other.values.size(); ++i)
            out[s].values[i] = 0.5f * (out[s].values[i] + other.values[i]);
    }
    return out;
}

/// Which sample of a brick is sample `i` of a sublattice.
std::size_t stored(const Plain& of, std::size_t i, std::size_t sublattices, std::size_t s) {
    const std::size_t slice = std::size_t(of.size.x) * std::size_t(of.size.y);
    return (i / slice * sublattices + s) * slice + i % slice;
}

} // namespace

std::span<const double> cubicSteps(const LevelGeometry& geometry) {
    return geometry.bccNeighbours() ? std::span<const double>(kStepsOnBcc) : std::span<const double>(kStepsOnCc);
}

int prefilterReach(Prefilter filter, const LevelGeometry& geometry) {
    if (filter != Prefilter::Cubic) return filter == Prefilter::Linear ? 1 : 0;
    return int(cubicSteps(geometry).size()) * (geometry.bccNeighbours() ? 2 : 1);
}

double prefilterOvershoot(Prefilter filter) {
    constexpr double kOfLinear = 2.0 / 3, kOfCubic = 10.5; // both on BCC; on CC 1/2 and 2.7
    return filter == Prefilter::Cubic ? kOfCubic : filter == Prefilter::Linear ? kOfLinear : 0;
}

BrickSamples cubicCoefficients(const BrickSamples& gathered, const LevelGeometry& geometry) {
    const bool bcc = geometry.bccNeighbours(), masked = !gathered.present.empty();
    const int slices = geometry.kind == LatticeKind::BCC ? 2 : 1, reach = prefilterReach(Prefilter::Cubic, geometry);
    assert(std::min({gathered.size.x, gathered.size.y, gathered.size.z / slices}) > 2 * reach);
    const glm::ivec3 each(gathered.size.x, gathered.size.y, gathered.size.z / slices);
    const auto sublattices = std::size_t(slices);

    // Relative to their middle, so that single precision suffices.
    float lo = std::numeric_limits<float>::infinity(), hi = -lo;
    for (std::size_t i = 0; i < gathered.values.size(); ++i)
        if (gathered.isPresent(i)) lo = std::min(lo, gathered.values[i]), hi = std::max(hi, gathered.values[i]);
    const float middle = lo <= hi ? lo / 2 + hi / 2 : 0;
    std::vector<Plain> samples(sublattices, Plain(each)), present(masked ? sublattices : 0, Plain(each));
    for (std::size_t s = 0; s < sublattices; ++s)
        for (std::size_t i = 0; i < samples[s].values.size(); ++i) {
            const std::size_t from = stored(samples[s], i, sublattices, s);
            const bool there = gathered.isPresent(from);
            samples[s].values[i] = there ? gathered.values[from] - middle : 0;
            if (masked) present[s].values[i] = there ? 1 : 0;
        }
    // An absent sample has the value 0 here; `lacks` is the weight of those around a sample.
    std::vector<Plain> lacks = masked ? smoothed(present, bcc) : std::vector<Plain>();
    for (Plain& of : lacks)
        for (float& share : of.values) share = 1 - share;
    std::vector<Plain> found = samples;
    for (const double factor : cubicSteps(geometry)) {
        const std::vector<Plain> smooth = smoothed(found, bcc);
        for (std::size_t s = 0; s < sublattices; ++s)
            parallelRanges(
                found[s].values.size(),
                [&](std::size_t begin, std::size_t end) {
                    for (std::size_t i = begin; i < end; ++i) {
                        const float own = found[s].values[i];
                        float kernel = smooth[s].values[i];
                        if (masked) kernel += lacks[s].values[i] * own;
                        const float next = own + float(factor) * (samples[s].values[i] - kernel);
                        found[s].values[i] = masked ? next * present[s].values[i] : next;
                    }
                },
                4096);
    }

    BrickSamples out;
    out.size = gathered.size - 2 * reach * glm::ivec3(1, 1, slices);
    out.values.resize(std::size_t(out.size.x) * std::size_t(out.size.y) * std::size_t(out.size.z));
    if (masked) out.present.resize(out.values.size());
    std::size_t to = 0;
    for (int z = 0; z < out.size.z; ++z)
        for (int y = 0; y < out.size.y; ++y) {
            const int slice = z / slices + reach;
            const auto s = std::size_t(z % slices);
            const float* from = found[s].row(y + reach, slice) + reach;
            const float* there = masked ? present[s].row(y + reach, slice) + reach : nullptr;
            for (int x = 0; x < out.size.x; ++x, ++to) {
                const bool has = there == nullptr || there[x] > 0;
                out.values[to] = has ? from[x] + middle : 0;
                if (masked) out.present[to] = has ? 1 : 0;
            }
        }
    return out;
}

BrickSamples prefiltered(const BrickSamples& gathered, const LevelGeometry& geometry, Prefilter filter) {
    if (filter == Prefilter::None) return gathered;
    return filter == Prefilter::Linear ? prefilter(gathered, geometry) : cubicCoefficients(gathered, geometry);
}

} // namespace tessera::volume
