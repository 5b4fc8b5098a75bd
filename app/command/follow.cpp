#include "app/command/follow.h"

#include "app/data/format.h"
#include "app/user_files/import_memory.h"
#include "codec/archive/archive.h"
#include "codec/pack/pack.h"
#include "volume/base/error.h"
#include "volume/import/growing_series.h"
#include "volume/import/parts_rules.h"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <nlohmann/json.hpp>

namespace tessera::app {

namespace {

/// Holds SIGINT and SIGTERM back, from tessera-import too, which a terminal would interrupt together with this program.
class HeldSignals {
public:
    HeldSignals() {
        sigemptyset(&signals_);
        sigaddset(&signals_, SIGINT);
        sigaddset(&signals_, SIGTERM);
        pthread_sigmask(SIG_BLOCK, &signals_, &before_);
    }
    ~HeldSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
    HeldSignals(const HeldSignals&) = delete;
    HeldSignals& operator=(const HeldSignals&) = delete;

    /// Waits for one of them, at most so long.
    bool arriveWithin(double seconds) const {
        timespec limit{};
        limit.tv_sec = static_cast<std::time_t>(seconds);
        limit.tv_nsec = static_cast<long>((seconds - double(limit.tv_sec)) * 1e9);
        return sigtimedwait(&signals_, nullptr, &limit) > 0;
    }

private:
    sigset_t signals_{}, before_{};
};

std::string nameOf(const std::string& path) {
    return std::filesystem::path(path).filename().string();
}

std::string timesText(std::size_t times) {
    return std::to_string(times) + (times == 1 ? " time" : " times");
}

void checkFollowed(const FollowRequest& request) {
    const codec::PackOptions& options = request.options;
    if (request.pattern.find_first_of("*?[") == std::string::npos)
        throw Error("--follow needs one pattern in quotes, such as 'run_*.vti'", request.pattern);
    if (options.lattice == codec::StoredLattice::D4)
        throw Error("each time of D4* is computed from several of the series: --follow stores cc or bcc", {},
                    "--lattice d4");
    if (options.sizeMb > 0) throw Error("the size of a series that grows is not known", {}, "--target-size");
    if (options.discard > 0) throw Error("the importance at later times is not known", {}, "--discard");
}

/// Says what the first file of a series decides for all others.
void sayDecided(const volume::GrowingSeries& series, const volume::ImportOptions& stated) {
    const auto say = [&](const std::string& text) {
        std::fprintf(stderr, "tessera: %s: %s (taken for all later files)\n", series.first.c_str(), text.c_str());
    };
    for (const std::string& rule : series.options.absent)
        if (std::ranges::find(stated.absent, rule) == stated.absent.end()) say("absent: " + rule);
    for (const volume::Parameter& parameter : series.info.parameters)
        if (parameter.parts.count() > 1) say(parameter.name + ": " + volume::partsText(parameter));
}

/// One run of `tessera pack --follow`.
class Following {
public:
    explicit Following(const FollowRequest& request) : request_(request), files_(request.pattern, request.arrival) {}
    void run();

private:
    void continueArchive();
    volume::GrowingSeries openFirst(const std::string& path) const;
    void requireSameSeries(const codec::Archive& archive, const volume::GrowingSeries& series) const;
    void append(const std::string& path);
    void tryAppend(const std::string& path);
    void tellNotes();

