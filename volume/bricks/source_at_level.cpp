#include "volume/bricks/source_at_level.h"

#include "volume/bricks/source_at_time.h"

#include <algorithm>
#include <utility>

namespace tessera::volume {

namespace {

BrickGrid gridAtLevel(const BrickGrid& fine, int level) {
    BrickGrid out;
    out.lattice.size = (fine.lattice.texels() + (1 << level) - 1) >> level;
    out.lattice.spacing = fine.lattice.spacing * double(1 << level);
    out.lattice.axes = fine.lattice.axes;
    out.lattice.origin = fine.lattice.sheetOfCells(glm::dvec3(fine.levelPhase(level)));
    out.brickSize = fine.brickSize >> level;
    out.levels = 1;
    return out;
}

class LevelSource final : public BrickSource, public ComputesBetweenTimes {
public:
    LevelSource(std::shared_ptr<const BrickSource> source, int level)
        : source_(std::move(source)), level_(level), grid_(gridAtLevel(source_->grid(), level)),
          info_(source_->info()) {
        info_.lattice = grid_.lattice;
    }

    const DatasetInfo& info() const override { return info_; }
    const BrickGrid& grid() const override { return grid_; }
    BrickStats stats(const BrickKey& key) const override { return source_->stats(key); }
    BrickSamples read(const BrickKey& key) const override {
        BrickKey coarse = key;
        coarse.level = level_;
        BrickSamples out = source_->read(coarse);
        if (source_->grid().lattice.kind == LatticeKind::BCC) keepEvenSlices(out);
        return out;
    }
    bool computes(int channel) const override {
        const auto* of = dynamic_cast<const ComputesBetweenTimes*>(source_.get());
        return of && of->computes(channel);
    }
    std::shared_ptr<const BrickSource> computedAt(const TimePair& time) const override {
        return sourceAtLevel(dynamic_cast<const ComputesBetweenTimes&>(*source_).computedAt(time), level_);
    }

private:
    static void keepEvenSlices(BrickSamples& samples) {
        const std::size_t slice = std::size_t(samples.size.x) * std::size_t(samples.size.y);
        samples.size.z = (samples.size.z + 1) / 2;
        const auto keep = [&](auto& values) {
            if (values.empty()) return;
            for (int z = 1; z < samples.size.z; ++z)
                std::copy_n(values.begin() + std::ptrdiff_t(2 * std::size_t(z) * slice), slice,
                            values.begin() + std::ptrdiff_t(std::size_t(z) * slice));
            values.resize(std::size_t(samples.size.z) * slice);
        };
        keep(samples.values);
        keep(samples.rest);
        keep(samples.present);
    }

    std::shared_ptr<const BrickSource> source_;
    int level_;
    BrickGrid grid_;
    DatasetInfo info_;
};

} // namespace

std::shared_ptr<const BrickSource> sourceAtLevel(std::shared_ptr<const BrickSource> source, int level) {
    return std::make_shared<LevelSource>(std::move(source), level);
}

} // namespace tessera::volume
