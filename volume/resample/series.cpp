#include "volume/resample/series.h"

#include "volume/base/parallel.h"
#include "volume/reconstruct/reconstruct.h"
#include "volume/resample/blend_frames.h"
#include "volume/resample/resample_taps.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <span>

namespace tessera::volume {

namespace {

using FramePtr = std::shared_ptr<const Field>;

constexpr std::size_t kGrain = 1 << 14; // samples per task

/// Frames `from + step * i`, blended with these weights.
Field blended(const Series& series, const std::vector<FrameWeight>& weights, int from = 0, int step = 1) {
    std::vector<WeightedFrame> frames;
    for (const FrameWeight& weight : weights) frames.push_back({series.frame(from + step * weight.frame), weight});
    return blendFrames(frames);
}

/// The two grids of a BCC field, as they are stored: slices of `even` and `odd` in turn.
Field interleaved(const Field& even, const Field& odd, const Lattice& lattice) {
    const bool same = even.type == odd.type && even.offset == odd.offset && even.scale == odd.scale;
    Field out = makeField(lattice, same ? even.type : ScalarType::F32);
    if (same) {
        out.offset = even.offset;
        out.scale = even.scale;
    }
    const std::size_t slice = std::size_t(lattice.size.x) * std::size_t(lattice.size.y);
    std::shared_ptr<Mask> mask;
    if (even.mask || odd.mask) mask = std::make_shared<Mask>(out.count(), std::uint8_t(1));
    parallelFor(std::size_t(lattice.size.z), [&](std::size_t k) {
        const Field& from = k % 2 == 0 ? even : odd;
        const std::size_t first = k / 2 * slice;
        if (same) {
            const std::size_t bytes = byteSize(out.type);
            std::copy_n(&from.samples[first * bytes], slice * bytes, &out.samples[k * slice * bytes]);
        } else {
            for (std::size_t i = 0; i < slice; ++i) out.as<float>()[k * slice + i] = float(from.value(first + i));
        }
        if (from.mask) std::copy_n(&(*from.mask)[first], slice, &(*mask)[k * slice]);
    });
    out.mask = std::move(mask);
    return out;
}

void filterFrame(const Series& d4, int number, Field& out) {
    const int last = d4.lattice.size.w - 1;
    const FramePtr centre = d4.frame(number);
    const FramePtr sides[] = {d4.frame(number > 0 ? number - 1 : std::min(1, last)),
                              d4.frame(number < last ? number + 1 : std::max(last - 1, 0))};
    const Lattice& grid = out.lattice;
    const int lo = (number & 1) - 1; // an even frame's neighbours have indices -1 and 0, an odd one's 0 and 1
    const auto to = out.as<float>();
    parallelFor(std::size_t(grid.size.z), [&](std::size_t k) {
        std::size_t index = grid.index({0, 0, int(k)});
        for (int j = 0; j < grid.size.y; ++j)
            for (int i = 0; i < grid.size.x; ++i, ++index) {
                if (!centre->present(index)) continue;
                const double own = centre->value(index);
                const auto isOwn = [number = centre->mask ? (*centre->mask)[index] : std::uint8_t(1)](const Field& side,
                                                                                                      std::size_t at) {
                    return (side.mask ? (*side.mask)[at] : std::uint8_t(1)) == number;
                };
                double differences = 0;
                for (int corner = 0; corner < 8; ++corner) {
                    const glm::ivec3 at(i + lo + (corner & 1), j + lo + (corner >> 1 & 1), int(k) + lo + (corner >> 2));
                    const std::size_t neighbour = grid.index(clampToLattice(LatticeKind::CC, grid.size, at));
                    for (const FramePtr& side : sides)
                        if (isOwn(*side, neighbour)) differences += side->value(neighbour) - own;
                }
                to[index] = float(own - differences / 24);
            }
    });
}

} // namespace

Series remembering(Series series, std::size_t frames) {
    struct Kept {
        std::deque<std::pair<int, FramePtr>> frames; ///< the last used at the back
    };
    series.frame = [load = series.frame, frames, kept = std::make_shared<Kept>()](int number) {
        auto& known = kept->frames;
        const auto found = std::find_if(known.begin(), known.end(), [&](const auto& k) { return k.first == number; });
        std::pair<int, FramePtr> wanted{number, nullptr};
        if (found != known.end()) {
            wanted = *found;
            known.erase(found);
        } else {
            wanted.second = load(number);
        }
        known.push_back(wanted);
        if (known.size() > frames) known.pop_front();
        return wanted.second;
    };
    return series;
}

Field converted(const Field& field, ScalarType type) {
    if (field.type == type) return field;
    if (field.type != ScalarType::F32) throw Error("only a float field is rounded to another type");
    Field out = makeField(field.lattice, type);
    out.mask = field.mask;
    out.offset = field.offset;
    out.scale = field.scale;
    const auto from = field.as<float>();
    dispatch(type, [&]<class T>(T) {
        const auto to = out.as<T>();
        constexpr double lo = double(std::numeric_limits<T>::lowest()), hi = double(std::numeric_limits<T>::max());
        for (std::size_t i = 0; i < to.size(); ++i)
            if (out.present(i)) to[i] = T(std::clamp(std::nearbyint(double(from[i])), lo, hi));
    });
    return out;
}

int framesSpanned(const ResampleOptions& options) {
    return tapCount(optionsInTime(options), 1 << 20);
}

Field toD4Frame(const Series& cc, const Lattice4& d4, int frame, const ResampleOptions& options) {
    const double cells = (d4.time(frame) - cc.lattice.origin.w) / cc.lattice.spacing.w;
    const ResampleOptions labels{.filter = ResampleFilter::Nearest};
    const Field atOnce =
        blended(cc, weightsBeyond(cells, cc.lattice.size.w, optionsFor(cc.categorical, optionsInTime(options))));
    const ScalarType type =
        cc.categorical ? atOnce.type : cc.frame(std::clamp(int(cells), 0, cc.lattice.size.w - 1))->type;
    return converted(resample(atOnce, d4.grid(frame), cc.categorical ? labels : options), type);
}

Field atTime(const Series& series, double time, TimeFilter filter) {
    const Lattice4& lattice = series.lattice;
    const double cells = (time - lattice.origin.w) / lattice.spacing.w;
    const ResampleOptions options{.filter =
                                      filter == TimeFilter::Cubic ? ResampleFilter::Cubic : ResampleFilter::Linear};
    const auto at = [&](double cell, int from, int step, int count) {
        return blended(series, frameWeights(cell, count, optionsFor(series.categorical, options)), from, step);
    };
    if (lattice.kind == LatticeKind4::CC) return at(cells, 0, 1, lattice.size.w);
    if (lattice.size.w < 2) throw Error("a D4* lattice needs two times or more");
    const Field even = at(cells, 0, 2, lattice.framesOf(0)), odd = at(cells - 0.5, 1, 2, lattice.framesOf(1));
    return interleaved(even, odd, lattice.atOneTime());
}

Series prefiltered(const Series& d4) {
    if (d4.lattice.kind != LatticeKind4::D4) throw Error("only D4* has the sixteen neighbours of this filter");
    Series out{d4.lattice, d4.categorical, {}};
    out.frame = [source = remembering(d4, 3)](int number) {
        Field field = makeField(source.lattice.grid(number), ScalarType::F32);
        field.mask = source.frame(number)->mask;
        filterFrame(source, number, field);
        return std::make_shared<const Field>(std::move(field));
    };
    return out;
}

} // namespace tessera::volume
