#pragma once

#include "app/queries/async_query.h"
#include "vis/shapes/cloud4.h"
#include "volume/analysis/samples4.h"
#include "volume/field/time_pair.h"

#include <memory>
#include <optional>
#include <string>

/// Samples for tesseract views, read in the background: the coarsest level first, then as many as the view may draw.
namespace tessera::app {

/// `time`: in place of the query's times, between stored ones.
struct TesseractQuery {
    volume::SamplesQuery samples;
    std::optional<volume::TimePair> time;
    bool operator==(const TesseractQuery&) const = default;
};

class AsyncSamples {
public:
    /// The best samples so far for a query, or of the former one, of former data too, while nothing is here; null at
    /// first. Sets context.answers.awaiting while better ones are on their way; headless, reads to the end.
    std::shared_ptr<const volume::Samples4> get(ViewContext& context, const std::string& jobKey,
                                                const TesseractQuery& query);
    /// Why the last query failed (damaged data), "" if it did not.
    std::string failure() const { return query_.failure(); }

private:
    AsyncQuery<TesseractQuery, volume::Samples4> query_{{.answers = 1}};
    std::shared_ptr<const volume::Samples4> last_;
};

} // namespace tessera::app
