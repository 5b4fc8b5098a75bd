#pragma once

#include "vis/gl/job_queue.h"
#include "vis/gl/warm_up.h"
#include "vis/gl/worker_context.h"

#include <chrono>
#include <condition_variable>
#include <set>

namespace tessera::vis {

/// A cache of programs by recipe. New ones are compiled on threads with their own contexts, if available, without
/// blocking the caller:
///
///     const ProgramAnswer answer = cache.request(recipe, 10);
///     if (answer.stage == ProgramStage::Linked) { set its uniforms, bind its textures; cache.warmUp(recipe, ...); }
///     if (answer.stage != ProgramStage::Ready) show the former picture;
///
/// A program that fails to compile is tried once; the error becomes a message. A program stays valid until others have
/// been requested: it is kept while it is one of the last ProgramLimit::count.
enum class ProgramStage {
    Linking, ///< in progress
    Linked,  ///< needs warmUp() once its uniforms and textures are set
    Warming, ///< in progress
    Ready,
    Failed
};
struct ProgramAnswer {
    const Program* program = nullptr; ///< null unless Linked or Ready
    ProgramStage stage = ProgramStage::Failed;
};

/// How many programs a cache keeps. Software GL takes some 10 MB for the machine code of one.
struct ProgramLimit {
    std::size_t count = 24;                                      ///< the least recently used ones beyond are deleted,
    std::chrono::milliseconds unused = std::chrono::seconds(20); ///< once nobody has asked for them for so long
};

class ProgramCache {
public:
    /// `warmsUp`: programs need warmUp() (Driver::compilesAtFirstDraw), and are compiled in a context that shares
    /// nothing; otherwise they are ready once linked, in one of several that share them.
    explicit ProgramCache(bool warmsUp = true, ProgramLimit limit = {});
    ~ProgramCache(); ///< waits for a running compilation

    /// The program of a recipe, compiled now if necessary; null if it does not compile.
    const Program* find(const ProgramRecipe& recipe);
    /// The same in the background; waits at most this long. Synchronous if there is no second context.
    ProgramAnswer request(const ProgramRecipe& recipe, double milliseconds);
    /// Draws with a linked program and the current state in the other context, so that its machine code is cached.
    void warmUp(const ProgramRecipe& recipe, const Framebuffer& framebuffer);
    /// True once per program: its first draw may be slow and should not be timed.
    bool firstUse(const Program& program) { return drawn_.insert(program.name()).second; }
    std::vector<std::string> takeMessages();
    std::size_t size() const { return programs_.size(); }

private:
    struct Entry;
    struct Shared;
    Entry& make(const ProgramRecipe& recipe, bool background);
    const Program* own(Entry& entry);
    void dropUnused();
    /// A program drawn by the other context, its draw state, and the time of that draw in milliseconds.
    struct Drawn {
        std::shared_ptr<Entry> entry;
        DrawState state;
        double firstDraw;
    };
    static bool inDiskCache(const Drawn& drawn);
    using Clock = std::chrono::steady_clock;
    void awaitDiskCache(const Drawn& drawn, std::size_t trial, Clock::time_point since);

    bool warmsUp_;
    ProgramLimit limit_;
    std::map<std::string, std::shared_ptr<Entry>> programs_;
    std::shared_ptr<Shared> shared_;
    std::set<GLuint> drawn_;
    /// A thread that compiles in a context of its own.
    struct Compiler {
        std::unique_ptr<WorkerContext> context;
        std::unique_ptr<JobQueue> worker; ///< last member: its jobs end before the context does
    };
    Compiler* idlest();
    std::vector<Compiler> compilers_; ///< none: everything runs synchronously in the current context; last member, too
};

} // namespace tessera::vis
