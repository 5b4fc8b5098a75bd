#pragma once

#include "vis/optics/light_maps.h"
#include "vis/optics/light_volume.h"

#include <cstdint>
#include <memory>
#include <vector>

/// Light maps and light volumes laid out for packets of rays.
namespace tessera::vis::packet {

/// The light of a picture besides its lamps.
struct SceneLight {
    std::shared_ptr<const LightMaps> maps;            ///< null: none
    std::shared_ptr<const LightVolume<float>> volume; ///< null: none
};

/// A cube map with what lies beyond the edges of its faces: face by face, edge + 2 texels in each of edge + 2 rows, RGB
/// and one number that means nothing.
struct PackedMap {
    int edge = 0;
    std::vector<float> texels;
};

struct PackedLight {
    PackedMap diffuse, specular;
    glm::dmat3 fromWorld{1};
    LightGrid grid;
    /// Two numbers of 2 x 16 bits for each cell, kQuantum = 1: the first two lights, the third one and ambient light.
    /// Empty: no light volume.
    std::vector<std::uint32_t> visible;
    std::vector<float> scattered; ///< RGB and one number that means nothing; empty: none
};
PackedLight packLight(const SceneLight& light);

} // namespace tessera::vis::packet
