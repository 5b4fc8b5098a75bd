#include "app/growing/follow.h"

#include "app/growing/held_signals.h"
#include "codec/archive/archive.h"
#include "volume/base/error.h"
#include "volume/base/terminal.h"
#include "volume/import/growing_series.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

namespace tessera::app {

namespace {

/// One run of `tessera pack --follow`.
class Following {
public:
    explicit Following(const FollowRequest& request)
        : request_(request), output_(request.archive), files_(request.pattern, request.arrival) {}
    void run();

private:
    void continueArchive();
    void tryAppend(const std::string& path);
    void tellNotes();

    const FollowRequest& request_;
    GrowingOutput output_;
    ArrivingFiles files_;
};

/// Finds out which of the files are in the archive already: from the newest one on, since few are not.
void Following::continueArchive() {
    const GrowingRequest& wanted = request_.archive;
    const codec::Archive archive(wanted.output);
    codec::PackOptions given = wanted.options;
    given.memoryMb = 0;
    if (archive.metadata().options != given)
        throw Error("was packed with other options than those given", wanted.output);
    const std::vector<std::string> paths = files_.waiting();
    // A file that does not open was left out at the time, or is still being written.
    if (std::ranges::none_of(paths, [&](const std::string& path) { return output_.begin(path); })) return;
    const double last = archive.info().times.back();
    std::size_t known = paths.size();
    for (; known > 0; --known) {
        try {
            if (volume::openOfSeries(*output_.series(), paths[known - 1]).info.times.back() <= last) break;
        } catch (const Error&) { // it is new, and will be tried again
        }
    }
    if (known > 0) files_.done(paths[known - 1], ArrivingFiles::Clock::now());
    if (wanted.json) return;
    say("%s: continues after time %.10g, with %s in it\n", wanted.output.c_str(), last,
        timesCounted(archive.info().times.size()).c_str());
    std::fflush(stdout);
}

void Following::tryAppend(const std::string& path) {
    try {
        output_.append(path);
        files_.done(path, ArrivingFiles::Clock::now());
    } catch (const MachineError&) {
        throw;
    } catch (const Error& error) {
        files_.failed(path, error.what(), ArrivingFiles::Clock::now());
    } catch (const Cancelled&) { // somebody interrupted tessera-import
        files_.failed(path, "the reader was interrupted", ArrivingFiles::Clock::now());
    }
}

void Following::tellNotes() {
    for (const ArrivingFiles::Note& note : files_.takeNotes(ArrivingFiles::Clock::now()))
        warn("tessera: %s: %s\n", note.path.c_str(), note.text.c_str());
}

void Following::run() {
    const HeldSignals signals;
    files_.look(ArrivingFiles::Clock::now());
    if (output_.continues()) continueArchive();
    const double pause = std::clamp(request_.arrival.settle.count() / 4, 0.02, 1.0);
    double wait = 0;
    bool stopped = false;
    while (!(stopped = signals.arriveWithin(wait))) {
        files_.look(ArrivingFiles::Clock::now());
        const std::optional<std::string> next = files_.ready(ArrivingFiles::Clock::now());
        if (next) tryAppend(*next);
        tellNotes();
        wait = next ? 0 : pause;
        const ArrivalTimes::Duration idle(request_.untilIdle.value_or(0));
        if (request_.untilIdle && files_.quietFor(idle, ArrivingFiles::Clock::now())) break;
    }
    const std::size_t missed = files_.missed() + (stopped ? 0 : files_.waiting().size());
    if (missed > 0) throw Error("files that are not in the archive: " + std::to_string(missed), request_.pattern);
    if (!output_.series() && !stopped) throw Error("no file fits this pattern", request_.pattern);
}

} // namespace

void follow(const FollowRequest& request) {
    if (request.pattern.find_first_of("*?[") == std::string::npos)
        throw Error("--follow needs one pattern in quotes, such as 'run_*.vti'", request.pattern);
    Following(request).run();
}

} // namespace tessera::app
