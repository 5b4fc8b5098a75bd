#include "codec/unpack/unpack.h"

#include "codec/archive/brick_access.h"
#include "codec/container/exactness.h"
#include "codec/unpack/corrections.h"
#include "codec/unpack/prediction.h"
#include "codec/unpack/stored_dataset.h"
#include "volume/base/parallel.h"
#include "volume/field/own_axes.h"
#include "volume/field/part_masks.h"
#include "volume/resample/resample.h"
#include "volume/resample/series_dataset.h"
#include "volume/sources/alternating_source.h"

#include <cmath>
#include <optional>

namespace tessera::codec {

namespace {

using volume::Field;
using volume::Lattice;
using volume::LatticeKind;
using volume::ScalarType;

/// One level of one sublattice as a field on its own CC lattice: coarse samples of BCC coincide with fine ones of their
/// sublattice, so the two sublattices of a level do not form a BCC lattice.
Field levelField(const volume::BrickSource& source, int channel, int time, int level, int sublattice) {
    const volume::BrickGrid& grid = source.grid();
    const bool bcc = grid.lattice.kind == LatticeKind::BCC;
    const int step = bcc ? 2 : 1, scale = 1 << level;
    const glm::ivec3 whole = grid.levelSamples(level);
    Lattice lattice;
    lattice.size = {whole.x, whole.y, (whole.z + step - 1 - sublattice) / step};
    lattice.spacing = grid.lattice.spacing * double(scale);
    lattice.axes = grid.lattice.axes;
    lattice.origin = grid.lattice.sheetOfCells(glm::dvec3(grid.levelPhase(level) + 0.5 * sublattice));
    Field field = volume::makeField(lattice, ScalarType::F32);
    volume::Mask mask(field.count(), 1);
    const auto values = field.as<float>();
    parallelFor(grid.brickCount(), [&](std::size_t number) {
        const glm::ivec3 brick = grid.indexOf(number);
        const volume::BrickSamples samples = source.read({channel, time, level, brick});
        const glm::ivec3 begin = grid.levelBegin(brick, level);
        for (int z = sublattice; z < samples.size.z; z += step)
            for (int y = 0; y < samples.size.y; ++y)
                for (int x = 0; x < samples.size.x; ++x) {
                    const std::size_t from =
                        (std::size_t(z) * std::size_t(samples.size.y) + std::size_t(y)) * std::size_t(samples.size.x) +
                        std::size_t(x);
                    const std::size_t to = lattice.index({begin.x + x, begin.y + y, (begin.z + z) / step});
                    values[to] = samples.values[from];
                    if (!samples.present.empty()) mask[to] = samples.present[from];
                }
    });
    field.mask = std::make_shared<const volume::Mask>(std::move(mask));
    return field;
}

/// The mean of two fields on the same grid where both are present and in the same part, else the value of the first one
/// that is present.
Field meanOf(const Field& a, const Field& b) {
    Field out = a;
    volume::Mask mask(a.count(), 1);
    const auto to = out.as<float>();
    const auto other = b.as<float>();
    const auto numberAt = [](const Field& field, std::size_t i) {
        return field.mask ? (*field.mask)[i] : std::uint8_t(1);
    };
    for (std::size_t i = 0; i < to.size(); ++i) {
        if (a.present(i) && numberAt(a, i) == numberAt(b, i))
            to[i] = 0.5f * to[i] + 0.5f * other[i];
        else if (!a.present(i) && b.present(i))
            to[i] = other[i];
        else
            mask[i] = a.present(i) ? 1 : 0;
    }
    out.mask = std::make_shared<const volume::Mask>(std::move(mask));
    return out;
}

} // namespace

volume::Series storedSeries(std::shared_ptr<const Archive> archive, int parameter, int component) {
    if (archive->metadata().alternating)
        return volume::d4SeriesOf(volume::withParts(storedDataset(std::move(archive))), parameter, component);
    return volume::seriesOf(volume::withParts(gridDataset(std::move(archive), 0)), parameter, component);
}

namespace {

/// Sets the source times of D4* frames, and the quantities at these times.
void atSourceTimes(volume::DatasetInfo& info, const Archive& archive) {
    info.times = archive.metadata().sourceTimes;
    info.quantities = archive.metadata().sourceQuantities;
}

/// Level 0 of a BCC or D4* archive at the samples and times of its source.
volume::Dataset sourceDataset(std::shared_ptr<const Archive> archive, const Lattice& target,
                              volume::TimeFilter filter) {
    const bool corrected = !archive->metadata().corrections.empty();
    if (filter != volume::TimeFilter::Cubic && hasDifferences(*archive))
        throw Error("its corrections belong to the cubic filter between times", archive->path(), "--time-filter");
    volume::Dataset dataset;
    dataset.info = archive->info();
    dataset.info.lattice = target;
    if (archive->metadata().alternating) atSourceTimes(dataset.info, *archive);
    const Prediction predict = predictionOf(archive, filter);
    const CorrectedReader corrections = corrected ? correctedReader(archive, predict) : CorrectedReader();
    dataset.read = [predict, corrections](int parameter, int component, int time) {
        if (corrections)
            if (std::optional<Field> field = corrections(parameter, component, time)) return std::move(*field);
        return predict(parameter, component, time, nullptr);
    };
    return dataset;
}

} // namespace

volume::Dataset gridDataset(std::shared_ptr<const Archive> archive, int level, volume::TimeFilter filter) {
    const Metadata& metadata = archive->metadata();
    const volume::BrickGrid& grid = archive->grid();
    if (level < 0 || level >= grid.levels)
        throw Error("there is no level " + std::to_string(level) + "; the coarsest is " +
                        std::to_string(grid.levels - 1),
                    archive->path());
    const bool bcc = grid.lattice.kind == LatticeKind::BCC || metadata.alternating;
    if (level == 0 && !bcc) return storedDataset(std::move(archive));

    Lattice target = metadata.source;
    target.kind = LatticeKind::CC;
    target.size = levelSize(target.size, level);
    target.spacing *= double(1 << level);
    if (level == 0) return sourceDataset(std::move(archive), target, filter);
    std::shared_ptr<const volume::BrickSource> source = archive;
    if (metadata.alternating) source = volume::makeAlternatingSource(archive, filter);
    volume::Dataset dataset;
    dataset.info = archive->info();
    const Lattice own = volume::withOwnAxes(target); // of the samples that are left
    dataset.info.lattice = own;
    if (metadata.alternating) atSourceTimes(dataset.info, *archive);
    for (volume::Parameter& parameter : dataset.info.parameters)
        if (!parameter.categorical) parameter.type = ScalarType::F32;
    dataset.read = [archive, source, target, own, level, bcc](int parameter, int component, int wanted) {
        const volume::DatasetInfo& info = archive->info();
        // Coarse levels of D4* show the nearest frame.
        const int time = archive->metadata().alternating
                             ? info.nearestTime(archive->metadata().sourceTimes[std::size_t(wanted)])
                             : wanted;
        const bool categorical = info.parameters[std::size_t(parameter)].categorical;
        const auto linear = categorical ? volume::ResampleFilter::Nearest : volume::ResampleFilter::Linear;
        const int channel = info.channelIndex(parameter, component);
        const int label = volume::labelOf(info, info.parameters[std::size_t(parameter)]);
        const auto of = [&](int sublattice) {
            Field field = levelField(*source, channel, time, level, sublattice);
            if (label >= 0)
                field = volume::withParts(std::move(field),
                                          levelField(*source, info.channelIndex(label, 0), time, level, sublattice),
                                          info.parameters[std::size_t(parameter)].parts);
            return volume::resample(field, target, linear);
        };
        Field coarse = of(0);
        if (bcc && !categorical) coarse = meanOf(coarse, of(1));
        coarse.lattice = own;
        if (!categorical) return volume::withoutParts(std::move(coarse));
        Field labels = volume::makeField(own, info.parameters[std::size_t(parameter)].type);
        labels.mask = coarse.mask;
        volume::dispatch(labels.type, [&]<class T>(T) {
            const auto from = coarse.as<float>();
            const auto to = labels.as<T>();
            for (std::size_t i = 0; i < to.size(); ++i) to[i] = static_cast<T>(std::lrint(from[i]));
        });
        return labels;
    };
    return dataset;
}

} // namespace tessera::codec
