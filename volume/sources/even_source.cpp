#include "volume/sources/even_source.h"

#include "volume/field/part_masks.h"
#include "volume/reconstruct/sample_grid.h"
#include "volume/resample/series.h"

#include <algorithm>
#include <utility>

namespace tessera::volume {

namespace {

/// A component at one time, as a field.
Field readFrame(const BrickSource& source, int channel, int time) {
    SampleGrid grid = readSamples(source, channel, time, 0);
    Field field = makeField(grid.lattice, ScalarType::F32);
    std::ranges::copy(grid.values, field.as<float>().begin());
    if (!grid.present.empty()) field.mask = std::make_shared<const Mask>(std::move(grid.present));
    const DatasetInfo& info = source.info();
    const Parameter& parameter = info.parameters[std::size_t(info.channel(channel).parameter)];
    return parameter.categorical ? converted(field, parameter.type) : field;
}

} // namespace

Dataset onEvenGrid(std::shared_ptr<const BrickSource> source, const EvenLimits& limits) {
    Dataset dataset;
    dataset.info = source->info();
    for (Parameter& parameter : dataset.info.parameters)
        if (!parameter.categorical) parameter.type = ScalarType::F32;
    dataset.read = [source = std::move(source)](int parameter, int component, int time) {
        return readFrame(*source, source->info().channelIndex(parameter, component), time);
    };
    return onEvenGrid(dataset, limits);
}

} // namespace tessera::volume
