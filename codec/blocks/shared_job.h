#pragma once

#include "volume/base/progress.h"
#include "volume/system/launched.h"
#include "volume/system/locked_file.h"

#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>

namespace tessera::codec {

/// Work on one output that processes share, on one machine or several that see the same files: they agree by locks on
/// files in the folder OUTPUT.blocks, which exists while the work is not complete. The folder of processes that ended
/// before is continued. Processes started by a launcher (mpirun, srun) belong together, so that one that starts late
/// does not begin again; others may come and go at any time.
class SharedJob {
public:
    /// Enters the folder, and makes it if there is none. `about` describes the work, the same in all processes. Throws
    /// Error when the folder belongs to other work, MachineError when it cannot be made or locked, Cancelled.
    SharedJob(const std::string& output, const std::string& about, const Launched& launched, const Progress& progress);
    /// Leaves the folder; the last process removes it, if the work is complete or nothing has been done.
    ~SharedJob();
    SharedJob(const SharedJob&) = delete;
    SharedJob& operator=(const SharedJob&) = delete;

    /// Does pieces 0 .. count - 1 of the work that is called `name`: first those that nobody does, then it waits for
    /// the others, and does those whose process ended before they were done. Returns how many it did; all are done
    /// then. `isDone(piece)`, which is asked of a piece that nobody does, must see what any process has done;
    /// `work(piece)` must leave nothing half done. With `help` all processes stay with the same piece: where another
    /// one does it, `help(piece)` is called once. Throws Cancelled, MachineError when the folder is removed.
    std::size_t share(const std::string& name, std::size_t count, const std::function<bool(std::size_t)>& isDone,
                      const std::function<void(std::size_t)>& work, const Progress& progress,
                      const std::function<void(std::size_t)>& help = {}) const;

    /// The path of a file of the folder.
    std::string file(const std::string& name) const { return folder_ + "/" + name; }
    /// The same for a file that only serves processes that are here: it is removed when the first of others enters.
    std::string scratch(const std::string& name) const { return file(kScratch + name); }
    /// Removes all of these whose names begin so, with locks of pieces that nobody does again.
    void removeScratch(const std::string& begin) const;
    /// A lock between the processes, which is waited for; `fraction` of the progress is reported meanwhile. Throws
    /// Cancelled, MachineError when the folder is removed.
    LockedFile lock(const std::string& name, const Progress& progress, double fraction) const;
    /// States that the work is complete, whatever the other processes do.
    void setComplete() const;
    bool complete() const;

private:
    static constexpr const char* kScratch = "scratch-";

    void removeEnded(bool ownToo) const;
    bool remove(LockedFile alone) const;
    bool holdsWork() const;
    /// Waits a little, longer the next time, between two looks at what others are doing.
    void pause(std::chrono::milliseconds& time, const Progress& progress, double fraction) const;

    std::string folder_;
    Launched launched_;
    std::optional<LockedFile> inside_; ///< shared by all processes in the folder
};

} // namespace tessera::codec
