#pragma once

#include "volume/base/error.h"
#include "volume/import/foreign.h"
#include "volume/import/import.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <iterator>
#include <string>
#include <unistd.h>
#include <vector>

/// Files of other programs, written by hand for the tests of tessera-import.
namespace tessera::volume {

namespace fs = std::filesystem;

template <class T> std::string bytesOf(T value, bool swap = false) {
    std::string out(sizeof value, '\0');
    std::memcpy(out.data(), &value, sizeof value);
    if (swap) std::reverse(out.begin(), out.end());
    return out;
}
template <class T> std::string bytesOf(const std::vector<T>& values, bool swap = false) {
    std::string out;
    for (const T value : values) out += bytesOf(value, swap);
    return out;
}
/// A word in so many bytes.
inline std::string inBytes(std::string word, std::size_t bytes) {
    word.resize(bytes, '\0');
    return word;
}

/// A zlib (else gzip) stream of stored blocks.
inline std::string stored(const std::string& text, bool zlib) {
    std::string out = zlib ? std::string("\x78\x01", 2) : std::string("\x1f\x8b\x08\0\0\0\0\0\0\xff", 10);
    std::uint32_t a = 1, b = 0, crc = ~0u;
    for (std::size_t at = 0; at < text.size() || at == 0;) {
        const auto count = static_cast<std::uint16_t>(std::min<std::size_t>(text.size() - at, 1000));
        out += char(at + count == text.size() ? 1 : 0);
        out += bytesOf(count) + bytesOf(static_cast<std::uint16_t>(~count)) + text.substr(at, count);
        at += count;
        if (count == 0) break;
    }
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        a = (a + byte) % 65521;
        b = (b + a) % 65521;
        crc ^= byte;
        for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0xedb88320u : 0u);
    }
    return out + (zlib ? bytesOf((b << 16) | a, true) : bytesOf(~crc) + bytesOf(std::uint32_t(text.size())));
}

/// Path of optional data; "" when absent.
inline std::string testData(const std::string& name) {
    const char* named = std::getenv("TESSERA_DATA");
    const fs::path path = fs::path(named != nullptr ? named : TESSERA_TEST_DATA) / name;
    return fs::exists(path) ? path.string() : std::string();
}

class ForeignFiles : public testing::Test {
protected:
    void SetUp() override {
        if (findImporter().empty()) GTEST_SKIP() << "tessera-import was not built";
        folder_ = fs::temp_directory_path() / ("tessera_foreign_" + std::to_string(getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override {
        if (!folder_.empty()) fs::remove_all(folder_);
    }
    std::string write(const std::string& name, const std::string& bytes) const {
        fs::create_directories((folder_ / name).parent_path());
        std::ofstream(folder_ / name, std::ios::binary) << bytes;
        return (folder_ / name).string();
    }
    static std::string read(const std::string& path) {
        std::ifstream in(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    static std::string failure(const std::string& path, const ImportOptions& options = {}) {
        try {
            const Dataset dataset = openFiles({path}, options);
            dataset.read(0, 0, 0);
            return "";
        } catch (const Error& error) {
            return error.what();
        }
    }
    /// Everything a data set holds, as text: names, grid, times, and each present sample.
    static std::string contents(const std::string& path, const ImportOptions& options = {}) {
        const Dataset dataset = openFiles({path}, options);
        const DatasetInfo& info = dataset.info;
        std::string out = bytesOf(info.lattice.size) + bytesOf(info.lattice.spacing) + bytesOf(info.lattice.origin) +
                          bytesOf(info.times);
        for (std::size_t p = 0; p < info.parameters.size(); ++p) {
            out += info.parameters[p].name + "|" + info.parameters[p].unit + "|";
            for (int c = 0; c < info.parameters[p].components; ++c)
                for (std::size_t t = 0; t < info.times.size(); ++t) {
                    const Field field = dataset.read(int(p), c, int(t));
                    for (std::size_t i = 0; i < field.count(); ++i)
                        out += field.present(i) ? bytesOf(field.value(i)) : "-";
                }
        }
        return out;
    }
    /// Cuts `cut` (a file that opening `path` reads) at many places: each time either one line of reason, or exactly
    /// what the whole file holds. Gives how many cuts were refused.
    int expectCutsAreTold(const std::string& path, const std::string& cut, const ImportOptions& options = {},
                          int cuts = 10) const {
        const std::string whole = read(cut), wanted = contents(path, options);
        EXPECT_FALSE(whole.empty()) << cut;
        std::vector<std::size_t> sizes;
        for (int i = 0; i < cuts; ++i) sizes.push_back(whole.size() * std::size_t(i) / std::size_t(cuts));
        for (const std::size_t less : {1u, 2u, 5u, 17u, 40u})
            if (whole.size() > less) sizes.push_back(whole.size() - less);
        int refused = 0;
        for (const std::size_t size : sizes) {
            std::ofstream(cut, std::ios::binary) << whole.substr(0, size);
            try {
                const bool same = contents(path, options) == wanted;
                EXPECT_TRUE(same) << cut << " cut at byte " << size << " of " << whole.size();
            } catch (const Error& error) {
                const std::string line = error.what();
                EXPECT_EQ(line.find('\n'), std::string::npos) << line;
                EXPECT_THAT(line, testing::HasSubstr(folder_.filename().string())) << "names the file";
                ++refused;
            }
        }
        std::ofstream(cut, std::ios::binary) << whole;
        EXPECT_GE(refused, cuts / 2) << cut;
        return refused;
    }
    fs::path folder_;
};

} // namespace tessera::volume
