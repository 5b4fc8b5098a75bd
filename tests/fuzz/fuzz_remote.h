#pragma once

#include "codec/remote/remote_file.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace tessera::fuzz {

/// Reads the begin of a file on another machine and what follows, with a cache in `folder`, which is empty again after
/// it. Only crashes and what sanitizers see are looked for.
inline void readRemote(const std::string& address, const std::filesystem::path& folder) {
    ::setenv("XDG_CACHE_HOME", folder.c_str(), 1);
    try {
        codec::RemoteFile file(address, {.cache = 16, .connections = 1, .patience = 0});
        constexpr std::uint64_t kMost = 3 * codec::RemoteFile::kBlockBytes;
        const FileRange all{0, std::min(file.size(), kMost)};
        (void)file.part(all);
        (void)file.freshPart(all);
        file.forget();
    } catch (const Error&) { // the only answer to a bad one
    }
}

} // namespace tessera::fuzz
