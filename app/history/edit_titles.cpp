#include "app/history/edit_titles.h"

#include "app/described/key_words.h"
#include "app/history/parameter_path.h"
#include "app/session/shown_scene.h"

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

/// The parts of a path that all operations of a patch share.
std::vector<std::string> commonPath(const Json& patch) {
    std::vector<std::string> common = splitPointer(patch[0].value("path", std::string()));
    for (const Json& each : patch) {
        const auto parts = splitPointer(each.value("path", std::string()));
        std::size_t same = 0;
        while (same < std::min(common.size(), parts.size()) && common[same] == parts[same]) ++same;
        common.resize(same);
    }
    return common;
}

/// The kind and the own name of a thing, without saying the kind twice: "brush hot", "lens 2".
std::string named(const std::string& kind, const std::string& name) {
    return name.empty() ? kind : name.starts_with(kind) ? name : kind + " " + name;
}

/// What users call a part of the session where that is not its key; "" = nothing else.
std::string partWord(std::string_view part) {
    static constexpr std::pair<std::string_view, std::string_view> kWords[] = {{"stretch", "proportions"},
                                                                               {"render", "quality"},
                                                                               {"appearance", "look of the window"},
                                                                               {"lighting", "light"},
                                                                               {"clips", "clipping"},
                                                                               {"tone", "tone curve"},
                                                                               {"animation", "animation"},
                                                                               {"cursor", "cross-hair"},
                                                                               {"views", "views"},
                                                                               {"layers", "layers"},
                                                                               {"lenses", "lenses"},
                                                                               {"paper", "paper"},
                                                                               {"probes", "probes"},
                                                                               {"depthMask", "shadows of depth"},
                                                                               {"callouts", "callouts"}};
    for (const auto& [key, word] : kWords)
        if (part == key) return std::string(word);
    return {};
}

/// The thing that a path leads into, as users call it, and how many parts of the path it takes; 0: none with a name.
struct NamedThing {
    std::string name;
    std::size_t parts = 0;
};
NamedThing thingAt(const Session& session, const std::vector<std::string>& path) {
    const auto at = [&](std::size_t part, const auto& list) -> const auto* {
        // A patch calls the place of what is put behind the last "-".
        if (path.size() > part && path[part] == "-" && !list.empty()) return &list.back();
        const bool there = path.size() > part && isNumber(path[part]) &&
                           static_cast<std::size_t>(std::stoi(path[part].substr(0, 8))) < list.size();
        return there ? &list[static_cast<std::size_t>(std::stoi(path[part].substr(0, 8)))] : nullptr;
    };
    const std::string first = path.empty() ? "" : path[0];
    if (first == "layers") {
        if (const auto* layer = at(1, session.layers)) return {layerName(*layer), 2};
    } else if (first == "lenses") {
        if (const auto* lens = at(1, session.lenses)) return {named("lens", lens->name), 2};
    } else if (first == "callouts") {
        if (const auto* callout = at(1, session.callouts)) return {"callout of " + callout->placeholder, 2};
    } else if (first == "probes") {
        if (const auto* probe = at(1, session.probes)) return {named("probe", probe->name), 2};
    } else if (first == "selection" && path.size() > 1 && path[1] == "brushes") {
        if (const auto* brush = at(2, session.selection.brushes)) return {named("brush", brush->name), 3};
        return {"brushes", 2};
    } else if (first == "selection") {
        return {"selection", 1};
    } else if (first == "views" && path.size() > 1 && session.views.contains(path[1])) {
        const VolumeView* view = volumeView(session, path[1]);
        const std::string title = paneTitle(session, path[1]);
        if (view && view->layers && path.size() > 2 && path[2] == "layers")
            if (const auto* layer = at(3, *view->layers)) return {title + ", " + layerName(*layer), 4};
        return {title, 2};
    } else if (first == "transfer" && path.size() > 1) {
        return {"transfer function of " + path[1], 2};
    } else if (first == "data" && path.size() > 1 && path[1] == "derived") {
        if (const auto* derived = at(2, session.data.derived)) return {"parameter " + derived->name, 3};
        return {"derived parameters", 2};
    }
    if (const std::string word = partWord(first); !word.empty()) return {word, 1};
    return {};
}

