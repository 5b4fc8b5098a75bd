#pragma once

#include "vis/gl/job_queue.h"
#include "vis/gl/shared_context.h"
#include "vis/gl/warm_up.h"

#include <chrono>
#include <condition_variable>
#include <set>

namespace tessera::vis {

/// A cache of programs by recipe. New ones are compiled on a thread with its own context, if there is one, so that
/// nobody waits for the compiler:
///
///     const ProgramAnswer answer = cache.request(recipe, 10);
///     if (answer.stage == ProgramStage::Linked) { set its uniforms, bind its textures; cache.warmUp(recipe, ...); }
///     if (answer.stage != ProgramStage::Ready) show the former picture;
///
/// A program that does not compile is tried once; the reason becomes a message.
enum class ProgramStage {
    Linking, ///< on the way
    Linked,  ///< wants warmUp() once its uniforms and textures are set
    Warming, ///< on the way
    Ready,
    Failed
};
struct ProgramAnswer {
    const Program* program = nullptr; ///< when Linked or Ready
    ProgramStage stage = ProgramStage::Failed;
};

class ProgramCache {
public:
    /// `warmsUp`: programs want warmUp(), as Driver::compilesAtFirstDraw says; else they are ready once they are
    /// linked.
    explicit ProgramCache(bool warmsUp = true);
    ~ProgramCache(); ///< waits for a compilation that has begun

    /// The program of a recipe, compiled now if necessary; null if it does not compile.
    const Program* find(const ProgramRecipe& recipe);
    /// The same in the background; waits at most this long. Ready at once if there is no second context.
    ProgramAnswer request(const ProgramRecipe& recipe, double milliseconds);
    /// Makes the other context draw with a linked program in the current state, so that its machine code is ready here.
    void warmUp(const ProgramRecipe& recipe, const Framebuffer& framebuffer);
    /// True once per program: its first draw may take long, so nobody should time it.
    bool firstUse(const Program& program) { return drawn_.insert(program.name()).second; }
    std::vector<std::string> takeMessages();

private:
    struct Entry;
    struct Shared;
    Entry& make(const ProgramRecipe& recipe, bool background);
    /// A program that the other context has drawn, how, and how long that took in milliseconds.
    struct Drawn {
        std::shared_ptr<Entry> entry;
        DrawState state;
        double firstDraw;
    };
    static bool inDiskCache(const Drawn& drawn);
    using Clock = std::chrono::steady_clock;
    void awaitDiskCache(const Drawn& drawn, std::size_t trial, Clock::time_point since);

    bool warmsUp_;
    std::map<std::string, std::shared_ptr<Entry>> programs_;
    std::shared_ptr<Shared> shared_;
    std::set<GLuint> drawn_;
    std::unique_ptr<SharedContext> context_; ///< null: everything here and now
    std::unique_ptr<JobQueue> worker_;       ///< last: its jobs end before anything else goes
};

} // namespace tessera::vis
