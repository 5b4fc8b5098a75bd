#include "app/document/autosaver.h"

#include <algorithm>
#include <limits>

namespace tessera::app {

Autosaver::Autosaver(std::string folder, std::chrono::milliseconds interval)
    : folder_(std::move(folder)), interval_(interval), autosave_(folder_) {}

void Autosaver::update(const Document& document, double now, Jobs& jobs, Messages& messages) {
    if (document.edits() == kept_ || now < next()) return;
    last_ = now;
    kept_ = document.edits();
    if (document.asSaved()) return;
    jobs.start(
        "autosave", "Autosave",
        [this, &messages, snapshot = document.snapshot()](const Progress&) -> Jobs::Finish {
            const std::string failure = autosave_.save(printSession(snapshot, folder_ + "/autosave"));
            if (failure.empty()) return {};
            return [&messages, failure] { messages.add("Autosave: " + failure, true); };
        },
        true);
}

void Autosaver::clear(const Document& document) {
    kept_ = document.edits();
    autosave_.remove();
}

double Autosaver::secondsToNext(const Document& document, double now) const {
    if (document.edits() == kept_) return std::numeric_limits<double>::infinity();
    return std::max(0.1, next() - now);
}

} // namespace tessera::app
