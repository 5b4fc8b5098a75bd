#include "volume/sources/labelled_source.h"

namespace tessera::volume {

namespace {

class LabelledSource final : public BrickSource {
public:
    LabelledSource(std::shared_ptr<const BrickSource> source, const std::vector<LabelRule>& rules)
        : source_(std::move(source)), info_(source_->info()) {
        applyLabels(info_, rules);
    }
    const DatasetInfo& info() const override { return info_; }
    const BrickGrid& grid() const override { return source_->grid(); }
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
};

} // namespace

std::shared_ptr<const BrickSource> withLabelNames(std::shared_ptr<const BrickSource> source,
                                                  const std::vector<std::string>& rules) {
    if (rules.empty()) return source;
    std::vector<LabelRule> parsed;
    for (const std::string& rule : rules) parsed.push_back(parseLabelRule(rule));
    return std::make_shared<LabelledSource>(std::move(source), parsed);
}

} // namespace tessera::volume
