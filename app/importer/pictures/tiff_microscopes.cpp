// TIFF of microscopes that describe their stacks in tags of their own: Zeiss LSM and MetaMorph STK.
#include "app/importer/pictures/tiff_stack.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace tessera::importer {

namespace {

template <class T> T numberAt(const std::vector<std::uint8_t>& bytes, std::size_t at) {
    T value{};
    if (at + sizeof value <= bytes.size()) std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

/// LSM: a page for each slice and time, its channels as planes of the page, each followed by a small picture of it.
bool arrangeLsm(TiffStack& stack, const std::vector<std::uint8_t>& words, Source& source) {
    constexpr std::size_t kWanted = 64; // always little-endian, at fixed places
    if (words.size() < kWanted || (numberAt<std::uint32_t>(words, 0) & 0xffffu) != 0x494c) return false;
    const auto slices = numberAt<std::int32_t>(words, 16), times = numberAt<std::int32_t>(words, 24);
    std::vector<TiffPlane> planes;
    for (std::size_t p = 0; p < stack.files[0].pages.size(); ++p) {
        const TiffPage& page = stack.files[0].pages[p];
        if (page.reduced) continue;
        if (planes.empty()) stack.form = page;
        planes.push_back({0, p, 0});
    }
    if (slices < 1 || times < 1 || planes.empty()) return false;
    stack.slices = std::size_t(slices);
    stack.times = std::size_t(times);
    if (double(slices) * times != double(planes.size()) || !arrangePlanes(stack, planes, "ZT")) {
        source.notes.push_back("Its " + std::to_string(slices) + " slices and " + std::to_string(times) +
                               " times do not give its " + std::to_string(planes.size()) +
                               " pages, which are read as slices.");
        stack.times = 1;
        stack.slices = planes.size();
        stack.planes = planes;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) { // in metres
        const double size = numberAt<double>(words, 40 + 8 * axis);
        stack.spacing[axis] = size > 0 && std::isfinite(size) ? std::round(size * 1e18) / 1e12 : 1;
        if (axis == 2 && size > 0) stack.statesDepth = true;
    }
    source.lengthUnit = "um";
    if (stack.times > 1) {
        const double interval = numberAt<double>(words, 112);
        const bool stated = interval > 0 && std::isfinite(interval);
        for (std::size_t t = 0; t < stack.times; ++t) source.times.push_back(double(t) * (stated ? interval : 1));
        source.timeUnit = stated ? "s" : "step";
    }
    source.notes.emplace_back("Small pictures and settings of the microscope (Zeiss LSM) are left out.");
    return true;
}

} // namespace

bool arrangeMicroscope(TiffStack& stack, TIFF* file, Source& source) {
    if (stack.files.size() > 1) return false;
    constexpr std::uint32_t kZeiss = 34412, kMetaMorph = 33629;
    if (arrangeLsm(stack, tiffBytes(file, kZeiss, 1), source)) return true;
    const TIFFField* planes = TIFFFindField(file, kMetaMorph, TIFF_ANY);
    std::uint32_t count = 0;
    void* data = nullptr;
    if (planes == nullptr || TIFFFieldReadCount(planes) != TIFF_VARIABLE2 ||
        TIFFGetField(file, kMetaMorph, &count, &data) == 0 || count < 2 || stack.files[0].pages.size() != 1)
        return false;
    stack.planes = planesBehind(stack, file, count);
    stack.slices = count;
    source.notes.emplace_back("It is a stack of MetaMorph, whose planes are read as slices; their distances and times, "
                              "kept in its own form, are left out.");
    return true;
}

} // namespace tessera::importer
