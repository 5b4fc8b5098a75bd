#pragma once

#include "app/ui/jobs.h"

#include <optional>
#include <string>
#include <vector>

namespace tessera::app {

/// Asks whether another machine may be asked for data that a file names, which others may have made.
class MachineDialog {
public:
    enum class Answer { No, Once, Always };
    struct Decision {
        Answer answer = Answer::No;
        std::vector<Jobs::Refused> jobs; ///< all that wait for this machine
    };
    /// Adds a job that waits for the answer.
    void show(Jobs::Refused job) { waiting_.push_back(std::move(job)); }
    bool shown() const { return !waiting_.empty(); }
    /// Returns what the user decided about the first machine.
    std::optional<Decision> draw();

private:
    std::vector<Jobs::Refused> waiting_;
};

} // namespace tessera::app
