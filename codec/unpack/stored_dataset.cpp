#include "codec/unpack/stored_dataset.h"

#include "volume/field/slices.h"

namespace tessera::codec {

volume::Dataset storedDataset(std::shared_ptr<const Archive> archive) {
    volume::Dataset dataset;
    dataset.info = archive->info();
    dataset.read = [archive](int parameter, int component, int time, volume::SliceRange slices) {
        const volume::BrickGrid& grid = archive->grid();
        if (slices.isAllOf(grid.lattice)) return readField(*archive, parameter, component, time);
        const auto [first, count] = slices.of(grid.lattice);
        const int perLayer = grid.end(glm::ivec3(0)).z; // slices per brick layer
        const int layer = first / perLayer, end = (first + count + perLayer - 1) / perLayer;
        const volume::Field layers = readLayers(*archive, parameter, component, time, layer, end);
        return volume::slicesOf(layers, first - grid.begin({0, 0, layer}).z, count);
    };
    return dataset;
}

} // namespace tessera::codec
