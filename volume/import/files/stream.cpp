#include "volume/import/files/stream.h"

#include "volume/base/error.h"
#include "volume/field/axes_json.h"
#include "volume/field/labels.h"
#include "volume/field/own_axes.h"
#include "volume/import/files/import_limits.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>

namespace tessera::volume {

namespace {

using nlohmann::json;

constexpr std::size_t kMostBlocks = 100'000;
constexpr std::size_t kMostEvents = 100'000; // of an axis
constexpr std::size_t kNumbersOfEvent = 7;

template <class T> T take(std::span<const std::byte> bytes, std::size_t at) {
    T value;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

struct HeaderReader {
    const json& object;
    const std::string& file;
    std::string place;

    [[noreturn]] void fail(const char* key) const {
        throw Error("is missing in its answer, or cannot be used", file, place + key);
    }
    const json& get(const char* key) const {
        const auto at = object.find(key);
        if (at == object.end()) fail(key);
        return *at;
    }
    std::string text(const char* key) const {
        const auto at = object.find(key);
        if (at == object.end()) return {};
        if (!at->is_string()) fail(key);
        return at->get<std::string>();
    }
    bool flag(const char* key) const {
        const json& value = get(key);
        if (!value.is_boolean()) fail(key);
        return value.get<bool>();
    }
    /// Finite numbers.
    std::vector<double> numbers(const char* key, std::size_t atLeast, std::size_t atMost) const {
        const json& value = get(key);
        if (!value.is_array() || value.size() < atLeast || value.size() > atMost) fail(key);
        std::vector<double> out;
        for (const json& item : value) {
            if (!item.is_number() || !std::isfinite(item.get<double>())) fail(key);
            out.push_back(item.get<double>());
        }
        return out;
    }
    glm::dvec3 triple(const char* key) const {
        const std::vector<double> v = numbers(key, 3, 3);
        return {v[0], v[1], v[2]};
    }
};

Array parseArray(const json& entry, const std::string& file, const std::string& place) {
    const HeaderReader reader{entry, file, place + "."};
    if (!entry.is_object()) reader.fail("");
    Array array;
    array.name = reader.text("name");
    array.unit = reader.text("unit");
    if (array.name.empty()) reader.fail("name");
    const json& components = reader.get("components");
    if (components != 1 && components != 3) reader.fail("components");
    array.components = components.get<int>();
    const std::optional<ScalarType> type = parseScalarType(reader.text("type"));
    if (!type) reader.fail("type");
    array.type = *type;
    if (const auto labels = entry.find("labels"); labels != entry.end()) {
        if (!labels->is_object() || labels->size() > kMostArrays) reader.fail("labels");
        for (const auto& [key, name] : labels->items()) {
            int value = 0;
            const auto parsed = std::from_chars(key.data(), key.data() + key.size(), value);
            if (parsed.ec != std::errc() || parsed.ptr != key.data() + key.size() || !name.is_string())
                reader.fail("labels");
            array.labels.push_back(labelOf(value, name.get<std::string>()));
        }
        std::sort(array.labels.begin(), array.labels.end(),
                  [](const Label& a, const Label& b) { return a.value < b.value; });
        array.categorical = !array.labels.empty() && array.components == 1;
    }
    return array;
}

Quantity parseQuantity(const json& entry, std::size_t times, const std::string& file, const std::string& place) {
    const HeaderReader reader{entry, file, place + "."};
    if (!entry.is_object()) reader.fail("");
    Quantity quantity{reader.text("name"), reader.text("unit"), {}};
    if (quantity.name.empty()) reader.fail("name");
    const json& values = reader.get("values");
    if (!values.is_array() || values.size() != std::max<std::size_t>(times, 1)) reader.fail("values");
    for (const json& value : values) {
        if (!value.is_number() && !value.is_null()) reader.fail("values");
        quantity.values.push_back(value.is_null() ? std::nan("") : value.get<double>());
    }
    return quantity;
}

AxisEvents parseEvents(const json& numbers, const HeaderReader& reader) {
    if (!numbers.is_array() || numbers.size() % kNumbersOfEvent != 0 || numbers.size() > kNumbersOfEvent * kMostEvents)
        reader.fail("events");
    AxisEvents events(numbers.size() / kNumbersOfEvent);
    for (std::size_t i = 0; i < events.size(); ++i) {
        AxisEvent& event = events[i];
        double* const fields[] = {&event.place,     &event.begun,          &event.ended,         &event.areaBegun,
                                  &event.areaEnded, &event.perLengthBegun, &event.perLengthEnded};
        for (std::size_t n = 0; n < kNumbersOfEvent; ++n) {
            const json& number = numbers[i * kNumbersOfEvent + n];
            if (!number.is_number() || !std::isfinite(number.get<double>())) reader.fail("events");
            *fields[n] = number.get<double>();
            if (n > 0 && *fields[n] < 0) reader.fail("events");
        }
        if (i > 0 && !(event.place > events[i - 1].place)) reader.fail("events");
    }
    return events;
}

/// The cells of a mesh, or of an uneven grid.
void parseCells(FileBlock& block, const HeaderReader& reader) {
    block.cellSize = reader.triple("cellSize");
    block.cells = reader.numbers("cells", 1, 1)[0];
    for (int axis = 0; axis < 3; ++axis)
        if (block.box.lo[axis] > block.box.hi[axis] || block.cellSize[axis] < 0) reader.fail("box");
    if (!(block.cells >= 1)) reader.fail("cells");
    if (reader.object.contains("volume")) block.volume = reader.numbers("volume", 1, 1)[0];
    block.cellArrays = reader.object.contains("cellArrays") && reader.flag("cellArrays");
    block.boxes = reader.object.contains("boxes") && reader.flag("boxes");
    const auto events = reader.object.find("events");
    if (events == reader.object.end()) return;
    if (!events->is_array() || events->size() != 3) reader.fail("events");
    for (std::size_t axis = 0; axis < 3; ++axis) block.events[axis] = parseEvents((*events)[axis], reader);
}

void parseGrid(FileBlock& block, const HeaderReader& reader) {
    const std::vector<double> dims = reader.numbers("dims", 3, 3);
    block.lattice.spacing = reader.triple("spacing");
    block.lattice.origin = reader.triple("origin");
    double samples = 1;
    for (int axis = 0; axis < 3; ++axis) {
        const double n = dims[std::size_t(axis)];
        if (!(n >= 1 && n <= kMostSamplesPerAxis) || n != std::floor(n)) reader.fail("dims");
        if (!(block.lattice.spacing[axis] > 0)) reader.fail("spacing");
        block.lattice.size[axis] = static_cast<int>(n);
        samples *= n;
    }
    if (samples > 1e12) reader.fail("dims");
    const auto axes = reader.object.find("axes");
    if (axes == reader.object.end()) return;
    block.lattice = withStatedAxes(block.lattice, true, axes->dump(-1, ' ', false, json::error_handler_t::replace),
                                   reader.file, reader.place + "axes");
    block.cellData = hasCells(block.lattice.axes);
    const Box stated = block.box;
    block.box = gridBounds(block.lattice);
    for (int axis = 0; axis < 3 && reader.object.contains("box"); ++axis) // of axes without a map it may be flat
        if (block.lattice.axes[axis] == nullptr && stated.lo[axis] <= stated.hi[axis]) {
            block.box.lo[axis] = stated.lo[axis];
            block.box.hi[axis] = stated.hi[axis];
        }
    if (reader.object.contains("cells")) parseCells(block, reader);
}

FileBlock parseBlock(const json& entry, const std::string& file, const std::string& place) {
    const HeaderReader reader{entry, file, place + "."};
    if (!entry.is_object()) reader.fail("");
    FileBlock block;
    block.file = file;
    block.name = reader.text("name");
    block.lengthUnit = reader.text("lengthUnit");
    block.timeUnit = reader.text("timeUnit");
    block.timeName = reader.text("timeName");
    if (const auto list = entry.find("notes"); list != entry.end()) {
        if (!list->is_array() || list->size() > kMostArrays) reader.fail("notes");
        for (const json& note : *list) {
            if (!note.is_string()) reader.fail("notes");
            block.notes.push_back(note.get<std::string>());
        }
    }
    block.mesh = reader.flag("mesh");
    block.cellData = (block.mesh || entry.contains("cellData")) && reader.flag("cellData");
    if (block.mesh || block.cellData || (entry.contains("axes") && entry.contains("box"))) {
        const std::vector<double> box = reader.numbers("box", 6, 6);
        block.box = {{box[0], box[1], box[2]}, {box[3], box[4], box[5]}};
    }
    if (block.mesh)
        parseCells(block, reader);
    else
        parseGrid(block, reader);
    block.times = reader.numbers("times", 0, kMostTimes);
    for (std::size_t t = 1; t < block.times.size(); ++t)
        if (block.times[t] <= block.times[t - 1]) reader.fail("times");
    if (const auto list = entry.find("quantities"); list != entry.end()) {
        if (!list->is_array() || list->size() > kMostArrays) reader.fail("quantities");
        for (std::size_t q = 0; q < list->size(); ++q)
            block.quantities.push_back(
                parseQuantity((*list)[q], block.times.size(), file, place + ".quantities[" + std::to_string(q) + "]"));
    }
    const json& arrays = reader.get("arrays");
    if (!arrays.is_array() || arrays.size() > kMostArrays) reader.fail("arrays");
    for (std::size_t a = 0; a < arrays.size(); ++a)
        block.arrays.push_back(parseArray(arrays[a], file, place + ".arrays[" + std::to_string(a) + "]"));
    return block;
}

} // namespace

std::uint64_t frameBytes(const Lattice& lattice, ScalarType type, bool mask) {
    return kFrameHeadBytes + std::uint64_t(lattice.count()) * (byteSize(type) + (mask ? 1 : 0));
}

MessageHead parseMessageHead(std::span<const std::byte> bytes, const Lattice& lattice, ScalarType type) {
    if (bytes.size() < kMessageHeadBytes || take<std::uint32_t>(bytes, 0) != kStreamMagic)
        throw Error("its answer is no message");
    const auto kind = take<std::uint32_t>(bytes, 4);
    const auto length = take<std::uint64_t>(bytes, 8);
    if (kind < 1 || kind > 3) throw Error("its answer is of the unknown kind " + std::to_string(kind));
    const MessageHead head{static_cast<MessageKind>(kind), length};
    const bool fits = head.kind == MessageKind::Frame
                          ? length == frameBytes(lattice, type, false) || length == frameBytes(lattice, type, true)
                          : length <= kMostTextBytes;
    if (!fits) throw Error("its answer has the impossible length " + std::to_string(length));
    return head;
}

std::vector<FileBlock> parseStreamHeader(std::string_view text, const std::string& file) {
    const json document = json::parse(text, nullptr, false);
    if (!document.is_object()) // nor is what cannot be parsed
        throw Error("its answer is not JSON", file);
    const HeaderReader reader{document, file, ""};
    const json& list = reader.get("blocks");
    if (!list.is_array() || list.size() > kMostBlocks) reader.fail("blocks");
    std::vector<FileBlock> blocks;
    for (std::size_t p = 0; p < list.size(); ++p) {
        blocks.push_back(parseBlock(list[p], file, "blocks[" + std::to_string(p) + "]"));
        blocks.back().format = reader.text("format");
    }
    return blocks;
}

std::vector<Range> parseRanges(std::string_view text, const std::string& file) {
    const json document = json::parse(text, nullptr, false);
    const bool fits = document.is_object() && document.contains("ranges") && document["ranges"].is_array() &&
                      document["ranges"].size() <= 4;
    if (!fits) throw Error("its answer has no usable ranges", file);
    std::vector<Range> ranges;
    for (const json& pair : document["ranges"]) {
        ranges.push_back({std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()});
        if (pair.is_null()) continue;
        if (!pair.is_array() || pair.size() != 2 || !pair[0].is_number() || !pair[1].is_number())
            throw Error("its answer has no usable ranges", file);
        ranges.back() = {pair[0].get<double>(), pair[1].get<double>()};
    }
    return ranges;
}

std::string latticeWords(const Lattice& lattice) {
    char text[256];
    std::snprintf(text, sizeof text, "%d %d %d %.17g %.17g %.17g %.17g %.17g %.17g", lattice.size.x, lattice.size.y,
                  lattice.size.z, lattice.origin.x, lattice.origin.y, lattice.origin.z, lattice.spacing.x,
                  lattice.spacing.y, lattice.spacing.z);
    std::string words = text;
    for (int axis = 0; axis < 3; ++axis) {
        const AxisMap* map = lattice.axes[axis];
        words += map == nullptr ? " even" : map->of() == AxisMap::Of::Cells ? " cells" : " points";
        if (map == nullptr) continue;
        for (const double plane : map->planes()) {
            std::snprintf(text, sizeof text, " %.17g", plane);
            words += text;
        }
    }
    return words;
}

Lattice parseLatticeWords(std::istream& in) {
    Lattice even;
    in >> even.size.x >> even.size.y >> even.size.z;
    in >> even.origin.x >> even.origin.y >> even.origin.z;
    in >> even.spacing.x >> even.spacing.y >> even.spacing.z;
    AxisMaps axes;
    for (int axis = 0; axis < 3; ++axis) {
        std::string of;
        in >> of;
        if (!in || (of != "even" && of != "cells" && of != "points")) throw Error("bad request");
        if (of == "even") continue;
        if (even.size[axis] < 1 || even.size[axis] > int(kMostSamplesPerAxis)) throw Error("bad request");
        std::vector<double> planes(std::size_t(even.size[axis]) + (of == "cells" ? 1 : 0));
        for (double& plane : planes) in >> plane;
        if (!in) throw Error("bad request");
        axes.of[std::size_t(axis)] = std::make_shared<const AxisMap>(
            of == "cells" ? AxisMap::Of::Cells : AxisMap::Of::Points, std::move(planes));
    }
    even.axes = std::move(axes);
    return even;
}

Field parseFrame(std::span<const std::byte> bytes, const Lattice& lattice, ScalarType type) {
    if (bytes.size() < kFrameHeadBytes) throw Error("its answer has too few samples");
    const auto mask = take<std::uint32_t>(bytes, 4);
    const glm::ivec3 size(take<std::int32_t>(bytes, 8), take<std::int32_t>(bytes, 12), take<std::int32_t>(bytes, 16));
    if (take<std::uint32_t>(bytes, 0) != static_cast<std::uint32_t>(type) || mask > 1 || size != lattice.size ||
        bytes.size() != frameBytes(lattice, type, mask == 1))
        throw Error("its answer has samples of another layout than requested");
    Field field = makeField(lattice, type);
    std::memcpy(field.samples.data(), bytes.data() + kFrameHeadBytes, field.samples.size());
    if (mask == 1) {
        Mask flags(field.count());
        std::memcpy(flags.data(), bytes.data() + kFrameHeadBytes + field.samples.size(), flags.size());
        for (std::uint8_t& flag : flags) flag = flag != 0 ? 1 : 0;
        field.mask = std::make_shared<const Mask>(std::move(flags));
    }
    return field;
}

} // namespace tessera::volume
