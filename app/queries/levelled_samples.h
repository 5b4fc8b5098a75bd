#pragma once

#include "app/queries/async_query.h"
#include "volume/bricks/brick_cache.h"

#include <functional>
#include <memory>
#include <string>
#include <utility>

/// What the numbers of plots are counted from: coarsely at once, then more exactly.
namespace tessera::app {

/// The samples of a view. Coarse bricks are kept, so that few are decoded while a brush is dragged.
class LevelledSamples {
public:
    /// Follows the numbers of the view.
    const std::shared_ptr<const volume::BrickSource>& follow(const ViewContext& context) {
        constexpr std::size_t kCoarseBytes = std::size_t(64) << 20;
        if (source_ != context.numbers) {
            source_ = context.numbers;
            coarse_ = std::make_shared<volume::BrickCache>(source_, kCoarseBytes);
        }
        return source_;
    }
    const std::shared_ptr<const volume::BrickSource>& coarse() const { return coarse_; }

private:
    std::shared_ptr<const volume::BrickSource> source_, coarse_;
};

/// How plots are answered: at the level `first`, then at those that `next` says.
inline AsyncOptions plotOptions(std::string key, std::string title, int first, std::function<int(int)> next) {
    return {.key = std::move(key),
            .title = std::move(title),
            .quiet = first == 0,
            .lowPriority = true,
            .duringEdits = true,
            .firstLevel = first,
            .nextLevel = std::move(next)};
}

} // namespace tessera::app
