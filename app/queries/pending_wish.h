#pragma once

#include "app/ui/jobs.h"
#include "volume/base/error.h"

#include <new>
#include <optional>
#include <string>

namespace tessera::app {

/// What a feed has asked a job for, and what it does not ask for again: else every frame would start the same job that
/// failed or was cancelled. `Wish` can be compared.
template <class Wish> struct PendingWish {
    std::optional<Wish> running, failed;
    std::string failure; ///< why `failed` has no answer, "" if nothing failed

    void start(const Wish& wish) { running = wish; }
    void answered() { *this = {}; }
    void fail(const Wish& wish, const std::string& why) {
        failed = wish; // may be `running`
        running.reset();
        failure = why;
    }
    /// Whether `wish` has failed. Call once per frame: a job that ended without a word was cancelled; what failed is
    /// forgotten when the wish is another one.
    bool refused(const Jobs& jobs, const std::string& key, const Wish& wish) {
        if (running && !jobs.running(key)) fail(*running, "cancelled");
        if (failed && !(*failed == wish)) {
            failed.reset();
            failure.clear();
        }
        return failed.has_value();
    }
};

/// What `make` returns, or nothing where it fails: then `failure` says why. Throws Cancelled.
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

} // namespace tessera::app
