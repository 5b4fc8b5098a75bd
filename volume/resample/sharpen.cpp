#include "volume/resample/sharpen.h"

#include "volume/field/for_slices.h"
#include "volume/resample/opposite_pairs.h"

namespace tessera::volume {

Field sharpened(const Field& source, double amount, const StoredExtent& extent) {
    const Lattice& lattice = source.lattice;
    Field out = source;
    dispatch(source.type, [&]<class T>(T) {
        const auto stored = source.as<T>();
        const auto to = out.as<T>();
        const StoredRange<T> range(extent);
        const PartNumbers number{source.mask.get()};
        forSlices(lattice, {}, [&](int k) {
            std::size_t index = lattice.index({0, 0, k});
            for (int j = 0; j < lattice.size.y; ++j)
                for (int i = 0; i < lattice.size.x; ++i, ++index) {
                    const std::uint8_t own = number(index);
                    if (own == 0) continue;
                    double difference = 0, count = 0;
                    forOppositePairs(lattice, {i, j, k}, [&](std::size_t a, std::size_t b) {
                        count += 2;
                        if (number(a) != own || number(b) != own)
                            return; // extrapolated linearly: second difference is 0
                        difference += double(stored[a]) - double(stored[index]);
                        difference += double(stored[b]) - double(stored[index]);
                    });
                    to[index] = range.store(double(stored[index]) - amount * difference / count, own);
                }
        });
    });
    return out;
}

Field sharpened(const Field& source, double amount) {
    StoredExtent extent;
    extent.add(source);
    return sharpened(source, amount, extent);
}

} // namespace tessera::volume
