#include "app/data/pack_child.h"

#include "app/data/import_options.h"
#include "volume/base/error.h"
#include "volume/system/process.h"

#include <nlohmann/json.hpp>
#include <optional>

namespace tessera::app {

namespace {

/// The next line the child prints, without its end; nothing once it has closed its output.
std::optional<std::string> readLine(volume::ChildProcess& child, const Progress& progress) {
    std::string line;
    std::byte byte{};
    const auto waiting = [&] {
        if (progress.stop.stop_requested()) throw Cancelled();
    };
    while (child.read({&byte, 1}, waiting)) {
        if (static_cast<char>(byte) == '\n') return line;
        line += static_cast<char>(byte);
    }
    return std::nullopt;
}

} // namespace

PackedArchive packInChild(const std::string& program, const std::vector<std::string>& files,
                          const volume::ImportOptions& import, const std::string& output, const Progress& progress) {
    std::vector<std::string> arguments{program, "pack", "--progress-json", "-o", output};
    for (const std::string& argument : importArguments(import)) arguments.push_back(argument);
    arguments.insert(arguments.end(), files.begin(), files.end());

    volume::ChildProcess child(arguments);
    PackedArchive packed;
    while (const std::optional<std::string> line = readLine(child, progress)) {
        const nlohmann::json json = nlohmann::json::parse(*line, nullptr, false);
        if (!json.is_object()) continue;
        if (json.contains("archiveBytes")) {
            packed.sourceBytes = json.value("sourceBytes", 0.0);
            packed.archiveBytes = json.value("archiveBytes", 0.0);
            packed.seconds = json.value("seconds", 0.0);
        } else {
            progress.advance(json.value("fraction", 0.0), json.value("what", std::string()));
        }
    }
    const std::string ending = child.ending();
    if (!ending.empty()) throw Error("packing " + ending, output);
    return packed;
}

} // namespace tessera::app
