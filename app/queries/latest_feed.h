#pragma once

#include "app/pane/view_context.h"
#include "app/queries/pending_wish.h"

#include <memory>
#include <optional>
#include <string>

namespace tessera::app {

/// An answer about the samples of context.numbers that takes too long for a frame: keeps the last one and asks for a
/// new one in the background when the wish changes. One per view, in its cache. `Wish` can be compared.
template <class Wish, class Result> class LatestFeed {
public:
    using Pointer = std::shared_ptr<const Result>;

    /// The answer to `wish`, else the last one while that is `alike` (called with the wish it answers), else null. Sets
    /// context.busy while a better one is on its way; headless, computes to the end. `make(context.numbers, wish,
    /// progress)` gives the Result and may throw Error, which is reported once. What failed or was cancelled is not
    /// tried again until the wish changes.
    template <class Make, class Alike>
    Pointer get(ViewContext& context, const std::string& jobKey, const char* title, const Wish& wish, Make make,
                Alike alike, bool quiet = false) {
        if (state_->source != context.numbers) {
            context.jobs.cancel(jobKey);
            state_ = std::make_shared<State>(); // a job of the old source finds its state gone
            state_->source = context.numbers;
        }
        State& state = *state_;
        const Pointer usable = state.last && alike(*state.answers) ? state.last : nullptr;
        if (state.last && *state.answers == wish) return state.last;
        if (state.pending.refused(context.jobs, jobKey, wish)) return usable;
        if (context.headless) {
            try {
                state.last = std::make_shared<const Result>(make(context.numbers, wish, Progress{}));
                state.answers = wish;
                return state.last;
            } catch (const Error& error) {
                state.pending.fail(wish, error.what());
                return usable;
            }
        }
        context.busy = context.behind = true;
        if (state.pending.running && *state.pending.running == wish) return usable; // on its way
        // While something is dragged or played the running answer is waited for: cancelling it each frame would show
        // none.
        if (state.pending.running && (usable || !state.last)) return usable;
        if (context.interacting && usable) return usable;
        state.pending.start(wish);
        context.jobs.start(
            jobKey, title,
            [weak = std::weak_ptr(state_), source = context.numbers, wish,
             make](const Progress& progress) -> Jobs::Finish {
                std::string failure;
                const Pointer result = attempt(
                    failure, [&]() -> Pointer { return std::make_shared<const Result>(make(source, wish, progress)); });
                return [weak, result, wish, failure] {
                    const auto owner = weak.lock();
                    if (!owner) return;
                    if (result) {
                        owner->last = result;
                        owner->answers = wish;
                        owner->pending.answered();
                    } else {
                        owner->pending.fail(wish, failure);
                        throw Error(failure);
                    }
                };
            },
            quiet);
        return usable;
    }

    /// Why the last wish could not be answered, "" if it can.
    std::string failure() const { return state_->pending.failure; }

private:
    struct State {
        std::shared_ptr<const volume::BrickSource> source;
        Pointer last;
        std::optional<Wish> answers;
        PendingWish<Wish> pending;
    };
    std::shared_ptr<State> state_ = std::make_shared<State>();
};

} // namespace tessera::app
