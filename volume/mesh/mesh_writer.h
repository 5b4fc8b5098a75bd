#pragma once

#include "volume/base/progress.h"
#include "volume/system/atomic_file.h"

#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <functional>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>

namespace tessera::volume {

static_assert(std::endian::native == std::endian::little, "files of meshes are little-endian");

/// A file of a mesh: numbers as they are in memory and texts, buffered. It appears complete, by commit(), or not at
/// all.
class MeshWriter {
public:
    MeshWriter(const std::string& path, const Progress& progress) : file_(path), progress_(progress) {}

    void text(std::string_view piece) { buffer_ += piece; }
    template <class T> void raw(const T& value) {
        char bytes[sizeof(T)];
        std::memcpy(bytes, &value, sizeof(T));
        buffer_.append(bytes, sizeof(T));
    }
    void vector(const glm::vec3& v) {
        for (int i = 0; i < 3; ++i) raw(v[i]);
    }
    void number(auto value) {
        char digits[32];
        buffer_.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
    }
    /// Calls `one(i)` for each of `count` items, flushing when the buffer is full.
    void each(std::size_t count, const std::function<void(std::size_t)>& one) {
        for (std::size_t i = 0; i < count; ++i) {
            one(i);
            if (buffer_.size() < std::size_t(1) << 20) continue;
            flush();
            progress_.advance(double(i) / double(count));
        }
    }
    void commit() {
        flush();
        file_.commit();
    }

private:
    void flush() {
        file_.write(buffer_);
        buffer_.clear();
    }
    AtomicFile file_;
    const Progress& progress_;
    std::string buffer_;
};

} // namespace tessera::volume
