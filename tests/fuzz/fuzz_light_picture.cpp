// A picture of surroundings, Radiance or PNG.
#include "vis/image/light_picture.h"
#include "volume/base/error.h"

using namespace tessera;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        vis::surroundingsOf(vis::decodeLightPicture({data, size}, "input"), "input");
    } catch (const Error&) {
    }
    return 0;
}
