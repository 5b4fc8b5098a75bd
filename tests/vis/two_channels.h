#pragma once

#include "volume/field/dataset.h"

namespace tessera::vis {

/// 4x4x4 samples of the channels "a" and "b".
inline volume::DatasetInfo twoChannels() {
    volume::DatasetInfo info;
    info.lattice.size = {4, 4, 4};
    info.parameters.resize(2);
    info.parameters[0].name = "a";
    info.parameters[1].name = "b";
    return info;
}

} // namespace tessera::vis
