#pragma once

#include "volume/field/lattice.h"
#include "volume/field/scalar.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace tessera::volume {

/// Which samples are present: one byte per sample, 1 present, 0 absent, in the order of the samples. Equal masks are
/// shared.
using Mask = std::vector<std::uint8_t>;

/// Whether a sample is present by flags that are empty where all are.
inline bool isPresent(std::span<const std::uint8_t> flags, std::size_t index) {
    return flags.empty() || flags[index] != 0;
}

/// One component of one parameter at one time on one lattice: the samples as stored, x fastest, and how to read them.
/// physical value = offset + scale * stored value.
struct Field {
    Lattice lattice;
    ScalarType type = ScalarType::F32;
    std::vector<std::byte> samples;   ///< lattice.count() numbers of `type`
    std::shared_ptr<const Mask> mask; ///< null: every sample is present
    double offset = 0, scale = 1;

    template <class T> std::span<T> as() { return {reinterpret_cast<T*>(samples.data()), samples.size() / sizeof(T)}; }
    template <class T> std::span<const T> as() const {
        return {reinterpret_cast<const T*>(samples.data()), samples.size() / sizeof(T)};
    }
    std::size_t count() const { return lattice.count(); }
    bool present(std::size_t index) const { return !mask || (*mask)[index] != 0; }
    /// Physical value of one sample, whether present or not.
    double value(std::size_t index) const;
};

/// A field with room for every sample of the lattice, all zero and present.
Field makeField(const Lattice& lattice, ScalarType type);

/// All physical values as double, absent ones included.
std::vector<double> physicalValues(const Field& field);

} // namespace tessera::volume
