#pragma once

#include "volume/base/describe.h"

namespace tessera::vis {

/// Resources that the renderer may use.
struct RenderLimits {
    int textureMemory = 1024; ///< MiB; may be exceeded for a picture that the caller waits for
    int brickMemory = 2048;   ///< MiB of decoded bricks in RAM
    float keptChange =
        0.0005f;          ///< fraction of a parameter's range: bricks that change less over time keep their textures
    float frameTime = 60; ///< ms of the GUI thread per frame during interaction

    bool operator==(const RenderLimits&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.textureMemory, FieldInfo{.key = "textureMemory",
                                            .doc = "Memory for textures",
                                            .unit = "MiB",
                                            .range = Range{64, 65536},
                                            .logScale = true});
        visit(self.brickMemory, FieldInfo{.key = "brickMemory",
                                          .doc = "Memory for decoded bricks",
                                          .unit = "MiB",
                                          .range = Range{64, 1048576},
                                          .logScale = true});
        visit(self.keptChange,
              FieldInfo{.key = "keptChange",
                        .doc = "Bricks whose values change by less than this share of their range between two times "
                               "keep their textures; 0 = only bricks that do not change",
                        .range = Range{0, 0.1}});
        visit(self.frameTime,
              FieldInfo{.key = "frameTime",
                        .doc = "Time to draw one picture while something moves; resolution and step are adapted to it",
                        .unit = "ms",
                        .range = Range{5, 1000},
                        .logScale = true});
    }
};

} // namespace tessera::vis
