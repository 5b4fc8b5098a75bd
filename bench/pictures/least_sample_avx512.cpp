#include "bench/pictures/least_sample.h"
#include "bench/pictures/least_sample_lanes.h"

namespace tessera::app {

float readAvx512(const vis::packet::VolumeView& volume, int rounds, long& taken) {
    return vis::packet::avx512::readFirstBrick(volume, rounds, taken);
}

} // namespace tessera::app
