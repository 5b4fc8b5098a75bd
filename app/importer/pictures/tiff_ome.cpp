// OME-TIFF: the XML in the first description says which directory, of which file, is which slice, channel and time.
#include "app/importer/pictures/tiff_stack.h"
#include "app/importer/readers/check_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <pugixml.hpp>
#include <stdexcept>
#include <string_view>

namespace tessera::importer {

namespace fs = std::filesystem;

namespace {

/// The name of an element without its name space.
std::string_view plainName(const pugi::xml_node& node) {
    const std::string_view name = node.name();
    const std::size_t colon = name.find(':');
    return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

std::vector<pugi::xml_node> childrenOf(const pugi::xml_node& node, std::string_view name) {
    std::vector<pugi::xml_node> found;
    for (const pugi::xml_node& child : node.children())
        if (plainName(child) == name) found.push_back(child);
    return found;
}

pugi::xml_node childOf(const pugi::xml_node& node, std::string_view name) {
    const std::vector<pugi::xml_node> found = childrenOf(node, name);
    return found.empty() ? pugi::xml_node() : found.front();
}

std::size_t sizeOf(const pugi::xml_node& node, const char* name, std::size_t otherwise) {
    const double value = node.attribute(name).as_double(double(otherwise));
    constexpr double kMost = 1e7;
    return value >= 0 && value <= kMost ? std::size_t(value) : otherwise;
}

std::string fileNameOf(const std::string& path) {
    return fs::path(path).filename().string();
}

/// One statement of an image: directories of a file for planes from a first one on.
struct Statement {
    std::string file; ///< "" = the file itself
    std::optional<std::size_t> directory, count;
    std::size_t z = 0, c = 0, t = 0;
};

std::vector<Statement> statementsOf(const pugi::xml_node& pixels) {
    std::vector<Statement> all;
    for (const pugi::xml_node& node : childrenOf(pixels, "TiffData")) {
        Statement one;
        if (node.attribute("IFD")) one.directory = sizeOf(node, "IFD", 0);
        if (node.attribute("PlaneCount")) one.count = sizeOf(node, "PlaneCount", 1);
        one.z = sizeOf(node, "FirstZ", 0);
        one.c = sizeOf(node, "FirstC", 0);
        one.t = sizeOf(node, "FirstT", 0);
        one.file = fileNameOf(childOf(node, "UUID").attribute("FileName").as_string());
        all.push_back(one);
    }
    if (all.empty()) all.emplace_back();
    return all;
}

/// The files of a stack by name; opens those beside the first that are not yet known.
class OmeFiles {
public:
    explicit OmeFiles(TiffStack& stack) : stack_(stack) {}

    /// The index of a file; none where it cannot be read, which is noted.
    std::optional<std::size_t> find(const std::string& name) {
        if (name.empty()) return 0;
        for (std::size_t f = 0; f < stack_.files.size(); ++f)
            if (fileNameOf(stack_.files[f].path) == name) return f;
        if (std::ranges::find(missing_, name) != missing_.end()) return std::nullopt;
        try {
            const std::string path = besides(stack_.files[0].path, name);
            const TiffHandle file = openTiffFile(path);
            stack_.files.push_back({path, pagesOf(file.get())});
            return stack_.files.size() - 1;
        } catch (const std::runtime_error&) {
            missing_.push_back(name);
            return std::nullopt;
        }
    }
    const std::vector<std::string>& missing() const { return missing_; }

private:
    TiffStack& stack_;
    std::vector<std::string> missing_;
};

/// The text of OME-XML, which may lie in a file of its own.
std::string wholeDescription(const std::string& description, const std::string& path) {
    pugi::xml_document document;
    if (!document.load_string(description.c_str())) return description;
    const pugi::xml_node only = childOf(document.document_element(), "BinaryOnly");
    if (!only) return description;
    const std::string name = fileNameOf(only.attribute("MetadataFile").as_string());
    const std::string other = besides(path, name);
    std::error_code unknown;
    constexpr std::uintmax_t kMost = 256u << 20;
    if (name.empty() || !fs::exists(other, unknown) || fs::file_size(other, unknown) > kMost) return description;
    if (name.ends_with(".ome") || name.ends_with(".xml")) return readWhole(other);
    return tiffText(openTiffFile(other).get(), TIFFTAG_IMAGEDESCRIPTION);
}

/// The image that has planes in this file; the first one that names none.
pugi::xml_node imageIn(const pugi::xml_node& root, const std::string& file, std::size_t& index) {
    const std::vector<pugi::xml_node> images = childrenOf(root, "Image");
    for (index = 0; index < images.size(); ++index)
        for (const Statement& one : statementsOf(childOf(images[index], "Pixels")))
            if (one.file.empty() || one.file == file) return images[index];
    index = 0;
    return images.empty() ? pugi::xml_node() : images.front();
}

void readOmeScale(const pugi::xml_node& pixels, TiffStack& stack, Source& source) {
    static constexpr const char* kSizes[] = {"PhysicalSizeX", "PhysicalSizeY", "PhysicalSizeZ"};
    std::string unit;
    bool differ = false, any = false;
    stack.spacing = {1, 1, 1};
    source.lengthUnit.clear();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double size = pixels.attribute(kSizes[axis]).as_double(0);
        if (!(size > 0) || !std::isfinite(size)) continue;
        const pugi::xml_attribute stated = pixels.attribute((std::string(kSizes[axis]) + "Unit").c_str());
        const std::string own = stated ? lengthUnitOfPicture(stated.as_string()) : "um";
        differ = differ || (any && own != unit);
        if (!any) unit = own;
        any = true;
        stack.spacing[axis] = size;
        if (axis == 2) stack.statesDepth = true;
    }
    if (any && !stack.statesDepth) stack.spacing[2] = stack.spacing[0];
    if (differ) source.notes.emplace_back("Its axes have different units: that of x is taken for all.");
    source.lengthUnit = unit;
}

/// Times from the increment, else from those of the planes.
void readOmeTimes(const pugi::xml_node& pixels, const TiffStack& stack, Source& source) {
    if (stack.times < 2) return;
    const auto unitOf = [](const pugi::xml_attribute& stated) {
        std::string unit = stated ? stated.as_string() : "s";
        if (unit == "\u00b5s") unit = "us";
        return unit;
    };
    const double step = pixels.attribute("TimeIncrement").as_double(0);
    if (step > 0 && std::isfinite(step)) {
        for (std::size_t t = 0; t < stack.times; ++t) source.times.push_back(double(t) * step);
        source.timeUnit = unitOf(pixels.attribute("TimeIncrementUnit"));
        return;
    }
    std::vector<double> times(stack.times, std::nan(""));
    for (const pugi::xml_node& plane : childrenOf(pixels, "Plane")) {
        const std::size_t t = sizeOf(plane, "TheT", stack.times);
        if (t >= stack.times || !plane.attribute("DeltaT")) continue;
        if (std::isnan(times[t])) times[t] = plane.attribute("DeltaT").as_double(std::nan(""));
        source.timeUnit = unitOf(plane.attribute("DeltaTUnit"));
    }
    bool ascending = true; // false with a time that is not stated, too
    for (std::size_t t = 0; t < times.size(); ++t)
        ascending = ascending && std::isfinite(times[t]) && (t == 0 || times[t] > times[t - 1]);
    if (!ascending) {
        source.timeUnit = "step";
        for (std::size_t t = 0; t < times.size(); ++t) times[t] = double(t);
    }
    source.times = times;
}

/// Steps to the next plane in the order of dimensions; false after the last.
bool nextPlane(std::size_t (&at)[3], const std::size_t (&sizes)[3], const std::string& order) {
    for (const char name : order) {
        const std::size_t axis = name == 'Z' ? 0 : name == 'C' ? 1 : 2;
        if (++at[axis] < sizes[axis]) return true;
        at[axis] = 0;
    }
    return false;
}

void placePlanes(const std::vector<Statement>& statements, const std::string& order, TiffStack& stack, Source& source) {
    const std::size_t sizes[3] = {stack.slices, stack.channels, stack.times};
    stack.planes.assign(sizes[0] * sizes[1] * sizes[2], {TiffPlane::kNone, 0, 0});
    OmeFiles files(stack);
    for (const Statement& one : statements) {
        const auto file = files.find(one.file);
        if (!file) continue;
        const std::size_t pages = stack.files[*file].pages.size(), first = one.directory.value_or(0);
        const std::size_t count = one.count.value_or(one.directory ? 1 : pages);
        std::size_t at[3] = {one.z, one.c, one.t};
        if (at[0] >= sizes[0] || at[1] >= sizes[1] || at[2] >= sizes[2]) continue;
        for (std::size_t i = 0; i < count && first + i < pages; ++i) {
            stack.planes[(at[2] * sizes[1] + at[1]) * sizes[0] + at[0]] = {*file, first + i, 0};
            if (!nextPlane(at, sizes, order)) break;
        }
    }
    for (const std::string& name : files.missing())
        source.notes.push_back("Its file " + name + " is not there or cannot be read: what it holds is absent.");
    const auto missing = std::ranges::count(stack.planes, TiffPlane::kNone, &TiffPlane::file);
    if (std::size_t(missing) == stack.planes.size()) throw std::runtime_error("holds no plane of its OME-XML");
    if (missing > 0)
        source.notes.push_back(std::to_string(missing) + " of its " + std::to_string(stack.planes.size()) +
                               " planes are in no file, and absent.");
    const auto held = std::ranges::find_if(stack.planes, [](const TiffPlane& p) { return p.file != TiffPlane::kNone; });
    stack.form = stack.files[held->file].pages[held->page];
}

/// Sizes, and names of the channels whose samples do not lie in one plane.
bool readSizes(const pugi::xml_node& pixels, TiffStack& stack) {
    stack.slices = sizeOf(pixels, "SizeZ", 1);
    stack.times = sizeOf(pixels, "SizeT", 1);
    std::size_t samples = sizeOf(pixels, "SizeC", 1);
    stack.channels = 0;
    stack.channelNames.clear();
    for (const pugi::xml_node& channel : childrenOf(pixels, "Channel")) {
        const std::size_t own = std::max<std::size_t>(1, sizeOf(channel, "SamplesPerPixel", 1));
        if (samples == 0) break;
        samples -= std::min(samples, own);
        ++stack.channels;
        stack.channelNames.emplace_back(channel.attribute("Name").as_string());
    }
    if (samples > 0) { // channels that are not described
        const auto perPlane = std::size_t(stack.form.form.samples);
        stack.channels += std::max<std::size_t>(1, samples / (stack.channels == 0 ? perPlane : 1));
        stack.channelNames.resize(stack.channels);
    }
    constexpr std::size_t kMostPlanes = 100'000'000;
    const double planes = double(stack.slices) * double(stack.times) * double(stack.channels);
    return planes >= 1 && planes <= double(kMostPlanes);
}

} // namespace

bool arrangeOme(TiffStack& stack, const std::string& description, Source& source) {
    if (description.find("<OME") == std::string::npos && description.find(":OME") == std::string::npos) return false;
    const std::string text = wholeDescription(description, stack.files[0].path);
    pugi::xml_document document;
    std::size_t index = 0;
    pugi::xml_node image;
    const auto parsed = document.load_buffer(text.data(), text.size());
    if (parsed) image = imageIn(document.document_element(), fileNameOf(stack.files[0].path), index);
    const pugi::xml_node pixels = childOf(image, "Pixels");
    if (!pixels || !readSizes(pixels, stack)) {
        stack.slices = stack.channels = stack.times = 1;
        stack.channelNames.clear();
        source.notes.emplace_back(
            parsed && childOf(document.document_element(), "BinaryOnly")
                ? "Its file of metadata is not beside it: pages are read as slices, without spacing, channels and "
                  "times."
                : "Its OME-XML cannot be read: pages are read as slices, without spacing, channels and times.");
        return false;
    }
    std::string order = pixels.attribute("DimensionOrder").as_string("XYZCT");
    order = order.size() == 5 ? order.substr(2) : "ZCT";
    placePlanes(statementsOf(pixels), order, stack, source);
    readOmeScale(pixels, stack, source);
    readOmeTimes(pixels, stack, source);
    const std::vector<pugi::xml_node> images = childrenOf(document.document_element(), "Image");
    if (images.size() > 1)
        source.notes.push_back("Of its " + std::to_string(images.size()) + " images number " +
                               std::to_string(index + 1) + " (\"" + image.attribute("Name").as_string() +
                               "\") is read; the others are left out.");
    if (sizeOf(pixels, "SizeX", stack.form.form.width) != stack.form.form.width ||
        sizeOf(pixels, "SizeY", stack.form.form.height) != stack.form.form.height)
        source.notes.push_back("Its OME-XML states another size than its pages, which have " + textOf(stack.form.form) +
                               ".");
    return true;
}

} // namespace tessera::importer
