#pragma once

#include <cstddef>
#include <new>
#include <sys/mman.h>
#include <type_traits>
#include <utility>
#include <vector>

/// Vectors of numbers whose elements are undefined until they are set: what is written by several threads need not be
/// filled by one before.
namespace tessera::volume {

/// Memory above what the C library keeps (keepFreeMemory()) comes in large pages where the system has such, since each
/// page costs a fault.
template <class T> struct Unfilled {
    static_assert(std::is_trivially_default_constructible_v<T> && std::is_trivially_destructible_v<T>);
    using value_type = T;

    Unfilled() = default;
    template <class Other> Unfilled(const Unfilled<Other>&) {} // NOLINT: as allocators convert

    T* allocate(std::size_t count) {
        const std::size_t bytes = count * sizeof(T);
        void* const made = ::operator new(bytes, alignment(bytes));
#ifdef MADV_HUGEPAGE
        if (bytes >= kLarge) ::madvise(made, bytes, MADV_HUGEPAGE); // if it is possible
#endif
        return static_cast<T*>(made);
    }
    void deallocate(T* from, std::size_t count) noexcept {
        ::operator delete(from, alignment(count * sizeof(T)));
    }

    template <class U, class... Values> void construct(U* at, Values&&... values) {
        if constexpr (sizeof...(Values) == 0)
            ::new (static_cast<void*>(at)) U;
        else
            ::new (static_cast<void*>(at)) U(std::forward<Values>(values)...);
    }
    template <class Other> bool operator==(const Unfilled<Other>&) const {
        return true;
    }

private:
    static constexpr std::size_t kLarge = std::size_t(32) << 20, kPage = std::size_t(2) << 20;
    static std::align_val_t alignment(std::size_t bytes) {
        return std::align_val_t(bytes >= kLarge ? kPage : 64);
    }
};

template <class T> using UnfilledVector = std::vector<T, Unfilled<T>>;

} // namespace tessera::volume
