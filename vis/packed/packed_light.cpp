#include "vis/packed/packed_light.h"

#include "vis/packed/packet_volume.h"

#include <algorithm>

namespace tessera::vis::packet {

namespace {

PackedMap packMap(const CubeMap& map) {
    PackedMap out{.edge = map.edge, .texels = {}};
    for (int face = 0; face < 6; ++face)
        for (int j = -1; j <= map.edge; ++j)
            for (int i = -1; i <= map.edge; ++i) {
                const glm::dvec3 texel = map.texel(face, i, j);
                for (int c = 0; c < 3; ++c) out.texels.push_back(float(texel[c]));
                out.texels.push_back(0);
            }
    return out;
}

std::uint32_t pairOf(float low, float high) {
    const auto quantum = [](float part) { return std::uint32_t(std::clamp(part, 0.0f, 1.0f) * kQuantum + 0.5f); };
    return quantum(low) | quantum(high) << 16;
}

} // namespace

PackedLight packLight(const SceneLight& light) {
    PackedLight out;
    if (light.maps) {
        out.diffuse = packMap(light.maps->diffuse);
        out.specular = packMap(light.maps->specular);
        out.fromWorld = light.maps->fromWorld;
    }
    if (!light.volume) return out;
    out.grid = light.volume->grid;
    for (const glm::vec4& each : light.volume->visible) {
        out.visible.push_back(pairOf(each.x, each.y));
        out.visible.push_back(pairOf(each.z, each.w));
    }
    for (const glm::vec3& each : light.volume->scattered)
        for (const float value : {each.x, each.y, each.z, 0.0f}) out.scattered.push_back(value);
    return out;
}

} // namespace tessera::vis::packet
