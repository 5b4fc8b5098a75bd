#include "codec/container/metadata.h"

#include "codec/bytes/lzma.h"
#include "codec/container/container.h"
#include "codec/container/json_text.h"
#include "codec/container/options_json.h"
#include "codec/container/stored_lattice.h"
#include "volume/base/error.h"
#include "volume/field/axes_json.h"

#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>

namespace tessera::codec {

namespace {

using nlohmann::json;

json parameterJson(const volume::Parameter& parameter) {
    json labels = json::array(), ranges = json::array();
    for (const volume::Label& label : parameter.labels) {
        labels.push_back({{"value", label.value}, {"name", label.name}});
        if (!label.color.empty()) labels.back()["color"] = label.color;
    }
    for (const Range& range : parameter.ranges) ranges.push_back({range.lo, range.hi});
    json out = {{"name", parameter.name},
                {"unit", parameter.unit},
                {"components", parameter.components},
                {"type", volume::name(parameter.type)},
                {"categorical", parameter.categorical},
                {"labels", std::move(labels)},
                {"ranges", std::move(ranges)}};
    if (!parameter.parts.label.empty())
        out["parts"] = {{"label", parameter.parts.label}, {"regions", parameter.parts.regions}};
    if (parameter.unitGuessed) out["unitGuessed"] = true;
    return out;
}

/// Numbers as JSON, null if unknown.
json quantityJson(const volume::Quantity& quantity) {
    json values = json::array();
    for (const double value : quantity.values) values.push_back(std::isfinite(value) ? json(value) : json());
    return {{"name", quantity.name}, {"unit", quantity.unit}, {"values", std::move(values)}};
}

std::vector<double> readTimes(const Node& node) {
    std::vector<double> times;
    for (const Node& time : node.items(1 << 20)) {
        if (!times.empty() && !(time.number() > times.back())) time.fail("times do not increase");
        times.push_back(time.number());
    }
    if (times.empty()) node.fail("no times");
    return times;
}

volume::Parameter readParameter(const Node& node) {
    volume::Parameter parameter;
    parameter.name = node["name"].text();
    parameter.unit = node["unit"].text();
    parameter.components = node["components"].integer(1, 64);
    const auto type = volume::parseScalarType(node["type"].text());
    if (!type) node["type"].fail("unknown number type");
    parameter.type = *type;
    parameter.categorical = node["categorical"].flag();
    constexpr int kMost = 1 << 30;
    for (const Node& label : node["labels"].items(65536))
        parameter.labels.push_back({label["value"].integer(-kMost, kMost), label["name"].text(),
                                    label.has("color") ? label["color"].text() : std::string()});
    if (node.has("parts")) {
        parameter.parts.label = node["parts"]["label"].text();
        for (const Node& part : node["parts"]["regions"].items(65536)) {
            std::vector<int>& values = parameter.parts.regions.emplace_back();
            for (const Node& value : part.items(65536)) values.push_back(value.integer(-kMost, kMost));
        }
    }
    if (node.has("unitGuessed")) parameter.unitGuessed = node["unitGuessed"].flag();
    for (const Node& range : node["ranges"].items(65)) {
        const auto ends = range.items(2);
        if (ends.size() != 2) range.fail("not two numbers");
        parameter.ranges.push_back({ends[0].number(), ends[1].number()});
    }
    return parameter;
}

volume::Quantity readQuantity(const Node& node) {
    volume::Quantity quantity{node["name"].text(), node["unit"].text(), {}};
    for (const Node& value : node["values"].items(1 << 20))
        quantity.values.push_back(value.isNull() ? std::nan("") : value.number());
    return quantity;
}

/// Per parameter, null if unknown.
json resampledJson(const std::vector<std::optional<ResampleError>>& resampled) {
    json out = json::array();
    for (const std::optional<ResampleError>& error : resampled)
        out.push_back(error ? json{{"meanSquare", error->meanSquare},
                                   {"largest", error->largest},
                                   {"samples", error->samples},
                                   {"share", error->share}}
                            : json());
    return out;
}

std::vector<std::optional<ResampleError>> readResampled(const Node& node, std::size_t parameters) {
    std::vector<std::optional<ResampleError>> resampled;
    for (const Node& error : node.items(parameters))
        resampled.push_back(error.isNull()
                                ? std::nullopt
                                : std::optional(ResampleError{error["meanSquare"].number(), error["largest"].number(),
                                                              error["samples"].number(), error["share"].number()}));
    return resampled;
}

/// Everything except the times, which are in the index.
std::string toJson(const Metadata& metadata) {
    const volume::DatasetInfo& info = metadata.info;
    json parameters = json::array();
    for (const volume::Parameter& parameter : info.parameters) parameters.push_back(parameterJson(parameter));
    json document = {
        {"program", metadata.program},
        {"data",
         {{"name", info.name},
          {"lattice", latticeJson(info.lattice, metadata.alternating)},
          {"bounds", {{"lo", vectorJson(info.bounds.lo)}, {"hi", vectorJson(info.bounds.hi)}}},
          {"lengthUnit", info.lengthUnit},
          {"parameters", std::move(parameters)},
          {"timeUnit", info.timeUnit},
          {"provenance", info.provenance}}},
        {"grid",
         {{"brickSize", metadata.grid.brickSize}, {"levels", metadata.grid.levels}, {"phase", metadata.grid.phase}}},
        {"source", latticeJson(metadata.source)},
        {"lossless", metadata.lossless},
        {"maxError", metadata.maxError},
        {"options", toJson(metadata.options)}};
    if (!info.lattice.isEven()) document["data"]["lattice"]["axes"] = json::parse(volume::axesJson(info.lattice.axes));
    if (info.timeName != volume::DatasetInfo().timeName) document["data"]["timeName"] = info.timeName;
    if (!info.notes.empty()) document["data"]["notes"] = info.notes;
    for (const volume::Quantity& quantity : metadata.alternating ? metadata.sourceQuantities : info.quantities)
        document["data"]["quantities"].push_back(quantityJson(quantity));
    if (!metadata.resampled.empty()) document["resampled"] = resampledJson(metadata.resampled);
    if (metadata.alternating) document["sourceTimes"] = metadata.sourceTimes;
    const auto putRanges = [&](const char* key, const std::vector<FileRange>& ranges) {
        for (const FileRange& range : ranges)
            document[key].push_back({{"offset", range.offset}, {"length", range.length}});
    };
    putRanges("corrections", metadata.corrections);
    putRanges("numbers", metadata.numbers);
    return jsonText(document);
}

Metadata metadataFromJson(std::string_view text, const std::string& file) {
    const json document = json::parse(text, nullptr, false);
    if (document.is_discarded()) throw Error("not JSON", file, "metadata");
    const Node root(document, "", file);
    Metadata metadata;
    metadata.program = root["program"].text();
    metadata.lossless = root["lossless"].flag();
    metadata.maxError = root["maxError"].number();
    metadata.source = readLattice(root["source"]);

    const Node data = root["data"];
    volume::DatasetInfo& info = metadata.info;
    info.name = data["name"].text();
    info.lattice = readLattice(data["lattice"], &metadata.alternating);
    info.bounds = {data["bounds"]["lo"].vector(), data["bounds"]["hi"].vector()};
    info.lengthUnit = data["lengthUnit"].text();
    for (const Node& parameter : data["parameters"].items(kMostParameters))
        info.parameters.push_back(readParameter(parameter));
    if (info.parameters.empty()) data["parameters"].fail("no parameters");
    info.times.clear();
    if (root.has("resampled")) metadata.resampled = readResampled(root["resampled"], info.parameters.size());
    if (metadata.alternating) metadata.sourceTimes = readTimes(root["sourceTimes"]);
    const auto takeRanges = [&](const char* key, std::vector<FileRange>& ranges) {
        if (!root.has(key)) return;
        for (const Node& range : root[key].items(1 << 20))
            ranges.push_back({range["offset"].count(), range["length"].count()});
    };
    takeRanges("corrections", metadata.corrections);
    takeRanges("numbers", metadata.numbers);
    info.timeUnit = data["timeUnit"].text();
    if (data.has("timeName")) info.timeName = data["timeName"].text();
    if (data.has("quantities")) {
        std::vector<volume::Quantity>& quantities = metadata.alternating ? metadata.sourceQuantities : info.quantities;
        for (const Node& quantity : data["quantities"].items(4096)) quantities.push_back(readQuantity(quantity));
    }
    info.provenance = data["provenance"].text();
    if (data.has("notes"))
        for (const Node& note : data["notes"].items(4096)) info.notes.push_back(note.text());

    readAxes(data["lattice"], metadata.source, info.lattice);
    if (!isOfSource(info.lattice, metadata.source, metadata.alternating))
        root["source"].fail("the samples of the data cannot be made of it");
    if (!areOf(info.bounds, metadata.source)) data["bounds"].fail("not the box of the samples");

    const Node grid = root["grid"];
    metadata.grid.lattice = info.lattice;
    metadata.grid.brickSize = grid["brickSize"].integer(4, 128);
    if (!std::has_single_bit(static_cast<unsigned>(metadata.grid.brickSize)))
        grid["brickSize"].fail("not a power of two");
    metadata.grid.levels = grid["levels"].integer(1, std::bit_width(static_cast<unsigned>(metadata.grid.brickSize)));
    metadata.grid.phase = grid["phase"].number();
    if (document.contains("options")) metadata.options = optionsFromJson(document["options"]);
    return metadata;
}

} // namespace

const Metadata& storable(const Metadata& metadata) {
    const std::size_t count = metadata.info.parameters.size();
    if (count > kMostParameters)
        throw Error(std::to_string(count) + " parameters do not fit into an archive, which holds " +
                    std::to_string(kMostParameters) + " at most: choose some with --parameters");
    Metadata known = metadata; // ranges may not be known yet
    for (volume::Parameter& parameter : known.info.parameters) parameter.ranges.clear();
    try {
        metadataFromJson(toJson(known), {});
    } catch (const Error& error) {
        throw Error("does not fit into an archive: " + error.place() + ": " + error.reason());
    }
    return metadata;
}

Bytes serialise(const Metadata& metadata, std::uint32_t features) {
    const std::string text = toJson(metadata);
    const auto plain = std::as_bytes(std::span(text));
    if ((features & kCompact) != 0) return encodeBlock(plain);
    const Bytes packed = Compressor(kMostZstdLevel).compress(plain);
    Bytes out;
    appendU32(out, static_cast<std::uint32_t>(text.size()));
    if (packed.empty())
        out.insert(out.end(), plain.begin(), plain.end());
    else
        out.insert(out.end(), packed.begin(), packed.end());
    return out;
}

namespace {

Metadata parseText(std::span<const std::byte> block, std::uint32_t features, const std::string& file) {
    const auto textOf = [](std::span<const std::byte> bytes) {
        return std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    };
    if ((features & kCompact) != 0) {
        Bytes text;
        if (decodeBlock(block, text) != DecodeStatus::Ok)
            throw Error("the metadata cannot be decoded", file, "metadata");
        return metadataFromJson(textOf(text), file);
    }
    constexpr std::size_t kLeastRatio = 4096; // no text compresses by a higher ratio
    if (block.size() < 4) throw Error("the metadata is truncated", file, "metadata");
    const std::size_t length = readU32(block.data());
    const auto body = block.subspan(4);
    if (length == body.size()) return metadataFromJson(textOf(body), file);
    if (length > kMostMetadata || length / kLeastRatio > body.size())
        throw Error("the metadata has an invalid length", file, "metadata");
    Bytes text(length);
    if (decompress(body, text) != DecodeStatus::Ok) throw Error("the metadata cannot be decoded", file, "metadata");
    return metadataFromJson(textOf(text), file);
}

} // namespace

Metadata parseMetadata(std::span<const std::byte> block, std::uint32_t features, const std::string& file) {
    Metadata metadata = parseText(block, features, file);
    if (!metadata.source.isEven() && (features & kUnevenAxes) == 0)
        throw Error("there are uneven axes that the archive does not declare", file, "metadata /data/lattice/axes");
    return metadata;
}

} // namespace tessera::codec
