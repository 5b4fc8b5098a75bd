#pragma once

#include "volume/field/dataset.h"

namespace tessera::app {

/// Three parameters at three times, for tests of sessions without samples.
inline volume::DatasetInfo cellInfo() {
    volume::DatasetInfo info;
    info.name = "cell";
    info.bounds = {{0, 0, 0}, {1, 2, 100}};
    for (const char* name : {"O2", "H2", "T"}) {
        volume::Parameter parameter;
        parameter.name = name;
        parameter.ranges = {{1, 5}};
        info.parameters.push_back(parameter);
    }
    info.times = {0, 1, 2};
    return info;
}

} // namespace tessera::app
