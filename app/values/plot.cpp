#include "app/values/plot.h"

#include "vis/transfer/transfer_function.h"

namespace tessera::app {

glm::vec3 stateInk(std::size_t n, std::size_t count, bool dark) {
    // Without the end of the map that has little contrast to the ground.
    const Range used = dark ? Range{0.42, 0.95} : Range{0.05, 0.8};
    const double share = count > 1 ? double(n) / double(count - 1) : 0;
    return glm::vec3(vis::colormapColor("plasma", used.lo + (used.hi - used.lo) * share));
}

} // namespace tessera::app
