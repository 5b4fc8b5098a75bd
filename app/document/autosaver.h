#pragma once

#include "app/document/document.h"
#include "app/ui/jobs.h"
#include "app/ui/messages.h"
#include "app/user_files/state_dir.h"

#include <chrono>

namespace tessera::app {

/// Keeps what has been edited, in the background, for the case that the program ends by itself. Must outlive the jobs.
class Autosaver {
public:
    /// `folder`: of the state of the program, "" = none.
    Autosaver(std::string folder, std::chrono::milliseconds interval);

    /// Sessions that runs left behind which did not end by themselves, newest first.
    std::vector<Recovery> abandoned() const { return autosave_.abandoned(); }
    /// Once per frame: writes the document where it has been edited and the interval is over. `now` in seconds.
    void update(const Document& document, double now, Jobs& jobs, Messages& messages);
    /// The document as it is needs not be kept: it is saved, or as opened.
    void clear(const Document& document);
    /// Does not wait for the interval next time.
    void hurry() { last_ = -1e9; }
    /// Seconds until update() may have something to write; infinity = nothing has been edited.
    double secondsToNext(const Document& document, double now) const;

private:
    double next() const { return last_ + interval_.count(); }

    std::string folder_;
    std::chrono::duration<double> interval_;
    Autosave autosave_;
    std::size_t kept_ = 0; ///< Document::edits() that need not be kept any more
    double last_ = 0;      ///< s
};

} // namespace tessera::app
