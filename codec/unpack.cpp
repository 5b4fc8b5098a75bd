#include "codec/unpack.h"

#include "codec/brick_access.h"
#include "volume/parallel.h"
#include "volume/resample.h"

#include <cmath>

namespace tessera::codec {

namespace {

using volume::Field;
using volume::Lattice;
using volume::LatticeKind;
using volume::ScalarType;

int channelOf(const volume::DatasetInfo& info, int parameter, int component) {
    const auto channels = info.channels();
    for (std::size_t c = 0; c < channels.size(); ++c)
        if (channels[c].parameter == parameter && channels[c].component == component) return int(c);
    throw Error("no such component");
}

/// A level of one sublattice as a field on a CC lattice of its own: coarse samples of a BCC lattice lie where fine ones
/// of their sublattice lie, so the two sublattices of a level no longer form a BCC lattice.
Field levelField(const Archive& archive, int channel, int time, int level, int sublattice) {
    const volume::BrickGrid& grid = archive.grid();
    const bool bcc = grid.lattice.kind == LatticeKind::BCC;
    const int step = bcc ? 2 : 1, scale = 1 << level;
    const glm::ivec3 whole = grid.levelSamples(level);
    Lattice lattice;
    lattice.size = {whole.x, whole.y, (whole.z + step - 1 - sublattice) / step};
    lattice.spacing = grid.lattice.spacing * double(scale);
    lattice.origin = grid.lattice.fromCells(glm::dvec3(grid.levelPhase(level) + 0.5 * sublattice));
    Field field = volume::makeField(lattice, ScalarType::F32);
    volume::Mask mask(field.count(), 1);
    const auto values = field.as<float>();
    parallelFor(brickCount(grid), [&](std::size_t number) {
        const glm::ivec3 brick = brickIndex(grid, number);
        const volume::BrickSamples samples = archive.read({channel, time, level, brick});
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

/// The mean of two fields on one grid where both are present, else the one that is.
Field meanOf(const Field& a, const Field& b) {
    Field out = a;
    volume::Mask mask(a.count(), 1);
    const auto to = out.as<float>();
    const auto other = b.as<float>();
    for (std::size_t i = 0; i < to.size(); ++i) {
        if (a.present(i) && b.present(i))
            to[i] = 0.5f * to[i] + 0.5f * other[i];
        else if (b.present(i))
            to[i] = other[i];
        else
            mask[i] = a.present(i) ? 1 : 0;
    }
    out.mask = std::make_shared<const volume::Mask>(std::move(mask));
    return out;
}

} // namespace

volume::Dataset storedDataset(std::shared_ptr<const Archive> archive) {
    volume::Dataset dataset;
    dataset.info = archive->info();
    dataset.load = [archive](int parameter, int component, int time) {
        return readField(*archive, parameter, component, time);
    };
    return dataset;
}

volume::Dataset gridDataset(std::shared_ptr<const Archive> archive, int level) {
    const volume::BrickGrid& grid = archive->grid();
    if (level < 0 || level >= grid.levels)
        throw Error("there is no level " + std::to_string(level) + "; the coarsest is " +
                        std::to_string(grid.levels - 1),
                    archive->path());
    const bool bcc = grid.lattice.kind == LatticeKind::BCC;
    if (level == 0 && !bcc) return storedDataset(std::move(archive));

    Lattice target = archive->metadata().source;
    target.kind = LatticeKind::CC;
    target.size = levelSize(target.size, level);
    target.spacing *= double(1 << level);
    volume::Dataset dataset;
    dataset.info = archive->info();
    dataset.info.lattice = target;
    if (level > 0)
        for (volume::Parameter& parameter : dataset.info.parameters)
            if (!parameter.categorical) parameter.type = ScalarType::F32;
    dataset.load = [archive, target, level, bcc](int parameter, int component, int time) {
        const volume::DatasetInfo& info = archive->info();
        const bool categorical = info.parameters[std::size_t(parameter)].categorical;
        const auto filter = categorical ? volume::ResampleFilter::Nearest : volume::ResampleFilter::Cubic;
        if (level == 0) return volume::resample(readField(*archive, parameter, component, time), target, filter);
        const auto linear = categorical ? volume::ResampleFilter::Nearest : volume::ResampleFilter::Linear;
        const int channel = channelOf(info, parameter, component);
        Field coarse = volume::resample(levelField(*archive, channel, time, level, 0), target, linear);
        if (bcc && !categorical)
            coarse = meanOf(coarse, volume::resample(levelField(*archive, channel, time, level, 1), target, linear));
        if (!categorical) return coarse;
        Field labels = volume::makeField(target, info.parameters[std::size_t(parameter)].type);
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
