#pragma once

#include "volume/field/field.h"

#include <array>
#include <cstdint>

struct XXH3_state_s;

namespace tessera::codec {

/// Hash of a mask, computed incrementally.
class MaskHash {
public:
    using Value = std::array<std::uint64_t, 2>;

    MaskHash();
    ~MaskHash();
    MaskHash(const MaskHash&) = delete;
    MaskHash& operator=(const MaskHash&) = delete;

    void add(const volume::Mask& part);
    /// Adds the flags of a field; without a mask all samples are present.
    void add(const volume::Field& part);
    Value value() const;
    /// Whether any sample is absent.
    bool gaps() const { return gaps_; }

private:
    XXH3_state_s* state_;
    bool gaps_ = false;
};

} // namespace tessera::codec
