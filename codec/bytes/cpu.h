#pragma once

#include "volume/base/cpu.h"

namespace tessera::codec {

using tessera::bestCpu;
using tessera::Cpu;

} // namespace tessera::codec
