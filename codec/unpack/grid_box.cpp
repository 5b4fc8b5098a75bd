#include "codec/unpack/grid_box.h"

#include "codec/unpack/unpack.h"
#include "volume/base/parallel.h"

#include <algorithm>
#include <cstring>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

namespace tessera::codec {

namespace {

using volume::Field;
using volume::Lattice;
using volume::ScalarType;

/// A box of a grid as a grid of its own.
Lattice boxOf(Lattice grid, glm::ivec3 begin, glm::ivec3 end) {
    grid.origin = grid.sheetPosition(begin);
    grid.size = end - begin;
    return grid;
}

/// Samples [begin, begin + box.size) of x and y; of z the field holds no more than the box.
Field cropped(const Field& field, const Lattice& box, glm::ivec3 begin) {
    if (field.lattice.size == box.size) return field;
    Field out = volume::makeField(box, field.type);
    out.offset = field.offset;
    out.scale = field.scale;
    volume::Mask mask(field.mask ? out.count() : 0);
    const std::size_t bytes = byteSize(field.type), row = std::size_t(box.size.x);
    for (int z = 0; z < box.size.z; ++z)
        for (int y = 0; y < box.size.y; ++y) {
            const std::size_t from = field.lattice.index({begin.x, begin.y + y, z}), to = box.index({0, y, z});
            std::memcpy(out.samples.data() + to * bytes, field.samples.data() + from * bytes, row * bytes);
            if (field.mask) std::copy_n(field.mask->data() + from, row, mask.data() + to);
        }
    if (field.mask) out.mask = std::make_shared<const volume::Mask>(std::move(mask));
    return out;
}

} // namespace

GridBoxes::GridBoxes(std::shared_ptr<const Archive> archive) : archive_(std::move(archive)) {
    for (int level = 0; level < archive_->grid().levels; ++level) levels_.push_back(gridDataset(archive_, level));
}

const volume::DatasetInfo& GridBoxes::info(int level) const {
    if (level < 0 || level >= int(levels_.size()))
        throw Error("there is no level " + std::to_string(level) + "; the coarsest is " +
                        std::to_string(levels_.size() - 1),
                    archive_->path());
    return levels_[std::size_t(level)].info;
}

/// Floats of a CC archive without labels lie in its bricks as they are shown.
bool GridBoxes::bricksSuffice(int parameter, int level) const {
    const volume::DatasetInfo& about = info(level);
    return archive_->grid().lattice.kind == volume::LatticeKind::CC && !archive_->metadata().alternating &&
           about.parameters[std::size_t(parameter)].type == ScalarType::F32 &&
           about.lattice.size == archive_->grid().levelSamples(level) && archive_->grid().levelPhase(level) == 0;
}

Field GridBoxes::readBricks(int parameter, int component, int time, int level, const Lattice& box,
                            glm::ivec3 begin) const {
    const volume::BrickGrid& grid = archive_->grid();
    const int channel = archive_->info().channelIndex(parameter, component);
    const glm::ivec3 end = begin + box.size;
    std::vector<glm::ivec3> touched;
    for (std::size_t number = 0; number < grid.brickCount(); ++number) {
        const glm::ivec3 index = grid.indexOf(number), lo = grid.levelBegin(index, level);
        const glm::ivec3 hi = lo + grid.brickSamples(index, level);
        if (glm::all(glm::lessThan(lo, end)) && glm::all(glm::lessThan(begin, hi))) touched.push_back(index);
    }
    Field out = volume::makeField(box, ScalarType::F32);
    volume::Mask mask(out.count(), 1);
    const auto values = out.as<float>();
    parallelFor(touched.size(), [&](std::size_t i) {
        const volume::BrickSamples brick = archive_->read({channel, time, level, touched[i]});
        const glm::ivec3 origin = grid.levelBegin(touched[i], level);
        const glm::ivec3 lo = glm::max(begin, origin), hi = glm::min(end, origin + brick.size);
        for (int z = lo.z; z < hi.z; ++z)
            for (int y = lo.y; y < hi.y; ++y) {
                const glm::ivec3 at = glm::ivec3(lo.x, y, z) - origin;
                const std::size_t from =
                    (std::size_t(at.z) * std::size_t(brick.size.y) + std::size_t(at.y)) * std::size_t(brick.size.x) +
                    std::size_t(at.x);
                const std::size_t to = box.index(glm::ivec3(lo.x, y, z) - begin), count = std::size_t(hi.x - lo.x);
                std::copy_n(brick.values.begin() + std::ptrdiff_t(from), count, values.begin() + std::ptrdiff_t(to));
                if (!brick.present.empty())
                    std::copy_n(brick.present.begin() + std::ptrdiff_t(from), count, mask.begin() + std::ptrdiff_t(to));
            }
    });
    if (std::ranges::count(mask, 0) > 0) out.mask = std::make_shared<const volume::Mask>(std::move(mask));
    return out;
}

Field GridBoxes::read(int parameter, int component, int time, int level, glm::ivec3 begin, glm::ivec3 end) const {
    const Lattice& grid = info(level).lattice;
    if (glm::any(glm::lessThan(begin, glm::ivec3(0))) || glm::any(glm::greaterThan(end, grid.size)) ||
        glm::any(glm::greaterThanEqual(begin, end)))
        throw Error("the box is not inside the grid", archive_->path());
    const Lattice box = boxOf(grid, begin, end);
    if (bricksSuffice(parameter, level)) return readBricks(parameter, component, time, level, box, begin);
    const std::scoped_lock alone(reading_);
    const volume::SliceRange slices{.first = begin.z, .count = end.z - begin.z};
    return cropped(levels_[std::size_t(level)].read(parameter, component, time, slices), box, begin);
}

} // namespace tessera::codec
