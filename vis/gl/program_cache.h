#pragma once

#include "vis/gl/program.h"

#include <set>

namespace tessera::vis {

/// The programs made so far, by recipe. One that does not compile is tried once; the reason becomes a message.
class ProgramCache {
public:
    /// The program of a recipe, made now if need be; null when it does not compile.
    const Program* find(const ProgramRecipe& recipe);
    /// True once per program: software GL compiles at the first draw.
    bool firstUse(const Program& program) { return drawn_.insert(program.name()).second; }
    std::vector<std::string> takeMessages() { return std::exchange(messages_, {}); }

private:
    std::map<std::string, Program> programs_; ///< an empty one did not compile
    std::set<GLuint> drawn_;
    std::vector<std::string> messages_;
};

} // namespace tessera::vis
