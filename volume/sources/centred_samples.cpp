#include "volume/sources/centred_samples.h"

#include "volume/reconstruct/present_coverage.h"
#include "volume/resample/slice_filter.h"
#include "volume/sources/box_filter.h"
#include "volume/sources/cell_ranges.h"
#include "volume/sources/weighed_rows.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <utility>

namespace tessera::volume {

namespace {

constexpr ResampleOptions kKernel{.filter = ResampleFilter::Cubic};
constexpr int kReach = 4; ///< samples that it reads along an axis, at most

/// Index along an axis of a sample of another; whole where it is nearly.
double indexIn(const LevelAxis& grid, const LevelAxis& other, int i) {
    const double index = (other.first - grid.first + other.step * i) / grid.step, whole = std::round(index);
    return std::abs(index - whole) < 1e-9 * (1 + std::abs(index)) ? whole : index;
}

/// The two samples around an index, which may lie beyond the ends.
Tap between(double index) {
    Tap tap;
    tap.first = int(std::floor(index));
    tap.count = 2;
    tap.fraction = index - tap.first;
    tap.weight[0] = 1 - tap.fraction;
    tap.weight[1] = tap.fraction;
    return tap;
}

/// Sum over the samples of the nearest one's part, with beyond(index, own) in place of others.
template <class Beyond>
double ownSum(const SampledBox& grid, const UnfilledVector<float>& values, const std::array<const Tap*, 3>& taps,
              const Beyond& beyond) {
    Lattice box;
    box.size = grid.box.size();
    const Tap x = countedFrom(*taps[0], grid.box.begin.x), y = countedFrom(*taps[1], grid.box.begin.y),
              z = countedFrom(*taps[2], grid.box.begin.z);
    return ofOwnPart(box, grid.numbers, {&x, &y, &z}, values, beyond);
}

/// Range of the samples of a part that a kernel reads, widened.
Range allowed(const SampledBox& grid, const std::array<const Tap*, 3>& taps, std::uint8_t number) {
    Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (int k = 0; k < taps[2]->count; ++k)
        for (int j = 0; j < taps[1]->count; ++j) {
            const std::size_t row = grid.box.place({taps[0]->first, taps[1]->first + j, taps[2]->first + k});
            for (int i = 0; i < taps[0]->count; ++i) {
                const std::size_t at = row + std::size_t(i);
                if (!grid.numbers.empty() && grid.numbers[at] != number) continue;
                range.lo = std::min(range.lo, double(grid.values[at]));
                range.hi = std::max(range.hi, double(grid.values[at]));
            }
        }
    const double beyond = kCentredHeadroom * (range.hi - range.lo);
    return {range.lo - beyond, range.hi + beyond};
}

/// Samples of both sublattices, prefiltered as by Prefiltered (volume/reconstruct/reconstruct.h), in a box that has one
/// texel less on every side.
std::array<SampledBox, 2> prefiltered(const std::array<SampledBox, 2>& centred) {
    const IndexBox box{centred[0].box.begin + 1, centred[0].box.end - 1};
    const IndexBox& all = centred[0].box;
    const auto stepY = std::ptrdiff_t(all.size().x), stepZ = stepY * all.size().y;
    const Cpu cpu = bestCpu();
    std::array<SampledBox, 2> out;
    for (int s = 0; s < 2; ++s) {
        const SampledBox &own = centred[std::size_t(s)], &other = centred[std::size_t(1 - s)];
        SampledBox& to = out[std::size_t(s)];
        to = boxLike(box, own);
        const int lo = s - 1; // neighbours of an even sample have indices -1 and 0, of an odd one 0 and 1
        std::array<std::ptrdiff_t, 8> steps;
        for (int n = 0; n < 8; ++n)
            steps[std::size_t(n)] = (lo + (n & 1)) + (lo + (n >> 1 & 1)) * stepY + (lo + (n >> 2)) * stepZ;
        std::size_t place = 0;
        const bool mixed = !own.numbers.empty() || !other.numbers.empty() || own.number != other.number;
        for (int z = box.begin.z; z < box.end.z; ++z)
            for (int y = box.begin.y; y < box.end.y; ++y) {
                const auto first = std::ptrdiff_t(all.place({box.begin.x, y, z}));
                const int width = box.size().x;
                if (!mixed) {
                    prefilterRow(&own.values[std::size_t(first)], &other.values[std::size_t(first)], steps,
                                 std::size_t(width), &to.values[place], cpu);
                    place += std::size_t(width);
                    continue;
                }
                for (int x = 0; x < width; ++x, ++place) {
                    const std::size_t at = std::size_t(first + x);
                    const float centre = own.values[at];
                    const std::uint8_t number = own.numberAt(at);
                    if (!to.numbers.empty()) to.numbers[place] = number;
                    if (number == 0) continue;
                    double differences = 0;
                    for (const std::ptrdiff_t step : steps)
                        if (const auto near = std::size_t(first + x + step); other.numberAt(near) == number)
                            differences += double(other.values[near]) - double(centre);
                    to.values[place] = float(double(centre) - differences / 12);
                }
            }
    }
    return out;
}

} // namespace

CentredLevel finestCentred(const Lattice& grid) {
    const Lattice centred = bccFor(grid);
    CentredLevel level;
    for (int axis = 0; axis < 3; ++axis) {
        level.grid[std::size_t(axis)].count = grid.size[axis];
        for (int s = 0; s < 2; ++s)
            level.sublattices[std::size_t(s)][std::size_t(axis)] = {
                (centred.origin[axis] - grid.origin[axis] + centred.spacing[axis] * (0.5 * s)) / grid.spacing[axis],
                centred.spacing[axis] / grid.spacing[axis], centred.sublatticeSize(s)[axis]};
    }
    return level;
}

CentredGrid::CentredGrid(const CentredLevel& level, bool categorical) : level_(level), categorical_(categorical) {
    for (std::size_t s = 0; s < 2; ++s)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const LevelAxis &grid = level.grid[axis], &own = level.sublattices[s][axis];
            for (int i = 0; i < own.count; ++i)
                kernel_[s][axis].push_back(tapAt(indexIn(grid, own, i), grid.count, kKernel));
            for (int i = 0; i < grid.count; ++i) between_[s][axis].push_back(between(indexIn(own, grid, i)));
        }
}

