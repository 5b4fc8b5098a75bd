#pragma once

#include <memory>
#include <utility>
#include <vector>

namespace tessera::codec {

/// An allocator that leaves elements uninitialised if they are given no value.
template <class T> struct UnclearedAllocator : std::allocator<T> {
    template <class Other> struct rebind { using other = UnclearedAllocator<Other>; };
    template <class Made> void construct(Made* at) { ::new (static_cast<void*>(at)) Made; }
    template <class Made, class... Values> void construct(Made* at, Values&&... values) {
        std::construct_at(at, std::forward<Values>(values)...);
    }
};

/// A vector that resize does not clear: for large arrays that are written before they are read.
template <class T> using Uncleared = std::vector<T, UnclearedAllocator<T>>;

} // namespace tessera::codec
