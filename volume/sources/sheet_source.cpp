#include "volume/sources/sheet_source.h"

namespace tessera::volume {

namespace {

class SheetSource final : public BrickSource {
public:
    explicit SheetSource(std::shared_ptr<const BrickSource> source)
        : source_(std::move(source)), info_(source_->info()), grid_(source_->grid()) {
        info_.lattice.axes = {};
        grid_.lattice.axes = {};
    }
    const DatasetInfo& info() const override { return info_; }
    const BrickGrid& grid() const override { return grid_; }
    BrickStats stats(const BrickKey& key) const override { return source_->stats(key); }
    std::optional<BrickDistribution> distribution(const BrickKey& key) const override {
        return source_->distribution(key);
    }
    std::optional<BrickImportance> importance(const BrickKey& key) const override { return source_->importance(key); }
    std::optional<BrickChange> change(const BrickKey& key, int toTime) const override {
        return source_->change(key, toTime);
    }
    BrickSamples read(const BrickKey& key) const override { return source_->read(key); }

private:
    std::shared_ptr<const BrickSource> source_;
    DatasetInfo info_;
    BrickGrid grid_;
};

} // namespace

std::shared_ptr<const BrickSource> sheetSource(std::shared_ptr<const BrickSource> source) {
    if (source->info().lattice.isEven()) return source;
    return std::make_shared<SheetSource>(std::move(source));
}

} // namespace tessera::volume
