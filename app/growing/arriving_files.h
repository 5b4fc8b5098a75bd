#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace tessera::app {

/// How long files are waited for.
struct ArrivalTimes {
    using Duration = std::chrono::duration<double>;
    Duration settle{1}; ///< a file is tried once neither its size nor its time of change has changed for so long
    Duration retry{30}; ///< a file that then cannot be read is tried again for so long before later ones go ahead
};

/// Files of one numbered series (run_0001.vti, run_0002.vti, ...) that another program is writing: tells which one is
/// to be read next, in the order of their numbers. The caller looks, reads what is `ready`, and says how that went.
///
/// What is watched is the file and all that it names (the samples of a header, the sidecar of a raw file).
class ArrivingFiles {
public:
    using Clock = std::chrono::steady_clock;
    struct Note {
        std::string path, text;
    };

    /// `pattern` as in volume::filesOfPattern.
    ArrivingFiles(std::string pattern, ArrivalTimes times);

    /// Lists the files again. Throws Error if the first ones that are found belong to several series.
    void look(Clock::time_point now);
    /// All files of the series that are there and not done, by number.
    std::vector<std::string> waiting() const;
    /// The next file to read, once it is whole as far as one can see from outside.
    std::optional<std::string> ready(Clock::time_point now) const;
    /// A file was read, or needs not be: it and all with lower numbers are not given again.
    void done(const std::string& path, Clock::time_point now);
    /// A file could not be read. It is tried again, at once if it changes.
    void failed(const std::string& path, const std::string& reason, Clock::time_point now);

    /// Whether nothing arrived, changed or was done for so long, and no file is still to be tried.
    bool quietFor(ArrivalTimes::Duration duration, Clock::time_point now) const;
    /// What is to be said of files since the last call: those that could not be read for the whole time of retries, and
    /// those that are left out (numbers below one that is done; another series).
    std::vector<Note> takeNotes(Clock::time_point now);
    /// Files of the series that are left out.
    std::size_t missed() const { return missed_; }

private:
    struct FileOnDisk {
        std::string path;
        std::uint64_t size = 0;
        std::int64_t changed = 0;
        bool operator==(const FileOnDisk&) const = default;
    };
    struct Waiting {
        std::string path;
        std::vector<FileOnDisk> files;            ///< as they were
        Clock::time_point since;                  ///< unchanged
        std::optional<Clock::time_point> failure; ///< the first one since it changed
        Clock::time_point next{};                 ///< when it is tried again
        std::string reason;
        bool reported = false;
    };
    static std::vector<FileOnDisk> filesOf(const std::string& path);
    void add(const std::string& path, Clock::time_point now);
    void leaveOut(const std::string& path, const std::string& why);
    bool isGivenUp(const Waiting& file, Clock::time_point now) const;

    std::string pattern_, series_;
    ArrivalTimes times_;
    std::set<std::string> known_;       ///< done, left out or waiting
    std::map<double, Waiting> waiting_; ///< by number
    std::optional<double> last_;        ///< largest number done
    std::vector<Note> notes_;
    std::size_t missed_ = 0;
    Clock::time_point event_{};
};

} // namespace tessera::app
