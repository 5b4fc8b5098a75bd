#pragma once

#include "app/views/view_context.h"
#include "volume/error.h"

#include <memory>
#include <optional>
#include <string>

namespace tessera::app {

/// An answer about the data that takes too long for a frame: keeps the last one and asks for a new one in the
/// background when the wish changes. One per view, in its cache. `Wish` can be compared.
template <class Wish, class Result> class LatestFeed {
public:
    using Pointer = std::shared_ptr<const Result>;

    /// The answer to `wish`, else the last one while that is `alike` (called with the wish it answers), else null. Sets
    /// context.busy while a better one is on its way; headless, computes to the end. `make(shared source, wish,
    /// progress)` gives the Result and may throw Error, which is reported once and not tried again until the wish
    /// changes.
    template <class Make, class Alike>
    Pointer get(ViewContext& context, const std::string& jobKey, const char* title, const Wish& wish, Make make,
                Alike alike, bool quiet = false) {
        if (state_->source != context.source.get()) {
            context.jobs.cancel(jobKey);
            state_ = std::make_shared<State>(); // a job of the old source finds its state gone
            state_->source = context.source.get();
        }
        State& state = *state_;
        const Pointer usable = state.last && alike(*state.answers) ? state.last : nullptr;
        if (state.last && *state.answers == wish) return state.last;
        if (state.failed && *state.failed == wish) return usable;
        if (context.headless) {
            try {
                state.last = std::make_shared<const Result>(make(context.source, wish, Progress{}));
                state.answers = wish;
                return state.last;
            } catch (const Error&) {
                state.failed = wish;
                return usable;
            }
        }
        context.busy = context.behind = true;
        // While something is dragged or played the running answer is waited for: cancelling it each frame would show
        // none.
        if (context.jobs.running(jobKey) && (usable || !state.last)) return usable;
        if (context.interacting && usable) return usable;
        context.jobs.start(
            jobKey, title,
            [weak = std::weak_ptr(state_), source = context.source, wish,
             make](const Progress& progress) -> Jobs::Finish {
                Pointer result;
                std::string failure;
                try {
                    result = std::make_shared<const Result>(make(source, wish, progress));
                } catch (const Error& error) {
                    failure = error.what();
                }
                return [weak, result, wish, failure] {
                    const auto owner = weak.lock();
                    if (!owner) return;
                    if (result) {
                        owner->last = result;
                        owner->answers = wish;
                        owner->failed.reset();
                    } else {
                        owner->failed = wish; // not tried again every frame
                        throw Error(failure);
                    }
                };
            },
            quiet);
        return usable;
    }

    /// Whether the last wish could not be answered; the log has the message.
    bool failed() const { return state_->failed.has_value(); }

private:
    struct State {
        const volume::BrickSource* source = nullptr;
        Pointer last;
        std::optional<Wish> answers, failed;
    };
    std::shared_ptr<State> state_ = std::make_shared<State>();
};

} // namespace tessera::app
