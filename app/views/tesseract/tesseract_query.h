#pragma once

#include "app/queries/async_query.h"
#include "vis/shapes/cloud4.h"
#include "volume/analysis/samples4.h"
#include "volume/field/time_pair.h"

#include <memory>
#include <optional>
#include <string>

/// Samples for tesseract views, read in the background: a few of few times first, then more, at last as many as the
/// view may draw.
namespace tessera::app {

/// `time`: in place of the query's times, between stored ones.
struct TesseractQuery {
    volume::SamplesQuery samples;
    std::optional<volume::TimePair> time;
    bool operator==(const TesseractQuery&) const = default;
    /// Whether samples of one can be drawn for the other until its own are there.
    bool resembles(const TesseractQuery& other) const {
        return samples.channels == other.samples.channels && time.has_value() == other.time.has_value();
    }
};

class AsyncSamples {
public:
    using Query = AsyncQuery<TesseractQuery, volume::Samples4>;
    /// The best samples so far for a query, or of a former one that it resembles, of former data too, while nothing is
    /// here; null at first. Sets context.answers.awaiting while better ones are on their way; headless, reads to the
    /// end.
    std::shared_ptr<const volume::Samples4> get(ViewContext& context, const std::string& jobKey,
                                                const TesseractQuery& query);
    /// Whether the samples that get() returned last are those that the query asked for; else better ones are to come,
    /// unless reading failed.
    bool exact() const { return exact_; }
    /// Why the last query failed (damaged data), "" if it did not.
    std::string failure() const { return query_.failure(); }

private:
    Query query_{{.answers = 1}};
    Query::AnswerPointer last_;
    bool exact_ = false;
};

} // namespace tessera::app
