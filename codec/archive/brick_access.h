#pragma once

#include "codec/brick/brick_codec.h"
#include "codec/container/index.h"
#include "volume/bricks/brick_grid.h"
#include "volume/field/dataset.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <glm/vec3.hpp>

/// Helpers shared by the writer and the reader of an archive.
namespace tessera::codec {

/// Bytes of the samples of a full-size brick.
inline std::size_t brickBytes(const volume::BrickGrid& grid, volume::ScalarType type) {
    const std::size_t edge = std::size_t(grid.brickSize),
                      sublattices = grid.lattice.kind == volume::LatticeKind::BCC ? 2 : 1;
    return std::min(edge * edge * edge * sublattices, grid.lattice.count()) * volume::byteSize(type);
}

inline BrickFormat brickFormat(const volume::BrickGrid& grid, glm::ivec3 brick, volume::ScalarType type,
                               const FrameRecord& frame) {
    return {grid.lattice.kind,
            grid.brickSamples(brick, 0),
            grid.levels,
            frame.wavelet,
            type,
            frame.numbers,
            frame.keepsAbsent,
            frame.codeBits,
            frame.bodyCentred,
            frame.steps,
            frame.subsampled,
            frame.mixed};
}
/// The format of the same brick in another frame of its component.
inline BrickFormat brickFormat(const BrickFormat& brick, const FrameRecord& frame) {
    return {brick.kind,        brick.size,     brick.levels,      frame.wavelet, brick.type,       frame.numbers,
            frame.keepsAbsent, frame.codeBits, frame.bodyCentred, frame.steps,   frame.subsampled, frame.mixed};
}

/// Number of components of all parameters before one: the index of its first frame within a time.
inline std::size_t firstComponent(const volume::DatasetInfo& info, int parameter) {
    std::size_t first = 0;
    for (int p = 0; p < parameter; ++p) first += std::size_t(info.parameters[std::size_t(p)].components);
    return first;
}
/// The parameter of a component, counted through all parameters.
inline std::size_t parameterOf(const volume::DatasetInfo& info, std::size_t component) {
    std::size_t parameter = 0;
    while (component >= std::size_t(info.parameters[parameter].components))
        component -= std::size_t(info.parameters[parameter++].components);
    return parameter;
}
inline std::size_t componentCount(const volume::DatasetInfo& info) {
    return firstComponent(info, int(info.parameters.size()));
}

/// Calls `visit(offset in the lattice, offset in the brick, length)` for each row of a brick.
template <class Visit> void forBrickRows(const volume::BrickGrid& grid, glm::ivec3 brick, Visit&& visit) {
    const glm::ivec3 begin = grid.begin(brick), size = grid.end(brick) - begin;
    std::size_t inBrick = 0;
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y, inBrick += std::size_t(size.x))
            visit(grid.lattice.index(begin + glm::ivec3(0, y, z)), inBrick, std::size_t(size.x));
}

} // namespace tessera::codec
