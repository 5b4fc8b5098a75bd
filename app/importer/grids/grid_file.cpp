#include "app/importer/grids/grid_file.h"

#include "app/importer/readers/check_file.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>
#include <vtkMatrix3x3.h>
#include <zlib.h>

namespace tessera::importer {

struct GridBytes::Stream {
    gzFile file = nullptr; // which reads files that are not compressed as they are
};

GridBytes::GridBytes(const std::string& path) : stream_(std::make_unique<Stream>()) {
    stream_->file = gzopen(path.c_str(), "rb");
    if (stream_->file == nullptr) throw std::runtime_error("cannot be read");
    gzbuffer(stream_->file, 1 << 18);
}

GridBytes::~GridBytes() {
    gzclose(stream_->file);
}

std::size_t GridBytes::take(std::size_t begin, std::size_t count, char* to) {
    const auto failed = [&] { throw std::runtime_error("its compressed samples end early: truncated or damaged"); };
    if (gzseek(stream_->file, z_off_t(begin), SEEK_SET) < 0) failed();
    std::size_t got = 0;
    constexpr std::size_t kOnce = 1 << 30;
    while (got < count) {
        const int now = gzread(stream_->file, to + got, unsigned(std::min(kOnce, count - got)));
        if (now < 0) failed();
        if (now == 0) break;
        got += std::size_t(now);
    }
    int status = Z_OK;
    gzerror(stream_->file, &status);
    if (status == Z_BUF_ERROR || status == Z_DATA_ERROR) failed();
    return got;
}

std::string GridBytes::part(std::size_t begin, std::size_t count) {
    constexpr std::size_t kOnce = 1 << 20; // so that a short file takes little memory
    std::string bytes;
    while (bytes.size() < count) {
        const std::size_t had = bytes.size(), wanted = std::min(kOnce, count - had);
        bytes.resize(had + wanted);
        const std::size_t got = take(begin + had, wanted, bytes.data() + had);
        bytes.resize(had + got);
        if (got < wanted) break;
    }
    return bytes;
}

void GridBytes::read(std::size_t begin, std::size_t count, char* to) {
    const std::size_t got = take(begin, count, to);
    if (got < count) wantBytes(double(begin + got), double(begin + count), {}, "bytes");
}

std::string wholeGridText(const std::string& path) {
    GridBytes bytes(path);
    constexpr std::size_t kMost = std::size_t(8) << 30, kOnce = std::size_t(16) << 20;
    std::string text;
    while (true) {
        const std::string more = bytes.part(text.size(), kOnce);
        text += more;
        if (more.size() < kOnce) return text;
        if (text.size() > kMost) throw std::runtime_error("is too large for a text file");
        refuseHollow(double(text.size()), double(bytesIn(path)));
    }
}

std::string_view GridWords::word() {
    const auto blank = [](char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t' || c == ','; };
    std::size_t begin = 0;
    while (begin < rest_.size() && blank(rest_[begin])) ++begin;
    std::size_t end = begin;
    while (end < rest_.size() && !blank(rest_[end])) ++end;
    const std::string_view found = rest_.substr(begin, end - begin);
    rest_.remove_prefix(end);
    return found;
}

bool GridWords::atEnd() {
    const GridWords before = *this;
    const bool end = word().empty();
    *this = before;
    return end;
}

std::string_view GridWords::line() {
    const std::size_t end = std::min(rest_.size(), rest_.find('\n'));
    std::string_view found = rest_.substr(0, end);
    rest_.remove_prefix(std::min(rest_.size(), end + 1));
    const auto blank = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
    while (!found.empty() && blank(found.front())) found.remove_prefix(1);
    while (!found.empty() && blank(found.back())) found.remove_suffix(1);
    return found;
}

bool parseGridNumber(std::string_view word, double& value) {
    if (word.starts_with('+')) word.remove_prefix(1);
    const auto parsed = std::from_chars(word.data(), word.data() + word.size(), value);
    if (parsed.ec == std::errc() && parsed.ptr == word.data() + word.size()) return !word.empty();
    std::string text(word.substr(0, 60));
    std::ranges::replace(text, 'D', 'e');
    std::ranges::replace(text, 'd', 'e');
    const std::size_t sign = text.find_last_of("+-"); // Fortran drops the letter of a long exponent: 1.0-100
    if (sign != std::string::npos && sign > 0 && std::isdigit(static_cast<unsigned char>(text[sign - 1])) != 0)
        text.insert(sign, "e");
    const std::size_t plus = text.find("e+");
    if (plus != std::string::npos) text.erase(plus + 1, 1);
    const auto again = std::from_chars(text.data(), text.data() + text.size(), value);
    if (again.ec == std::errc::result_out_of_range) { // too small, or too large
        value = text.find("e-") != std::string::npos ? 0 : std::numeric_limits<double>::quiet_NaN();
        return again.ptr == text.data() + text.size();
    }
    return !text.empty() && again.ec == std::errc() && again.ptr == text.data() + text.size();
}

double GridWords::number() {
    const std::string_view text = word();
    if (text.empty()) throw std::runtime_error("ends early: holds fewer numbers than it announces");
    double value = 0;
    if (!parseGridNumber(text, value))
        throw std::runtime_error("has \"" + std::string(text.substr(0, 40)) + "\" where a number belongs");
    return value;
}

int GridWords::count() {
    const double value = number();
    if (!(value >= 1) || value > 1e9 || value != std::floor(value))
        throw std::runtime_error("states an impossible size");
    return int(value);
}

void checkLastNumber(std::string_view text) {
    if (text.empty() || std::isspace(static_cast<unsigned char>(text.back())) != 0) return;
    constexpr std::size_t kEnough = 200;
    GridWords words(text.substr(text.size() - std::min(text.size(), kEnough)));
    std::string_view last, before;
    for (std::string_view word = words.word(); !word.empty(); word = words.word()) {
        before = last;
        last = word;
    }
    const auto exponent = [](std::string_view word) {
        const std::size_t letter = word.find_first_of("eEdD");
        return letter == std::string_view::npos ? std::size_t(0) : word.size() - letter;
    };
    if (exponent(last) < exponent(before)) throw std::runtime_error("ends within its last number");
}

void readZFastest(GridWords& words, glm::ivec3 size, const std::vector<float*>& values) {
    const std::size_t row = std::size_t(size.x), slice = row * std::size_t(size.y);
    for (std::size_t x = 0; x < row; ++x)
        for (std::size_t y = 0; y < std::size_t(size.y); ++y)
            for (std::size_t z = 0; z < std::size_t(size.z); ++z)
                for (float* array : values) array[x + row * y + slice * z] = float(words.number());
}

std::size_t samplesOfText(glm::ivec3 size, std::size_t arrays, std::size_t bytes) {
    const double count = double(size.x) * size.y * size.z * double(arrays);
    // A number and what parts it from the next take two letters at least.
    wantBytes(double(bytes) / 2 + 1, count, {}, "numbers at most");
    return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z);
}

vtkSmartPointer<vtkImageData> gridImage(glm::ivec3 size, glm::dvec3 origin, const glm::dmat3& steps) {
    auto image = vtkSmartPointer<vtkImageData>::New();
    image->SetDimensions(size.x, size.y, size.z);
    image->SetOrigin(origin.x, origin.y, origin.z);
    double spacing[3];
    for (int axis = 0; axis < 3; ++axis) {
        const double length = glm::length(steps[axis]);
        const bool usable = std::isfinite(length) && length > 0;
        spacing[axis] = usable ? length : 1;
        for (int row = 0; row < 3; ++row)
            image->GetDirectionMatrix()->SetElement(row, axis,
                                                    usable        ? steps[axis][row] / length
                                                    : row == axis ? 1.0
                                                                  : 0.0);
    }
    image->SetSpacing(spacing);
    return image;
}

} // namespace tessera::importer