/// Without the arrangement of panes, which changes with the panes that are opened and closed, if there is more.
Json withoutDock(const Json& patch) {
    Json rest = Json::array();
    for (const Json& each : patch)
        if (const auto parts = splitPointer(each.value("path", std::string())); parts.empty() || parts[0] != "dock")
            rest.push_back(each);
    return rest.empty() ? patch : rest;
}

/// The parts of a session that a patch changes: "camera and time".
std::string changedParts(const Json& patch) {
    std::vector<std::string> words;
    for (const Json& each : patch) {
        const auto path = splitPointer(each.value("path", std::string()));
        if (path.empty()) return "several changes";
        const std::string word = partWord(path[0]).empty() ? keyWords(path[0]) : partWord(path[0]);
        if (std::ranges::find(words, word) == words.end()) words.push_back(word);
    }
    if (words.size() > 3) return "several changes";
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i)
        text += (i == 0 ? "" : i + 1 < words.size() ? ", " : " and ") + words[i];
    return text;
}

} // namespace

std::string editTitle(const Json& whole, const Session& before, const Session& after) {
    if (whole.empty()) return describePatch(whole);
    const Json patch = withoutDock(whole);
    const std::vector<std::string> path = commonPath(patch);
    const std::string operation = patch[0].value("op", std::string());
    const bool removed = operation == "remove";
    const NamedThing thing = thingAt(removed ? before : after, path);
    if (thing.parts == 0) return describePatch(patch);
    if (patch.size() == 1 && path.size() == thing.parts && operation != "replace") {
        if (path[0] == "views") return thing.name + (removed ? " closed" : " opened");
        return thing.name + (removed ? " removed" : " added");
    }
    // Of what is inside, the first key that is no identifier of the program.
    std::size_t part = thing.parts;
    while (part < path.size() && (isNumber(path[part]) || path[part] == "technique")) ++part;
    return part < path.size() ? thing.name + ": " + keyWords(path[part]) : thing.name;
}

std::string describePatch(const Json& patch) {
    if (patch.empty()) return "nothing";
    const std::vector<std::string> common = commonPath(patch);
    const std::string operation = patch[0].value("op", std::string());
    if (common.empty()) return changedParts(patch);
    if (common[0] == "dock") return "arrangement of panes";
    if (common[0] == "camera") return "camera";
    std::string name = keyWords(common[0]);
    for (std::size_t i = 1; i < common.size(); ++i) {
        if (isNumber(common[i])) {
            name += " " + std::to_string(std::stoi(common[i].substr(0, 8)) + 1);
        } else if (common[i] != "technique" && common[i] != "-") {
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
    const std::vector<vis::Layer>* layers = first == "layers" ? &session.layers : nullptr;
    std::string of;
    if (first == "views") { // "/views/volume-2/layers/0/...", "/views/volume-2/camera/..."
        const std::string pane = detail::firstKey(rest, rest);
        const VolumeView* view = volumeView(session, pane);
        if (view) of = paneTitle(session, pane) + ", ";
        std::string_view inside;
        const std::string member = detail::firstKey(rest, inside);
        if (view && view->layers && member == "layers") {
            layers = &*view->layers;
            rest = inside;
        }
    }
    if (layers) {
        const std::size_t index = detail::indexOf(detail::firstKey(rest, rest), layers->size());
        if (index < layers->size()) {
            if (rest.starts_with("/technique")) rest.remove_prefix(10);
            const Json patch = Json::array({{{"op", "replace"}, {"path", std::string(rest)}}});
            return of + layerName((*layers)[index]) + ": " + describePatch(patch);
        }
    }
    if (!of.empty()) return of + describePatch(Json::array({{{"op", "replace"}, {"path", std::string(rest)}}}));
    return describePatch(Json::array({{{"op", "replace"}, {"path", path}}}));
}

} // namespace tessera::app
