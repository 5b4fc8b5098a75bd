#include "volume/sources/layer_source.h"

#include "volume/base/load_once.h"
#include "volume/bricks/field_bricks.h"
#include "volume/bricks/magnitude.h"
#include "volume/field/part_masks.h"

#include <cassert>
#include <mutex>
#include <vector>

namespace tessera::volume {

namespace {

struct LayerKey {
    int parameter, component, time, layer;
    bool operator==(const LayerKey&) const = default;
};

struct LayerKeyHash {
    std::size_t operator()(const LayerKey& key) const {
        return BrickKeyHash{}({key.parameter, key.time, key.component, {0, 0, key.layer}});
    }
};

class LayerSource final : public BrickSource {
public:
    LayerSource(Dataset dataset, int brickSize, std::size_t budget)
        : dataset_(std::move(dataset)), channels_(dataset_.info.channels()),
          layers_(
              budget, [this](const LayerKey& key) { return load(key); },
              [](const Field& field) { return field.samples.size() + (field.mask ? field.mask->size() : 0); }) {
        assert(dataset_.info.lattice.kind == LatticeKind::CC);
        grid_.lattice = dataset_.info.lattice;
        grid_.brickSize = brickSize;
        grid_.levels = 1;
    }

    const DatasetInfo& info() const override { return dataset_.info; }
    const BrickGrid& grid() const override { return grid_; }
    BrickStats stats(const BrickKey& key) const override { return statsOfSamples(read(key)); }

    BrickSamples read(const BrickKey& key) const override {
        assert(key.level == 0);
        const Channel& channel = channels_.at(std::size_t(key.channel));
        const auto component = [&](int c) {
            const glm::ivec3 begin = grid_.begin(key.index), first(0, 0, begin.z);
            const auto layer = layers_.get({channel.parameter, c, key.time, key.index.z});
            return fineBrick(*layer, begin - first, grid_.end(key.index) - first);
        };
        if (!channel.magnitude) return component(channel.component);
        std::vector<BrickSamples> components;
        for (int c = 0; c < channel.component; ++c) components.push_back(component(c));
        return magnitude(components);
    }

private:
    std::shared_ptr<const Field> load(const LayerKey& key) const {
        const int begin = grid_.begin({0, 0, key.layer}).z, end = grid_.end({0, 0, key.layer}).z;
        const std::lock_guard lock(loading_);
        return std::make_shared<const Field>(
            withoutParts(dataset_.read(key.parameter, key.component, key.time, {begin, end - begin})));
    }

    Dataset dataset_;
    BrickGrid grid_;
    std::vector<Channel> channels_;
    mutable std::mutex loading_;
    mutable LoadOnce<LayerKey, Field, LayerKeyHash> layers_;
};

} // namespace

std::shared_ptr<const BrickSource> makeLayerSource(Dataset dataset, int brickSize, std::size_t budget) {
    return std::make_shared<const LayerSource>(std::move(dataset), brickSize, budget);
}

} // namespace tessera::volume
