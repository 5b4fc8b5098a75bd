#include "app/command/command.h"
#include "app/data/import_options.h"
#include "codec/archive/archive.h"
#include "codec/container/json_text.h"
#include "codec/remote/remote_file.h"
#include "volume/base/byte_text.h"
#include "volume/base/terminal.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

namespace tessera::app {

namespace {

/// Describes the damage in one line.
std::string verdictOf(const codec::VerifyReport& report) {
    const auto counted = [](std::uint64_t count, const char* one, const char* more) {
        return std::to_string(count) + (count == 1 ? one : more);
    };
    const std::string places = counted(report.damaged, " place is damaged", " places are damaged");
    if (report.damagedBricks == 0) return places + ", all bricks can be read";
    return std::to_string(report.damagedBricks) + " of " + counted(report.bricks, " brick", " bricks") +
           " cannot be read, the rest can; " + places;
}

struct VerifyRequest {
    std::string path;
    codec::RemoteOptions remote;
    bool json = false;
};

void run(const VerifyRequest& request) {
    const auto& [path, remote, json] = request;
    codec::forgetRemote(path, remote); // the bytes there are checked, not those that were read before
    const codec::Archive archive(path, remote);
    const codec::VerifyReport report = codec::verifyArchive(archive, terminalProgress("verify"));
    // A crash may damage one of the two headers; the data are intact then.
    const bool whole = report.damaged == (report.damagedHeader ? 1 : 0);
    if (json) {
        sayJson(jsonText({{"file", path},
                          {"ok", whole},
                          {"bricks", report.bricks},
                          {"samples", report.samples},
                          {"bytes", archive.fileBytes()},
                          {"damaged", report.damaged},
                          {"damagedBricks", report.damagedBricks},
                          {"damage", report.damage}},
                         1));
    } else {
        for (const std::string& line : report.damage) warn("%s: %s\n", path.c_str(), line.c_str());
    }
    if (!whole) throw Error(verdictOf(report), path);
    if (!json)
        say("%s: whole%s; %llu brick%s decoded at every level, %s checked\n", path.c_str(),
            report.damagedHeader ? " but for one copy of the header, which the next append replaces" : "",
            static_cast<unsigned long long>(report.bricks), report.bricks == 1 ? "" : "s",
            textOfBytes(double(archive.fileBytes())).c_str());
}

} // namespace

void addVerifyCommand(CLI::App& app) {
    CLI::App* command = app.add_subcommand("verify", "Check every byte of an archive and decode every brick");
    command->footer("The exit status is 0 if the archive is intact or only one of its two header copies is damaged (a "
                    "crash can leave it so; nothing is lost), and 2 for any other damage.");
    const auto request = std::make_shared<VerifyRequest>();
    command->add_option("IN", request->path, "Archive (.tsr), also by its address on another machine")->required();
    command->add_flag("--json", request->json, "Print the result as JSON");
    addRemoteOptions(*command, request->remote);
    command->callback([request] { run(*request); });
}

} // namespace tessera::app
