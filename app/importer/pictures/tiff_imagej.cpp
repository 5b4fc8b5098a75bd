// What ImageJ and Fiji write into the first description of a TIFF file, one "key=value" a line.
#include "app/importer/pictures/tiff_stack.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <map>
#include <stdexcept>
#include <string_view>

namespace tessera::importer {

namespace {

using Words = std::map<std::string, std::string>;

Words wordsOfImageJ(const std::string& text) {
    Words words;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.size(), text.find('\n', at));
        const std::string line = text.substr(at, end - at);
        if (const std::size_t equals = line.find('='); equals != std::string::npos)
            words.emplace(line.substr(0, equals), line.substr(equals + 1));
        at = end + 1;
    }
    return words;
}

double numberOf(const Words& words, const std::string& key, double otherwise) {
    const auto at = words.find(key);
    if (at == words.end()) return otherwise;
    char* end = nullptr;
    const double value = std::strtod(at->second.c_str(), &end);
    return end != at->second.c_str() && std::isfinite(value) ? value : otherwise;
}

std::string wordOf(const Words& words, const std::string& key) {
    const auto at = words.find(key);
    return at == words.end() ? "" : at->second;
}

/// Polynomials and the straight line are applied; the rest is said.
void readCalibration(const Words& words, TiffStack& stack, Source& source) {
    if (!words.contains("cf") && !words.contains("c0")) return;
    const auto kind = int(numberOf(words, "cf", 0));
    constexpr int kMostPolynomial = 3, kNoFunction = 20;
    if (kind == kNoFunction) return;
    std::vector<double> factors;
    for (int i = 0; i < 10 && words.contains("c" + std::to_string(i)); ++i)
        factors.push_back(numberOf(words, "c" + std::to_string(i), 0));
    if (kind < 0 || kind > kMostPolynomial || factors.size() < 2) {
        source.notes.push_back("The calibration of its values (function " + std::to_string(kind) +
                               " of ImageJ) is not applied: they are the numbers stored.");
        return;
    }
    factors.resize(std::min(factors.size(), std::size_t(kind) + 2));
    if (factors == std::vector<double>{0, 1}) factors.clear();
    stack.calibration = factors;
    std::string unit = wordOf(words, "vunit");
    std::string plain;
    for (const char c : unit) plain += char(std::tolower(static_cast<unsigned char>(c)));
    if (plain != "gray value" && plain != "grey value") stack.valueUnit = unit;
}

void readScale(const Words& words, TiffStack& stack, Source& source) {
    const std::string unit = wordOf(words, "unit");
    if (!unit.empty()) source.lengthUnit = lengthUnitOfPicture(unit);
    const bool pixels = unit == "pixel" || unit == "pixels" || unit.find_first_not_of(' ') == std::string::npos;
    if (source.lengthUnit.empty() && !pixels)
        source.notes.push_back("Its unit of lengths \"" + unit.substr(0, 40) + "\" is not known and left out.");
    // Absent where it is 1; negative where the order of slices was turned round.
    const double depth = std::abs(numberOf(words, "spacing", 1));
    stack.spacing[2] = depth > 0 ? depth : 1;
    stack.statesDepth = true;
    static constexpr const char* kOrigins[] = {"xorigin", "yorigin", "zorigin"};
    for (std::size_t axis = 0; axis < 3; ++axis) // in pixels
        if (const double pixel = numberOf(words, kOrigins[axis], 0); pixel != 0)
            stack.origin[axis] = -pixel * stack.spacing[axis];
    for (const char* other : {"yunit", "zunit"})
        if (words.contains(other) && lengthUnitOfPicture(wordOf(words, other)) != source.lengthUnit)
            source.notes.push_back("Its axes have different units (" + std::string(other) + "=" + wordOf(words, other) +
                                   "): that of x is taken for all.");
}

void readFrames(const Words& words, std::size_t frames, Source& source) {
    double interval = std::abs(numberOf(words, "finterval", 0));
    const double rate = numberOf(words, "fps", 0);
    if (interval == 0 && rate > 0) interval = 1 / rate;
    const bool stated = interval > 0;
    for (std::size_t t = 0; t < frames; ++t) source.times.push_back(double(t) * (stated ? interval : 1));
    std::string unit = wordOf(words, "tunit");
    if (unit.empty() || unit == "sec" || unit == "seconds" || unit == "second") unit = "s";
    if (unit == "msec") unit = "ms";
    if (unit == "\\u00B5s") unit = "us";
    source.timeUnit = stated ? unit : "step";
}

