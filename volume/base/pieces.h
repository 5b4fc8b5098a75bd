#pragma once

#include <cstddef>
#include <cstring>
#include <functional>
#include <span>
#include <type_traits>
#include <vector>

/// Work in pieces that may be done elsewhere.
namespace tessera {

/// Does `count` pieces of work, and returns what `work(piece)` gave for each of them, in their order. Where processes
/// share the work, it is called in one of them for each piece.
using Pieces = std::function<std::vector<std::vector<std::byte>>(
    std::size_t count, const std::function<std::vector<std::byte>(std::size_t piece)>& work)>;

/// All pieces here, one after the other.
inline std::vector<std::vector<std::byte>> piecesHere(std::size_t count,
                                                      const std::function<std::vector<std::byte>(std::size_t)>& work) {
    std::vector<std::vector<std::byte>> results;
    for (std::size_t piece = 0; piece < count; ++piece) results.push_back(work(piece));
    return results;
}

/// The same for values: what `work(piece)` gave for the pieces, one after the other.
template <class T>
std::vector<T> valuesOf(const Pieces& pieces, std::size_t count,
                        const std::function<std::vector<T>(std::size_t piece)>& work) {
    static_assert(std::is_trivially_copyable_v<T>);
    std::vector<T> values;
    for (const std::vector<std::byte>& bytes : pieces(count, [&](std::size_t piece) {
             const std::vector<T> own = work(piece);
             const auto of = std::as_bytes(std::span(own));
             return std::vector<std::byte>(of.begin(), of.end());
         })) {
        const std::size_t before = values.size();
        values.resize(before + bytes.size() / sizeof(T));
        if (!bytes.empty()) std::memcpy(values.data() + before, bytes.data(), bytes.size());
    }
    return values;
}

} // namespace tessera
