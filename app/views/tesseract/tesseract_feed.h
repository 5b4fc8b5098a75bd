#pragma once

#include "app/pane/view_context.h"
#include "vis/shapes/cloud4.h"
#include "volume/analysis/samples4.h"
#include "volume/field/time_pair.h"

#include <memory>
#include <optional>
#include <string>

/// Samples for tesseract views, read in the background: the coarsest level first, then as many as the view may draw.
namespace tessera::app {

class TesseractFeed {
public:
    TesseractFeed();
    /// The best samples so far for a query, or of the former one, of former data too, while nothing is here; null at
    /// first. Sets context.busy while better ones are on their way; headless, reads to the end. `time`: in place of the
    /// query's times, between stored ones.
    std::shared_ptr<const volume::Samples4> get(ViewContext& context, const std::string& jobKey,
                                                const volume::SamplesQuery& query,
                                                const std::optional<volume::TimePair>& time);
    /// Why the last query failed (damaged data), "" if it did not.
    std::string failure() const;

private:
    struct State;
    std::shared_ptr<State> state_;
};

} // namespace tessera::app
