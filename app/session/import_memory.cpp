#include "app/session/import_memory.h"

#include "app/session/describe_json.h"
#include "volume/atomic_file.h"
#include "volume/error.h"
#include "volume/import/absent.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

namespace tessera::app {

namespace fs = std::filesystem;

namespace {

std::map<std::string, std::string> readTexts(const Json& object, const std::string& file, const std::string& place) {
    std::map<std::string, std::string> texts;
    if (!object.is_object()) throw Error("must be an object", file, place);
    for (const auto& [key, value] : object.items()) {
        if (!value.is_string()) throw Error("must be a text", file, place + "/" + key);
        texts[key] = value.get<std::string>();
    }
    return texts;
}

} // namespace

std::string importMemoryPath() {
    if (const char* config = std::getenv("XDG_CONFIG_HOME"); config != nullptr && *config != '\0')
        return (fs::path(config) / "tessera" / "units.json").string();
    if (const char* home = std::getenv("HOME"); home != nullptr && *home != '\0')
        return (fs::path(home) / ".config" / "tessera" / "units.json").string();
    return {};
}

ImportMemory loadImportMemory(const std::string& path) {
    ImportMemory memory;
    if (path.empty() || !fs::exists(path)) return memory;
    std::ifstream in(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    const Json document = Json::parse(text, nullptr, false);
    if (document.is_discarded() || !document.is_object()) throw Error("is not a JSON object", path);
    if (const auto units = document.find("units"); units != document.end())
        memory.units = readTexts(*units, path, "/units");
    if (const auto rename = document.find("rename"); rename != document.end()) {
        if (!rename->is_object()) throw Error("must be an object", path, "/rename");
        for (const auto& [data, names] : rename->items())
            memory.rename[data] = readTexts(names, path, "/rename/" + data);
    }
    if (const auto absent = document.find("absent"); absent != document.end()) {
        if (!absent->is_object()) throw Error("must be an object", path, "/absent");
        for (const auto& [data, rules] : absent->items()) {
            if (!rules.is_array()) throw Error("must be a list", path, "/absent/" + data);
            for (const Json& rule : rules) {
                if (!rule.is_string()) throw Error("must be texts", path, "/absent/" + data);
                volume::parseAbsentRule(rule.get<std::string>());
                memory.absent[data].push_back(rule.get<std::string>());
            }
        }
    }
    return memory;
}

void saveImportMemory(const ImportMemory& memory, const std::string& path) {
    if (path.empty()) throw MachineError("there is no home folder to remember units in");
    std::error_code ignored;
    fs::create_directories(fs::path(path).parent_path(), ignored);
    Json out;
    out["units"] = memory.units;
    out["absent"] = memory.absent;
    out["rename"] = memory.rename;
    AtomicFile file(path);
    file.write(out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    file.commit();
}

volume::ImportOptions withMemory(volume::ImportOptions options, const ImportMemory& memory,
                                 const volume::DatasetInfo& info) {
    options.units.insert(memory.units.begin(), memory.units.end());
    std::set<std::string> names;
    for (const volume::Parameter& parameter : info.parameters) names.insert(parameter.name);
    if (const auto known = memory.rename.find(info.name); known != memory.rename.end())
        for (const auto& [from, to] : known->second)
            if (names.contains(from) && !names.contains(to)) {
                options.rename.emplace(from, to);
                names.erase(from);
                names.insert(to);
            }
    if (const auto known = memory.absent.find(info.name); known != memory.absent.end()) {
        std::set<std::string> stated;
        for (const std::string& rule : options.absent) stated.insert(volume::parseAbsentRule(rule).parameter);
        for (const std::string& text : known->second) {
            const volume::AbsentRule rule = volume::parseAbsentRule(text);
            const bool fits = (rule.parameter == "*" || names.contains(rule.parameter)) &&
                              (rule.label.empty() || names.contains(rule.label));
            if (fits && !stated.contains(rule.parameter)) options.absent.push_back(text);
        }
    }
    return options;
}

volume::ImportOptions recallOptions(const std::vector<std::string>& paths, const volume::ImportOptions& stated,
                                    const Progress& progress) {
    if (paths.size() == 1 && paths[0].ends_with(".tsr")) return stated;
    const ImportMemory memory = loadImportMemory();
    if (memory == ImportMemory{}) return stated;
    return withMemory(stated, memory, volume::previewFiles(paths, stated, progress).info);
}

void rememberStated(const volume::ImportOptions& stated, const std::string& dataName, const std::string& path) {
    if (path.empty() || (stated.units.empty() && stated.absent.empty() && stated.rename.empty())) return;
    try {
        ImportMemory memory = loadImportMemory(path);
        if (remember(memory, stated, dataName)) saveImportMemory(memory, path);
    } catch (const Error&) {
    }
}

bool remember(ImportMemory& memory, const volume::ImportOptions& stated, const std::string& dataName) {
    const ImportMemory before = memory;
    for (const auto& [name, unit] : stated.units) memory.units[name] = unit;
    if (!dataName.empty() && !stated.absent.empty()) {
        std::vector<std::string>& rules = memory.absent[dataName];
        for (const std::string& rule : stated.absent) { // the newest rule of a parameter counts
            const std::string parameter = volume::parseAbsentRule(rule).parameter;
            std::erase_if(rules, [&](const std::string& old) {
                return old != rule && volume::parseAbsentRule(old).parameter == parameter &&
                       std::find(stated.absent.begin(), stated.absent.end(), old) == stated.absent.end();
            });
            if (std::find(rules.begin(), rules.end(), rule) == rules.end()) rules.push_back(rule);
        }
    }
    if (!dataName.empty())
        for (const auto& [from, to] : stated.rename) memory.rename[dataName][from] = to;
    return memory != before;
}

} // namespace tessera::app
