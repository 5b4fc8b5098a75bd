// The JSON that tifffile writes into the first description of a TIFF file: {"shape": [12, 11, 10], "axes": "ZYX"}.
#include "app/importer/pictures/tiff_stack.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace tessera::importer {

namespace {

/// Lengths of the axes before those of a page, slowest first; none where the page is not at the end of the shape.
std::optional<std::vector<std::size_t>> outerAxes(const nlohmann::json& words, const PixelForm& form, bool planes) {
    std::vector<std::size_t> shape;
    for (const auto& length : words["shape"]) {
        if (!length.is_number_unsigned()) return std::nullopt;
        shape.push_back(length.get<std::size_t>());
    }
    std::vector<std::size_t> page{form.height, form.width};
    const auto samples = std::size_t(form.samples);
    if (samples > 1) page.insert(planes ? page.begin() : page.end(), samples);
    if (shape.size() < page.size() || !std::equal(page.rbegin(), page.rend(), shape.rbegin())) return std::nullopt;
    shape.resize(shape.size() - page.size());
    return shape;
}

/// What the outer axes mean: letters of Z, C and T, from the names or by their number.
std::string namesOfAxes(const nlohmann::json& words, std::vector<std::size_t>& outer, Source& source) {
    std::string names;
    if (const auto axes = words.find("axes"); axes != words.end() && axes->is_string())
        names = axes->get<std::string>();
    if (names.size() >= outer.size()) {
        names.resize(outer.size());
        std::string known;
        for (char c : names) {
            c = char(std::toupper(static_cast<unsigned char>(c)));
            if (c == 'I' || c == 'Q') c = known.find('Z') == std::string::npos ? 'Z' : 'T'; // images, "other"
            if ((c != 'Z' && c != 'C' && c != 'T') || known.find(c) != std::string::npos) return {};
            known += c;
        }
        return known;
    }
    std::erase(outer, 1);
    static constexpr const char* kGuesses[] = {"", "Z", "TZ", "TCZ"};
    if (outer.size() > 3) return {};
    if (outer.size() > 1)
        source.notes.push_back(
            "It does not name its axes: the first of " + std::to_string(outer[0]) + " is taken as the time" +
            (outer.size() == 3 ? ", the second of " + std::to_string(outer[1]) + " as channels." : std::string(".")));
    return kGuesses[outer.size()];
}

} // namespace

bool arrangeShaped(TiffStack& stack, const std::string& description, TIFF* file, Source& source) {
    if (!description.starts_with("{")) return false;
    const nlohmann::json words = nlohmann::json::parse(description, nullptr, false);
    if (!words.is_object() || !words.contains("shape") || !words["shape"].is_array()) return false;
    auto outer = outerAxes(words, stack.form.form, stack.form.planes);
    if (!outer) return false;
    double count = 1;
    for (const std::size_t length : *outer) count *= double(length);
    const std::size_t pages = stack.files[0].pages.size();
    std::vector<TiffPlane> planes;
    if (pages == 1 && count > 1 && count < 1e9)
        planes = planesBehind(stack, file, std::size_t(count));
    else if (count <= double(pages)) // further pages are another series
        for (std::size_t p = 0; p < std::size_t(count); ++p) planes.push_back({0, p, 0});
    else
        return false;
    if (planes.empty()) return false;
    if (count < double(pages) && pages > 1)
        source.notes.push_back("Only its first " + std::to_string(planes.size()) +
                               " pages are read, of the array that it "
                               "describes; the others are left out.");
    const std::string names = namesOfAxes(words, *outer, source);
    for (std::size_t i = 0; i < names.size(); ++i)
        (names[i] == 'Z' ? stack.slices : names[i] == 'C' ? stack.channels : stack.times) = (*outer)[i];
    if (!arrangePlanes(stack, planes, std::string(names.rbegin(), names.rend()))) {
        source.notes.push_back("Its array of " + std::to_string(outer->size()) +
                               " axes beside those of a page is read as one axis of slices.");
        stack.channels = stack.times = 1;
        stack.slices = planes.size();
        stack.planes = planes;
    }
    if (stack.times > 1) {
        for (std::size_t t = 0; t < stack.times; ++t) source.times.push_back(double(t));
        source.timeUnit = "step";
    }
    const auto number = [&](const char* key) {
        return words.contains(key) && words[key].is_number() ? words[key].get<double>() : 0.0;
    };
    if (const double depth = number("spacing"); depth > 0) {
        stack.spacing[2] = depth;
        stack.statesDepth = true;
    }
    if (words.contains("unit") && words["unit"].is_string())
        source.lengthUnit = lengthUnitOfPicture(words["unit"].get<std::string>());
    return true;
}

} // namespace tessera::importer