const Tap& CentredGrid::tapOf(int sublattice, int axis, int texel) const {
    const std::vector<Tap>& taps = kernel_[std::size_t(sublattice)][std::size_t(axis)];
    return taps[std::size_t(std::clamp(texel, 0, int(taps.size()) - 1))];
}

IndexBox CentredGrid::near(const IndexBox& texels) const {
    IndexBox out{glm::ivec3(std::numeric_limits<int>::max()), glm::ivec3(0)};
    for (int s = 0; s < 2; ++s)
        for (int axis = 0; axis < 3; ++axis)
            for (int i : {texels.begin[axis] - 1, texels.begin[axis], texels.end[axis] - 1, texels.end[axis]}) {
                const Tap& tap = tapOf(s, axis, i);
                out.begin[axis] = std::min({out.begin[axis], tap.first, tap.nearest - 1});
                out.end[axis] = std::max({out.end[axis], tap.first + tap.count, tap.nearest + 2});
            }
    for (int axis = 0; axis < 3; ++axis) {
        out.begin[axis] = std::max(out.begin[axis], 0);
        out.end[axis] = std::min(out.end[axis], level_.grid[std::size_t(axis)].count);
    }
    return out;
}

IndexBox CentredGrid::texelsAround(const IndexBox& grid) const {
    IndexBox out{glm::ivec3(std::numeric_limits<int>::max()), glm::ivec3(std::numeric_limits<int>::lowest())};
    for (std::size_t s = 0; s < 2; ++s)
        for (int axis = 0; axis < 3; ++axis) {
            const std::vector<Tap>& taps = between_[s][std::size_t(axis)];
            out.begin[axis] = std::min(out.begin[axis], taps[std::size_t(grid.begin[axis])].first);
            out.end[axis] = std::max(out.end[axis], taps[std::size_t(grid.end[axis] - 1)].first + 2);
        }
    return {out.begin - 1, out.end + 1}; // neighbours for the prefilter
}

