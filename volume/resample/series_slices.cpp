#include "volume/resample/series_slices.h"

#include "volume/field/part_masks.h"
#include "volume/resample/blend_frames.h"
#include "volume/resample/resample_slices.h"
#include "volume/resample/series.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

namespace tessera::volume {

namespace {

/// One data set on its way to D4*.
class SlicedD4 {
public:
    SlicedD4(const DatasetInfo& info, SliceLoad series, const Lattice4& cc, const Lattice4& d4, int first,
             const ResampleOptions& options, int step, std::string scratch)
        : info_(info), series_(withParts(info, std::move(series))), cc_(cc), d4_(d4), first_(first), options_(options),
          step_(step), scratch_(std::move(scratch)) {}

    Field read(int parameter, int component, int time, int first, int count) {
        std::erase_if(frames_,
                      [&](const auto& kept) { return kept.first.first != parameter || kept.second.time != time; });
        const auto [found, isNew] = frames_.try_emplace({parameter, component});
        if (isNew) found->second = {time, frame(parameter, component, first_ + time)};
        const ScalarType type = info_.parameters[std::size_t(parameter)].type;
        return converted(withoutParts(found->second.frame.read(first, count)), type);
    }

private:
    struct Kept {
        int time = -1;
        SlicedFrame frame;
    };

    /// Of a whole frame of the series.
    StoredExtent extent(int parameter, int component, int time) {
        const auto [found, isNew] = extents_.try_emplace({parameter, component, time});
        if (isNew)
            found->second = extentOf(
                cc_.grid(time), [&](int first, int count) { return series_(parameter, component, time, first, count); },
                step_);
        return found->second;
    }

    /// A frame of the lattice: the series blended at its time, then resampled.
    SlicedFrame frame(int parameter, int component, int number) {
        const bool label = info_.parameters[std::size_t(parameter)].categorical;
        const double cells = (d4_.time(number) - cc_.origin.w) / cc_.spacing.w;
        const std::vector<FrameWeight> weights =
            frameWeights(cells, cc_.size.w, optionsFor(label, optionsInTime(options_)));
        std::vector<StoredExtent> extents;
        for (const FrameWeight& weight : weights)
            if (overshoots(weights)) extents.push_back(extent(parameter, component, weight.frame));
        SlicedFrame blended{cc_.grid(0),
                            [this, parameter, component, weights, extents](int first, int count) {
                                std::vector<WeightedFrame> frames;
                                for (const FrameWeight& weight : weights)
                                    frames.push_back({std::make_shared<const Field>(
                                                          series_(parameter, component, weight.frame, first, count)),
                                                      weight});
                                return blendFrames(frames, extents);
                            },
                            {}};
        blended.extent = extentOf(blended.lattice, blended.read, step_);
        return resampled(blended, d4_.grid(number), optionsFor(label, options_), step_, scratch_);
    }

    DatasetInfo info_;
    SliceLoad series_;
    Lattice4 cc_, d4_;
    int first_;
    ResampleOptions options_;
    int step_;
    std::string scratch_;
    std::map<std::tuple<int, int, int>, StoredExtent> extents_;
    std::map<std::pair<int, int>, Kept> frames_; ///< by parameter and component
};

} // namespace

SliceLoad d4Slices(const DatasetInfo& info, SliceLoad series, const Lattice4& cc, const Lattice4& d4, int first,
                   const ResampleOptions& options, int step, const std::string& scratch) {
    const auto made = std::make_shared<SlicedD4>(info, std::move(series), cc, d4, first, options, step, scratch);
    return [made](int parameter, int component, int time, int from, int count) {
        return made->read(parameter, component, time, from, count);
    };
}

} // namespace tessera::volume
