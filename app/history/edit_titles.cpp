#include "app/history/edit_titles.h"

#include "app/described/key_words.h"
#include "app/history/parameter_path.h"
#include "app/session/session.h"

#include <algorithm>
#include <cctype>

namespace tessera::app {

namespace {

std::vector<std::string> splitPointer(const std::string& path) {
    std::vector<std::string> parts;
    std::size_t begin = 1;
    while (begin <= path.size() && !path.empty()) {
        const std::size_t end = std::min(path.find('/', begin), path.size());
        std::string part = path.substr(begin, end - begin);
        for (const auto& [from, to] : {std::pair<std::string, std::string>{"~1", "/"}, {"~0", "~"}})
            for (std::size_t at = 0; (at = part.find(from, at)) != std::string::npos; at += to.size())
                part.replace(at, from.size(), to);
        parts.push_back(part);
        begin = end + 1;
    }
    return parts;
}

bool isNumber(const std::string& text) {
    return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

} // namespace

std::string describePatch(const Json& patch) {
    if (patch.empty()) return "nothing";
    std::vector<std::string> common = splitPointer(patch[0].value("path", std::string()));
    const std::string operation = patch[0].value("op", std::string());
    for (const Json& each : patch) {
        const auto parts = splitPointer(each.value("path", std::string()));
        std::size_t same = 0;
        while (same < std::min(common.size(), parts.size()) && common[same] == parts[same]) ++same;
        common.resize(same);
    }
    if (common.empty()) return "several changes";
    if (common[0] == "dock") return "arrangement of panes";
    if (common[0] == "camera") return "camera";
    std::string name = keyWords(common[0]);
    for (std::size_t i = 1; i < common.size(); ++i) {
        if (isNumber(common[i])) {
            name += " " + std::to_string(std::stoi(common[i].substr(0, 8)) + 1);
        } else if (common[i] != "technique") {
            // Keys of maps are names of parameters and panes: kept as they are.
            const bool mapKey = i == 1 && (common[0] == "transfer" || common[0] == "views");
            name += (i == 1 && mapKey ? " " : ": ") + (mapKey ? common[i] : keyWords(common[i]));
        }
    }
    if (patch.size() == 1 && operation == "add") name += " added";
    if (patch.size() == 1 && operation == "remove") name += " removed";
    return name;
}

std::string pathTitle(const Session& session, const std::string& path) {
    std::string_view rest;
    const std::string first = detail::firstKey(path, rest);
    if (first == "layers") {
        const std::size_t index = detail::indexOf(detail::firstKey(rest, rest), session.layers.size());
        if (index < session.layers.size() && !session.layers[index].name.empty()) {
            if (rest.starts_with("/technique")) rest.remove_prefix(10);
            const Json patch = Json::array({{{"op", "replace"}, {"path", std::string(rest)}}});
            return session.layers[index].name + ": " + describePatch(patch);
        }
    }
    return describePatch(Json::array({{{"op", "replace"}, {"path", path}}}));
}

} // namespace tessera::app
