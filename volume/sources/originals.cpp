#include "volume/sources/originals.h"

#include "volume/base/error.h"

namespace tessera::volume {

namespace {

/// A level by subsampling: every 2^level-th sample of each sublattice of a brick at full resolution.
BrickSamples thinned(const BrickSamples& fine, glm::ivec3 size, int level, LatticeKind kind) {
    BrickSamples out{.size = size, .values = {}, .present = {}};
    const auto count = std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z);
    out.values.reserve(count);
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const int slice = kind == LatticeKind::BCC ? (z / 2 << level) * 2 + z % 2 : z << level;
                const std::size_t i = (std::size_t(slice) * std::size_t(fine.size.y) + std::size_t(y << level)) *
                                          std::size_t(fine.size.x) +
                                      std::size_t(x << level);
                out.values.push_back(fine.values[i]);
                if (!fine.present.empty()) out.present.push_back(fine.present[i]);
            }
    return out;
}

class WithOriginals final : public BrickSource {
public:
    WithOriginals(std::shared_ptr<const BrickSource> source, std::shared_ptr<const BrickSource> original)
        : source_(std::move(source)), original_(std::move(original)), info_(source_->info()),
          own_(int(info_.channels().size())) {
        for (Parameter parameter : original_->info().parameters) {
            parameter.name += " as computed";
            info_.parameters.push_back(std::move(parameter));
        }
    }

    const DatasetInfo& info() const override { return info_; }
    const BrickGrid& grid() const override { return source_->grid(); }
    BrickStats stats(const BrickKey& key) const override {
        return ofSource(key) ? source_->stats(key) : original_->stats(inOriginal(key));
    }
    std::optional<BrickDistribution> distribution(const BrickKey& key) const override {
        return ofSource(key) ? source_->distribution(key) : original_->distribution(inOriginal(key));
    }
    std::optional<BrickImportance> importance(const BrickKey& key) const override {
        return ofSource(key) ? source_->importance(key) : original_->importance(inOriginal(key));
    }
    std::optional<BrickChange> change(const BrickKey& key, int toTime) const override {
        return ofSource(key) ? source_->change(key, toTime) : original_->change(inOriginal(key), toTime);
    }
    BrickSamples read(const BrickKey& key) const override {
        if (ofSource(key)) return source_->read(key);
        BrickKey at = inOriginal(key);
        const bool means = grid().phase != 0 && key.level < original_->grid().levels;
        if (key.level == 0 || means) return original_->read(at);
        at.level = 0;
        return thinned(original_->read(at), grid().brickSamples(key.index, key.level), key.level, grid().lattice.kind);
    }

private:
    bool ofSource(const BrickKey& key) const { return key.channel < own_; }
    BrickKey inOriginal(BrickKey key) const {
        key.channel -= own_;
        return key;
    }

    std::shared_ptr<const BrickSource> source_, original_;
    DatasetInfo info_;
    int own_; ///< channels of the source
};

} // namespace

std::shared_ptr<const BrickSource> withOriginals(std::shared_ptr<const BrickSource> source,
                                                 std::shared_ptr<const BrickSource> original) {
    if (source->info().lattice != original->info().lattice || source->info().times != original->info().times ||
        source->grid().brickSize != original->grid().brickSize)
        throw Error(
            "data can be shown with their originals only on the same lattice, at the same times and with equal bricks");
    return std::make_shared<WithOriginals>(std::move(source), std::move(original));
}

} // namespace tessera::volume
