#pragma once

#include "app/session/session.h"

#include <string>
#include <vector>

/// The variants that a comparison offers, made from the session and its data.
namespace tessera::app {

/// One entry of the menu: the variants it adds.
struct CompareOffer {
    std::string title;
    std::vector<CompareVariant> variants;
    bool operator==(const CompareOffer&) const = default;
};

/// A submenu. Its first offer adds all that the others add one by one, where it has several.
struct CompareOffers {
    std::string title;
    std::vector<CompareOffer> offers;
    std::size_t first = 0;  ///< of the variants of the first offer: the one to show first
    bool technique = false; ///< of the renderer and the lattice: for those who compare techniques
};

/// What differs from what the session shows, the plainest first: the other file, other times, parameters of the first
/// layer, styles, looks and compressions; then techniques. Groups with nothing to offer are left out. `info`: of the
/// pictures; `numbers`: of the numbers, nothing where both are the same.
std::vector<CompareOffers> compareOffers(const Session& session, const volume::DatasetInfo& info,
                                         const volume::DatasetInfo* numbers = nullptr);

/// The variants of a view: its own, or where it has none the session as it is and the first other one that
/// compareOffers has, so that there is something to see.
std::vector<CompareVariant> shownVariants(const CompareView& view, const Session& session,
                                          const volume::DatasetInfo& info);

} // namespace tessera::app
