#include "app/command/command.h"
#include "app/command/merge_layouts.h"
#include "app/data/format.h"
#include "app/data/import_options.h"
#include "app/data/open.h"
#include "app/data/picture_session.h"
#include "app/data/spacing_text.h"
#include "app/described/describe_cli.h"
#include "app/history/session_file.h"
#include "app/user_files/import_memory.h"
#include "codec/archive/archive.h"
#include "codec/container/exactness.h"
#include "codec/container/json_text.h"
#include "codec/pack/error_bound.h"
#include "codec/remote/address.h"
#include "volume/base/byte_text.h"
#include "volume/base/terminal.h"
#include "volume/field/axes_json.h"
#include "volume/import/find_parts.h"
#include "volume/import/import.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

namespace tessera::app {

namespace {

/// What an archive says of its data, at the times of its source.
volume::DatasetInfo infoOf(const codec::Archive& archive) {
    volume::DatasetInfo info = archive.info();
    if (!archive.metadata().alternating) return info;
    info.times = archive.metadata().sourceTimes;
    info.quantities = archive.metadata().sourceQuantities;
    return info;
}

std::uint64_t bytesOf(const std::vector<FileRange>& parts) {
    std::uint64_t bytes = 0;
    for (const FileRange& part : parts) bytes += part.length;
    return bytes;
}

Json vectorJson(const auto& v) {
    return {v.x, v.y, v.z};
}

/// The resampling error of a parameter; null if not known.
Json resampledJson(const codec::Metadata& metadata, std::size_t parameter, double extent) {
    if (parameter >= metadata.resampled.size() || !metadata.resampled[parameter]) return nullptr;
    const codec::ResampleError& error = *metadata.resampled[parameter];
    const double psnr = codec::psnrOf(error, extent);
    return {{"psnr", std::isfinite(psnr) ? Json(psnr) : Json()},
            {"rms", std::sqrt(error.meanSquare)},
            {"largest", error.largest},
            {"samples", error.samples},
            {"share", error.share}};
}

Json archiveJson(const codec::Archive& archive) {
    const volume::DatasetInfo info = infoOf(archive);
    const volume::BrickGrid& grid = archive.grid();
    Json parameters = Json::array(), levels = Json::array();
    double stored = 0;
    for (const volume::Parameter& parameter : info.parameters) {
        Json entry = {{"name", parameter.name},
                      {"unit", parameter.unit},
                      {"components", parameter.components},
                      {"type", volume::name(parameter.type)},
                      {"categorical", parameter.categorical},
                      {"labels", Json::object()},
                      {"parts", {{"label", parameter.parts.label}, {"regions", parameter.parts.regions}}},
                      {"ranges", Json::array()}};
        if (parameter.unitGuessed) entry["unitGuessed"] = true;
        for (const volume::Label& label : parameter.labels) entry["labels"][std::to_string(label.value)] = label.name;
        for (const Range& range : parameter.ranges) entry["ranges"].push_back({range.lo, range.hi});
        if (codec::isResampled(archive.metadata()))
            entry["resampled"] = resampledJson(archive.metadata(), parameters.size(), volume::extentOf(parameter));
        parameters.push_back(std::move(entry));
        stored += double(info.lattice.count()) * double(info.times.size()) * parameter.components *
                  double(volume::byteSize(parameter.type));
    }
    for (int level = 0; level < grid.levels; ++level)
        levels.push_back({{"samples", vectorJson(grid.levelSamples(level))}, {"bytes", archive.levelBytes(level)}});
    Json document = {
        {"kind", "archive"},
        {"file", archive.path()},
        {"bytes", archive.fileBytes()},
        {"version", archive.version()},
        {"commits", archive.commits()},
        {"storedBytes", stored},
        {"name", info.name},
        {"lattice", archive.metadata().alternating ? "d4" : volume::kLatticeNames[std::size_t(info.lattice.kind)]},
        {"size", vectorJson(info.lattice.size)},
        {"spacing", vectorJson(info.lattice.spacing)},
        {"origin", vectorJson(info.lattice.origin)},
        {"sourceSize", vectorJson(archive.metadata().source.size)},
        {"bounds", {vectorJson(info.bounds.lo), vectorJson(info.bounds.hi)}},
        {"lengthUnit", info.lengthUnit},
        {"parameters", std::move(parameters)},
        {"times", info.times},
        {"timeName", info.timeName},
        {"timeUnit", info.timeUnit},
        {"quantities", quantitiesJson(info)},
        {"brickSize", grid.brickSize},
        {"levels", std::move(levels)},
        {"masks", archive.maskCount()},
        {"maskBytes", archive.maskBytes()},
        {"correctionBytes", bytesOf(archive.metadata().corrections)},
        {"regionNumberBytes", bytesOf(archive.metadata().numbers)},
        {"repeatedBricks", archive.repeats().bricks},
        {"repeatedBytes", archive.repeats().bytes},
        {"lossless", archive.metadata().lossless && !codec::isResampled(archive.metadata())},
        {"maxError", archive.metadata().maxError},
        {"exactness", codec::exactnessText(archive.metadata())},
        {"provenance", info.provenance},
        {"notes", info.notes}};
    if (!info.lattice.isEven()) document["axes"] = Json::parse(volume::axesJson(info.lattice.axes));
    return document;
}

std::string triple(glm::ivec3 v) {
    return std::to_string(v.x) + " x " + std::to_string(v.y) + " x " + std::to_string(v.z);
}

void printArchive(const codec::Archive& archive) {
    const volume::DatasetInfo info = infoOf(archive);
    const volume::BrickGrid& grid = archive.grid();
    const glm::dvec3 extent = info.bounds.size();
    say("%s (archive, %s, %s)\n", info.name.c_str(), textOfBytes(double(archive.fileBytes())).c_str(),
        codec::exactnessText(archive.metadata()).c_str());
    say("  samples    %s on %s, from a grid of %s\n", triple(info.lattice.size).c_str(),
        archive.metadata().alternating                  ? "D4* (each time)"
        : info.lattice.kind == volume::LatticeKind::BCC ? "BCC"
                                                        : "CC",
        triple(archive.metadata().source.size).c_str());
    volume::DatasetInfo ofSource = info;
    ofSource.lattice = archive.metadata().source;
    if (const std::string spacing = spacingText(ofSource); !spacing.empty()) say("  spacing    %s\n", spacing.c_str());
    say("  extent     %s x %s x %s%s%s\n", numberText(extent.x).c_str(), numberText(extent.y).c_str(),
        numberText(extent.z).c_str(), info.lengthUnit.empty() ? "" : " ", info.lengthUnit.c_str());
    say("  times      %s\n", timesText(info).c_str());
    say("%s", quantityLines(info).c_str());
    if (archive.commits() > 1) say("  written    in %d steps\n", archive.commits());
    say("  bricks     %s of %d, levels from fine to coarse:", triple(grid.count()).c_str(), grid.brickSize);
    for (int level = 0; level < grid.levels; ++level)
        say("%s %s", level > 0 ? "," : "", textOfBytes(double(archive.levelBytes(level))).c_str());
    say("\n");
    if (archive.maskCount() > 0)
        say("  masks      %d, %s\n", archive.maskCount(), textOfBytes(double(archive.maskBytes())).c_str());
    if (const std::uint64_t bytes = bytesOf(archive.metadata().corrections); bytes > 0)
        say("  corrected  to the samples of the source, by %s\n", textOfBytes(double(bytes)).c_str());
    if (const std::uint64_t bytes = bytesOf(archive.metadata().numbers); bytes > 0)
        say("  regions    their numbers as computed from the source, %s\n", textOfBytes(double(bytes)).c_str());
    if (const auto repeats = archive.repeats(); repeats.bricks > 0)
        say("  repeats    %llu bricks equal those of the time before, which saves %s\n",
            static_cast<unsigned long long>(repeats.bricks), textOfBytes(double(repeats.bytes)).c_str());
    say("  parameters\n");
    for (std::size_t p = 0; p < info.parameters.size(); ++p) {
        const volume::Parameter& parameter = info.parameters[p];
        say("    %-16s %-8s %-8s", parameter.name.c_str(), std::string(volume::name(parameter.type)).c_str(),
            (parameter.unit + (parameter.unitGuessed ? " (guessed)" : "")).c_str());
        if (parameter.components > 1) say(" vector of %d, length", parameter.components);
        const bool hasRange = !parameter.ranges.empty() && !parameter.categorical;
        if (hasRange)
            say(" %s .. %s", numberText(parameter.ranges.back().lo).c_str(),
                numberText(parameter.ranges.back().hi).c_str());
        std::string more; // after a range, else the first
        for (const volume::Label& label : parameter.labels)
            more += (more.empty() ? " " : ", ") + std::to_string(label.value) +
                    (label.name.empty() ? "" : " " + label.name);
        if (parameter.parts.count() > 1) more += (more.empty() ? " " : ", ") + volume::partsText(parameter);
        say("%s%s", hasRange && !more.empty() ? "," : "", more.c_str());
        if (const std::string words = codec::resampledText(archive.metadata(), p); !words.empty())
            say("  (%s)", words.c_str());
        say("\n");
    }
    if (!info.provenance.empty()) say("  %s\n", info.provenance.c_str());
    for (const std::string& note : info.notes) say("  %s\n", note.c_str());
}

void printSession(const std::string& path, bool asJson) {
    const SessionDocument document =
        namesPicture(path) ? parseSession(sessionTextOfPicture(path), path) : loadSession(path);
    const Session& session = document.session;
    Json files = Json::array(), layers = Json::array(), views = Json::array();
    for (const DataFile& file : session.data.files) files.push_back(file.path);
    for (const auto& [key, view] : session.views) views.push_back(key);
    if (asJson) {
        sayJson(jsonText({{"kind", "session"},
                          {"file", path},
                          {"schema", session.schema},
                          {"title", session.title},
                          {"files", files},
                          {"model", session.data.model},
                          {"views", views},
                          {"layers", session.layers.size()},
                          {"messages", document.messages}},
                         1));
        return;
    }
    say("%s (session)\n", session.title.empty() ? path.c_str() : session.title.c_str());
    for (const DataFile& file : session.data.files) say("  data       %s\n", file.path.c_str());
    if (session.data.other)
        for (const DataFile& file : session.data.other->files) say("  other data %s\n", file.path.c_str());
    for (const volume::DerivedParameter& each : session.data.derived)
        say("  derived    %s%s\n", each.name.c_str(), each.unit.empty() ? "" : (" [" + each.unit + "]").c_str());
    if (!session.data.model.empty()) say("  model      %s\n", session.data.model.c_str());
    say("  views     ");
    for (const auto& [key, view] : session.views) say(" %s", key.c_str());
    say("\n  layers     %zu\n", session.layers.size());
    for (const std::string& message : document.messages) say("  %s\n", message.c_str());
}

/// Calls `visit(channel, time, brick)` for every stored component of every brick.
template <class Visit> void forBricks(const codec::Archive& archive, Visit&& visit) {
    const auto channels = archive.info().channels();
    const volume::BrickGrid& grid = archive.grid();
    for (std::size_t time = 0; time < archive.info().times.size(); ++time)
        for (std::size_t channel = 0; channel < channels.size(); ++channel)
            for (std::size_t n = 0; !channels[channel].magnitude && n < grid.brickCount(); ++n)
                visit(int(channel), int(time), grid.indexOf(n));
}

/// Change of a brick since the previous frame, if there is one and its change is known.
std::optional<volume::BrickChange> lastChange(const codec::Archive& archive, const volume::BrickKey& key) {
    const int before = key.time - (archive.metadata().alternating ? 2 : 1);
    return before < 0 ? std::nullopt : archive.change(key, before);
}

Json bricksJson(const codec::Archive& archive) {
    Json bricks = Json::array();
    const auto channels = archive.info().channels();
    forBricks(archive, [&](int channel, int time, glm::ivec3 brick) {
        const volume::BrickKey key{channel, time, 0, brick};
        const volume::BrickStats stats = archive.stats(key);
        Json entry = {{"channel", channels[std::size_t(channel)].name},
                      {"time", archive.info().times[std::size_t(time)]},
                      {"brick", vectorJson(brick)},
                      {"presentFraction", stats.presentFraction},
                      {"bytes", archive.brickBytes(key)},
                      {"repeats", archive.repeats(key)}};
        if (stats.presentFraction > 0) entry["range"] = {stats.min, stats.max};
        if (const auto distribution = archive.distribution(key); distribution && distribution->samples > 0) {
            entry["samples"] = distribution->samples;
            entry["mean"] = distribution->mean;
            entry["histogram"] = distribution->counts;
        }
        if (const auto importance = archive.importance(key)) {
            entry["importance"] = importance->importance;
            entry["detail"] = importance->detail;
        }
        if (const auto change = lastChange(archive, key)) {
            // JSON cannot represent infinity.
            entry["change"] = std::isfinite(change->max) ? Json(change->max) : Json("appears");
            entry["changeRms"] = std::isfinite(change->rms) ? Json(change->rms) : Json("appears");
        }
        bricks.push_back(std::move(entry));
    });
    return bricks;
}

/// A histogram as a row of bars, with heights by the square root of the counts.
std::string barsOf(const std::vector<std::uint32_t>& counts) {
    constexpr const char* kBars[] = {" ",      "\u2581", "\u2582", "\u2583", "\u2584",
                                     "\u2585", "\u2586", "\u2587", "\u2588"};
    std::uint32_t most = 1;
    for (const std::uint32_t count : counts) most = std::max(most, count);
    std::string bars;
    for (const std::uint32_t count : counts)
        bars += kBars[std::size_t(std::ceil(8 * std::sqrt(double(count) / double(most))))];
    return bars;
}

void printBricks(const codec::Archive& archive) {
    const auto channels = archive.info().channels();
    say("  %-16s %12s %-10s %10s %10s %10s %7s %9s %6s %11s %11s %8s  %s\n", "channel", "time", "brick", "min", "max",
        "mean", "present", "importance", "detail", "change", "change RMS", "bytes", "histogram");
    forBricks(archive, [&](int channel, int time, glm::ivec3 brick) {
        const volume::BrickKey key{channel, time, 0, brick};
        const volume::BrickStats stats = archive.stats(key);
        const auto importance = archive.importance(key);
        const auto distribution = archive.distribution(key);
        const auto change = lastChange(archive, key);
        const bool any = stats.presentFraction > 0;
        const std::string place =
            std::to_string(brick.x) + "," + std::to_string(brick.y) + "," + std::to_string(brick.z);
        const auto changeText = [&](float value) {
            return std::isfinite(value) ? numberText(double(value)) : std::string("appears");
        };
        say("  %-16s %12s %-10s %10s %10s %10s %6.1f%% %10s %6s %11s %11s %8s  %s\n",
            channels[std::size_t(channel)].name.c_str(), numberText(archive.info().times[std::size_t(time)]).c_str(),
            place.c_str(), any ? numberText(double(stats.min)).c_str() : "-",
            any ? numberText(double(stats.max)).c_str() : "-",
            distribution && distribution->samples > 0 ? numberText(distribution->mean).c_str() : "-",
            100.0 * double(stats.presentFraction),
            importance ? numberText(std::round(1000 * double(importance->importance)) / 1000).c_str() : "-",
            importance ? numberText(std::round(1000 * double(importance->detail)) / 1000).c_str() : "-",
            change ? changeText(change->max).c_str() : "-", change ? changeText(change->rms).c_str() : "-",
            archive.repeats(key) > 0 ? "repeats" : std::to_string(archive.brickBytes(key)).c_str(),
            distribution ? barsOf(distribution->counts).c_str() : "");
    });
}

struct InfoRequest {
    std::vector<std::string> paths;
    volume::ImportOptions import;
    volume::MergeOptions merging;
    codec::RemoteOptions remote;
    bool json = false, bricks = false, merge = false;
};

void describeArchive(const InfoRequest& request) {
    const codec::Archive archive(request.paths[0], request.remote);
    std::vector<MergeLayout> layouts;
    if (request.merge) layouts = mergeLayouts(archive, request.merging, terminalProgress("info"));
    if (request.json) {
        Json document = archiveJson(archive);
        if (request.bricks) document["bricks"] = bricksJson(archive);
        if (request.merge) document["merged"] = layoutsJson(layouts, request.merging);
        sayJson(jsonText(document, 1));
        return;
    }
    printArchive(archive);
    if (request.bricks) printBricks(archive);
    if (request.merge) printLayouts(archive, layouts, request.merging);
}

volume::ImportPreview previewOf(const std::vector<std::string>& paths, const volume::ImportOptions& stated) {
    if (paths.size() != 1 || !namesModel(paths[0])) {
        requireData(paths);
        return volume::previewFiles(paths, recallOptions(paths, stated), terminalProgress("info"));
    }
    const volume::Dataset model = modelNamed(paths[0], stated, terminalProgress("info"));
    return {.format = "built-in model", .info = model.info, .bytes = volume::bytesOf(model.info), .notes = {}};
}

void describe(const InfoRequest& request) {
    const std::vector<std::string>& paths = request.paths;
    const bool asJson = request.json;
    if (paths.size() == 1 && codec::namesArchive(paths[0])) {
        describeArchive(request);
    } else if (request.bricks || request.merge) {
        throw Error("only archives (.tsr) have bricks", paths[0]);
    } else if (paths.size() == 1 &&
               (opensAsPicture(paths[0]) || (hasEnding(paths[0], ".json") && looksLikeSession(readText(paths[0]))))) {
        printSession(paths[0], asJson);
    } else {
        const volume::ImportPreview preview = previewOf(paths, request.import);
        say("%s%s", (asJson ? describePreviewJson(preview) : describePreview(preview)).c_str(), asJson ? "\n" : "");
    }
}

} // namespace

void addInfoCommand(CLI::App& app) {
    CLI::App* command = app.add_subcommand("info", "Describe a data file, an archive, a session or a picture");
    const auto request = std::make_shared<InfoRequest>();
    command
        ->add_option(
            "FILE", request->paths,
            "Archive, session, picture exported by Tessera, data files that belong together, or a built-in model")
        ->required();
    command->add_flag("--json", request->json, "Print JSON with stable keys");
    command->add_flag("--bricks", request->bricks,
                      "Of an archive, list every brick of every component and time: range, mean, histogram, "
                      "importance, change from the time before, bytes");
    command->add_flag(
        "--merge", request->merge,
        "Of an archive, list how its bricks could be merged into larger ones, and the bytes these would take");
    addDescribed(*command, request->merging, "merge.");
    addImportOptions(*command, request->import);
    addRemoteOptions(*command, request->remote);
    command->callback([request] { describe(*request); });
}

} // namespace tessera::app
