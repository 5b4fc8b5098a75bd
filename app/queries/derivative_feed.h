#pragma once

#include "app/queries/latest_feed.h"
#include "vis/gl/plot_texture.h"
#include "volume/analysis/boundary.h"
#include "volume/field/time_pair.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

/// Histograms of value and gradient for the transfer-function views, computed in the background.
namespace tessera::app {

/// What a channel's derivatives tell.
struct DerivativeResult {
    volume::DerivativeHistogram histogram;
    volume::BoundaryCurves curves;
};

/// The answers for one view, kept in its cache.
class DerivativeFeed {
public:
    /// The answer to this query at a time (in place of its own), else the last one of the same channel while it is
    /// being computed, else null; as LatestFeed::get.
    std::shared_ptr<const DerivativeResult> get(ViewContext& context, const std::string& jobKey,
                                                const volume::DerivativeQuery& query, const volume::TimePair& time);
    /// Why the last query could not be answered, "" if it can.
    std::string failure() const { return feed_.failure(); }

private:
    struct Wish {
        volume::DerivativeQuery query;
        volume::TimePair time;
        bool operator==(const Wish&) const = default;
    };
    LatestFeed<Wish, DerivativeResult> feed_;
};

/// The joint histogram as a picture, row 0 = the largest gradient: transparent where no sample is, else a grey whose
/// lightness (CIE L*) grows with the logarithm of the count, away from the theme's background.
std::vector<std::uint8_t> derivativeImage(const volume::DerivativeHistogram& histogram, bool dark);

} // namespace tessera::app
