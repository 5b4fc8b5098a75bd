#include "volume/sources/axis_source.h"

#include "volume/field/quantities.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace tessera::volume {

namespace {

class OnAxis final : public BrickSource {
public:
    OnAxis(std::shared_ptr<const BrickSource> source, OtherAxis axis)
        : source_(std::move(source)), axis_(std::move(axis)), grid_(source_->grid()) {
        grid_.lattice = axis_.info.lattice;
    }

    const DatasetInfo& info() const override { return axis_.info; }
    const BrickGrid& grid() const override { return grid_; }
    BrickStats stats(const BrickKey& key) const override { return source_->stats(before(key)); }
    std::optional<BrickDistribution> distribution(const BrickKey& key) const override {
        return source_->distribution(before(key));
    }
    std::optional<BrickImportance> importance(const BrickKey& key) const override {
        return source_->importance(before(key));
    }
    std::optional<BrickChange> change(const BrickKey& key, int toTime) const override {
        return source_->change(before(key), axis_.order[std::size_t(toTime)]);
    }
    BrickSamples read(const BrickKey& key) const override { return source_->read(before(key)); }

private:
    BrickKey before(BrickKey key) const {
        key.time = axis_.order[std::size_t(key.time)];
        return key;
    }

    std::shared_ptr<const BrickSource> source_;
    OtherAxis axis_;
    BrickGrid grid_;
};

} // namespace

std::optional<OtherAxis> axisBy(const DatasetInfo& info, std::string_view quantity) {
    const auto found = findQuantity(info, quantity);
    if (!found) return std::nullopt;
    const Quantity& by = info.quantities[std::size_t(*found)];
    if (!std::ranges::all_of(by.values, [](double value) { return std::isfinite(value); })) return std::nullopt;
    const bool rises = std::ranges::adjacent_find(by.values, std::greater_equal<>()) == by.values.end();
    const bool falls = std::ranges::adjacent_find(by.values, std::less_equal<>()) == by.values.end();
    if (!rises && !falls) return std::nullopt;
    OtherAxis axis{info, {}};
    const int count = static_cast<int>(info.times.size());
    for (int k = 0; k < count; ++k) axis.order.push_back(rises ? k : count - 1 - k);
    axis.info.quantities[std::size_t(*found)] = {info.timeName, info.timeUnit, info.times};
    axis.info.times = by.values;
    axis.info.timeName = by.name;
    axis.info.timeUnit = by.unit;
    if (falls) {
        std::ranges::reverse(axis.info.times);
        for (Quantity& each : axis.info.quantities) std::ranges::reverse(each.values);
    }
    return axis;
}

Dataset onAxis(Dataset dataset, const OtherAxis& axis) {
    dataset.info = axis.info;
    dataset.read = [read = std::move(dataset.read), order = axis.order](int parameter, int component, int time) {
        return read(parameter, component, order[std::size_t(time)]);
    };
    return dataset;
}

std::shared_ptr<const BrickSource> onAxis(std::shared_ptr<const BrickSource> source, OtherAxis axis) {
    return std::make_shared<OnAxis>(std::move(source), std::move(axis));
}

} // namespace tessera::volume