/// The labels that ImageJ keeps of each slice, in its own tags; empty if there are none.
std::vector<std::string> sliceLabels(TIFF* file) {
    constexpr std::uint32_t kCounts = 50838, kData = 50839;
    const std::vector<std::uint8_t> counts = tiffBytes(file, kCounts, 4), data = tiffBytes(file, kData, 1);
    if (counts.size() < 8 || data.size() < 12) return {};
    const bool big = TIFFIsBigEndian(file) != 0;
    const auto number = [&](std::size_t at) {
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < 4; ++i) value = value * 256 + data[at + (big ? i : 3 - i)];
        return value;
    };
    const auto count = [&](std::size_t i) {
        std::uint32_t value = 0;
        std::memcpy(&value, counts.data() + 4 * i, 4);
        return std::size_t(value);
    };
    std::vector<std::string> labels;
    std::size_t block = 1, at = count(0); // the first count is that of the table of kinds
    for (std::size_t entry = 4; entry + 8 <= std::min(count(0), data.size()); entry += 8) {
        const bool isLabels = number(entry) == 0x6c61626c; // "labl"
        for (std::uint32_t i = 0; i < number(entry + 4); ++i, ++block) {
            if (block * 4 + 4 > counts.size()) return labels;
            const std::size_t length = count(block);
            if (at > data.size() || length > data.size() - at) return labels;
            std::string label;
            for (std::size_t k = 0; isLabels && k + 1 < length; k += 2) { // UTF-16
                const unsigned code =
                    big ? data[at + k] * 256u + data[at + k + 1] : data[at + k + 1] * 256u + data[at + k];
                if (code < 0x80) {
                    label += char(code);
                } else if (code < 0x800) {
                    label += char(0xc0 | (code >> 6));
                    label += char(0x80 | (code & 63));
                } else {
                    label += char(0xe0 | (code >> 12));
                    label += char(0x80 | ((code >> 6) & 63));
                    label += char(0x80 | (code & 63));
                }
            }
            if (isLabels) labels.push_back(label.substr(0, label.find('\n')));
            at += length;
        }
    }
    return labels;
}

/// Labels are names of channels where each channel has its own, the same on all slices and times.
void nameChannels(TiffStack& stack, const std::vector<std::string>& labels) {
    if (stack.channels < 2 || labels.size() != stack.planes.size()) return;
    std::vector<std::string> names(labels.begin(), labels.begin() + std::ptrdiff_t(stack.channels));
    for (std::size_t i = 0; i < labels.size(); ++i)
        if (labels[i] != names[i % stack.channels]) return;
    for (std::size_t i = 1; i < names.size(); ++i)
        if (names[i] == names[0]) return;
    stack.channelNames = names;
}

} // namespace

bool arrangeImageJ(TiffStack& stack, const std::string& description, TIFF* file, Source& source) {
    if (!description.starts_with("ImageJ=")) return false;
    const Words words = wordsOfImageJ(description);
    readCalibration(words, stack, source);
    readScale(words, stack, source);
    if (stack.files.size() > 1) return false; // a slice each, of which the first says how large they are
    const std::size_t pages = stack.files[0].pages.size();
    const double images = numberOf(words, "images", double(pages));
    std::vector<TiffPlane> planes;
    if (pages == 1 && images > 1 && images < 1e9) {
        planes = planesBehind(stack, file, std::size_t(images));
    } else {
        if (images > double(pages))
            throw std::runtime_error("announces " + wordOf(words, "images") + " images, holds " +
                                     std::to_string(pages));
        planes = fittingPages(stack, source);
    }
    const auto count = [&](const char* key) {
        const double value = numberOf(words, key, 1);
        return value >= 1 && value <= double(planes.size()) ? std::size_t(value) : std::size_t(1);
    };
    stack.channels = count("channels");
    stack.slices = count("slices");
    stack.times = count("frames");
    if (stack.channels * stack.slices * stack.times == 1) stack.slices = planes.size();
    if (!arrangePlanes(stack, planes, "CZT")) {
        source.notes.push_back("Its " + std::to_string(stack.channels) + " channels, " + std::to_string(stack.slices) +
                               " slices and " + std::to_string(stack.times) + " frames do not give its " +
                               std::to_string(planes.size()) + " images, which are read as slices.");
        stack.channels = stack.times = 1;
        stack.slices = planes.size();
        stack.planes = planes;
    }
    if (stack.times > 1) readFrames(words, stack.times, source);
    nameChannels(stack, sliceLabels(file));
    return true;
}

} // namespace tessera::importer
