#include "codec/archive.h"

namespace tessera::codec {

std::shared_ptr<const volume::BrickSource> openArchive(const std::string& path) {
    throw Error("archives cannot be read yet", path);
}

} // namespace tessera::codec
