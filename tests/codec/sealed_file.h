#pragma once

#include "codec/container/container.h"

#include <algorithm>
#include <cstring>
#include <vector>

namespace tessera::codec::testing {

/// An archive made by hand: both copies of its header written over the first bytes, with the size that the file has.
inline std::vector<char> sealed(Header header, Bytes file) {
    header.fileSize = file.size();
    const Bytes front = serialise(header);
    for (const std::size_t at : {std::size_t(0), kHeaderBytes})
        std::copy(front.begin(), front.end(), file.begin() + std::ptrdiff_t(at));
    std::vector<char> chars(file.size());
    std::memcpy(chars.data(), file.data(), file.size());
    return chars;
}

} // namespace tessera::codec::testing
