#include "app/growing/arriving_files.h"

#include "volume/base/error.h"
#include "volume/import/files/named_files.h"
#include "volume/import/files/series.h"

#include <algorithm>
#include <sys/stat.h>
#include <utility>

namespace tessera::app {

ArrivingFiles::ArrivingFiles(std::string pattern, ArrivalTimes times)
    : pattern_(std::move(pattern)), times_(times), event_(Clock::now()) {}

std::vector<ArrivingFiles::FileOnDisk> ArrivingFiles::filesOf(const std::string& path) {
    std::vector<std::string> paths = volume::filesNamedBy(path);
    paths.push_back(path);
    std::vector<FileOnDisk> files;
    for (const std::string& each : paths) {
        struct stat about {};
        if (::stat(each.c_str(), &about) != 0) continue;
        constexpr std::int64_t kNano = 1'000'000'000;
        files.push_back({each, static_cast<std::uint64_t>(about.st_size),
                         std::int64_t(about.st_mtim.tv_sec) * kNano + std::int64_t(about.st_mtim.tv_nsec)});
    }
    return files;
}

void ArrivingFiles::leaveOut(const std::string& path, const std::string& why) {
    notes_.push_back({path, why + ": it is left out"});
    ++missed_;
}

void ArrivingFiles::add(const std::string& path, Clock::time_point now) {
    const volume::NumberedName name = volume::numberedName(path);
    if (name.number && series_.empty()) series_ = name.pattern;
    if (!name.number || name.pattern != series_) {
        if (name.number && !last_)
            throw Error("fits files of two series, " + series_ + " and " + name.pattern + ": follow each by itself",
                        pattern_);
        notes_.push_back({path, "is not of the series " + (series_.empty() ? "of numbered files" : series_)});
    } else if (last_ && *name.number <= *last_) {
        leaveOut(path, "came after a later time");
    } else if (waiting_.try_emplace(*name.number, Waiting{path, {}, now, {}, {}, {}, false}).second) {
        event_ = now;
    } else {
        leaveOut(path, "has the same number as " + waiting_.at(*name.number).path);
    }
}

void ArrivingFiles::look(Clock::time_point now) {
    const std::vector<std::string> paths = volume::filesOfPattern(pattern_);
    for (const std::string& path : paths)
        if (known_.insert(path).second) add(path, now);
    const std::set<std::string> present(paths.begin(), paths.end());
    std::erase_if(waiting_, [&](const auto& entry) {
        const bool gone = !present.contains(entry.second.path);
        if (gone) known_.erase(entry.second.path);
        return gone;
    });
    // The first ones suffice, and cost little where the file system is far away.
    constexpr int kMost = 64;
    int left = kMost;
    for (auto& [number, file] : waiting_) {
        if (left-- == 0) break;
        std::vector<FileOnDisk> files = filesOf(file.path);
        if (files == file.files) continue;
        file = {file.path, std::move(files), now, {}, {}, {}, false};
        event_ = now;
    }
}

bool ArrivingFiles::isGivenUp(const Waiting& file, Clock::time_point now) const {
    return file.failure && now - *file.failure >= times_.retry;
}

std::vector<std::string> ArrivingFiles::waiting() const {
    std::vector<std::string> paths;
    for (const auto& [number, file] : waiting_) paths.push_back(file.path);
    return paths;
}

std::optional<std::string> ArrivingFiles::ready(Clock::time_point now) const {
    for (const auto& [number, file] : waiting_) {
        if (!file.files.empty() && now - file.since >= times_.settle && now >= file.next) return file.path;
        if (!isGivenUp(file, now)) return std::nullopt; // later ones wait for it
    }
    return std::nullopt;
}

void ArrivingFiles::done(const std::string& path, Clock::time_point now) {
    const auto found = std::ranges::find_if(waiting_, [&](const auto& entry) { return entry.second.path == path; });
    if (found == waiting_.end()) return;
    last_ = found->first;
    event_ = now;
    for (auto at = waiting_.begin(); at != found; ++at)
        if (at->second.failure) leaveOut(at->second.path, "cannot be read (" + at->second.reason + ")");
    waiting_.erase(waiting_.begin(), std::next(found));
}

void ArrivingFiles::failed(const std::string& path, const std::string& reason, Clock::time_point now) {
    for (auto& [number, file] : waiting_) {
        if (file.path != path) continue;
        if (!file.failure) file.failure = now;
        file.reason = reason;
        // Often at first, since a writer may just have paused; then rarely.
        constexpr double kShare = 0.25;
        const auto tried = std::chrono::duration_cast<ArrivalTimes::Duration>(now - *file.failure);
        const ArrivalTimes::Duration pause = std::max(times_.settle, kShare * tried);
        file.next = now + std::chrono::duration_cast<Clock::duration>(pause);
    }
}

bool ArrivingFiles::quietFor(ArrivalTimes::Duration duration, Clock::time_point now) const {
    return now - event_ >= duration &&
           std::ranges::all_of(waiting_, [&](const auto& entry) { return isGivenUp(entry.second, now); });
}

std::vector<ArrivingFiles::Note> ArrivingFiles::takeNotes(Clock::time_point now) {
    std::vector<Note> notes = std::exchange(notes_, {});
    for (auto& [number, file] : waiting_)
        if (!file.reported && isGivenUp(file, now)) {
            file.reported = true;
            notes.push_back({file.path, "cannot be read so far: " + file.reason});
        }
    return notes;
}

} // namespace tessera::app