    const FollowRequest& request_;
    ArrivingFiles files_;
    std::optional<volume::GrowingSeries> series_; ///< once a file of it is in the archive
};

volume::GrowingSeries Following::openFirst(const std::string& path) const {
    volume::GrowingSeries series = volume::growingSeries(path, request_.import);
    const volume::ImportOptions recalled = withMemory(request_.import, loadImportMemory(), series.info);
    sayRemembered(request_.import, recalled);
    if (recalled != request_.import) series = volume::growingSeries(path, recalled);
    rememberStated(request_.import, series.info.name);
    return series;
}

void Following::requireSameSeries(const codec::Archive& archive, const volume::GrowingSeries& series) const {
    const volume::DatasetInfo& info = archive.info();
    if (info.name != series.info.name)
        throw Error("holds the series " + info.name + ", the files are of " + series.info.name, request_.output);
    const bool labels = std::ranges::any_of(info.parameters, &volume::Parameter::categorical);
    const bool stated = !request_.import.autoAbsent && !request_.import.parts.empty();
    if (labels && !stated && info.times.front() != series.info.times.front())
        throw Error("the file of its first time is gone, where absent samples and parts were found: state them by "
                    "--no-auto-absent, --absent and --parts",
                    request_.output);
}

/// Finds out which of the files are in the archive already: from the newest one on, since few are not.
void Following::continueArchive() {
    const codec::Archive archive(request_.output);
    codec::PackOptions given = request_.options;
    given.memoryMb = 0;
    if (archive.metadata().options != given)
        throw Error("was packed with other options than those given", request_.output);
    const std::vector<std::string> paths = files_.waiting();
    for (const std::string& path : paths) {
        try {
            series_ = openFirst(path);
            break;
        } catch (const Error&) { // left out at the time, or still being written
        }
    }
    if (!series_) return;
    requireSameSeries(archive, *series_);
    const double last = archive.info().times.back();
    std::size_t known = paths.size();
    for (; known > 0; --known) {
        try {
            if (volume::openOfSeries(*series_, paths[known - 1]).info.times.back() <= last) break;
        } catch (const Error&) { // it is new, and will be tried again
        }
    }
    if (known > 0) files_.done(paths[known - 1], ArrivingFiles::Clock::now());
    if (request_.json) return;
    std::printf("%s: continues after time %.10g, with %s in it\n", request_.output.c_str(), last,
                timesText(archive.info().times.size()).c_str());
    std::fflush(stdout);
}

void Following::append(const std::string& path) {
    const ArrivingFiles::Clock::time_point begun = ArrivingFiles::Clock::now();
    volume::GrowingSeries series = series_ ? *series_ : openFirst(path);
    volume::Dataset data = volume::openOfSeries(series, path);
    std::error_code ignored;
    std::size_t before = 0;
    if (std::filesystem::exists(request_.output, ignored)) {
        const codec::Archive archive(request_.output);
        if (!series_) requireSameSeries(archive, series);
        before = archive.info().times.size();
        data = volume::timesAfter(std::move(data), archive.info().times.back(), path);
    } else if (series_) {
        throw MachineError("was removed while it grew", request_.output);
    }
    const std::vector<double> times = data.info.times;
    const codec::PackSummary summary = before > 0 ? codec::append(data, request_.output, request_.options.memoryMb)
                                                  : codec::pack(data, request_.options, request_.output);
    if (before == 0) sayDecided(series, request_.import);
    if (!series_)
        for (const std::string& note : summary.notes) std::fprintf(stderr, "tessera: %s\n", note.c_str());
    series_ = std::move(series);
    const double seconds = ArrivalTimes::Duration(ArrivingFiles::Clock::now() - begun).count();
    for (std::size_t t = 0; t < times.size(); ++t) {
        const std::size_t count = before + t + 1;
        if (request_.json) {
            const nlohmann::json line{{"file", path},
                                      {"time", times[t]},
                                      {"times", count},
                                      {"archiveBytes", summary.archiveBytes},
                                      {"addedBytes", summary.addedBytes},
                                      {"seconds", seconds}};
            std::printf("%s\n", line.dump().c_str());
        } else {
            std::printf("%s: time %.10g of %s appended (%s, %s, %.2f s)\n", request_.output.c_str(), times[t],
                        nameOf(path).c_str(), timesText(count).c_str(), bytesText(double(summary.archiveBytes)).c_str(),
                        seconds);
        }
    }
    std::fflush(stdout);
}

void Following::tryAppend(const std::string& path) {
    try {
        append(path);
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
        std::fprintf(stderr, "tessera: %s: %s\n", note.path.c_str(), note.text.c_str());
}

void Following::run() {
    const HeldSignals signals;
    files_.look(ArrivingFiles::Clock::now());
    std::error_code ignored;
    if (std::filesystem::exists(request_.output, ignored)) continueArchive();
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
    if (!series_ && !stopped) throw Error("no file fits this pattern", request_.pattern);
}

} // namespace

void sayRemembered(const volume::ImportOptions& stated, const volume::ImportOptions& used) {
    for (const std::string& rule : used.absent)
        if (std::ranges::find(stated.absent, rule) == stated.absent.end())
            std::fprintf(stderr, "tessera: remembered: --absent %s\n", rule.c_str());
    for (const auto& [from, to] : used.rename)
        if (!stated.rename.contains(from))
            std::fprintf(stderr, "tessera: remembered: --rename %s=%s\n", from.c_str(), to.c_str());
}

void follow(const FollowRequest& request) {
    checkFollowed(request);
    Following(request).run();
}

} // namespace tessera::app
