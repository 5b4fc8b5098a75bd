#include "app/importer/pictures/pixels.h"

#include "volume/base/trimmed.h"
#include "volume/base/unit_conversion.h"
#include "volume/import/files/series.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>

namespace tessera::importer {

namespace {

float fromHalf(std::uint16_t half) {
    const float sign = (half & 0x8000u) != 0 ? -1.0f : 1.0f;
    const int exponent = (half >> 10) & 31, mantissa = half & 1023;
    if (exponent == 31) return mantissa == 0 ? sign * std::numeric_limits<float>::infinity() : std::nanf("");
    if (exponent == 0) return sign * std::ldexp(float(mantissa), -24);
    return sign * std::ldexp(float(mantissa + 1024), exponent - 25);
}

/// Numbers of whole bytes, every `stride`th from `from` on.
template <class T> void copyStrided(const char* from, std::size_t count, std::size_t stride, void* to) {
    auto* out = static_cast<T*>(to);
    for (std::size_t i = 0; i < count; ++i) std::memcpy(out + i, from + i * stride, sizeof(T));
}

/// Whole numbers of any count of bits up to 32 in one row.
template <class T> void unpackBits(const char* row, const PixelForm& form, int sample, T* to) {
    const auto bits = std::size_t(form.bits);
    for (std::size_t x = 0; x < form.width; ++x) {
        std::size_t at = (x * std::size_t(form.samples) + std::size_t(sample)) * bits;
        std::uint64_t value = 0;
        for (std::size_t left = bits; left > 0;) {
            const std::size_t free = 8 - at % 8, take = std::min(left, free);
            const auto byte = static_cast<unsigned char>(row[at / 8]);
            value = (value << take) | ((byte >> (free - take)) & ((1u << take) - 1u));
            at += take;
            left -= take;
        }
        if (form.numbers == PixelNumbers::Signed && ((value >> (bits - 1)) & 1u) != 0)
            value |= ~std::uint64_t(0) << bits;
        to[x] = static_cast<T>(value);
    }
}

bool isWhole(const PixelForm& form) {
    return form.bits == 8 || form.bits == 16 || form.bits == 32 || form.bits == 64;
}

} // namespace

std::string textOf(const PixelForm& form) {
    return std::to_string(form.width) + " x " + std::to_string(form.height) + " pixels of " +
           (form.samples > 1 ? std::to_string(form.samples) + " times " : "") + std::to_string(form.bits) + " bits";
}

int vtkTypeOf(const PixelForm& form) {
    const bool isSigned = form.numbers == PixelNumbers::Signed;
    switch (form.numbers) {
    case PixelNumbers::Float:
        if (form.bits == 16 || form.bits == 32) return VTK_FLOAT;
        if (form.bits == 64) return VTK_DOUBLE;
        break;
    case PixelNumbers::Complex:
        if (form.bits == 64) return VTK_FLOAT;
        if (form.bits == 128) return VTK_DOUBLE;
        break;
    default:
        if (form.bits >= 1 && form.bits <= 8) return isSigned ? VTK_SIGNED_CHAR : VTK_UNSIGNED_CHAR;
        if (form.bits > 8 && form.bits <= 16) return isSigned ? VTK_SHORT : VTK_UNSIGNED_SHORT;
        if (form.bits > 16 && form.bits <= 32) return isSigned ? VTK_INT : VTK_UNSIGNED_INT;
        if (form.bits == 64) return isSigned ? VTK_LONG_LONG : VTK_UNSIGNED_LONG_LONG;
    }
    throw std::runtime_error("has " + std::string(form.numbers == PixelNumbers::Complex ? "complex " : "") +
                             "samples of " + std::to_string(form.bits) +
                             " bits, which are not read: write them with 8, 16 or 32");
}

bool isPlain(const PixelForm& form) {
    return form.samples == 1 && form.numbers != PixelNumbers::Complex && isWhole(form) &&
           !(form.numbers == PixelNumbers::Float && form.bits == 16);
}

void unpackSample(const char* rows, const PixelForm& form, int sample, const std::vector<void*>& to) {
    const int type = vtkTypeOf(form);
    const std::size_t row = form.rowBytes(), count = std::size_t(form.width) * form.height;
    if (isPlain(form)) {
        std::memcpy(to[0], rows, count * std::size_t(form.bits / 8));
        return;
    }
    const bool half = form.numbers == PixelNumbers::Float && form.bits == 16;
    if (!isWhole(form) && form.numbers != PixelNumbers::Complex) {
        for (std::size_t y = 0; y < form.height; ++y) {
            const char* from = rows + y * row;
            switch (type) {
                vtkTemplateMacro(unpackBits(from, form, sample, static_cast<VTK_TT*>(to[0]) + y * form.width));
            }
        }
        return;
    }
    const auto part = std::size_t(form.bits / 8 / form.parts());
    const std::size_t stride = part * std::size_t(form.parts()) * std::size_t(form.samples);
    for (std::size_t p = 0; p < std::size_t(form.parts()); ++p) {
        const char* from = rows + part * (std::size_t(sample) * std::size_t(form.parts()) + p);
        if (half) {
            auto* out = static_cast<float*>(to[p]);
            for (std::size_t i = 0; i < count; ++i) {
                std::uint16_t bits = 0;
                std::memcpy(&bits, from + i * stride, sizeof bits);
                out[i] = fromHalf(bits);
            }
        } else if (part == 1) {
            copyStrided<std::uint8_t>(from, count, stride, to[p]);
        } else if (part == 2) {
            copyStrided<std::uint16_t>(from, count, stride, to[p]);
        } else if (part == 4) {
            copyStrided<std::uint32_t>(from, count, stride, to[p]);
        } else {
            copyStrided<std::uint64_t>(from, count, stride, to[p]);
        }
    }
}

vtkSmartPointer<vtkDataArray> pixelArray(int vtkType, std::size_t count, const std::string& name) {
    auto array = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(vtkType));
    array->SetNumberOfTuples(vtkIdType(count));
    array->SetName(name.c_str());
    return array;
}

