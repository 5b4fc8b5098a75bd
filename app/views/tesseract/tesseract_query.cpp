#include "app/views/tesseract/tesseract_query.h"

#include "volume/bricks/source_at_time.h"

namespace tessera::app {

std::shared_ptr<const volume::Samples4> AsyncSamples::get(ViewContext& context, const std::string& jobKey,
                                                          const TesseractQuery& query) {
    volume::SamplesQuery read = query.samples;
    if (query.time) read.times = {0}; // one, whichever
    const bool shown = last_ && last_->query.resembles(query);
    const Query::AnswerPointer found = query_.answer(
        context, context.source,
        {.key = jobKey,
         .title = "Samples of the tesseract",
         .quiet = true,
         .duringEdits = true,
         // Coarse steps only while there is no picture yet.
         .firstLevel = shown ? 0 : volume::coarseSteps(context.source->grid(), read),
         .nextLevel = [](int level) { return level - 1; }},
        query,
        [](const std::shared_ptr<const volume::BrickSource>& source, const TesseractQuery& asked, int level,
           const Progress& progress) {
            volume::SamplesQuery own = asked.samples;
            const volume::SourceAtTime at =
                asked.time ? volume::sourceAt(source, *asked.time) : volume::SourceAtTime{source, 0};
            if (asked.time) own.times = {at.time};
            return volume::gatherSamples(*at.source, own, level, progress);
        },
        [](const TesseractQuery& former, const TesseractQuery& now) { return former.resembles(now); });
    if (found && (found->level == 0 || !shown || last_->level > 0)) last_ = found;
    exact_ = found && found == last_ && last_->level == 0 && last_->query == query; // not one of former data
    if (!last_ || !last_->query.resembles(query)) return nullptr;
    return {last_, &last_->result};
}

} // namespace tessera::app
