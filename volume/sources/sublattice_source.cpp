#include "volume/sources/sublattice_source.h"

#include "volume/base/error.h"

#include <algorithm>
#include <mutex>
#include <unordered_map>
#include <utility>

namespace tessera::volume {

namespace {

class SublatticeSource final : public BrickSource {
public:
    SublatticeSource(std::shared_ptr<const BrickSource> bcc, int sublattice)
        : bcc_(std::move(bcc)), sublattice_(sublattice), info_(bcc_->info()), grid_(bcc_->grid()) {
        const Lattice whole = info_.lattice;
        if (whole.kind != LatticeKind::BCC || whole.size.z <= sublattice)
            throw Error("one grid alone is shown of a body-centred lattice", info_.name);
        info_.lattice.kind = LatticeKind::CC;
        info_.lattice.size = whole.sublatticeSize(sublattice);
        info_.lattice.origin = whole.sheetPosition({0, 0, sublattice});
        grid_.lattice = info_.lattice;
    }

    const DatasetInfo& info() const override { return info_; }
    const BrickGrid& grid() const override { return grid_; }
    BrickStats stats(const BrickKey& key) const override {
        BrickKey fine = key;
        fine.level = 0;
        {
            const std::lock_guard lock(statsMutex_);
            if (const auto found = stats_.find(fine); found != stats_.end()) return found->second;
        }
        const BrickStats stats = statsOfSamples(read(fine)); // those stored are of both grids
        const std::lock_guard lock(statsMutex_);
        return stats_.try_emplace(fine, stats).first->second;
    }
    std::optional<BrickImportance> importance(const BrickKey& key) const override { return bcc_->importance(key); }
    std::optional<BrickChange> change(const BrickKey& key, int toTime) const override {
        return bcc_->change(key, toTime);
    }

    BrickSamples read(const BrickKey& key) const override {
        const BrickSamples both = bcc_->read(key);
        BrickSamples out;
        out.size = {both.size.x, both.size.y, (both.size.z + 1 - sublattice_) / 2};
        const std::size_t slice = std::size_t(out.size.x) * std::size_t(out.size.y);
        out.values.resize(slice * std::size_t(out.size.z));
        if (!both.present.empty()) out.present.resize(out.values.size());
        if (!both.rest.empty()) out.rest.resize(out.values.size());
        for (std::size_t k = 0; k < std::size_t(out.size.z); ++k) {
            const std::size_t from = (2 * k + std::size_t(sublattice_)) * slice, to = k * slice;
            std::copy_n(both.values.begin() + std::ptrdiff_t(from), slice, out.values.begin() + std::ptrdiff_t(to));
            if (!both.present.empty())
                std::copy_n(both.present.begin() + std::ptrdiff_t(from), slice,
                            out.present.begin() + std::ptrdiff_t(to));
            if (!both.rest.empty())
                std::copy_n(both.rest.begin() + std::ptrdiff_t(from), slice, out.rest.begin() + std::ptrdiff_t(to));
        }
        return out;
    }

private:
    std::shared_ptr<const BrickSource> bcc_;
    int sublattice_;
    DatasetInfo info_;
    BrickGrid grid_;
    mutable std::mutex statsMutex_;
    mutable std::unordered_map<BrickKey, BrickStats, BrickKeyHash> stats_;
};

} // namespace

std::shared_ptr<const BrickSource> makeSublatticeSource(std::shared_ptr<const BrickSource> bcc, int sublattice) {
    return std::make_shared<const SublatticeSource>(std::move(bcc), sublattice);
}

} // namespace tessera::volume