IndexBox CentredGrid::needed(const IndexBox& texels, bool mixed) const {
    IndexBox out = near(texels);
    if (categorical_) return out;
    if (level_.finest) {
        const IndexBox around = texelsAround(out);
        const IndexBox wider = near({glm::min(around.begin, texels.begin), glm::max(around.end, texels.end)});
        out = {glm::min(out.begin, wider.begin), glm::max(out.end, wider.end)};
    }
    if (!mixed) return out;
    for (int axis = 0; axis < 3; ++axis) { // a part is continued from samples beyond a cell
        out.begin[axis] = std::max(out.begin[axis] - OwnWindow::kReach, 0);
        out.end[axis] = std::min(out.end[axis] + OwnWindow::kReach, level_.grid[std::size_t(axis)].count);
    }
    return out;
}

bool CentredGrid::inGap(int sublattice, glm::ivec3 at, const SampledBox& grid) const {
    glm::ivec3 nearest;
    for (int axis = 0; axis < 3; ++axis) {
        const int last = level_.sublattices[std::size_t(sublattice)][std::size_t(axis)].count - 1;
        at[axis] = std::clamp(at[axis], 0, last);
        nearest[axis] = tapOf(sublattice, axis, at[axis]).nearest;
    }
    for (int axis = 0; axis < 3; ++axis)
        for (const int side : {-1, 1}) {
            const int other = at[axis] + side;
            if (other < 0 || other >= level_.sublattices[std::size_t(sublattice)][std::size_t(axis)].count) continue;
            const Tap &own = tapOf(sublattice, axis, at[axis]), &next = tapOf(sublattice, axis, other);
            if (side * (next.nearest - own.nearest) < 2) continue;
            glm::ivec3 there = nearest, gap = nearest;
            there[axis] = next.nearest;
            gap[axis] += side;
            if (grid.numbers[grid.box.place(there)] == 0 || grid.numbers[grid.box.place(gap)] != 0) continue;
            const double mine = std::abs(own.cell[0] + own.fraction - gap[axis]);
            const double theirs = std::abs(next.cell[0] + next.fraction - gap[axis]);
            if (mine < theirs || (mine == theirs && side > 0)) return true;
        }
    return false;
}

SampledBox CentredGrid::labels(int sublattice, const SampledBox& grid, const IndexBox& texels) const {
    SampledBox out = boxLike(texels, grid);
    forEachIndex(texels, [&](glm::ivec3 at, std::size_t place) {
        const std::size_t from = grid.box.place({tapOf(sublattice, 0, at.x).nearest, tapOf(sublattice, 1, at.y).nearest,
                                                 tapOf(sublattice, 2, at.z).nearest});
        const bool here =
            grid.numberAt(from) != 0 && (out.numbers.empty() || !level_.finest || !inGap(sublattice, at, grid));
        if (!out.numbers.empty()) out.numbers[place] = here ? grid.numbers[from] : std::uint8_t(0);
        if (here) out.values[place] = grid.values[from];
    });
    return out;
}

