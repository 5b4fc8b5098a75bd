#include "app/importer/meshes/plot3d_file.h"

#include "app/importer/readers/check_file.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <functional>
#include <stdexcept>
#include <string_view>

namespace tessera::importer {

namespace {

constexpr std::int64_t kMostBlocks = 1'000'000, kMostPoints = std::int64_t(1) << 31;

template <class T> T valueAt(const std::string& bytes, std::size_t at, bool swap) {
    char raw[sizeof(T)];
    std::memcpy(raw, bytes.data() + at, sizeof(T));
    if (swap) std::reverse(raw, raw + sizeof(T));
    T value;
    std::memcpy(&value, raw, sizeof(T));
    return value;
}

/// Reads the header of a file: the number of blocks where `several`, their sizes, and with `counts` a number of
/// variables behind each size. Nothing if these are no sizes.
std::optional<Plot3dForm> headerOf(const Plot3dBytes& file, bool swap, bool several, int dimensions, bool counts) {
    Plot3dForm form;
    form.swap = swap;
    form.dimensions = dimensions;
    const std::size_t step = file.step(4);
    std::size_t at = 0;
    std::int64_t blocks = 1;
    if (several) {
        const auto stated = file.whole(at, swap);
        if (!stated || *stated < 1 || *stated > kMostBlocks) return std::nullopt;
        blocks = *stated;
        at += step;
    }
    for (std::int64_t b = 0; b < blocks; ++b) {
        Plot3dSize size;
        double points = 1;
        for (int axis = 0; axis < dimensions; ++axis, at += step) {
            const auto n = file.whole(at, swap);
            if (!n || *n < 1 || (points *= double(*n)) > double(kMostPoints)) return std::nullopt;
            size.points[std::size_t(axis)] = std::size_t(*n);
        }
        form.blocks.push_back(size);
        if (!counts) continue;
        const auto n = file.whole(at, swap);
        if (!n || *n < 1 || *n > 10'000) return std::nullopt;
        form.variables.push_back(std::size_t(*n));
        at += step;
    }
    form.begin = at;
    return form;
}

/// Numbers of all blocks in a file, `each` for a block.
double sumOver(const Plot3dForm& form, const std::function<double(std::size_t block)>& each) {
    double sum = 0;
    for (std::size_t b = 0; b < form.blocks.size(); ++b) sum += each(b);
    return sum;
}

[[noreturn]] void noForm(const char* what) {
    throw std::runtime_error("has no size that a " + std::string(what) +
                             " of PLOT3D can have: truncated, damaged or of another kind");
}

/// Tries the forms of a file whose blocks are known.
Plot3dForm formOn(const Plot3dBytes& file, const Plot3dForm& grid, bool counts,
                  const std::function<double(const Plot3dForm&, std::size_t block)>& each, const char* what) {
    for (const bool swap : file.orders())
        for (const bool several : {false, true})
            if (const auto form = headerOf(file, swap, several, grid.dimensions, counts);
                form && form->blocks == grid.blocks)
                for (const std::size_t bytes : {std::size_t(4), std::size_t(8)}) {
                    const double wanted = sumOver(*form, [&](std::size_t b) { return each(*form, b); });
                    if (double(form->begin) + double(file.step(bytes)) * wanted != double(file.size())) continue;
                    Plot3dForm found = *form;
                    found.bytes = bytes;
                    return found;
                }
    noForm(what);
}

} // namespace

Plot3dBytes::Plot3dBytes(const std::string& path) : bytes_(readWhole(path)) {
    const std::string_view head = std::string_view(bytes_).substr(0, 1024);
    text_ = !head.empty() &&
            std::ranges::all_of(head, [](unsigned char c) { return std::isprint(c) != 0 || std::isspace(c) != 0; });
    if (text_) {
        readNumbers();
        orders_ = {false};
    } else if (joinRecords(false)) {
        orders_ = {false};
    } else if (joinRecords(true)) {
        orders_ = {true};
    } else {
        orders_ = {false, true};
    }
}

bool Plot3dBytes::joinRecords(bool swap) {
    std::string joined;
    for (std::size_t at = 0; at < bytes_.size();) {
        if (bytes_.size() - at < 8) return false;
        const auto length = valueAt<std::uint32_t>(bytes_, at, swap);
        if (length > bytes_.size() - at - 8 || valueAt<std::uint32_t>(bytes_, at + 4 + length, swap) != length)
            return false;
        joined.append(bytes_, at + 4, length);
        at += 8 + std::size_t(length);
    }
    bytes_ = std::move(joined);
    return true;
}

/// Numbers between blanks and commas; "3*1.5" stands for three.
void Plot3dBytes::readNumbers() {
    const auto isBetween = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0 || c == ','; };
    for (std::size_t at = 0; at < bytes_.size();) {
        while (at < bytes_.size() && isBetween(bytes_[at])) ++at;
        const std::size_t begin = at;
        while (at < bytes_.size() && !isBetween(bytes_[at])) ++at;
        if (begin == at) break;
        std::string word = bytes_.substr(begin, at - begin);
        std::size_t times = 1;
        if (const std::size_t star = word.find('*'); star != std::string::npos) {
            std::from_chars(word.data(), word.data() + star, times);
            word = word.substr(star + 1);
        }
        std::ranges::replace(word, 'D', 'E');
        std::ranges::replace(word, 'd', 'e');
        double value = 0;
        const char* first = word.data() + (word.starts_with('+') ? 1 : 0);
        const auto [end, failed] = std::from_chars(first, word.data() + word.size(), value);
        if (failed == std::errc::invalid_argument || end != word.data() + word.size())
            throw std::runtime_error("has \"" + word.substr(0, 40) + "\" where a number belongs");
        if (times < 1 || times > std::size_t(kMostPoints)) throw std::runtime_error("repeats a number too often");
        refuseHollow(8 * double(times), double(bytes_.size()));
        numbers_.insert(numbers_.end(), times, value);
    }
    bytes_.clear();
}

std::optional<std::int64_t> Plot3dBytes::whole(std::size_t at, bool swap) const {
    if (text_) {
        if (at >= numbers_.size() || numbers_[at] != std::floor(numbers_[at]) || std::abs(numbers_[at]) > 1e15)
            return std::nullopt;
        return std::int64_t(numbers_[at]);
    }
    if (at + 4 > bytes_.size()) return std::nullopt;
    return valueAt<std::int32_t>(bytes_, at, swap);
}

double Plot3dBytes::number(std::size_t at, std::size_t bytes, bool swap) const {
    if (text_) return numbers_.at(at);
    if (at + bytes > bytes_.size()) throw std::runtime_error("ends too early: truncated");
    return bytes == 8 ? valueAt<double>(bytes_, at, swap) : double(valueAt<float>(bytes_, at, swap));
}

Plot3dForm formOfGrid(const Plot3dBytes& file) {
    for (const int dimensions : {3, 2})
        for (const bool swap : file.orders())
            for (const bool several : {false, true})
                for (const bool blanks : {false, true})
                    for (const std::size_t bytes : {std::size_t(4), std::size_t(8)}) {
                        auto form = headerOf(file, swap, several, dimensions, false);
                        if (!form) continue;
                        const double points = sumOver(*form, [&](std::size_t b) { return form->blocks[b].count(); });
                        const double each =
                            double(file.step(bytes)) * dimensions + (blanks ? double(file.step(4)) : 0.0);
                        if (double(form->begin) + points * each != double(file.size())) continue;
                        form->blanks = blanks;
                        form->bytes = bytes;
                        return *form;
                    }
    noForm("grid");
}

Plot3dForm formOfSolution(const Plot3dBytes& file, const Plot3dForm& grid) {
    return formOn(
        file, grid, false,
        [&](const Plot3dForm& form, std::size_t b) {
            return 4.0 + double(grid.dimensions + 2) * double(form.blocks[b].count());
        },
        "solution");
}

Plot3dForm formOfFunctions(const Plot3dBytes& file, const Plot3dForm& grid) {
    return formOn(
        file, grid, true,
        [](const Plot3dForm& form, std::size_t b) {
            return double(form.variables[b]) * double(form.blocks[b].count());
        },
        "file of functions");
}

} // namespace tessera::importer
