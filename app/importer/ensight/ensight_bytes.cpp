#include "app/importer/ensight/ensight_bytes.h"

#include "app/importer/readers/check_file.h"
#include "volume/base/trimmed.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace tessera::importer {

namespace {

constexpr std::size_t kLine = 80; // bytes of a line of a binary file

[[noreturn]] void endsEarly() {
    throw std::runtime_error("ends too early: truncated");
}

std::int32_t int32At(const char* bytes, bool swap) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes, 4);
    return static_cast<std::int32_t>(swap ? __builtin_bswap32(value) : value);
}

/// A last line without a line end is whole, unless it is a number shorter than those of fixed width above it.
void checkFixedWidth(std::string_view text) {
    if (text.empty() || text.back() == '\n') return;
    std::size_t widths[3] = {};
    for (std::size_t& width : widths) {
        const std::size_t begin = text.rfind('\n');
        if (begin == std::string_view::npos) return;
        width = text.size() - begin - 1;
        text = text.substr(0, begin);
        if (text.ends_with('\r')) text.remove_suffix(1);
    }
    if (widths[1] == widths[2] && widths[1] >= 10 && widths[0] < widths[1]) endsEarly();
}

} // namespace

EnSightBytes::EnSightBytes(const std::string& path, std::size_t step) {
    open(path);
    std::string head = bytes_.substr(0, 30); // Fortran: after the length of the record
    std::ranges::transform(head, head.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    form_.fortran = head.find("fortran binary") < 10;
    form_.binary = form_.fortran || head.starts_with("c binary");
    if (form_.binary) {
        joinRecords();
        at_ = kLine;
    }
    selectStep(step);
    if (form_.binary) guessOrder();
}

EnSightBytes::EnSightBytes(const std::string& path, std::size_t step, EnSightForm form) : form_(form) {
    open(path);
    joinRecords();
    selectStep(step);
}

void EnSightBytes::open(const std::string& path) {
    bytes_ = readWhole(path);
    end_ = bytes_.size();
    if (bytes_.empty()) throw std::runtime_error("is empty");
}

/// Takes the lengths of Fortran's records out.
void EnSightBytes::joinRecords() {
    if (!form_.fortran) return;
    form_.swap = int32At(bytes_.data(), false) != std::int32_t(kLine);
    std::size_t from = 0, to = 0;
    while (from < bytes_.size()) {
        if (bytes_.size() - from < 8) endsEarly();
        const std::int32_t length = int32At(bytes_.data() + from, form_.swap);
        if (length < 0 || bytes_.size() - from - 8 < std::size_t(length)) endsEarly();
        std::memmove(bytes_.data() + to, bytes_.data() + from + 4, std::size_t(length));
        to += std::size_t(length);
        from += std::size_t(length) + 8;
    }
    bytes_.resize(to);
    end_ = to;
}

/// The step between "BEGIN TIME STEP" and "END TIME STEP", where the file has these.
void EnSightBytes::selectStep(std::size_t step) {
    static constexpr std::string_view kBegin = "BEGIN TIME STEP", kEnd = "END TIME STEP";
    std::size_t begin = bytes_.find(kBegin, at_);
    const bool leads =
        begin != std::string::npos && volume::trimmed(std::string_view(bytes_).substr(at_, begin - at_)).empty();
    if (!leads) {
        if (step > 0) throw std::runtime_error("holds one step, its case states more");
        if (!form_.binary) checkFixedWidth(bytes_);
        return;
    }
    for (std::size_t s = 0; s < step; ++s)
        if ((begin = bytes_.find(kBegin, begin + 1)) == std::string::npos)
            throw std::runtime_error("ends before step " + std::to_string(step + 1) + ": truncated");
    at_ = form_.binary ? begin + kLine : std::min(bytes_.find('\n', begin), bytes_.size() - 1) + 1;
    end_ = bytes_.find(kEnd, at_);
    if (end_ == std::string::npos || at_ > end_) throw std::runtime_error("ends within a step: truncated");
}

/// The number of the first part is small in the right byte order.
void EnSightBytes::guessOrder() {
    if (form_.fortran) return;
    const std::size_t part = bytes_.find(std::string("part\0", 5), at_), blank = bytes_.find("part   ", at_);
    const std::size_t at = std::min(part, blank);
    if (at == std::string::npos || at + kLine + 4 > bytes_.size()) return;
    const auto plain = std::uint32_t(int32At(bytes_.data() + at + kLine, false));
    form_.swap = __builtin_bswap32(plain) < plain;
}

const char* EnSightBytes::take(std::size_t bytes) {
    if (end_ - at_ < bytes) endsEarly();
    const char* out = bytes_.data() + at_;
    at_ += bytes;
    return out;
}

void EnSightBytes::skipBlank() {
    while (at_ < end_ && std::isspace(static_cast<unsigned char>(bytes_[at_])) != 0) ++at_;
}

bool EnSightBytes::atEnd() {
    if (!form_.binary) skipBlank();
    return at_ >= end_;
}

std::string EnSightBytes::line() {
    std::string_view text;
    if (form_.binary) {
        text = std::string_view(take(kLine), kLine);
        text = text.substr(0, text.find('\0'));
    } else {
        if (at_ >= end_) endsEarly();
        const std::size_t stop = std::min(end_, bytes_.find('\n', at_));
        text = std::string_view(bytes_).substr(at_, stop - at_);
        at_ = std::min(end_, stop + 1);
    }
    return std::string(volume::trimmed(text));
}

std::string EnSightBytes::ahead() {
    if (atEnd()) return {};
    const std::size_t at = at_;
    std::string text = line();
    at_ = at;
    return text;
}

std::string_view EnSightBytes::word() {
    skipBlank();
    if (at_ >= end_) endsEarly();
    const std::size_t begin = at_;
    while (at_ < end_ && std::isspace(static_cast<unsigned char>(bytes_[at_])) == 0) ++at_;
    std::string_view text(bytes_.data() + begin, at_ - begin);
    if (text.starts_with('+')) text.remove_prefix(1);
    return text;
}

std::int32_t EnSightBytes::integer() {
    return integers(1)[0];
}

std::vector<std::int32_t> EnSightBytes::integers(std::size_t count) {
    if (count > (end_ - at_) / (form_.binary ? 4 : 1)) endsEarly();
    std::vector<std::int32_t> out(count);
    if (form_.binary) {
        const char* from = take(4 * count);
        for (std::size_t n = 0; n < count; ++n) out[n] = int32At(from + 4 * n, form_.swap);
        return out;
    }
    for (std::int32_t& value : out) {
        const std::string_view text = word();
        const auto [stop, failed] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (failed != std::errc() || stop != text.data() + text.size())
            throw std::runtime_error("has \"" + std::string(text.substr(0, 40)) + "\" where a whole number belongs");
    }
    if (count > 0 && at_ < end_) at_ = std::min(end_, std::max(at_, bytes_.find_first_not_of(" \t\r", at_)));
    if (count > 0 && at_ < end_ && bytes_[at_] == '\n') ++at_;
    return out;
}

std::vector<float> EnSightBytes::numbers(std::size_t count) {
    if (count > (end_ - at_) / (form_.binary ? 4 : 1)) endsEarly();
    std::vector<float> out(count);
    if (form_.binary) {
        const char* from = take(4 * count);
        for (std::size_t n = 0; n < count; ++n) {
            const std::int32_t bits = int32At(from + 4 * n, form_.swap);
            std::memcpy(&out[n], &bits, 4);
        }
        return out;
    }
    for (float& value : out) {
        const std::string_view text = word();
        double read = 0; // numbers that a float does not hold are 0 or infinite
        const auto [stop, failed] = std::from_chars(text.data(), text.data() + text.size(), read);
        if (failed == std::errc::result_out_of_range)
            read = text.find("E-") == std::string_view::npos && text.find("e-") == std::string_view::npos
                       ? std::numeric_limits<double>::infinity()
                       : 0;
        else if (failed != std::errc() || stop != text.data() + text.size())
            throw std::runtime_error("has \"" + std::string(text.substr(0, 40)) + "\" where a number belongs");
        value = float(read);
    }
    if (count > 0 && at_ < end_) at_ = std::min(end_, std::max(at_, bytes_.find_first_not_of(" \t\r", at_)));
    if (count > 0 && at_ < end_ && bytes_[at_] == '\n') ++at_;
    return out;
}

void EnSightBytes::skip(std::size_t count) {
    if (form_.binary) {
        if (count > (end_ - at_) / 4) endsEarly();
        take(4 * count);
    } else {
        for (std::size_t n = 0; n < count; ++n) word();
    }
}

std::size_t EnSightBytes::count(const char* what) {
    const std::int32_t value = integer();
    if (value < 0) throw std::runtime_error("states a negative number of " + std::string(what));
    if (std::size_t(value) > end_ - at_) endsEarly();
    return std::size_t(value);
}

} // namespace tessera::importer
