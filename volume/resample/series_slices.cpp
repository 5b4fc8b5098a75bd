#include "volume/resample/series_slices.h"

#include "volume/field/part_masks.h"
#include "volume/resample/blend_frames.h"
#include "volume/resample/series.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

namespace tessera::volume {

namespace {

/// A data set being resampled to D4*.
class SlicedD4 {
public:
    SlicedD4(const Dataset& series, const Lattice4& cc, const Lattice4& d4, const ResampleOptions& options,
             SliceMemory memory)
        : series_(withParts(series)), cc_(cc), d4_(d4), options_(options), memory_(std::move(memory)) {}

    Field read(int parameter, int component, int time, SliceRange slices) {
        std::erase_if(frames_,
                      [&](const auto& kept) { return kept.first.first != parameter || kept.second.time != time; });
        const auto [found, isNew] = frames_.try_emplace({parameter, component});
        if (isNew) found->second = {time, frame(parameter, component, time)};
        const SliceRange taken = slices.of(d4_.grid(0));
        return converted(withoutParts(found->second.frame.read(taken.first, taken.count)), about(parameter).type);
    }

private:
    struct Kept {
        int time = -1;
        SlicedFrame frame;
    };

    const Parameter& about(int parameter) const { return series_.info.parameters[std::size_t(parameter)]; }

    /// Of a whole frame of the series.
    StoredExtent extent(int parameter, int component, int time) {
        const auto [found, isNew] = extents_.try_emplace({parameter, component, time});
        if (isNew)
            found->second = extentOf(
                cc_.grid(time),
                [&](int first, int count) {
                    return series_.read(parameter, component, time, {first, count});
                },
                memory_.step);
        return found->second;
    }

    /// A frame of the lattice: the series blended at its time, then resampled.
    SlicedFrame frame(int parameter, int component, int number) {
        const bool label = about(parameter).categorical;
        const double cells = (d4_.time(number) - cc_.origin.w) / cc_.spacing.w;
        const std::vector<FrameWeight> weights =
            weightsBeyond(cells, cc_.size.w, optionsFor(label, optionsInTime(options_)));
        std::vector<StoredExtent> extents;
        for (const FrameWeight& weight : weights)
            if (overshoots(weights)) extents.push_back(extent(parameter, component, weight.frame));
        SlicedFrame blended{cc_.grid(0),
                            [this, parameter, component, weights, extents](int first, int count) {
                                std::vector<WeightedFrame> frames;
                                for (const FrameWeight& weight : weights)
                                    frames.push_back({std::make_shared<const Field>(series_.read(
                                                          parameter, component, weight.frame, {first, count})),
                                                      weight});
                                return blendFrames(frames, extents);
                            },
                            {}};
        blended.extent = extentOf(blended.lattice, blended.read, memory_.step);
        return resampled(blended, d4_.grid(number), optionsFor(label, options_), memory_);
    }

    Dataset series_;
    Lattice4 cc_, d4_;
    ResampleOptions options_;
    SliceMemory memory_;
    std::map<std::tuple<int, int, int>, StoredExtent> extents_;
    std::map<std::pair<int, int>, Kept> frames_; ///< by parameter and component
};

} // namespace

FrameReader d4Slices(const Dataset& series, const Lattice4& cc, const Lattice4& d4, const ResampleOptions& options,
                     const SliceMemory& memory) {
    const auto made = std::make_shared<SlicedD4>(series, cc, d4, options, memory);
    return [made](int parameter, int component, int time, SliceRange slices) {
        return made->read(parameter, component, time, slices);
    };
}

} // namespace tessera::volume
