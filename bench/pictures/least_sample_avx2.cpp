#include "bench/pictures/least_sample.h"
#include "bench/pictures/least_sample_lanes.h"

namespace tessera::app {

float readAvx2(const vis::packet::VolumeView& volume, int rounds, long& taken) {
    return vis::packet::avx2::readFirstBrick(volume, rounds, taken);
}

} // namespace tessera::app