SampledBox CentredGrid::resampled(int sublattice, const SampledBox& grid, const IndexBox& texels) const {
    SampledBox out = boxLike(texels, grid);
    const auto tap = [&](int axis, int i) -> const Tap& { return tapOf(sublattice, axis, i); };
    const auto width = std::size_t(texels.size().x);
    const auto inPart = [&](glm::ivec3 at, std::size_t to, double sum, std::uint8_t met) {
        const std::array<const Tap*, 3> taps{&tap(0, at.x), &tap(1, at.y), &tap(2, at.z)};
        const std::size_t nearest = grid.box.place({taps[0]->nearest, taps[1]->nearest, taps[2]->nearest});
        const std::uint8_t number = grid.numbers[nearest];
        if (number == 0 || (level_.finest && inGap(sublattice, at, grid))) return;
        out.numbers[to] = number;
        if (met != bitOf(number)) {
            sum = ownSum(grid, grid.values, taps, [&](glm::ivec3 there, const auto& own) {
                return continued(LatticeKind::CC, there, own, [](glm::ivec3) { return true; })
                    .value_or(double(grid.values[nearest]));
            });
            const Range range = allowed(grid, taps, number);
            sum = std::clamp(sum, range.lo, range.hi);
        }
        out.values[to] = float(sum);
    };
    std::size_t place = 0;
    filterBox<kReach>(grid, texels, tap, [&](int y, int z, const double* sums, const std::uint8_t* met) {
        float* const to = &out.values[place];
        for (std::size_t x = 0; x < width && met == nullptr; ++x) to[x] = float(sums[x]);
        for (std::size_t x = 0; x < width && met != nullptr; ++x)
            inPart({texels.begin.x + int(x), y, z}, place + x, sums[x], met[x]);
        place += width;
    });
    return out;
}

std::optional<double> CentredGrid::ofPart(const std::array<SampledBox, 2>& filtered, glm::ivec3 at,
                                          std::uint8_t number) const {
    double sum = 0, coverage = 0;
    for (std::size_t s = 0; s < 2; ++s)
        for (int n = 0; n < 8; ++n) {
            const glm::ivec3 side(n & 1, n >> 1 & 1, n >> 2);
            double weight = 0.5;
            glm::ivec3 texel;
            for (int axis = 0; axis < 3; ++axis) {
                const Tap& tap = between_[s][std::size_t(axis)][std::size_t(at[axis])];
                weight *= tap.weight[std::size_t(side[axis])];
                texel[axis] = tap.first + side[axis];
            }
            const std::size_t place = filtered[s].box.place(texel);
            if (weight == 0 || filtered[s].numberAt(place) != number) continue;
            sum += weight * double(filtered[s].values[place]);
            coverage += weight;
        }
    if (coverage < kPresentCoverage) return std::nullopt;
    return sum / coverage;
}

SampledBox CentredGrid::residual(const SampledBox& grid, const std::array<SampledBox, 2>& centred,
                                 const IndexBox& of) const {
    const std::array<SampledBox, 2> filtered = prefiltered(centred);
    SampledBox out = boxLike(of, grid);
    std::vector<double> sums(out.values.size());
    std::vector<std::uint8_t> met(grid.numbers.empty() ? 0 : sums.size());
    const auto width = std::size_t(of.size().x);
    for (std::size_t s = 0; s < 2; ++s) {
        std::size_t place = 0;
        const auto tap = [&](int axis, int i) -> const Tap& { return between_[s][std::size_t(axis)][std::size_t(i)]; };
        filterBox<2>(filtered[s], of, tap, [&](int, int, const double* own, const std::uint8_t* bits) {
            for (std::size_t x = 0; x < width; ++x) sums[place + x] += 0.5 * own[x];
            for (std::size_t x = 0; x < width && !met.empty(); ++x)
                met[place + x] |= bits != nullptr ? bits[x] : bitOf(filtered[s].number);
            place += width;
        });
    }
    if (met.empty() && grid.number == 0) return out;
    for (int z = of.begin.z; z < of.end.z; ++z)
        for (int y = of.begin.y; y < of.end.y; ++y) {
            const std::size_t from = grid.box.place({of.begin.x, y, z}), to = of.place({of.begin.x, y, z});
            for (std::size_t i = 0; i < width && met.empty(); ++i)
                out.values[to + i] = float(double(grid.values[from + i]) - sums[to + i]);
            for (std::size_t i = 0; i < width && !met.empty(); ++i) {
                std::optional<double> value = sums[to + i];
                const std::uint8_t number = out.numbers[to + i] = grid.numbers[from + i];
                if (number == 0) continue;
                if (met[to + i] != bitOf(number)) value = ofPart(filtered, {of.begin.x + int(i), y, z}, number);
                if (value) out.values[to + i] = float(double(grid.values[from + i]) - *value);
            }
        }
    return out;
}

