#pragma once

#include "tests/reference/samples.h"
#include "vis/optics/light_maps.h"

namespace tessera::vis::reference {

struct Options {
    Flaws flaws;                                      ///< none, except in tests
    std::shared_ptr<const CubeMap> surroundings = {}; ///< of Environment::Picture
};

} // namespace tessera::vis::reference
