#pragma once

#include "app/views/transfer/transfer_pages.h"

/// The rows of controls above the transfer function view: what is edited, its colours, its range, by which page.
namespace tessera::app {

/// The name of the function that is edited: that of a layer or face alone, or the channel's.
std::string functionName(Session& session, const TransferView& view, const std::string& channel);

/// The pages that begin with something found in the data when they are chosen.
struct FindingPages {
    RegionPage& regions;
    BoundaryPage& boundaries;
};

/// `channel`: whose function is shown; another is chosen into the view.
void drawTransferControls(ViewContext& context, TransferView& view, const FindingPages& pages,
                          const volume::DatasetInfo& info, std::string channel);

} // namespace tessera::app
