#include "app/importer/zarr/ome_zarr.h"

#include "app/importer/readers/check_file.h"
#include "app/importer/readers/give_times.h"
#include "app/importer/zarr/zarr_array.h"
#include "volume/base/unit_conversion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <utility>
#include <vtkDoubleArray.h>
#include <vtkImageData.h>
#include <vtkMatrix3x3.h>
#include <vtkNew.h>
#include <vtkPointData.h>

namespace tessera::importer {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

enum class AxisRole { X, Y, Z, Time, Channel, Other };

struct OmeAxis {
    AxisRole role = AxisRole::Other;
    std::string name, unit;
    double scale = 1, shift = 0; ///< place = shift + scale * index
};

/// One array and what its axes mean.
struct OmeLevel {
    ZarrArray array;
    std::vector<OmeAxis> axes; ///< by axis of the array

    std::size_t lengthOf(AxisRole role) const {
        for (std::size_t axis = 0; axis < axes.size(); ++axis)
            if (axes[axis].role == role) return array.shape[axis];
        return 1;
    }
};

std::string jsonText(const json& object, const char* key) {
    const auto at = object.is_object() ? object.find(key) : object.end();
    return object.is_object() && at != object.end() && at->is_string() ? at->get<std::string>() : std::string();
}

json jsonList(const json& object, const char* key) {
    const auto at = object.is_object() ? object.find(key) : object.end();
    return object.is_object() && at != object.end() && at->is_array() ? *at : json::array();
}

AxisRole roleOf(const std::string& name, const std::string& type) {
    if (name == "x") return AxisRole::X;
    if (name == "y") return AxisRole::Y;
    if (name == "z") return AxisRole::Z;
    if (name == "t" || type == "time") return AxisRole::Time;
    if (name == "c" || type == "channel") return AxisRole::Channel;
    return AxisRole::Other;
}

/// The axes that an image states; those of versions before 0.3 are t, c, z, y, x.
std::vector<OmeAxis> axesOf(const json& image, std::size_t count) {
    std::vector<OmeAxis> axes;
    for (const json& axis : jsonList(image, "axes")) {
        const std::string name = axis.is_string() ? axis.get<std::string>() : jsonText(axis, "name");
        axes.push_back({roleOf(name, jsonText(axis, "type")), name, jsonText(axis, "unit")});
        if (jsonText(axis, "type") == "space" && axes.back().role == AxisRole::Other) axes.back().role = AxisRole::Z;
    }
    if (axes.empty())
        for (const char* name : {"t", "c", "z", "y", "x"}) axes.push_back({roleOf(name, ""), name, ""});
    if (axes.size() != count)
        throw std::runtime_error("is damaged: it names " + std::to_string(axes.size()) + " axes of an array with " +
                                 std::to_string(count));
    std::set<AxisRole> seen;
    for (const OmeAxis& axis : axes)
        if (axis.role != AxisRole::Other && !seen.insert(axis.role).second)
            throw std::runtime_error("is damaged: it names two axes \"" + axis.name + "\"");
    if (!seen.contains(AxisRole::X) || !seen.contains(AxisRole::Y))
        throw std::runtime_error("holds no image: it has no axes x and y");
    return axes;
}

/// Applies scales and translations in their order.
void place(std::vector<OmeAxis>& axes, const json& steps, std::vector<std::string>& notes) {
    for (const json& step : steps) {
        const std::string type = jsonText(step, "type");
        if (type == "identity") continue;
        const json numbers = type == "scale" || type == "translation" ? jsonList(step, type.c_str()) : json::array();
        if (numbers.size() != axes.size()) {
            notes.push_back("a coordinate transformation of the type \"" + type.substr(0, 40) +
                            "\" is not read and left out");
            continue;
        }
        for (std::size_t axis = 0; axis < axes.size(); ++axis) {
            const double number = numbers[axis].is_number() ? numbers[axis].get<double>() : type == "scale" ? 1 : 0;
            if (type == "scale") {
                axes[axis].scale *= number;
                axes[axis].shift *= number;
            } else {
                axes[axis].shift += number;
            }
        }
    }
}

OmeLevel openLevel(const std::string& folder, std::vector<std::string>& notes) {
    const json images = jsonList(zarrJson(folder, ".zattrs"), "multiscales");
    if (images.empty()) throw std::runtime_error("is damaged: its multiscales are empty");
    if (images.size() > 1)
        notes.push_back("the first of " + std::to_string(images.size()) + " multiscales of the folder shown");
    const json levels = jsonList(images.front(), "datasets");
    const std::string path = levels.empty() ? "" : jsonText(levels.front(), "path");
    const fs::path inside = fs::path(path).lexically_normal();
    if (path.empty() || inside.is_absolute() || inside.string().starts_with(".."))
        throw std::runtime_error("is damaged: its multiscales name no array");
    OmeLevel level{openZarrArray((fs::path(folder) / inside).string()), {}};
    level.axes = axesOf(images.front(), level.array.shape.size());
    place(level.axes, jsonList(levels.front(), "coordinateTransformations"), notes);
    place(level.axes, jsonList(images.front(), "coordinateTransformations"), notes);
    for (std::size_t axis = 0; axis < level.axes.size(); ++axis)
        if (level.axes[axis].role == AxisRole::Other && level.array.shape[axis] > 1)
            notes.push_back("axis \"" + level.axes[axis].name + "\": the first of its " +
                            std::to_string(level.array.shape[axis]) + " samples shown");
    return level;
}

struct OmeChannel {
    std::string name;
    std::size_t index = 0;
};

std::vector<OmeChannel> channelsOf(const json& about, std::size_t count) {
    constexpr std::size_t kMost = 1000;
    if (count > kMost) throw std::runtime_error("has " + std::to_string(count) + " channels, more than are read");
    if (count == 1 && jsonList(about.value("omero", json::object()), "channels").empty()) return {{"value", 0}};
    const json named = jsonList(about.value("omero", json::object()), "channels");
    std::vector<OmeChannel> channels;
    std::set<std::string> used;
    for (std::size_t c = 0; c < count; ++c) {
        std::string name = c < named.size() ? jsonText(named[c], "label") : "";
        if (name.empty() || used.contains(name)) name = "channel " + std::to_string(c);
        used.insert(name);
        channels.push_back({name, c});
    }
    return channels;
}

/// The space of one time and channel, in the order in which it is stored.
vtkSmartPointer<vtkDataArray> frameOfLevel(const OmeLevel& level, std::size_t time, std::size_t channel) {
    std::vector<std::size_t> begin(level.axes.size(), 0), count(level.axes.size(), 1);
    for (std::size_t axis = 0; axis < level.axes.size(); ++axis) {
        const AxisRole role = level.axes[axis].role;
        if (role == AxisRole::Time) begin[axis] = level.array.shape[axis] > 1 ? time : 0;
        if (role == AxisRole::Channel) begin[axis] = channel;
        if (role == AxisRole::X || role == AxisRole::Y || role == AxisRole::Z) count[axis] = level.array.shape[axis];
    }
    return readZarr(level.array, begin, count);
}

/// An image whose axes i, j, k are the stored axes of space, the last of the file first.
vtkSmartPointer<vtkImageData> gridOf(const OmeLevel& level) {
    int size[3] = {1, 1, 1}, to = 0;
    double origin[3] = {0, 0, 0}, step[3] = {1, 1, 1};
    bool used[3] = {};
    auto image = vtkSmartPointer<vtkImageData>::New();
    image->GetDirectionMatrix()->Zero();
    for (std::size_t axis = level.axes.size(); axis-- > 0;) {
        const OmeAxis& about = level.axes[axis];
        if (about.role != AxisRole::X && about.role != AxisRole::Y && about.role != AxisRole::Z) continue;
        const auto along = int(about.role);
        if (level.array.shape[axis] > std::size_t(std::numeric_limits<int>::max()) || level.array.shape[axis] == 0)
            throw std::runtime_error("has an axis without samples, or with more than are read");
        size[to] = int(level.array.shape[axis]);
        origin[along] = about.shift;
        step[to] = about.scale != 0 && std::isfinite(about.scale) ? std::abs(about.scale) : 1;
        image->GetDirectionMatrix()->SetElement(along, to, about.scale < 0 ? -1 : 1);
        used[along] = true;
        ++to;
    }
    for (int along = 0; along < 3; ++along)
        if (!used[along]) image->GetDirectionMatrix()->SetElement(along, to++, 1);
    image->SetDimensions(size);
    image->SetOrigin(origin);
    image->SetSpacing(step);
    return image;
}

/// Lengths in the unit of the first axis of space that states one.
void useOneUnit(OmeLevel& level, Source& source) {
    for (const AxisRole role : {AxisRole::X, AxisRole::Y, AxisRole::Z})
        for (OmeAxis& axis : level.axes) {
            if (axis.role != role || axis.unit.empty()) continue;
            const std::string named = volume::lengthUnitNamed(axis.unit);
            const std::string unit = named.empty() ? axis.unit : named;
            if (source.lengthUnit.empty()) source.lengthUnit = unit;
            if (const auto convert = volume::unitConversion(unit, source.lengthUnit)) {
                axis.scale *= convert->factor;
                axis.shift *= convert->factor;
            } else {
                source.notes.push_back("axis \"" + axis.name + "\" is in " + unit + ", shown as " + source.lengthUnit);
            }
        }
}

void stateTimes(const OmeLevel& level, Source& source) {
    static constexpr std::array<std::pair<const char*, const char*>, 7> kUnits = {{{"second", "s"},
                                                                                   {"millisecond", "ms"},
                                                                                   {"microsecond", "us"},
                                                                                   {"nanosecond", "ns"},
                                                                                   {"minute", "min"},
                                                                                   {"hour", "h"},
                                                                                   {"day", "d"}}};
    for (std::size_t axis = 0; axis < level.axes.size(); ++axis) {
        const OmeAxis& about = level.axes[axis];
        if (about.role != AxisRole::Time) continue;
        constexpr std::size_t kMost = 1'000'000;
        if (level.array.shape[axis] > kMost) throw std::runtime_error("states more times than are read");
        std::vector<double> times;
        for (std::size_t t = 0; t < level.array.shape[axis]; ++t)
            times.push_back(about.shift + std::abs(about.scale != 0 ? about.scale : 1) * double(t));
        const bool stated = !about.unit.empty() || about.scale != 1;
        if (times.size() < 2 && !stated) continue;
        giveTimes(source, times);
        source.timeUnit = about.unit.empty() ? (stated ? "" : "step") : about.unit;
        for (const auto& [word, unit] : kUnits)
            if (about.unit == word) source.timeUnit = unit;
    }
}

/// The axes of space in the order of the file, with their lengths.
std::vector<std::pair<AxisRole, std::size_t>> spaceOf(const OmeLevel& level) {
    std::vector<std::pair<AxisRole, std::size_t>> space;
    for (std::size_t axis = 0; axis < level.axes.size(); ++axis) {
        const AxisRole role = level.axes[axis].role;
        if (role == AxisRole::X || role == AxisRole::Y || role == AxisRole::Z)
            space.emplace_back(role, level.array.shape[axis]);
    }
    return space;
}

struct OmeImage {
    std::vector<OmeLevel> levels;                          ///< the image, then its labels
    std::vector<std::pair<std::size_t, OmeChannel>> shown; ///< level and channel
};

/// Labels that belong to the image: arrays of whole numbers on its grid.
void addLabels(const std::string& folder, OmeImage& image, std::vector<std::string>& notes) {
    for (const json& item : jsonList(zarrJson((fs::path(folder) / "labels").string(), ".zattrs"), "labels")) {
        const std::string name = item.is_string() ? item.get<std::string>() : "";
        if (name.empty() || name.find("..") != std::string::npos || name.front() == '/') continue;
        try {
            std::vector<std::string> ignored;
            OmeLevel level = openLevel(besidesIn((fs::path(folder) / "labels").string(), name), ignored);
            const std::size_t times = level.lengthOf(AxisRole::Time);
            if (spaceOf(level) != spaceOf(image.levels.front()) ||
                (times != 1 && times != image.levels.front().lengthOf(AxisRole::Time)))
                throw std::runtime_error("has another grid than its image");
            image.shown.push_back({image.levels.size(), {"label " + name, 0}});
            image.levels.push_back(std::move(level));
        } catch (const std::runtime_error& error) {
            notes.push_back("labels \"" + name + "\" left out: it " + error.what());
        }
    }
}

} // namespace

void openOmeZarr(Source& source, const std::string& folder) {
    const json about = zarrJson(folder, ".zattrs");
    auto image = std::make_shared<OmeImage>();
    image->levels.push_back(openLevel(folder, source.notes));
    OmeLevel& first = image->levels.front();
    useOneUnit(first, source);
    stateTimes(first, source);
    for (const OmeChannel& channel : channelsOf(about, first.lengthOf(AxisRole::Channel)))
        image->shown.push_back({0, channel});
    addLabels(folder, *image, source.notes);
    source.read = [image](std::size_t time) -> vtkSmartPointer<vtkDataObject> {
        const vtkSmartPointer<vtkImageData> grid = gridOf(image->levels.front());
        for (const auto& [level, channel] : image->shown) {
            const auto values = frameOfLevel(image->levels[level], time, channel.index);
            values->SetName(channel.name.c_str());
            grid->GetPointData()->AddArray(values);
        }
        return grid;
    };
}

} // namespace tessera::importer
