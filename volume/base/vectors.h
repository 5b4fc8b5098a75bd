#pragma once

#include "volume/base/numbers.h"

#include <glm/vec4.hpp>

/// Vectors of the numbers of numbers.h.
namespace tessera {

template <class Which, class N> glm::vec<3, N> choose(Which which, const glm::vec<3, N>& a, const glm::vec<3, N>& b) {
    return {choose(which, a.x, b.x), choose(which, a.y, b.y), choose(which, a.z, b.z)};
}
template <class Which, class N> glm::vec<4, N> choose(Which which, const glm::vec<4, N>& a, const glm::vec<4, N>& b) {
    return {choose(which, a.x, b.x), choose(which, a.y, b.y), choose(which, a.z, b.z), choose(which, a.w, b.w)};
}
template <class N> glm::vec<4, N> blended(const glm::vec<4, N>& a, const glm::vec<4, N>& b, N share) {
    return a * (N(1) - share) + b * share;
}

} // namespace tessera
