#pragma once

#include "app/document/document.h"
#include "app/ui/jobs.h"
#include "app/ui/messages.h"
#include "app/user_files/state_dir.h"

#include <chrono>

namespace tessera::app {

/// Writes an autosave of an edited document in the background, in case the program crashes. Must outlive the jobs.
class Autosaver {
public:
    /// `folder`: of the state of the program, "" = none.
    Autosaver(std::string folder, std::chrono::milliseconds interval);

    /// Why nothing is kept, "" where something is.
    const std::string& problem() const { return autosave_.problem(); }
    /// Sessions left behind by crashed runs, newest first.
    std::vector<Recovery> abandoned() const { return autosave_.abandoned(); }
    /// Once per frame: writes the document where it has been edited and the interval is over. `now` in seconds.
    void update(const Document& document, double now, Jobs& jobs, Messages& messages);
    /// The current document needs no autosave: it is saved or unmodified.
    void clear(const Document& document);
    /// Saves at the next update without waiting for the interval.
    void hurry() { last_ = -1e9; }
    /// Seconds until update() may write; infinity if nothing has been edited.
    double secondsToNext(const Document& document, double now) const;

private:
    double next() const { return last_ + interval_.count(); }

    std::string folder_;
    std::chrono::duration<double> interval_;
    Autosave autosave_;
    std::size_t kept_ = 0; ///< Document::edits() at the last autosave or save
    double last_ = 0;      ///< s
};

} // namespace tessera::app
