#pragma once

#include "vis/packet/cast_job.h"
#include "vis/transfer/transfer_function.h"

#include <optional>
#include <vector>

/// Transfer functions as tables for packets of samples.
namespace tessera::vis::packet {

/// Entries of LayerView::table, and the factor of their opacities.
struct Table {
    std::vector<std::int32_t> entries;
    std::vector<float> opacity; ///< of each entry, in kQuantum
    float opacityScale = 1;
};
/// Its first and last entry are those of `domain`, by default of `range`. `byRegions`: see LayerView::regions.
Table makeTable(const TransferFunction& function, Range range, std::optional<Range> domain = {},
                bool byRegions = false);

/// LayerView::packed.
std::vector<std::uint32_t> packedTable(const TransferFunction& function, Range range);

/// An IntegralView. Half the difference of the sums before and behind a place is the density there, also at the ends.
struct SegmentSums {
    std::vector<std::int32_t> sums; ///< from those before the first place on
    float extinction = 0;
};
SegmentSums segmentSums(const TransferFunction& function, Range range);

/// Sets LayerView::shows.
void markShown(const Table& table, LayerView& layer);

} // namespace tessera::vis::packet
