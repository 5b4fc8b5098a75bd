#pragma once

#include "codec/archive/archive.h"
#include "codec/bytes/lzma.h"
#include "codec/pack/pack.h"
#include "tests/codec/make_dataset.h"
#include "tests/codec/sealed_file.h"
#include "volume/field/own_axes.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

/// Small archives whose metadata, or records of whose index, are changed behind right checksums, as only a bad hand
/// does it.
///
/// An input names one of the archives (first byte), and changes of it: a byte each for what is changed, the place and
/// the value. Beyond its end all bytes are 0.
namespace tessera::changed_archives {

using codec::Bytes;
using codec::testing::TemporaryFolder;
using codec::testing::Texture;
using nlohmann::json;
using volume::ScalarType;

/// The bytes of an input; 0 beyond its end.
class Input {
public:
    Input(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}
    bool empty() const { return left_ == 0; }
    std::uint64_t byte() {
        if (left_ == 0) return 0;
        --left_;
        return *data_++;
    }
    /// Below `count`, which is not 0.
    std::size_t below(std::size_t count) { return std::size_t(byte() * 256 + byte()) * count / 65536; }

private:
    const std::uint8_t* data_;
    std::size_t left_;
};

/// An archive in parts that can be changed.
struct Parts {
    codec::Header header;
    Bytes chunks; ///< all before the last metadata and page
    json metadata;
    Bytes page; ///< the last one, as records
};

inline Bytes decoded(std::span<const std::byte> block) {
    Bytes out;
    if (codec::decodeBlock(block, out) != codec::DecodeStatus::Ok) std::abort();
    return out;
}

inline Parts partsOf(const std::vector<char>& file) {
    const auto bytes = std::as_bytes(std::span(file));
    Parts parts;
    parts.header = codec::parseHeaders(bytes, bytes.size(), "made").header;
    const codec::Block &metadata = parts.header.metadata, &index = parts.header.index;
    if (metadata.offset + metadata.length != index.offset) std::abort();
    parts.chunks.assign(bytes.begin(), bytes.begin() + std::ptrdiff_t(metadata.offset));
    const Bytes text = decoded(bytes.subspan(metadata.offset, metadata.length));
    parts.metadata = json::parse(reinterpret_cast<const char*>(text.data()),
                                 reinterpret_cast<const char*>(text.data()) + text.size());
    parts.page = decoded(bytes.subspan(index.offset, index.length));
    return parts;
}

inline std::vector<char> joined(const Parts& parts) {
    Bytes file = parts.chunks;
    codec::Header header = parts.header;
    const auto add = [&](const Bytes& block) {
        file.insert(file.end(), block.begin(), block.end());
        return codec::Block{file.size() - block.size(), block.size(), codec::checksum(block)};
    };
    const std::string text = parts.metadata.dump(-1, ' ', false, json::error_handler_t::replace);
    header.metadata = add(codec::encodeBlock(std::as_bytes(std::span(text)), true));
    header.index = add(codec::encodeBlock(parts.page, true));
    return codec::testing::sealed(header, std::move(file));
}

inline std::vector<Parts> makeArchives() {
    const TemporaryFolder folder;
    std::vector<Parts> all;
    const auto add = [&](glm::ivec3 size, int times, codec::StoredLattice lattice, double maxError, bool parts,
                         bool uneven = false) {
        volume::Dataset made =
            codec::testing::makeDataset(size,
                                        {{"T", ScalarType::F32, 1, Texture::Smooth, true, false},
                                         {"U", ScalarType::F32, 3, Texture::Decimals, false, false},
                                         {"n", ScalarType::I16, 1, Texture::Smooth, false, false},
                                         {"region", ScalarType::U8, 1, Texture::Sparse, false, true}},
                                        times);
        if (parts) made.info.parameters[0].parts = {"region", {{0}, {1}}};
        made.info.quantities = {{"voltage", "V", std::vector<double>(std::size_t(times), 0.7)}};
        if (uneven) {
            std::vector<double> places;
            for (int i = 0; i <= size.z; ++i) places.push_back(0.1 * i * i);
            const auto cells = std::make_shared<const volume::AxisMap>(volume::AxisMap::Of::Cells, places);
            places.resize(std::size_t(size.x), 1e3);
            const auto points = std::make_shared<const volume::AxisMap>(volume::AxisMap::Of::Points, places);
            made.info.lattice = volume::withAxes(made.info.lattice, {{points, nullptr, cells}});
            made.info.bounds = volume::gridBounds(made.info.lattice);
        }
        codec::PackOptions options;
        options.brickSize = 8;
        options.lattice = lattice;
        options.maxError = maxError;
        codec::pack(made, options, folder / "made.tsr");
        all.push_back(partsOf(codec::testing::readFile(folder / "made.tsr")));
    };
    add({12, 9, 10}, 2, codec::StoredLattice::CC, 0, true);
    add({12, 9, 10}, 2, codec::StoredLattice::CC, 1e-2, true);
    add({12, 9, 10}, 1, codec::StoredLattice::BCC, 1e-2, false);
    add({8, 7, 9}, 8, codec::StoredLattice::D4, 1e-2, false);
    add({90, 1, 1}, 1, codec::StoredLattice::CC, 0, false);
    add({9, 6, 10}, 1, codec::StoredLattice::CC, 0, true, true);
    add({9, 6, 10}, 2, codec::StoredLattice::BCC, 1e-2, false, true);
    return all;
}

/// Everything in a document, containers before what they hold.
inline void collect(json& node, std::vector<json*>& all) {
    all.push_back(&node);
    for (json& child : node)
        if (node.is_structured()) collect(child, all);
}

inline double number(Input& in) {
    constexpr double kNumbers[] = {0,
                                   1,
                                   -1,
                                   2,
                                   3,
                                   7,
                                   0.5,
                                   255,
                                   256,
                                   32767,
                                   65536,
                                   1 << 24,
                                   1e9,
                                   1e18,
                                   1e300,
                                   1e-300,
                                   1e-18,
                                   -1e300,
                                   2147483647,
                                   -2147483648.0,
                                   4294967296.0,
                                   1e-5,
                                   16,
                                   5e-324,
                                   1.8446744073709552e19};
    return kNumbers[in.below(std::size(kNumbers))];
}

inline json value(Input& in, const json& before) {
    switch (in.byte() % 8) {
    case 0:
    case 1: {
        const double wanted = number(in);
        const bool isWhole = std::abs(wanted) < 9e15 && wanted == std::trunc(wanted);
        return isWhole ? json(std::int64_t(wanted)) : json(wanted);
    }
    case 2:
        if (before.is_number_integer()) return before.get<std::int64_t>() + std::int64_t(in.byte()) - 128;
        return before.is_number() ? json(before.get<double>() * number(in)) : json(number(in));
    case 3:
        return before.is_number() ? json(-before.get<double>()) : json(std::string(in.below(300), 'x'));
    case 4:
        return json(std::string("a\0\x1b[31m\xff\n=1", 10));
    case 5:
        return json(nullptr);
    case 6:
        return json(in.byte() % 2 == 0);
    default:
        return in.byte() % 2 == 0 ? json::array() : json::object();
    }
}

inline void changeMetadata(Input& in, json& metadata) {
    std::vector<json*> all;
    collect(metadata, all);
    json& node = *all[in.below(all.size())];
    const std::uint64_t how = in.byte() % 8;
    if (how == 0 && node.is_array() && !node.empty()) {
        node.erase(in.below(node.size()));
    } else if (how == 1 && node.is_array() && !node.empty()) {
        const json copy = node[in.below(node.size())];
        for (std::uint64_t n = in.byte() + 1; n > 0; --n) node.push_back(copy);
    } else if (how == 2) {
        const json copy = *all[in.below(all.size())];
        node = copy;
    } else if (how == 3 && node.is_object() && !node.empty()) {
        node.erase(std::next(node.begin(), std::ptrdiff_t(in.below(node.size()))));
    } else {
        node = value(in, node);
    }
}

/// Overwrites 1, 2, 4 or 8 bytes of the index.
inline void changeIndex(Input& in, Bytes& page) {
    const std::size_t width = std::size_t(1) << in.byte() % 4;
    const std::size_t at = in.below(page.size() - width + 1);
    std::uint64_t bits = 0;
    switch (in.byte() % 4) {
    case 0:
        bits = std::bit_cast<std::uint64_t>(number(in));
        break;
    case 1:
        bits = std::uint64_t(std::bit_cast<std::uint32_t>(float(number(in))));
        break;
    case 2:
        bits = std::uint64_t(std::int64_t(in.byte()) - 128);
        break;
    default:
        bits = std::uint64_t(1) << in.byte() % 64;
    }
    std::memcpy(page.data() + at, &bits, width);
}

/// The archive that an input stands for.
inline std::vector<char> archiveOf(const std::uint8_t* data, std::size_t size) {
    static const std::vector<Parts> archives = makeArchives();
    Input in(data, size);
    Parts parts = archives[std::size_t(in.byte()) % archives.size()];
    while (!in.empty()) {
        if (in.byte() % 4 == 0)
            changeIndex(in, parts.page);
        else
            changeMetadata(in, parts.metadata);
    }
    return joined(parts);
}

} // namespace tessera::changed_archives
