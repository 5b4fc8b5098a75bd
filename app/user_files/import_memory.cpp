#include "app/user_files/import_memory.h"

#include "app/described/describe_json.h"
#include "codec/archive/archive.h"
#include "codec/container/json_text.h"
#include "codec/remote/address.h"
#include "volume/base/error.h"
#include "volume/base/terminal.h"
#include "volume/field/labels.h"
#include "volume/import/absent.h"
#include "volume/import/find_parts.h"
#include "volume/system/atomic_file.h"
#include "volume/system/input_file.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <functional>
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

/// Rules by data name; `check` throws Error for what is none.
void readRules(const Json& document, const std::string& key, const std::string& file,
               std::map<std::string, std::vector<std::string>>& out,
               const std::function<void(const std::string&)>& check) {
    const auto rules = document.find(key);
    if (rules == document.end()) return;
    if (!rules->is_object()) throw Error("must be an object", file, "/" + key);
    for (const auto& [data, list] : rules->items()) {
        if (!list.is_array()) throw Error("must be a list", file, "/" + key + "/" + data);
        for (const Json& rule : list) {
            if (!rule.is_string()) throw Error("must be texts", file, "/" + key + "/" + data);
            try {
                check(rule.get<std::string>());
            } catch (const Error& error) {
                throw Error(error.what(), file, "/" + key + "/" + data);
            }
            out[data].push_back(rule.get<std::string>());
        }
    }
}

/// Adds rules to those known: the newest one of a parameter counts.
void rememberRules(std::vector<std::string>& known, const std::vector<std::string>& stated,
                   const std::function<std::string(const std::string&)>& parameterOf) {
    for (const std::string& rule : stated) {
        const std::string parameter = parameterOf(rule);
        std::erase_if(known, [&](const std::string& old) {
            return old != rule && parameterOf(old) == parameter &&
                   std::find(stated.begin(), stated.end(), old) == stated.end();
        });
        if (std::find(known.begin(), known.end(), rule) == known.end()) known.push_back(rule);
    }
}

std::string parameterOfAbsent(const std::string& rule) {
    return volume::parseAbsentRule(rule).parameter;
}
std::string parameterOfParts(const std::string& rule) {
    return volume::parsePartsRule(rule).parameter;
}

std::string parameterOfLabels(const std::string& rule) {
    return volume::parseLabelRule(rule).parameter;
}
/// The form of a rule for recallRules.
struct NamedLabels {
    std::string parameter, label;
};
NamedLabels parseLabels(const std::string& rule) {
    return {parameterOfLabels(rule), {}};
}

/// Adds remembered rules for parameters without a stated one, if they fit the data.
template <class Parse>
void recallRules(std::vector<std::string>& stated, const std::vector<std::string>& known,
                 const std::set<std::string>& names, const Parse& parse) {
    std::set<std::string> ruled;
    for (const std::string& rule : stated) ruled.insert(parse(rule).parameter);
    for (const std::string& text : known) {
        const auto rule = parse(text);
        const bool fits = (rule.parameter == "*" || names.contains(rule.parameter)) &&
                          (rule.label.empty() || names.contains(rule.label));
        if (fits && !ruled.contains(rule.parameter)) stated.push_back(text);
    }
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
    constexpr std::uintmax_t kMost = 64'000'000;
    const Json document = Json::parse(readInput(path, kMost), nullptr, false);
    if (document.is_discarded() || !document.is_object()) throw Error("is not a JSON object", path);
    if (const auto units = document.find("units"); units != document.end())
        memory.units = readTexts(*units, path, "/units");
    if (const auto lengths = document.find("lengths"); lengths != document.end())
        memory.lengths = readTexts(*lengths, path, "/lengths");
    if (const auto rename = document.find("rename"); rename != document.end()) {
        if (!rename->is_object()) throw Error("must be an object", path, "/rename");
        for (const auto& [data, names] : rename->items())
            memory.rename[data] = readTexts(names, path, "/rename/" + data);
    }
    readRules(document, "absent", path, memory.absent, [](const std::string& rule) { volume::parseAbsentRule(rule); });
    readRules(document, "parts", path, memory.parts, [](const std::string& rule) { volume::parsePartsRule(rule); });
    readRules(document, "labels", path, memory.labels, [](const std::string& rule) { volume::parseLabelRule(rule); });
    return memory;
}

void saveImportMemory(const ImportMemory& memory, const std::string& path) {
    if (path.empty()) throw MachineError("there is no home folder to remember units in");
    std::error_code ignored;
    fs::create_directories(fs::path(path).parent_path(), ignored);
    Json out;
    out["units"] = memory.units;
    out["absent"] = memory.absent;
    out["parts"] = memory.parts;
    out["labels"] = memory.labels;
    out["rename"] = memory.rename;
    out["lengths"] = memory.lengths;
    AtomicFile file(path);
    file.write(jsonText(out, 2) + "\n");
    file.commit();
}

