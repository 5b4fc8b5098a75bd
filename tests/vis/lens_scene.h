#pragma once

#include "tests/vis/raycast_compare.h"

namespace tessera::vis {

/// A volume, a surface and another volume in a small lens, and a disc that magnifies: lenses that change nothing beside
/// themselves.
inline Scene lensScene(bool perspective) {
    Scene scene = baseScene(perspective);
    scene.layers = {{"", true, VolumeLayer{.channel = "a", .density = 3}},
                    {"", true, IsoLayer{.channel = "b", .value = 0.55, .opacity = 0.7f}, "inner"},
                    {"", true, VolumeLayer{.channel = "b", .shaded = false}, "inner"}};
    scene.lenses = {{.name = "inner", .center = scene.cursor, .size = glm::vec3(0.14f)},
                    {.name = "larger",
                     .shape = LensShape::Disc,
                     .effect = LensEffect::Magnify,
                     .center = scene.cursor + 4.0,
                     .size = glm::vec3(0.1f)}};
    return scene;
}

} // namespace tessera::vis