std::string lengthUnitOfPicture(std::string_view word) {
    std::string text(volume::trimmed(word));
    for (const std::string_view micro : {"\\u00B5", "\\u00b5", "\u00b5", "\u03bc", "\xb5"})
        if (text.starts_with(micro)) {
            text.replace(0, micro.size(), "u");
            break;
        }
    if (text == "microns" || text == "micron" || text == "\xb5m") return "um";
    for (const std::string_view angstrom : {"\\u00C5", "\\u00c5", "\u00c5", "\u212b", "\xc5"})
        if (text == angstrom) return "angstrom";
    return volume::lengthUnitNamed(text);
}

std::vector<std::string> distinctNames(std::vector<std::string> names) {
    std::set<std::string> taken;
    for (std::size_t i = 0; i < names.size(); ++i) {
        std::string name(volume::trimmed(names[i]));
        std::erase_if(name, [](char c) { return static_cast<unsigned char>(c) < 32; });
        const std::string number = std::to_string(i + 1);
        if (name.empty()) name = names.size() == 1 ? "value" : "channel " + number;
        while (!taken.insert(name).second) name += " " + number;
        names[i] = name;
    }
    return names;
}

std::string missingNumbers(const std::vector<std::string>& files) {
    std::vector<double> numbers, last;
    for (const std::string& file : files) {
        if (const auto number = volume::sliceName(file).slice) numbers.push_back(*number);
        if (const auto number = volume::numberedName(file).number) last.push_back(*number);
    }
    if (std::set<double>(numbers.begin(), numbers.end()).size() < 2) numbers = last;
    if (numbers.size() != files.size() || numbers.size() < 3) return {};
    std::ranges::sort(numbers);
    std::map<double, int> steps; // by length
    for (std::size_t i = 1; i < numbers.size(); ++i) ++steps[numbers[i] - numbers[i - 1]];
    if (steps.size() < 2) return {};
    const double usual = steps.begin()->first;
    if (!(usual > 0)) return {};
    std::string listed;
    double missing = 0;
    constexpr int kMostListed = 5;
    for (std::size_t i = 1; i < numbers.size(); ++i)
        for (double n = numbers[i - 1] + usual; n < numbers[i]; n += usual) {
            if (++missing <= kMostListed) listed += (listed.empty() ? "" : ", ") + std::to_string(std::int64_t(n));
            if (missing > kMostListed) {
                missing += std::max(0.0, std::round((numbers[i] - n) / usual) - 1);
                break;
            }
        }
    if (missing > kMostListed) listed += ", ...";
    const bool one = missing == 1;
    return (one ? "The slice of number " : "The slices of numbers ") + listed + (one ? " is" : " are") +
           " missing among the files: the others are joined without " + (one ? "it" : "them") +
           ", so what follows lies nearer than it should.";
}

} // namespace tessera::importer
