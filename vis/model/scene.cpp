#include "vis/model/scene.h"

namespace tessera::vis {

const TransferFunction& transferFor(const Scene& scene, const std::string& channel) {
    static const TransferFunction fallback;
    const auto found = scene.transfer.find(channel);
    return found == scene.transfer.end() ? fallback : found->second;
}

} // namespace tessera::vis