SampledBox CentredGrid::corrected(int sublattice, const SampledBox& grid, const SampledBox& residual,
                                  const SampledBox& centred, const IndexBox& texels) const {
    SampledBox out = boxLike(texels, grid);
    if (out.numbers.empty() && out.number == 0) return out;
    const auto own = [&](int axis, int i) -> const Tap& { return tapOf(sublattice, axis, i); };
    CellRanges cells(grid, texels, own);
    const auto width = std::size_t(texels.size().x);
    const auto inRange = [&](glm::ivec3 at, std::size_t to, std::size_t from, double sum, bool whole) {
        const std::uint8_t number = centred.numberAt(from);
        if (!out.numbers.empty()) out.numbers[to] = number;
        if (number == 0) return;
        const std::array<const Tap*, 3> taps{&own(0, at.x), &own(1, at.y), &own(2, at.z)};
        if (!whole) sum = ownSum(residual, residual.values, taps, [](glm::ivec3, const auto&) { return 0.0; });
        const Range range = allowed(grid, taps, number);
        out.values[to] = float(std::clamp(double(centred.values[from]) + sum, range.lo, range.hi));
    };
    std::size_t place = 0;
    filterBox<kReach>(residual, texels, own, [&](int y, int z, const double* sums, const std::uint8_t* met) {
        const std::size_t from = centred.box.place({texels.begin.x, y, z}), to = std::exchange(place, place + width);
        const auto at = [&](std::size_t x) { return glm::ivec3(texels.begin.x + int(x), y, z); };
        if (met != nullptr) {
            for (std::size_t x = 0; x < width; ++x)
                inRange(at(x), to + x, from + x, sums[x], met[x] == bitOf(centred.numberAt(from + x)));
            return;
        }
        // Within the range of the corners of its cell, widened, a value lies within that of all that the kernel reads.
        cells.setRow(y, z);
        if (addWithin(&centred.values[from], sums, cells.lo.data(), cells.hi.data(), kCentredHeadroom, width,
                      &out.values[to]) == 0)
            return;
        for (std::size_t x = 0; x < width; ++x)
            if (!isWithin(double(centred.values[from + x]) + sums[x], cells.lo[x], cells.hi[x], kCentredHeadroom))
                inRange(at(x), to + x, from + x, sums[x], true);
    });
    return out;
}

std::array<SampledBox, 2> CentredGrid::make(SampledBox grid, const IndexBox& texels) const {
    clean(grid);
    std::array<SampledBox, 2> out;
    if (categorical_) {
        for (int s = 0; s < 2; ++s) out[std::size_t(s)] = labels(s, grid, texels);
        return out;
    }
    if (!level_.finest) {
        for (int s = 0; s < 2; ++s) out[std::size_t(s)] = resampled(s, grid, texels);
        return out;
    }
    const IndexBox read = near(texels), around = texelsAround(read);
    const IndexBox all{glm::min(around.begin, texels.begin), glm::max(around.end, texels.end)};
    std::array<SampledBox, 2> first;
    for (int s = 0; s < 2; ++s) first[std::size_t(s)] = resampled(s, grid, all);
    const SampledBox left = residual(grid, first, read);
    for (int s = 0; s < 2; ++s) out[std::size_t(s)] = corrected(s, grid, left, first[std::size_t(s)], texels);
    return out;
}

} // namespace tessera::volume
