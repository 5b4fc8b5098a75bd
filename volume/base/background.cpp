#include "volume/base/background.h"

#include <sys/resource.h>
#include <tbb/task_scheduler_observer.h>
#include <unistd.h>

namespace tessera {

namespace {

struct Helpers : tbb::task_scheduler_observer {
    Helpers() { observe(true); }
    ~Helpers() override { observe(false); }
    void on_scheduler_entry(bool isWorker) override {
        if (isWorker) workInBackground();
    }
};

} // namespace

void workInBackground() {
    constexpr int kNiceness = 10;
    const auto thread = id_t(gettid());
    if (getpriority(PRIO_PROCESS, thread) >= kNiceness) return; // already low; never raise a priority
    // If the system refuses, priorities stay as they are.
    [[maybe_unused]] const int refused = setpriority(PRIO_PROCESS, thread, kNiceness);
}

void helpInBackground() {
    static const Helpers helpers;
}

} // namespace tessera