volume::ImportOptions withMemory(volume::ImportOptions options, const ImportMemory& memory,
                                 const volume::DatasetInfo& info) {
    const auto length = memory.lengths.find(info.name);
    if (options.lengthUnit.empty() && info.lengthUnit.empty() && length != memory.lengths.end())
        options.lengthUnit = length->second;
    std::set<std::string> names;
    for (const volume::Parameter& parameter : info.parameters) names.insert(parameter.name);
    if (const auto known = memory.rename.find(info.name); known != memory.rename.end())
        for (const auto& [from, to] : known->second)
            if (names.contains(from) && !names.contains(to)) {
                options.rename.emplace(from, to);
                names.erase(from);
                names.insert(to);
            }
    for (const volume::Quantity& quantity : info.quantities) names.insert(quantity.name);
    for (const auto& [name, unit] : memory.units)
        if (names.contains(name)) options.units.emplace(name, unit);
    if (const auto known = memory.absent.find(info.name); known != memory.absent.end())
        recallRules(options.absent, known->second, names, volume::parseAbsentRule);
    if (const auto known = memory.parts.find(info.name); known != memory.parts.end())
        recallRules(options.parts, known->second, names, volume::parsePartsRule);
    if (const auto known = memory.labels.find(info.name); known != memory.labels.end())
        recallRules(options.labels, known->second, names, parseLabels);
    return options;
}

volume::ImportOptions recallOptions(const std::vector<std::string>& paths, const volume::ImportOptions& stated,
                                    std::vector<std::string>& messages, const Progress& progress) {
    ImportMemory memory;
    try {
        memory = loadImportMemory();
    } catch (const Error& error) {
        messages.push_back(
            std::string(error.what()) +
            "; units, names and labels that were stated before are not used until it is mended or removed");
    }
    if (paths.size() == 1 && codec::namesArchive(paths[0])) {
        volume::ImportOptions options = stated;
        if (!memory.labels.empty()) options.labels = withMemory(stated, memory, codec::Archive(paths[0]).info()).labels;
        return options;
    }
    const bool nothingStated = stated.units.empty() && stated.absent.empty() && stated.parts.empty() &&
                               stated.lengthUnit.empty() && stated.timeUnit.empty();
    volume::ImportOptions options = stated;
    if (memory != ImportMemory{}) {
        using volume::Misfits; // names may be remembered ones
        options = withMemory(stated, memory, volume::previewFiles(paths, stated, progress, Misfits::Ignored).info);
    }
    if (!nothingStated) volume::previewFiles(paths, options, progress); // refuses what fits nothing
    return options;
}

volume::ImportOptions recallOptions(const std::vector<std::string>& paths, const volume::ImportOptions& stated,
                                    const Progress& progress) {
    std::vector<std::string> messages;
    volume::ImportOptions options = recallOptions(paths, stated, messages, progress);
    for (const std::string& text : messages) warn("tessera: %s\n", text.c_str());
    return options;
}

void rememberStated(const volume::ImportOptions& stated, const std::string& dataName, const std::string& path) {
    const bool isEmpty = stated.units.empty() && stated.absent.empty() && stated.parts.empty() &&
                         stated.labels.empty() && stated.rename.empty() && stated.lengthUnit.empty();
    if (path.empty() || isEmpty) return;
    try {
        ImportMemory memory = loadImportMemory(path);
        if (remember(memory, stated, dataName)) saveImportMemory(memory, path);
    } catch (const Error&) {
    }
}

void rememberLabels(const std::vector<std::string>& now, const std::vector<std::string>& before,
                    const std::string& dataName, const std::string& path) {
    if (path.empty() || dataName.empty()) return;
    try {
        ImportMemory memory = loadImportMemory(path);
        std::vector<std::string>& known = memory.labels[dataName];
        std::erase_if(known, [&](const std::string& rule) {
            const auto same = [&](const std::string& other) {
                return parameterOfLabels(other) == parameterOfLabels(rule);
            };
            return std::ranges::any_of(before, same) || std::ranges::any_of(now, same);
        });
        known.insert(known.end(), now.begin(), now.end());
        if (known.empty()) memory.labels.erase(dataName);
        saveImportMemory(memory, path);
    } catch (const Error&) { // as in rememberStated
    }
}

bool remember(ImportMemory& memory, const volume::ImportOptions& stated, const std::string& dataName) {
    const ImportMemory before = memory;
    for (const auto& [name, unit] : stated.units) memory.units[name] = unit;
    if (!dataName.empty() && !stated.lengthUnit.empty()) memory.lengths[dataName] = stated.lengthUnit;
    if (!dataName.empty() && !stated.absent.empty())
        rememberRules(memory.absent[dataName], stated.absent, parameterOfAbsent);
    if (!dataName.empty() && !stated.parts.empty())
        rememberRules(memory.parts[dataName], stated.parts, parameterOfParts);
    if (!dataName.empty() && !stated.labels.empty())
        rememberRules(memory.labels[dataName], stated.labels, parameterOfLabels);
    if (!dataName.empty())
        for (const auto& [from, to] : stated.rename) memory.rename[dataName][from] = to;
    return memory != before;
}

} // namespace tessera::app
