#pragma once

#include "volume/base/describe.h"

namespace tessera::codec {

/// How archives on other machines are read.
struct RemoteOptions {
    int cache = 2048;
    int connections = 6;
    double patience = 10;
    bool operator==(const RemoteOptions&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.cache, FieldInfo{.key = "cache",
                                    .doc = "Disk space in the user's cache folder for what was read of archives on "
                                           "other machines; what was used least recently is removed first",
                                    .unit = "MiB",
                                    .range = Range{16, 1 << 20},
                                    .logScale = true});
        visit(self.connections, FieldInfo{.key = "connections",
                                          .doc = "Connections to the other machine at a time",
                                          .range = Range{1, 32}});
        visit(self.patience, FieldInfo{.key = "patience",
                                       .doc = "How long a request to another machine that failed is tried again",
                                       .unit = "s",
                                       .range = Range{0, 600}});
    }
};

} // namespace tessera::codec
