#include "codec/unpack/prediction.h"

#include "codec/unpack/stored_dataset.h"
#include "volume/field/part_masks.h"
#include "volume/resample/resample.h"
#include "volume/resample/series_dataset.h"

#include <map>
#include <utility>

namespace tessera::codec {

namespace {

using volume::Field;

/// One component of a parameter at a time index of the source, on the BCC lattice, with parts.
using BccFrames = std::function<Field(int parameter, int component, int time)>;

/// D4* frames, interpolated at the times of the source.
BccFrames betweenFrames(std::shared_ptr<const Archive> archive, volume::TimeFilter filter) {
    constexpr std::size_t kFrames =
        6; // frames in the cache; cubic: four of one parity, and two of the other for linear interpolation
    const auto series = std::make_shared<std::map<std::pair<int, int>, volume::Series>>();
    const volume::Dataset stored = volume::withParts(storedDataset(archive));
    for (int p = 0; p < int(stored.info.parameters.size()); ++p)
        for (int c = 0; c < stored.info.parameters[std::size_t(p)].components; ++c)
            (*series)[{p, c}] = volume::remembering(volume::d4SeriesOf(stored, p, c), kFrames);
    return [archive, series, filter](int parameter, int component, int time) {
        const Metadata& metadata = archive->metadata();
        const double frame = volume::frameAt(metadata.info.times, metadata.sourceTimes[std::size_t(time)]);
        return volume::atTime(series->at({parameter, component}), frame, filter);
    };
}

} // namespace

Prediction predictionOf(std::shared_ptr<const Archive> archive, volume::TimeFilter filter) {
    BccFrames frames;
    if (archive->metadata().alternating)
        frames = betweenFrames(archive, filter);
    else
        frames = [stored = volume::withParts(storedDataset(archive))](int parameter, int component, int time) {
            return stored.read(parameter, component, time);
        };
    return [archive, frames](int parameter, int component, int time, std::shared_ptr<const volume::Mask> own) {
        const volume::Parameter& about = archive->info().parameters[std::size_t(parameter)];
        const volume::Lattice& target = archive->metadata().source;
        const Field stored = frames(parameter, component, time);
        if (own) return volume::converted(volume::resampleOnto(stored, target, std::move(own)), about.type);
        const auto kernel = about.categorical ? volume::ResampleFilter::Nearest : volume::ResampleFilter::Cubic;
        return volume::converted(volume::withoutParts(volume::resample(stored, target, kernel)), about.type);
    };
}

} // namespace tessera::codec
