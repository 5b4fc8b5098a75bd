// Which fault is on, and which faults a run has come to. Linked into every program of a build with faults.
//   TESSERA_MUTANT=17            switches fault 17 on
//   TESSERA_MUTANT_COVER=FILE    at the end of the process the numbers of all faults it came to are added to FILE
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <string>
#include <unistd.h>

constexpr int kFaults = 4096;

extern "C" {
unsigned char tesseraMutantArmed[kFaults]; // what guards look at first: 0 costs them a load and a branch
}

namespace {

std::atomic<unsigned char> reached[kFaults];
bool covering = false;

} // namespace

extern "C" bool tesseraMutantHit(int fault) {
    if (!covering) return true; // only the one switched on is armed
    reached[fault].store(1, std::memory_order_relaxed);
    tesseraMutantArmed[fault] = 0;
    return false;
}

/// Forgets what was reached so far.
extern "C" void tesseraMutantForget() {
    if (!covering) return;
    for (auto& one : reached) one.store(0);
    std::memset(tesseraMutantArmed, 1, sizeof tesseraMutantArmed);
}

extern "C" bool tesseraMutantReached(int fault) {
    return fault < kFaults && reached[fault].load();
}

namespace {

__attribute__((constructor(101))) void start() {
    if (const char* fault = std::getenv("TESSERA_MUTANT"))
        tesseraMutantArmed[std::atoi(fault) % kFaults] = 1;
    else if (std::getenv("TESSERA_MUTANT_COVER")) {
        covering = true;
        tesseraMutantForget();
    }
}

__attribute__((destructor)) void finish() {
    const char* path = std::getenv("TESSERA_MUTANT_COVER");
    if (!covering || !path || !*path) return;
    std::string text;
    for (int i = 0; i < kFaults; ++i)
        if (reached[i].load()) text += std::to_string(i) + "\n";
    const int file = open(path, O_WRONLY | O_CREAT | O_APPEND, 0644);
    if (file < 0) return;
    [[maybe_unused]] const auto written = write(file, text.data(), text.size());
    close(file);
}

} // namespace
