#include "vis/scene/lens_bend.h"

namespace tessera::vis {

glm::dvec3 PlacedLens::bend(glm::dvec3 world) const {
    return bentBy<double>(*this, world);
}

glm::dvec3 bend(const std::vector<PlacedLens>& lenses, glm::dvec3 world, glm::dvec3 halfSize) {
    return bentBy<double>(lenses, world, halfSize);
}

} // namespace tessera::vis
