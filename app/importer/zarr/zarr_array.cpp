#include "app/importer/zarr/zarr_array.h"

#include "app/importer/readers/check_file.h"
#include "app/importer/zarr/zarr_codecs.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vtkType.h>

namespace tessera::importer {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr std::size_t kMostChunks = 4'000'000, kMostChunkBytes = std::size_t(2'000'000'000);

std::vector<std::size_t> sizesIn(const json& about, const char* key) {
    const auto list = about.find(key);
    if (list == about.end() || !list->is_array() || list->size() > 16)
        throw std::runtime_error(std::string("is damaged: its ") + key + " is missing");
    std::vector<std::size_t> sizes;
    for (const json& item : *list) {
        if (!item.is_number_integer() || item.get<std::int64_t>() < 0 ||
            item.get<std::int64_t>() > std::int64_t(1) << 40)
            throw std::runtime_error(std::string("is damaged: its ") + key + " holds no sizes");
        sizes.push_back(item.get<std::size_t>());
    }
    return sizes;
}

void readType(const json& about, ZarrArray& array) {
    const auto type = about.find("dtype");
    if (type == about.end() || !type->is_string()) throw std::runtime_error("holds records, not numbers");
    const std::string text = type->get<std::string>();
    const std::string size = text.size() > 2 ? text.substr(2) : "";
    const bool known =
        text.size() == 3 && std::string("<>|").find(text[0]) != std::string::npos &&
        ((text[1] == 'f' && (size == "2" || size == "4" || size == "8")) ||
         ((text[1] == 'i' || text[1] == 'u') && (size == "1" || size == "2" || size == "4" || size == "8")) ||
         (text[1] == 'b' && size == "1"));
    if (!known) throw std::runtime_error("holds the type " + text.substr(0, 20) + ", which is no number that is read");
    array.bigEndian = text[0] == '>';
    array.kind = text[1];
    array.bytes = std::size_t(size[0] - '0');
}

void readFill(const json& about, ZarrArray& array) {
    const auto fill = about.find("fill_value");
    if (fill == about.end() || fill->is_null()) return;
    if (fill->is_number()) array.fill = fill->get<double>();
    if (fill->is_boolean()) array.fill = fill->get<bool>() ? 1 : 0;
    if (!fill->is_string()) return;
    const double kInfinity = std::numeric_limits<double>::infinity();
    const std::string word = fill->get<std::string>();
    if (word == "NaN") array.fill = std::numeric_limits<double>::quiet_NaN();
    if (word == "Infinity") array.fill = kInfinity;
    if (word == "-Infinity") array.fill = -kInfinity;
}

void readFilters(const json& about, ZarrArray& array) {
    const auto name = [](const json& codec) {
        const auto id = codec.is_object() ? codec.find("id") : codec.end();
        if (!codec.is_object() || id == codec.end() || !id->is_string()) return std::string("?");
        return id->get<std::string>();
    };
    if (const auto codec = about.find("compressor"); codec != about.end() && !codec->is_null())
        array.compressor = name(*codec);
    if (!knowsCompressor(array.compressor))
        throw std::runtime_error("is compressed by " + array.compressor.substr(0, 40) + ", which is not read");
    const auto filters = about.find("filters");
    if (filters == about.end() || !filters->is_array() || filters->empty()) return;
    const json& first = filters->front();
    const auto size = first.is_object() ? first.find("elementsize") : first.end();
    if (filters->size() > 1 || name(first) != "shuffle" || !size->is_number_integer())
        throw std::runtime_error("is stored through the filter " + name(first).substr(0, 40) + ", which is not read");
    array.shuffled = std::size_t(std::clamp<std::int64_t>(size->get<std::int64_t>(), 1, 255));
}

float ofHalf(std::uint16_t half) {
    const int exponent = (half >> 10) & 31, mantissa = half & 1023;
    const float sign = (half & 0x8000) != 0 ? -1.0f : 1.0f;
    if (exponent == 31)
        return mantissa != 0 ? std::numeric_limits<float>::quiet_NaN() : sign * std::numeric_limits<float>::infinity();
    if (exponent == 0) return sign * std::ldexp(float(mantissa), -24);
    return sign * std::ldexp(float(mantissa + 1024), exponent - 25);
}

std::string chunkFile(const ZarrArray& array, const std::vector<std::size_t>& index) {
    std::string name;
    for (const std::size_t n : index) name += (name.empty() ? "" : std::string(1, array.separator)) + std::to_string(n);
    return (fs::path(array.folder) / (name.empty() ? "0" : name)).string();
}

/// Calls body(index) for each index below `count` by axis, the last axis fastest.
void eachIndex(const std::vector<std::size_t>& count, const auto& body) {
    std::vector<std::size_t> index(count.size(), 0);
    for (const std::size_t n : count)
        if (n == 0) return;
    for (;;) {
        body(index);
        std::size_t axis = count.size();
        while (axis > 0 && ++index[axis - 1] == count[axis - 1]) index[--axis] = 0;
        if (axis == 0) return;
    }
}

std::size_t chunkBytes(const ZarrArray& array) {
    double bytes = double(array.bytes);
    for (const std::size_t n : array.chunks) bytes *= double(n);
    if (bytes > double(kMostChunkBytes)) throw std::runtime_error("has chunks of more than 2 GB, which are not read");
    return std::size_t(bytes);
}

/// The bytes of a chunk in the order of the machine; empty where the chunk is not stored.
std::vector<char> chunkAt(const ZarrArray& array, const std::vector<std::size_t>& index, std::size_t bytes) {
    const std::string path = chunkFile(array, index);
    std::error_code missing;
    if (!fs::is_regular_file(path, missing)) return {};
    const std::string stored = readWhole(path);
    refuseHollow(double(bytes), double(stored.size()), "chunk " + fs::path(path).filename().string());
    std::vector<char> out = decompressed(array.compressor, {stored.begin(), stored.end()}, bytes);
    if (array.shuffled > 1) { // first all first bytes of its elements, then all second ones
        std::vector<char> whole(out);
        const std::size_t count = out.size() / array.shuffled;
        for (std::size_t byte = 0; byte < array.shuffled; ++byte)
            for (std::size_t i = 0; i < count; ++i) whole[i * array.shuffled + byte] = out[byte * count + i];
        out = std::move(whole);
    }
    if (array.bigEndian && array.bytes > 1)
        for (std::size_t at = 0; at + array.bytes <= out.size(); at += array.bytes)
            std::reverse(out.begin() + std::ptrdiff_t(at), out.begin() + std::ptrdiff_t(at + array.bytes));
    return out;
}

/// Stores a number as `readZarr` gives it.
void put(const ZarrArray& array, const char* from, void* to, std::size_t at) {
    const auto as = [&]<class T>(T value) {
        std::memcpy(&value, from, sizeof value);
        return value;
    };
    if (array.kind == 'f' && array.bytes == 2) {
        static_cast<float*>(to)[at] = ofHalf(as(std::uint16_t{}));
    } else if (array.bytes == 8 && array.kind != 'f') {
        static_cast<double*>(to)[at] = array.kind == 'i' ? double(as(std::int64_t{})) : double(as(std::uint64_t{}));
    } else if (array.bytes == 4 && array.kind == 'u') {
        static_cast<double*>(to)[at] = double(as(std::uint32_t{}));
    } else {
        std::memcpy(static_cast<char*>(to) + at * array.bytes, from, array.bytes);
    }
}

void countChunks(ZarrArray& array) {
    std::error_code failed;
    fs::recursive_directory_iterator at(array.folder, failed);
    for (; !failed && at != fs::recursive_directory_iterator(); at.increment(failed)) {
        if (!at->is_regular_file(failed)) continue;
        array.stored += double(at->file_size(failed));
        ++array.files;
    }
}

/// Whether numbers are given as they are stored.
bool asStored(const ZarrArray& array) {
    return array.kind == 'f' ? array.bytes > 2 : array.bytes < 4 || (array.bytes == 4 && array.kind == 'i');
}

} // namespace

int ZarrArray::vtkType() const {
    if (kind == 'f') return bytes == 8 ? VTK_DOUBLE : VTK_FLOAT;
    if (bytes == 1) return kind == 'i' ? VTK_SIGNED_CHAR : VTK_UNSIGNED_CHAR;
    if (bytes == 2) return kind == 'i' ? VTK_SHORT : VTK_UNSIGNED_SHORT;
    return bytes == 4 && kind == 'i' ? VTK_INT : VTK_DOUBLE;
}

double ZarrArray::statedBytes() const {
    double all = double(bytes);
    for (const std::size_t n : shape) all *= double(n);
    return all;
}

json zarrJson(const std::string& folder, const std::string& file) {
    const std::string path = (fs::path(folder) / file).string();
    std::error_code missing;
    if (!fs::is_regular_file(path, missing)) return json::object();
    constexpr std::size_t kMost = std::size_t(64) << 20;
    if (bytesIn(path) > kMost) throw std::runtime_error("its file " + file + " is too large");
    json parsed = json::parse(readWhole(path), nullptr, false);
    if (!parsed.is_object()) throw std::runtime_error("its file " + file + " is damaged: no JSON");
    return parsed;
}

ZarrArray openZarrArray(const std::string& folder) {
    const json about = zarrJson(folder, ".zarray");
    ZarrArray array;
    array.folder = folder;
    array.shape = sizesIn(about, "shape");
    array.chunks = sizesIn(about, "chunks");
    if (array.chunks.size() != array.shape.size() || std::ranges::count(array.chunks, 0u) > 0)
        throw std::runtime_error("is damaged: its chunks do not fit its shape");
    readType(about, array);
    readFill(about, array);
    readFilters(about, array);
    array.columnsFirst = about.value("order", json("C")) == json("F");
    array.separator = about.value("dimension_separator", json(".")) == json("/") ? '/' : '.';
    double chunks = 1;
    for (std::size_t axis = 0; axis < array.shape.size(); ++axis)
        chunks *= std::ceil(double(array.shape[axis]) / double(array.chunks[axis]));
    if (chunks > double(kMostChunks)) throw std::runtime_error("states more chunks than are read");
    chunkBytes(array);
    countChunks(array);
    return array;
}

vtkSmartPointer<vtkDataArray> readZarr(const ZarrArray& array, const std::vector<std::size_t>& begin,
                                       const std::vector<std::size_t>& count) {
    const std::size_t axes = array.shape.size();
    double numbers = 1;
    for (std::size_t axis = 0; axis < axes; ++axis) {
        if (begin[axis] + count[axis] > array.shape[axis]) throw std::runtime_error("has no such part");
        numbers *= double(count[axis]);
    }
    refuseHollow(numbers * double(array.bytes), array.stored, "array " + fs::path(array.folder).filename().string());
    auto out = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(array.vtkType()));
    out->SetNumberOfTuples(vtkIdType(numbers));
    if (numbers == 0) return out;
    out->Fill(array.fill.value_or(0));
    void* to = out->GetVoidPointer(0);
    const std::size_t bytes = chunkBytes(array);
    // Steps, in numbers, within the result and within a chunk.
    std::vector<std::size_t> step(axes, 1), inner(axes, 1), first(axes), chunks(axes);
    for (std::size_t axis = axes; axis-- > 1;) step[axis - 1] = step[axis] * count[axis];
    for (std::size_t n = 1; n < axes; ++n) {
        const std::size_t axis = array.columnsFirst ? n : axes - 1 - n;
        inner[axis] =
            array.columnsFirst ? inner[axis - 1] * array.chunks[axis - 1] : inner[axis + 1] * array.chunks[axis + 1];
    }
    for (std::size_t axis = 0; axis < axes; ++axis) {
        first[axis] = begin[axis] / array.chunks[axis];
        chunks[axis] = (begin[axis] + count[axis] - 1) / array.chunks[axis] - first[axis] + 1;
    }
    double asked = 1;
    for (const std::size_t n : chunks) asked *= double(n);
    constexpr double kMostPerFile = 1000; // a damaged description may state chunks without end
    if (asked > kMostPerFile * double(array.files + 10))
        throw std::runtime_error("states " + std::to_string(std::size_t(asked)) + " chunks, of which fewer than " +
                                 std::to_string(array.files) + " are stored");
    eachIndex(chunks, [&](std::vector<std::size_t> index) {
        for (std::size_t axis = 0; axis < axes; ++axis) index[axis] += first[axis];
        const std::vector<char> chunk = chunkAt(array, index, bytes);
        if (chunk.empty()) return;
        std::vector<std::size_t> low(axes), size(axes);
        for (std::size_t axis = 0; axis < axes; ++axis) {
            const std::size_t start = index[axis] * array.chunks[axis];
            low[axis] = std::max(start, begin[axis]);
            size[axis] = std::min(start + array.chunks[axis], begin[axis] + count[axis]) - low[axis];
        }
        const std::size_t last = axes == 0 ? 0 : axes - 1, run = axes == 0 ? 1 : std::exchange(size[last], 1);
        const std::size_t stride = axes == 0 ? 1 : inner[last];
        eachIndex(size, [&](const std::vector<std::size_t>& at) {
            std::size_t from = 0, place = 0;
            for (std::size_t axis = 0; axis < axes; ++axis) {
                from += (low[axis] + at[axis] - index[axis] * array.chunks[axis]) * inner[axis];
                place += (low[axis] + at[axis] - begin[axis]) * step[axis];
            }
            const char* numbersThere = chunk.data() + from * array.bytes;
            if (stride == 1 && asStored(array))
                std::memcpy(static_cast<char*>(to) + place * array.bytes, numbersThere, run * array.bytes);
            else
                for (std::size_t n = 0; n < run; ++n)
                    put(array, numbersThere + n * stride * array.bytes, to, place + n);
        });
    });
    return out;
}

} // namespace tessera::importer
