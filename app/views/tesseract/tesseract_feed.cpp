#include "app/views/tesseract/tesseract_feed.h"

#include "app/queries/pending_wish.h"
#include "volume/base/error.h"
#include "volume/bricks/source_at_time.h"

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
    std::optional<Asked> of; ///< what `samples` answers
    bool coarse = false;     ///< they are of the coarsest level only
    PendingWish<Asked> pending;
    std::shared_ptr<const volume::BrickSource> source;
};

TesseractFeed::TesseractFeed() : state_(std::make_shared<State>()) {}

std::string TesseractFeed::failure() const {
    return state_->pending.failure;
}

std::shared_ptr<const volume::Samples4> TesseractFeed::get(ViewContext& context, const std::string& jobKey,
                                                           const volume::SamplesQuery& query,
                                                           const std::optional<volume::TimePair>& time) {
    if (state_->source != context.source) {
        context.jobs.cancel(jobKey);
        auto next = std::make_shared<State>(); // a job of the old source finds its state gone
        next->samples = state_->samples;
        next->source = context.source;
        state_ = std::move(next);
    }
    State& state = *state_;
    const Asked asked{query, time};
    const bool answered = state.samples && state.of == asked;
    if (state.pending.refused(context.jobs, jobKey, asked) || (answered && !state.coarse)) return state.samples;
    // Other values of the same samples come soon enough; nothing at all is worth a first picture.
    const bool coarse = !state.samples;
    const auto take = [asked](State& own, bool first, std::shared_ptr<const volume::Samples4> made,
                              const std::string& failure) {
        if (!made) return own.pending.fail(asked, failure);
        own.pending.answered();
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
    if (state.pending.running) return state.samples; // the next one when this is here: a drag shows all the time
    state.pending.start(asked);
    context.jobs.start(
        jobKey, "Samples of the tesseract",
        [weak = std::weak_ptr<State>(state_), take, gather, coarse](const Progress& progress) -> Jobs::Finish {
            std::string failure;
            const auto made = attempt(failure, [&] { return gather(coarse, progress); });
            return [weak, take, coarse, made, failure] {
                if (const auto own = weak.lock()) take(*own, coarse, made, failure);
                if (!failure.empty()) throw Error(failure);
            };
        },
        true);
    return state.samples;
}

} // namespace tessera::app
