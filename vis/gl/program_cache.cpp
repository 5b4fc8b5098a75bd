#include "vis/gl/program_cache.h"

#include "volume/error.h"

namespace tessera::vis {

const Program* ProgramCache::find(const ProgramRecipe& recipe) {
    const std::string key = recipe.key();
    auto found = programs_.find(key);
    if (found == programs_.end()) {
        Program made;
        try {
            made = makeProgram(recipe);
        } catch (const Error& error) {
            messages_.push_back(error.what());
        }
        found = programs_.emplace(key, std::move(made)).first;
    }
    return found->second ? &found->second : nullptr;
}

} // namespace tessera::vis
