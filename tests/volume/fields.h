#pragma once

#include "volume/field/dataset.h"
#include "volume/field/field.h"

#include <memory>
#include <vector>

/// Small fields for tests.
namespace tessera::volume::test {

/// Samples `value(position)` as T on a lattice.
template <class T, class Function> Field sampled(const Lattice& lattice, const Function& value) {
    Field field = makeField(lattice, scalarTypeOf<T>());
    const auto out = field.as<T>();
    for (int k = 0; k < lattice.size.z; ++k)
        for (int j = 0; j < lattice.size.y; ++j)
            for (int i = 0; i < lattice.size.x; ++i)
                out[lattice.index({i, j, k})] = static_cast<T>(value(lattice.position({i, j, k})));
    return field;
}

/// Makes samples absent where `absent(position)`.
template <class Function> void removeWhere(Field& field, const Function& absent) {
    auto mask = std::make_shared<Mask>(field.count(), std::uint8_t(1));
    const Lattice& lattice = field.lattice;
    for (int k = 0; k < lattice.size.z; ++k)
        for (int j = 0; j < lattice.size.y; ++j)
            for (int i = 0; i < lattice.size.x; ++i)
                if (absent(lattice.position({i, j, k}))) (*mask)[lattice.index({i, j, k})] = 0;
    field.mask = mask;
}

inline Lattice ccLattice(glm::ivec3 size, glm::dvec3 spacing = glm::dvec3(1), glm::dvec3 origin = glm::dvec3(0)) {
    return {LatticeKind::CC, size, spacing, origin};
}

inline Box boxOf(const Lattice& cc) {
    return {cc.origin, cc.origin + cc.spacing * glm::dvec3(cc.size - 1)};
}

/// A data set of one component per parameter, all on one lattice: fields[parameter * times + time].
inline Dataset datasetOf(std::vector<Field> fields, std::size_t times = 1) {
    Dataset dataset;
    dataset.info.name = "test";
    dataset.info.lattice = fields.front().lattice;
    dataset.info.bounds = boxOf(fields.front().lattice);
    dataset.info.times.clear();
    for (std::size_t t = 0; t < times; ++t) dataset.info.times.push_back(double(t));
    for (std::size_t p = 0; p < fields.size() / times; ++p) {
        Parameter parameter;
        parameter.name = "p" + std::to_string(p);
        parameter.type = fields[p * times].type;
        dataset.info.parameters.push_back(parameter);
    }
    auto shared = std::make_shared<const std::vector<Field>>(std::move(fields));
    dataset.read = [shared, times](int parameter, int, int time) {
        return (*shared)[std::size_t(parameter) * times + std::size_t(time)];
    };
    return dataset;
}

} // namespace tessera::volume::test
