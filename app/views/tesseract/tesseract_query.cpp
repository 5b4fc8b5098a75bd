#include "app/views/tesseract/tesseract_query.h"

#include "volume/bricks/source_at_time.h"

namespace tessera::app {

std::shared_ptr<const volume::Samples4> AsyncSamples::get(ViewContext& context, const std::string& jobKey,
                                                          const TesseractQuery& query) {
    const auto samples = query_.get(
        context, context.source,
        {.key = jobKey,
         .title = "Samples of the tesseract",
         .quiet = true,
         .duringEdits = true,
         // Show the coarsest level first only if there is no picture yet.
         .firstLevel = last_ ? 0 : 1},
        query,
        [](const std::shared_ptr<const volume::BrickSource>& source, const TesseractQuery& asked, int level,
           const Progress& progress) {
            volume::SamplesQuery own = asked.samples;
            const volume::SourceAtTime shown =
                asked.time ? volume::sourceAt(source, *asked.time) : volume::SourceAtTime{source, 0};
            if (asked.time) own.times = {shown.time};
            return volume::gatherSamples(*shown.source, own, level > 0, progress);
        },
        [](const TesseractQuery&, const TesseractQuery&) { return true; });
    if (samples) last_ = samples;
    return last_;
}

} // namespace tessera::app
