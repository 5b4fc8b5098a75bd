#pragma once

#include "volume/field/field.h"

#include <array>
#include <cstdint>

struct XXH3_state_s;

namespace tessera::codec {

/// Hash of a mask, computed part by part.
class MaskHash {
public:
    using Value = std::array<std::uint64_t, 2>;

    MaskHash();
    ~MaskHash();
    MaskHash(const MaskHash&) = delete;
    MaskHash& operator=(const MaskHash&) = delete;

    void add(const volume::Mask& part);
    /// Adds a part; a field without a mask has all samples present.
    void add(const volume::Field& part);
    Value value() const;
    /// Whether anything is absent.
    bool gaps() const { return gaps_; }

private:
    XXH3_state_s* state_;
    bool gaps_ = false;
};

} // namespace tessera::codec
