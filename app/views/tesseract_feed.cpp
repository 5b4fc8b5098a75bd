#include "app/views/tesseract_feed.h"

#include "volume/error.h"
#include "volume/source_at_time.h"

namespace tessera::app {

namespace {

struct Asked {
    volume::SamplesQuery query;
    std::optional<volume::TimePair> time;
    bool operator==(const Asked&) const = default;
};

} // namespace

struct TesseractFeed::State {
    std::shared_ptr<const volume::Samples4> samples;
    std::optional<Asked> of, failed; ///< what `samples` answers; what is not tried again every frame
    bool coarse = false;             ///< they are of the coarsest level only
    std::string failure;
};

TesseractFeed::TesseractFeed() : state_(std::make_shared<State>()) {}

std::string TesseractFeed::failure() const {
    return state_->failure;
}

std::shared_ptr<const volume::Samples4> TesseractFeed::get(ViewContext& context, const std::string& jobKey,
                                                           const volume::SamplesQuery& query,
                                                           const std::optional<volume::TimePair>& time) {
    State& state = *state_;
    const Asked asked{query, time};
    const bool answered = state.samples && state.of == asked;
    if ((answered && !state.coarse) || state.failed == asked) return state.samples;
    // Other values of the same samples come soon enough; nothing at all is worth a first picture.
    const bool coarse = !state.samples;
    const auto take = [asked](State& own, bool first, std::shared_ptr<const volume::Samples4> made,
                              const std::string& failure) {
        own.failure = failure;
        if (!made) {
            own.failed = asked;
            return;
        }
        own.samples = std::move(made);
        own.of = asked;
        own.coarse = first;
    };
    const auto gather = [source = context.source, asked](bool first, const Progress& progress) {
        volume::SamplesQuery own = asked.query;
        const volume::SourceAtTime shown =
            asked.time ? volume::sourceAt(source, *asked.time) : volume::SourceAtTime{source, 0};
        if (asked.time) own.times = {shown.time};
        return std::make_shared<const volume::Samples4>(volume::gatherSamples(*shown.source, own, first, progress));
    };
    if (context.headless) {
        try {
            take(state, false, gather(false, {}), {});
        } catch (const Error& error) {
            take(state, false, nullptr, error.what());
        }
        return state.samples;
    }
    context.busy = true;
    if (context.jobs.running(jobKey)) return state.samples; // the next one when this is here: a drag shows all the time
    context.jobs.start(
        jobKey, "Samples of the tesseract",
        [weak = std::weak_ptr<State>(state_), take, gather, coarse](const Progress& progress) -> Jobs::Finish {
            std::shared_ptr<const volume::Samples4> made;
            std::string failure;
            try {
                made = gather(coarse, progress);
            } catch (const Error& error) {
                failure = error.what();
            }
            return [weak, take, coarse, made, failure] {
                if (const auto own = weak.lock()) take(*own, coarse, made, failure);
                if (!failure.empty()) throw Error(failure);
            };
        },
        true);
    return state.samples;
}

} // namespace tessera::app
