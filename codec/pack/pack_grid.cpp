#include "codec/pack/pack_grid.h"

#include "codec/archive/frame_options.h"
#include "volume/base/error.h"

#include <algorithm>
#include <bit>
#include <string>

namespace tessera::codec {

namespace {

using volume::LatticeKind;
using volume::ScalarType;

int defaultLevels(const volume::Lattice& lattice, int brickSize) {
    const glm::ivec3 texels = lattice.texels();
    const int longest = std::min(brickSize, std::max({texels.x, texels.y, texels.z}));
    int levels = 1;
    while (longest >> levels >= 4) ++levels;
    return levels;
}

/// The automatic brick size. Three kinds of data get bricks that are larger than usual, if a usual one does not hold
/// them:
///  - Numbers within an error bound, since every face of a brick costs bytes: volumes so small that a view reads them
///    whole anyway. Thresholds and omitted bricks depend on the importance of each brick, for which small ones are
///    better.
///  - Integers packed with the most effort, as fitted predictions need their neighbours as well.
///  - Repetition, which only integers that were not resampled have, is only found within a brick, so small data of that
///    kind get one large brick.
/// Archives that grow keep their brick size.
int brickSizeFor(const volume::Lattice& lattice, const volume::DatasetInfo& source, const PackOptions& options,
                 const Archive* grown) {
    constexpr int kUsual = 64, kLargest = 128;
    constexpr std::size_t kSmall = 1 << 19, kReadWhole = 1 << 21; // samples
    if (options.brickSize != 0) return options.brickSize;
    if (grown) return grown->grid().brickSize;
    const glm::ivec3 texels = lattice.texels();
    if (std::max({texels.x, texels.y, texels.z}) <= kUsual) return kUsual;
    const auto isFloat = [](const volume::Parameter& parameter) { return parameter.type == ScalarType::F32; };
    const bool bounded = (options.maxError > 0 || options.absError > 0 || options.psnr > 0 || options.sizeMb > 0) &&
                         !hasThreshold(options) && options.discard == 0;
    const auto isLabel = [](const volume::Parameter& parameter) { return parameter.categorical; };
    if (bounded && lattice.count() <= kReadWhole && !std::ranges::all_of(source.parameters, isLabel)) return kLargest;
    const bool isInteger = std::ranges::none_of(source.parameters, isFloat);
    if (options.effort >= kLongestEffort && isInteger && !hasThreshold(options) && options.discard == 0)
        return kLargest;
    const glm::ivec3 size = lattice.size;
    const bool one = lattice.kind == LatticeKind::CC && lattice == source.lattice && source.times.size() == 1 &&
                     lattice.count() <= kSmall && std::max({size.x, size.y, size.z}) <= kLargest && isInteger;
    return one ? kLargest : kUsual;
}

} // namespace

volume::BrickGrid gridFor(const volume::Lattice& lattice, const volume::DatasetInfo& source, const PackOptions& options,
                          const Archive* grown) {
    const int brickSize = brickSizeFor(lattice, source, options, grown);
    volume::BrickGrid grid{lattice, brickSize, options.levels,
                           levelPhase(waveletOf(options.wavelet).value_or(Wavelet::W22))};
    if (brickSize < 4 || brickSize > 128 || !std::has_single_bit(unsigned(brickSize)))
        throw Error("the brick size must be a power of two from 4 to 128, not " + std::to_string(brickSize));
    if (grid.levels == 0) grid.levels = defaultLevels(lattice, grid.brickSize);
    if (grid.levels < 1 || grid.levels > int(std::bit_width(unsigned(grid.brickSize))))
        throw Error(std::to_string(grid.levels) + " levels do not fit bricks of " + std::to_string(grid.brickSize));
    return grid;
}

int layersOfTeam(const volume::BrickGrid& grid, const volume::DatasetInfo& info) {
    constexpr int kMostFiles = 512;
    int components = 1;
    for (const volume::Parameter& parameter : info.parameters) components = std::max(components, parameter.components);
    const int slabs = std::max(1, kMostFiles / (components + 2));
    return (grid.count().z + slabs - 1) / slabs;
}

} // namespace tessera::codec
