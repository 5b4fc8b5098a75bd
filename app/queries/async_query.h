#pragma once

#include "app/pane/view_context.h"
#include "volume/base/background.h"
#include "volume/base/error.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <list>
#include <map>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <utility>

namespace tessera::app {

/// What `make` returns, or a default value where it fails: then `failure` says why. Throws Cancelled.
template <class Make> auto attempt(std::string& failure, Make&& make) -> decltype(make()) {
    try {
        return make();
    } catch (const Error& error) {
        failure = error.what();
    } catch (const std::bad_alloc&) {
        failure = "not enough memory";
    }
    return {};
}

/// How a query is answered in the background.
struct AsyncOptions {
    std::string key;          ///< of the job, and of the place that shows the answer
    std::string title;        ///< of the job
    bool quiet = false;       ///< the job is not listed to the user; the first of several levels never is
    bool lowPriority = false; ///< the job's thread yields to others
    bool duringEdits = false; ///< asked also while something is dragged and a previous answer can be shown
    int firstLevel = 0;       ///< of accuracy: 0 is exact, larger levels are coarser
    std::function<int(int)> nextLevel = {}; ///< the level computed after this one; null: 0
};

/// Questions about data that take longer than a frame: answers them in background jobs, first coarsely where a query
/// has several levels of accuracy, and keeps some answers. One per view, in its cache, or one for several places that
/// share answers. `Query` can be compared.
template <class Query, class Result> class AsyncQuery {
public:
    struct Answer {
        Query query;
        int level = 0;
        Result result;
    };
    using AnswerPointer = std::shared_ptr<const Answer>;

    /// Which answers are kept: the newest two, or as many as `answers` if fewer, and more while both limits hold.
    struct Keep {
        std::size_t answers = 4;
        std::size_t size = std::numeric_limits<std::size_t>::max(); ///< total of sizeOf()
        std::size_t (*sizeOf)(const Result&) = nullptr;
        bool coarse = false; ///< coarse answers are kept beside the exact one
    };

    AsyncQuery() = default;
    explicit AsyncQuery(const Keep& keep) : keep_(keep) {}

    /// The most exact answer to `query`; while there is none, the previous answer at this place if
    /// compatible(previousQuery, query), else null. Sets context.answers.awaiting while a better answer is on its way
    /// and context.answers.behind while there is none to this very query; headless, computes the exact answer at once.
    ///
    /// `make(data, query, level, progress)` returns the Result, on another thread. It may take `level` by reference and
    /// set it to the one it computed, and may throw Error, which is reported once. What failed or was cancelled is not
    /// tried again until the query changes. When `data` change, former answers are dropped.
    template <class Data, class Make, class Compatible>
    AnswerPointer answer(ViewContext& context, const std::shared_ptr<const Data>& data, const AsyncOptions& options,
                         const Query& query, Make make, Compatible compatible) {
        if (state_->data != data) {
            for (const auto& [key, place] : state_->places) context.jobs.cancel(key);
            state_ = std::make_shared<State>(); // a job of the former data finds its state gone
            state_->data = data;
        }
        lastKey_ = options.key;
        Place& place = state_->places[options.key];
        AnswerPointer current = state_->find(query, true);
        if (!current && place.shown && place.shown->query == query) current = place.shown; // kept no longer
        place.shown = current ? current : previous(place, options.key, query, compatible);
        const bool failed = place.hasFailed(query, context.jobs.running(options.key));
        if (failed || (current && current->level == 0)) return place.shown;
        if (context.headless) {
            try {
                int level = 0;
                Result result = make(data, query, level, Progress{});
                place.shown = state_->keep(options.key, {query, level, std::move(result)}, keep_);
            } catch (const Error& error) {
                place.fail(query, error.what());
            }
            return place.shown;
        }
        context.answers.awaiting = true;
        context.answers.behind = context.answers.behind || !current;
        if (mayStart(context, place, options, query, current != nullptr, compatible)) {
            const int next = current && options.nextLevel ? options.nextLevel(current->level) : 0;
            start(context.jobs, data, options, query, current ? next : options.firstLevel, make);
        }
        return place.shown;
    }

    /// The same without its query and level.
    template <class Data, class Make, class Compatible>
    std::shared_ptr<const Result> get(ViewContext& context, const std::shared_ptr<const Data>& data,
                                      const AsyncOptions& options, const Query& query, Make make,
                                      Compatible compatible) {
        const AnswerPointer found = answer(context, data, options, query, std::move(make), std::move(compatible));
        return found ? std::shared_ptr<const Result>(found, &found->result) : nullptr;
    }

    /// The coarsest answer to a query that is kept, null if there is none.
    AnswerPointer coarsest(const Query& query) const { return state_->find(query, false); }

    /// Why the query asked last could not be answered, "" if it can.
    std::string failure() const {
        const auto place = state_->places.find(lastKey_);
        return place == state_->places.end() ? std::string() : place->second.failure;
    }

private:
    struct Place {
        AnswerPointer shown;
        std::optional<Query> running, failed;
        int runningLevel = 0;
        std::string failure; ///< why `failed` has no answer

        void fail(const Query& query, const std::string& why) {
            failed = query; // may be `running`
            running.reset();
            failure = why;
        }
        /// Whether `query` has failed. A job that ended without a result was cancelled; a failure is forgotten at the
        /// next other query.
        bool hasFailed(const Query& query, bool jobRuns) {
            if (running && !jobRuns) fail(*running, "cancelled");
            if (failed && !(*failed == query)) {
                failed.reset();
                failure.clear();
            }
            return failed.has_value();
        }
    };
    struct Kept {
        std::string key; ///< of the place it was made for
        AnswerPointer answer;
    };
    struct State {
        std::shared_ptr<const void> data;
        std::map<std::string, Place> places;
        std::list<Kept> kept; ///< newest first

        AnswerPointer find(const Query& query, bool finest) const {
            AnswerPointer best;
            for (const auto& [key, answer] : kept)
                if (answer->query == query &&
                    (!best || (finest ? answer->level < best->level : answer->level > best->level)))
                    best = answer;
            return best;
        }
        AnswerPointer keep(const std::string& key, Answer made, const Keep& limits) {
            std::erase_if(kept, [&](const Kept& old) {
                return old.answer->query == made.query && (!limits.coarse || old.answer->level == made.level);
            });
            kept.push_front({key, std::make_shared<const Answer>(std::move(made))});
            std::size_t size = 0, count = 0;
            AnswerPointer newest = kept.front().answer;
            std::erase_if(kept, [&](const Kept& old) {
                if (limits.sizeOf) size += limits.sizeOf(old.answer->result);
                return count++ >= std::min<std::size_t>(2, limits.answers) &&
                       (count > limits.answers || size > limits.size);
            });
            return newest;
        }
    };

    template <class Compatible>
    AnswerPointer previous(const Place& place, const std::string& key, const Query& query, Compatible& compatible) {
        if (place.shown && compatible(place.shown->query, query)) return place.shown;
        for (const Kept& old : state_->kept)
            if (old.key == key && compatible(old.answer->query, query)) return old.answer;
        return nullptr;
    }

    /// Whether a job for `query` may start now, in place of a running one.
    template <class Compatible>
    static bool mayStart(const ViewContext& context, const Place& place, const AsyncOptions& options,
                         const Query& query, bool answered, Compatible& compatible) {
        if (place.running) {
            if (*place.running == query) return false;
            // A first answer that can be shown for this query is waited for: else a drag, which asks for another one
            // each frame, would show none.
            if (place.runningLevel == options.firstLevel && compatible(*place.running, query)) return false;
        }
        if (!context.interacting) return true;
        return !answered && (options.duringEdits || !place.shown);
    }

    template <class Data, class Make>
    void start(Jobs& jobs, const std::shared_ptr<const Data>& data, const AsyncOptions& options, const Query& query,
               int level, Make make) {
        Place& place = state_->places[options.key];
        place.running = query;
        place.runningLevel = level;
        jobs.start(
            options.key, options.title,
            [weak = std::weak_ptr(state_), data, options, keep = keep_, query, level,
             make = std::move(make)](const Progress& progress) mutable -> Jobs::Finish {
                if (options.lowPriority) workInBackground();
                std::string failure;
                auto made = attempt(failure, [&]() -> std::shared_ptr<Answer> {
                    Result result = make(data, query, level, progress);
                    return std::make_shared<Answer>(Answer{query, level, std::move(result)});
                });
                return [weak, made, failure, query, keep, key = options.key] {
                    const auto owner = weak.lock();
                    if (!owner) return;
                    Place& asked = owner->places[key];
                    if (!made) {
                        asked.fail(query, failure);
                        throw Error(failure);
                    }
                    asked.running.reset();
                    owner->keep(key, std::move(*made), keep);
                };
            },
            options.quiet || (level > 0 && level == options.firstLevel));
    }

    struct Keep keep_;
    std::string lastKey_;
    std::shared_ptr<State> state_ = std::make_shared<State>();
};

} // namespace tessera::app
