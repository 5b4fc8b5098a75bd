#pragma once

#include "app/importer/readers/check_file.h"
#include "volume/base/utf8.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string>

/// The basic values in binary Tecplot files.
namespace tessera::importer {

/// Reads a number in the file's byte order.
template <class T> T numberAt(const char* bytes, bool swap) {
    char raw[sizeof(T)];
    std::memcpy(raw, bytes, sizeof raw);
    if (swap) std::reverse(raw, raw + sizeof raw);
    return std::bit_cast<T>(raw);
}

/// Reads a file from its beginning. `place` names the section for the error message of a truncated file.
class Bytes {
public:
    explicit Bytes(const std::string& path) : in_(path, std::ios::binary), size_(bytesIn(path)) {}

    std::string place = "its header";
    bool swap = false;

    std::uint64_t at() const { return at_; }
    std::uint64_t left() const { return size_ - at_; }
    void skip(std::uint64_t count) {
        need(count);
        at_ += count;
        in_.seekg(static_cast<std::streamoff>(at_));
    }
    template <class T> T next() {
        need(sizeof(T));
        char raw[sizeof(T)] = {};
        in_.read(raw, sizeof raw);
        at_ += sizeof raw;
        return numberAt<T>(raw, swap);
    }
    std::int32_t integer() { return next<std::int32_t>(); }
    std::size_t count(const char* what) {
        const std::int32_t value = integer();
        if (value < 0) throw std::runtime_error("has a bad number of " + std::string(what) + " in " + place);
        return static_cast<std::size_t>(value);
    }
    /// A flag, stored as an integer.
    bool flag() {
        const std::int32_t value = integer();
        if (value != 0 && value != 1) throw std::runtime_error("is damaged in " + place);
        return value == 1;
    }
    /// A text stored as one integer per byte, ended by 0: UTF-8, or Latin-1 in old files.
    std::string text() {
        std::string out;
        bool eight = false;
        while (const std::int32_t code = integer()) {
            if (code < -128 || code > 255) throw std::runtime_error("has a bad name in " + place);
            out += code > 0 && code < ' ' ? ' ' : static_cast<char>(code);
            eight = eight || out.back() < 0;
        }
        return eight && !isUtf8(out) ? fromLatin(out) : out;
    }

private:
    void need(std::uint64_t count) const {
        if (count > left())
            throw std::runtime_error("ends within " + place + ": truncated at byte " + std::to_string(size_));
    }
    std::ifstream in_;
    std::uint64_t size_, at_ = 0;
};

} // namespace tessera::importer
