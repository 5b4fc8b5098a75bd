#include "volume/sources/centred_field.h"

#include "volume/base/parallel.h"
#include "volume/sources/centred_samples.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace tessera::volume {

namespace {

/// Samples of a field in a box.
SampledBox cut(const Field& field, const IndexBox& box) {
    SampledBox out{box, UnfilledVector<float>(box.count()), {}, 1};
    if (field.mask) out.numbers.resize(out.values.size());
    const auto width = std::size_t(box.size().x);
    dispatch(field.type, [&]<class T>(T) {
        const auto stored = field.as<T>();
        std::size_t to = 0;
        for (int z = box.begin.z; z < box.end.z; ++z)
            for (int y = box.begin.y; y < box.end.y; ++y, to += width) {
                const std::size_t row = field.lattice.index({box.begin.x, y, z});
                for (std::size_t x = 0; x < width; ++x)
                    out.values[to + x] = float(field.offset + field.scale * double(stored[row + x]));
                if (field.mask) std::copy_n(&(*field.mask)[row], width, &out.numbers[to]);
            }
    });
    return out;
}

/// The field with samples that are not finite made absent.
Field onlyFinite(Field field) {
    if (field.type != ScalarType::F32) return field;
    const auto isFinite = [](float value) { return std::isfinite(value); };
    if (std::ranges::all_of(field.as<float>(), isFinite)) return field;
    auto mask =
        field.mask ? std::make_shared<Mask>(*field.mask) : std::make_shared<Mask>(field.count(), std::uint8_t(1));
    for (std::size_t i = 0; i < mask->size(); ++i)
        if (!isFinite(field.as<float>()[i])) (*mask)[i] = 0;
    field.mask = std::move(mask);
    return field;
}

} // namespace

Field toCentred(const Field& given, bool categorical, const Progress& progress) {
    const Field source = onlyFinite(given);
    constexpr int kEdge = 32; // texels: what is made at a time
    const Lattice target = bccFor(source.lattice);
    const CentredGrid grid(finestCentred(source.lattice), categorical);
    Field out = makeField(target, ScalarType::F32);
    std::vector<std::uint8_t> mask(source.mask ? target.count() : 0);
    const glm::ivec3 texels = target.texels(), blocks = (texels + kEdge - 1) / kEdge;
    const int perLayer = blocks.x * blocks.y;
    for (int layer = 0; layer < blocks.z; ++layer) {
        progress.advance(double(layer) / blocks.z, "resample");
        parallelFor(std::size_t(perLayer), [&](std::size_t i) {
            const glm::ivec3 begin = glm::ivec3(int(i) % blocks.x, int(i) / blocks.x, layer) * kEdge;
            const IndexBox box{begin, glm::min(begin + kEdge, texels)};
            const auto made = grid.make(cut(source, grid.needed(box, source.mask != nullptr)), box);
            forEachIndex(box, [&](glm::ivec3 at, std::size_t place) {
                for (int s = 0; s < 2; ++s) {
                    if (2 * at.z + s >= target.size.z) continue;
                    const std::size_t to = target.index({at.x, at.y, 2 * at.z + s});
                    out.as<float>()[to] = made[std::size_t(s)].values[place];
                    if (!mask.empty()) mask[to] = made[std::size_t(s)].numberAt(place);
                }
            });
        });
    }
    progress.advance(1, "resample");
    if (!std::ranges::all_of(mask, [](std::uint8_t number) { return number == 1; }))
        out.mask = std::make_shared<const Mask>(std::move(mask));
    return out;
}

} // namespace tessera::volume
