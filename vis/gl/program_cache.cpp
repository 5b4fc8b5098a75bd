#include "vis/gl/program_cache.h"

#include "volume/base/error.h"

#include <algorithm>
#include <chrono>
#include <thread>

namespace tessera::vis {

/// State shared with the worker thread.
struct ProgramCache::Shared {
    std::mutex mutex;
    std::condition_variable changed;
    std::vector<std::string> messages;

    void fail(Entry& entry, const std::string& reason);
    void reach(Entry& entry, ProgramStage stage);
};

struct ProgramCache::Entry {
    ProgramText text;
    Program program;                            ///< of the cache's own context
    ProgramBinary binary;                       ///< what the worker compiled apart; complete from Linked on
    ProgramStage stage = ProgramStage::Linking; ///< guarded by the mutex
    Clock::time_point used = {};                ///< read and written by the cache's own thread
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

/// How many programs are compiled at a time.
unsigned compilers(bool warmsUp) {
    return warmsUp ? 1 : std::clamp(std::thread::hardware_concurrency() / 2, 1u, 4u);
}

bool underWay(ProgramStage stage) {
    return stage == ProgramStage::Linking || stage == ProgramStage::Warming;
}

} // namespace

ProgramCache::ProgramCache(bool warmsUp, ProgramLimit limit)
    : warmsUp_(warmsUp), limit_(limit), shared_(std::make_shared<Shared>()) {
    for (unsigned i = 0; i < compilers(warmsUp); ++i)
        if (std::unique_ptr<WorkerContext> context = WorkerContext::make(warmsUp))
            compilers_.push_back({std::move(context), std::make_unique<JobQueue>(1, JobThreads::Equal)});
}

/// The compiler with the fewest programs to compile; null if there is none.
ProgramCache::Compiler* ProgramCache::idlest() {
    if (compilers_.empty()) return nullptr;
    return &*std::ranges::min_element(compilers_, {}, [](const Compiler& each) { return each.worker->unfinished(); });
}

ProgramCache::~ProgramCache() = default;

ProgramCache::Entry& ProgramCache::make(const ProgramRecipe& recipe, bool background) {
    const auto [found, isNew] = programs_.try_emplace(recipe.key());
    if (isNew) found->second = std::make_shared<Entry>();
    const std::shared_ptr<Entry> entry = found->second;
    entry->used = Clock::now();
    dropUnused();
    if (!isNew) return *entry;
    const auto link = [entry, shared = shared_](bool apart) {
        try {
            Program program = linkProgram(entry->text);
            if (apart)
                entry->binary = binaryOf(program);
            else
                entry->program = std::move(program);
            glFinish(); // before another context uses it
            shared->reach(*entry, apart ? ProgramStage::Linked : ProgramStage::Ready);
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
    const Compiler* const compiler = background ? idlest() : nullptr;
    if (!compiler) {
        link(false);
    } else {
        compiler->worker->add(0, [link, apart = warmsUp_, context = compiler->context.get()](std::stop_token) {
            const WorkerContext::Use use(*context);
            link(apart);
        });
    }
    return *entry;
}

/// Programs that the worker refers to stay, since only this thread may delete them.
void ProgramCache::dropUnused() {
    while (programs_.size() > limit_.count) {
        const auto oldest = std::ranges::min_element(
            programs_, {}, [](const auto& each) { return std::pair(each.second.use_count() > 1, each.second->used); });
        const Entry& entry = *oldest->second;
        if (oldest->second.use_count() > 1 || Clock::now() - entry.used < limit_.unused) return;
        drawn_.erase(entry.program.name());
        programs_.erase(oldest);
    }
}

/// The program of an entry that is linked or ready; null if it cannot be made in this context.
const Program* ProgramCache::own(Entry& entry) {
    if (entry.program) return &entry.program;
    try {
        entry.program = loadProgram(entry.binary, entry.text);
        return &entry.program;
    } catch (const Error& error) {
        shared_->fail(entry, error.what());
        return nullptr;
    }
}

const Program* ProgramCache::find(const ProgramRecipe& recipe) {
    Entry& entry = make(recipe, false);
    {
        std::unique_lock lock(shared_->mutex);
        shared_->changed.wait(lock, [&] { return !underWay(entry.stage); });
        if (entry.stage == ProgramStage::Linked) entry.stage = ProgramStage::Ready; // the caller draws it first
        if (entry.stage != ProgramStage::Ready) return nullptr;
    }
    return own(entry);
}

ProgramAnswer ProgramCache::request(const ProgramRecipe& recipe, double milliseconds) {
    Entry& entry = make(recipe, true);
    ProgramStage stage;
    {
        std::unique_lock lock(shared_->mutex);
        shared_->changed.wait_for(lock, std::chrono::duration<double, std::milli>(milliseconds),
                                  [&] { return !underWay(entry.stage); });
        stage = entry.stage;
    }
    if (stage != ProgramStage::Linked && stage != ProgramStage::Ready) return {nullptr, stage};
    const Program* const program = own(entry);
    return {program, program ? stage : ProgramStage::Failed};
}

void ProgramCache::warmUp(const ProgramRecipe& recipe, const Framebuffer& framebuffer) {
    const auto found = programs_.find(recipe.key());
    if (found == programs_.end() || compilers_.empty() || !found->second->program) return;
    const DrawState state = captureDrawState(found->second->program, framebuffer);
    shared_->reach(*found->second, ProgramStage::Warming);
    compilers_.front().worker->add(-1, [this, entry = found->second, state](std::stop_token) {
        double firstDraw = 0;
        try {
            const WorkerContext::Use use(*compilers_.front().context);
            firstDraw = drawNothing(loadProgram(entry->binary, entry->text), state);
        } catch (const std::exception&) { // for example out of memory: then the first draw happens in the first context
        }
        constexpr double kWorthIt = 25; // ms; hardware drivers and code already in the disk cache stay below
        if (firstDraw < kWorthIt)
            shared_->reach(*entry, ProgramStage::Ready);
        else
            awaitDiskCache({entry, state, firstDraw}, 0, Clock::now());
    });
}

/// Mesa writes its disk cache on a low-priority thread. Whether the code has been written shows in a second copy of the
/// program: its first draw is then many times faster.
bool ProgramCache::inDiskCache(const Drawn& drawn) {
    return drawNothing(loadProgram(drawn.entry->binary, drawn.entry->text), drawn.state) < 0.4 * drawn.firstDraw;
}

/// Checks repeatedly, at growing intervals, whether the driver has cached a drawn program; other jobs run in between.
void ProgramCache::awaitDiskCache(const Drawn& drawn, std::size_t trial, Clock::time_point since) {
    using namespace std::chrono_literals;
    static constexpr std::chrono::milliseconds kPauses[] = {60ms, 250ms, 800ms};
    compilers_.front().worker->add(1, [this, drawn, trial, since](std::stop_token stop) {
        const bool due = Clock::now() >= since + kPauses[trial];
        if (!due) std::this_thread::sleep_for(10ms);
        if (!due && !stop.stop_requested()) return awaitDiskCache(drawn, trial, since);
        try {
            const WorkerContext::Use use(*compilers_.front().context);
            if (!stop.stop_requested() && trial + 1 < std::size(kPauses) && !inDiskCache(drawn))
                return awaitDiskCache(drawn, trial + 1, Clock::now());
        } catch (const std::exception&) { // as above
        }
        shared_->reach(*drawn.entry, ProgramStage::Ready);
    });
}

std::vector<std::string> ProgramCache::takeMessages() {
    const std::lock_guard lock(shared_->mutex);
    return std::exchange(shared_->messages, {});
}

} // namespace tessera::vis
