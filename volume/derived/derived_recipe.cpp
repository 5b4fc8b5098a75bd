#include "volume/derived/derived_recipe.h"

#include <array>
#include <cassert>
#include <utility>

namespace tessera::volume {

DerivedRecipe recipeOfKind(std::size_t kind) {
    assert(kind < kDerivedKinds);
    return []<std::size_t... I>(std::size_t of, std::index_sequence<I...>) {
        const std::array<DerivedRecipe, kDerivedKinds> all{DerivedRecipe(std::in_place_index<I>)...};
        return all[of];
    }
    (kind, std::make_index_sequence<kDerivedKinds>());
}

} // namespace tessera::volume
