#include "app/command/command.h"
#include "app/command/format.h"
#include "codec/archive.h"

#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

namespace tessera::app {

namespace {

void run(const std::string& path, bool json) {
    const codec::Archive archive(path);
    const codec::VerifyReport report = codec::verifyArchive(archive, terminalProgress("verify"));
    if (json) {
        std::printf("%s\n", nlohmann::json{{"file", path},
                                           {"ok", report.damaged == 0},
                                           {"bricks", report.bricks},
                                           {"samples", report.samples},
                                           {"bytes", archive.fileBytes()},
                                           {"damaged", report.damaged},
                                           {"damage", report.damage}}
                                .dump(1)
                                .c_str());
    } else {
        for (const std::string& line : report.damage) std::fprintf(stderr, "%s: %s\n", path.c_str(), line.c_str());
    }
    if (report.damaged > 0)
        throw Error(std::to_string(report.damaged) + " of " + std::to_string(report.bricks) +
                        " bricks are damaged, the rest is readable",
                    path);
    if (!json)
        std::printf("%s: whole; %llu bricks decoded at every level, %s checked\n", path.c_str(),
                    static_cast<unsigned long long>(report.bricks), bytesText(double(archive.fileBytes())).c_str());
}

} // namespace

void addVerifyCommand(CLI::App& app) {
    CLI::App* command = app.add_subcommand("verify", "Check every byte of an archive and decode every brick");
    const auto path = std::make_shared<std::string>();
    const auto json = std::make_shared<bool>(false);
    command->add_option("IN", *path, "Archive (.tsr)")->required();
    command->add_flag("--json", *json, "Print the verdict as JSON");
    command->callback([path, json] { run(*path, *json); });
}

} // namespace tessera::app
