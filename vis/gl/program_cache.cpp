#include "vis/gl/program_cache.h"

#include "volume/error.h"

#include <chrono>
#include <thread>

namespace tessera::vis {

/// What both threads look at.
struct ProgramCache::Shared {
    std::mutex mutex;
    std::condition_variable changed;
    std::vector<std::string> messages;

    void fail(Entry& entry, const std::string& reason);
    void reach(Entry& entry, ProgramStage stage);
};

struct ProgramCache::Entry {
    ProgramText text;
    Program program;                            ///< touched by the thread whose stage it is
    ProgramStage stage = ProgramStage::Linking; ///< under the mutex
};

void ProgramCache::Shared::fail(Entry& entry, const std::string& reason) {
    const std::lock_guard lock(mutex);
    messages.push_back(reason);
    entry.stage = ProgramStage::Failed;
    changed.notify_all();
}

void ProgramCache::Shared::reach(Entry& entry, ProgramStage stage) {
    const std::lock_guard lock(mutex);
    entry.stage = stage;
    changed.notify_all();
}

namespace {

bool underWay(ProgramStage stage) {
    return stage == ProgramStage::Linking || stage == ProgramStage::Warming;
}

/// Mesa writes its disk cache on a thread of low priority. A second copy of the program shows whether the code is
/// there: its first draw is then many times faster.
void waitForDiskCache(const Program& program, const ProgramText& text, const DrawState& state, double firstDraw,
                      std::stop_token stop) {
    constexpr double kWorthIt = 25; // ms; hardware drivers, and code that was in the cache already, stay below
    if (firstDraw < kWorthIt) return;
    for (const int pause : {60, 250, 800}) {
        std::this_thread::sleep_for(std::chrono::milliseconds(pause));
        if (stop.stop_requested()) return;
        const Program copy = linkProgram(text);
        copySamplerUnits(program, copy);
        if (drawOnePixel(copy, state) < 0.4 * firstDraw) return;
    }
}

} // namespace

ProgramCache::ProgramCache() : shared_(std::make_shared<Shared>()), context_(SharedContext::make()) {
    if (context_) worker_ = std::make_unique<JobQueue>(1, false);
}

ProgramCache::~ProgramCache() = default;

ProgramCache::Entry& ProgramCache::make(const ProgramRecipe& recipe, bool background) {
    const auto [found, isNew] = programs_.try_emplace(recipe.key());
    if (!isNew) return *found->second;
    const auto entry = found->second = std::make_shared<Entry>();
    const auto link = [entry, shared = shared_](ProgramStage next) {
        try {
            entry->program = linkProgram(entry->text);
            glFinish(); // before another context may use it
            shared->reach(*entry, next);
        } catch (const Error& error) {
            shared->fail(*entry, error.what());
        }
    };
    try {
        entry->text = composeProgram(recipe);
    } catch (const Error& error) {
        shared_->fail(*entry, error.what());
        return *entry;
    }
    if (!background || !worker_) {
        link(ProgramStage::Ready);
    } else {
        worker_->add(0, [link, context = context_.get()](std::stop_token) {
            const SharedContext::Use use(*context);
            link(ProgramStage::Linked);
        });
    }
    return *entry;
}

const Program* ProgramCache::find(const ProgramRecipe& recipe) {
    Entry& entry = make(recipe, false);
    std::unique_lock lock(shared_->mutex);
    shared_->changed.wait(lock, [&] { return !underWay(entry.stage); });
    if (entry.stage == ProgramStage::Linked) entry.stage = ProgramStage::Ready; // its first draw happens here
    return entry.stage == ProgramStage::Ready ? &entry.program : nullptr;
}

ProgramAnswer ProgramCache::request(const ProgramRecipe& recipe, double milliseconds) {
    Entry& entry = make(recipe, true);
    std::unique_lock lock(shared_->mutex);
    shared_->changed.wait_for(lock, std::chrono::duration<double, std::milli>(milliseconds),
                              [&] { return !underWay(entry.stage); });
    const bool usable = entry.stage == ProgramStage::Linked || entry.stage == ProgramStage::Ready;
    return {usable ? &entry.program : nullptr, entry.stage};
}

void ProgramCache::warmUp(const ProgramRecipe& recipe, const Framebuffer& framebuffer) {
    const auto found = programs_.find(recipe.key());
    if (found == programs_.end() || !worker_) return;
    const DrawState state = captureDrawState(framebuffer);
    glFlush(); // the other context sees the uniforms set here
    shared_->reach(*found->second, ProgramStage::Warming);
    worker_->add(-1, [entry = found->second, shared = shared_, state, context = context_.get()](std::stop_token stop) {
        const SharedContext::Use use(*context);
        try {
            const double firstDraw = drawOnePixel(entry->program, state);
            waitForDiskCache(entry->program, entry->text, state, firstDraw, stop);
        } catch (const std::exception&) { // no memory for it, say: the first draw happens in the first context then
        }
        shared->reach(*entry, ProgramStage::Ready);
    });
}

std::vector<std::string> ProgramCache::takeMessages() {
    const std::lock_guard lock(shared_->mutex);
    return std::exchange(shared_->messages, {});
}

} // namespace tessera::vis
