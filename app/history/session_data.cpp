#include "app/history/session_file.h"
#include "codec/remote/address.h"
#include "volume/import/files/named_files.h"
#include "volume/system/input_file.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <vector>
#include <xxhash.h>

/// The data files of a session: what is recorded about them, and how they are found again.
namespace tessera::app {

namespace fs = std::filesystem;

namespace {

std::string hex(std::uint64_t value) {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
    return text;
}

/// xxh64 of the first and the last MiB of a file; "" when it cannot be read.
std::string hashOfEnds(const std::string& path, std::uintmax_t bytes) {
    if (!whyNoFile(path).empty()) return {};
    std::ifstream in(path, std::ios::binary);
    if (!in) return {};
    constexpr std::uintmax_t part = 1 << 20;
    XXH64_state_t* state = XXH64_createState();
    XXH64_reset(state, 0);
    std::vector<char> buffer(static_cast<std::size_t>(std::min(bytes, part)));
    in.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    XXH64_update(state, buffer.data(), static_cast<std::size_t>(in.gcount()));
    if (bytes > part) {
        in.seekg(static_cast<std::streamoff>(bytes - std::min(part, bytes - part)));
        in.read(buffer.data(), static_cast<std::streamsize>(std::min(part, bytes - part)));
        XXH64_update(state, buffer.data(), static_cast<std::size_t>(in.gcount()));
    }
    std::string hash = hex(XXH64_digest(state));
    XXH64_freeState(state);
    return hash;
}

/// The hash of a data file as a session keeps it: xxh64 of its first and last MiB, then for every other file that is
/// read with it a line of size, xxh64 and path from the folder of the first.
using OtherFiles = std::map<std::string, std::string>; // by path: size and hash

std::string joinHashes(std::string own, const OtherFiles& others) {
    for (const auto& [path, hash] : others) own += "\n" + hash + " " + path;
    return own;
}

struct Hashes {
    std::string own;
    OtherFiles others;
};

Hashes splitHashes(const std::string& joined) {
    std::istringstream lines(joined);
    Hashes hashes;
    std::getline(lines, hashes.own);
    for (std::string line; std::getline(lines, line);) {
        const std::size_t second = line.find(' ', line.find(' ') + 1);
        if (second != std::string::npos) hashes.others[line.substr(second + 1)] = line.substr(0, second);
    }
    return hashes;
}

/// A line for each companion file that has changed.
void compareOthers(const OtherFiles& wanted, const OtherFiles& now, const std::string& path,
                   std::vector<std::string>& warnings) {
    if (wanted.empty()) return;       // saved by an older version, or there are none
    constexpr std::size_t kMost = 20; // lines
    std::vector<std::string> lines;
    const auto nameOf = [folder = fs::path(path).parent_path()](const std::string& other) {
        return (folder / other).lexically_normal().generic_string();
    };
    for (const auto& [other, hash] : wanted) {
        const auto found = now.find(other);
        if (found == now.end())
            lines.push_back(nameOf(other) + " is no longer opened together with " + path);
        else if (found->second != hash)
            lines.push_back(nameOf(other) + " has changed since the session was saved");
    }
    for (const auto& [other, hash] : now)
        if (!wanted.contains(other))
            lines.push_back(nameOf(other) + " was not opened together with " + path + " when the session was saved");
    if (lines.size() > kMost) {
        const std::size_t more = lines.size() - kMost;
        lines.resize(kMost);
        lines.push_back("and " + std::to_string(more) + " further files of " + path + " have changed");
    }
    warnings.insert(warnings.end(), lines.begin(), lines.end());
}

} // namespace

fs::path absolutePath(const std::string& path) {
    return fs::absolute(path).lexically_normal();
}

DataFile describeFile(const std::string& path) {
    DataFile file;
    if (codec::isRemote(path)) { // its machine is asked only when it is opened
        file.path = file.absolutePath = path;
        return file;
    }
    std::string plain = absolutePath(path).generic_string();
    if (plain.size() > 1 && plain.ends_with('/')) plain.pop_back(); // of a folder
    file.path = file.absolutePath = plain;
    std::error_code problem;
    if (const auto bytes = fs::file_size(file.path, problem); !problem) {
        file.hash = hashOfEnds(file.path, bytes);
        if (!file.hash.empty()) file.bytes = static_cast<double>(bytes);
    }
    const fs::path folder = fs::path(file.absolutePath).parent_path();
    OtherFiles others;
    for (const std::string& other : volume::filesNamedBy(file.path)) {
        const auto bytes = fs::file_size(other, problem);
        if (problem) continue;
        const std::string key = fs::path(other).lexically_relative(folder).generic_string();
        others[key] = std::to_string(bytes) + " " + hashOfEnds(other, bytes);
    }
    file.hash = joinHashes(file.hash, others);
    return file;
}

namespace {

/// The members of a data set, or of the second one, that name files.
struct Named {
    std::vector<DataFile>& files;
    volume::ImportOptions& import;
    std::optional<DataFile>& table;
};

Named named(DataRef& data, bool other) {
    if (other && data.other) return {data.other->files, data.other->import, data.other->table};
    return {data.files, data.import, data.table};
}

/// The recorded table over time; only the path if another one has been stated since.
DataFile tableOf(const Named& of) {
    if (of.table && of.table->absolutePath == of.import.overTime) return *of.table;
    DataFile file;
    file.path = file.absolutePath = of.import.overTime;
    return file;
}

} // namespace

void noteTables(DataRef& data) {
    for (const bool other : {false, true}) {
        if (other && !data.other) break;
        const Named of = named(data, other);
        if (of.import.overTime.empty()) {
            of.table.reset();
            continue;
        }
        of.import.overTime = absolutePath(of.import.overTime).generic_string();
        if (!of.table || of.table->absolutePath != of.import.overTime) of.table = describeFile(of.import.overTime);
    }
}

void locate(DataRef& data, const MissingData& missing, const std::string& path) {
    const Named of = named(data, missing.other);
    if (!missing.table) {
        of.files[missing.index] = describeFile(path);
        return;
    }
    of.table = describeFile(path);
    of.import.overTime = of.table->absolutePath;
}

ResolvedData resolveData(const DataRef& data, const std::string& folder) {
    ResolvedData resolved;
    resolved.data = data;
    const fs::path base = absolutePath(folder.empty() ? "." : folder);
    const auto in = [&base](const fs::path& path) { return path.empty() ? path : base / path; };
    const auto find = [&](DataFile& file) {
        const DataFile wanted = file;
        for (const std::string& address : {wanted.absolutePath, wanted.path})
            if (codec::isRemote(address)) {
                file = describeFile(address);
                return true;
            }
        const fs::path candidates[] = {in(wanted.path), fs::path(wanted.absolutePath),
                                       in(fs::path(wanted.path).filename())};
        for (const fs::path& candidate : candidates) {
            std::error_code problem;
            if (candidate.empty() || !fs::exists(candidate, problem)) continue;
            file = describeFile(candidate.string());
            const Hashes was = splitHashes(wanted.hash), now = splitHashes(file.hash);
            if (!was.own.empty() && now.own != was.own)
                resolved.warnings.push_back(file.path + " has changed since the session was saved (xxh64 " + now.own +
                                            ", was " + was.own + ")");
            compareOthers(was.others, now.others, file.path, resolved.warnings);
            return true;
        }
        return false;
    };
    for (const bool other : {false, true}) {
        if (other && !data.other) break;
        const Named of = named(resolved.data, other);
        for (std::size_t i = 0; i < of.files.size(); ++i)
            if (!find(of.files[i])) resolved.missing.push_back({i, of.files[i], other, false});
        if (of.import.overTime.empty()) continue;
        DataFile table = tableOf(of);
        if (!find(table)) {
            resolved.missing.push_back({0, table, other, true});
            continue;
        }
        of.import.overTime = table.absolutePath;
        of.table = std::move(table);
    }
    return resolved;
}

} // namespace tessera::app
