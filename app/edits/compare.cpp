#include "app/edits/compare.h"

#include "app/history/edit_titles.h"
#include "app/history/parameter_path.h"
#include "app/session/session_json.h"
#include "codec/container/json_text.h"
#include "codec/remote/address.h"
#include "volume/base/error.h"
#include "volume/derived/other_source.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace tessera::app {

namespace {

constexpr const char *kPackedPath = "/data/packed", *kTimeAxisPath = "/data/timeAxis";

/// The session with what it may leave out set to the defaults.
Session withOptionalData(Session session) {
    if (!session.data.packed) session.data.packed.emplace();
    if (!session.data.timeAxis) session.data.timeAxis.emplace();
    return session;
}

/// Views that know no layers show a parameter of the other data by its own function: where a layer of them has that of
/// the first data, they have it too, as it is now.
void followSharedFunctions(Session& session) {
    for (const vis::Layer& layer : session.layers) {
        const std::string channel = vis::shownChannel(layer.technique);
        std::string plain = channel; // "T" of "T (other)", "|U|" of "|U (other)|"
        const auto suffix = plain.find(volume::kOtherSuffix);
        if (suffix != std::string::npos) plain.erase(suffix, volume::kOtherSuffix.size());
        if (suffix == std::string::npos || plain != layer.transfer) continue;
        if (const auto shared = session.transfer.find(layer.transfer); shared != session.transfer.end())
            session.transfer[channel] = shared->second;
    }
}

} // namespace

Session variantSession(const Session& session, const CompareVariant& variant) {
    if (variant.changes.empty()) return session;
    Json document = toJson(session);
    for (const auto& [path, value] : variant.changes) {
        // An empty object stands for the defaults, whole, so that changes of single settings find their place.
        const bool defaults = value == "{}" && (path == kPackedPath || path == kTimeAxisPath);
        setInDocument(document, path,
                      defaults ? jsonText(toJson(withOptionalData({}))[Json::json_pointer(path)]) : value);
    }
    std::vector<JsonIssue> unknown;
    Session out = sessionFromJson(document, {}, &unknown);
    if (!unknown.empty()) throw Error("unknown key", {}, unknown.front().path);
    takeAllowed(out.data, session.data);
    followSharedFunctions(out);
    return out;
}

namespace {

/// Of several values only those that have changed: "charcoal contrast 0.6, part context".
std::string differingText(const Json& now, const Json& before) {
    std::string text;
    for (const auto& [key, value] : now.items()) {
        const Json was = before.is_object() ? before.value(key, Json()) : Json();
        if (was == value) continue;
        std::string shown = value.is_string() ? value.get<std::string>() : jsonText(value);
        if (value.is_object()) shown = differingText(value, was);
        text += (text.empty() ? "" : ", ") + key + (shown.empty() ? "" : " " + shown);
    }
    return text;
}

/// The names of layers that replace those of a session.
std::string layersText(const Session& session, const std::string& layers) {
    CompareVariant variant;
    variant.changes["/layers"] = layers;
    std::string text;
    try {
        for (const vis::Layer& layer : variantSession(session, variant).layers)
            text += (text.empty() ? "" : " and ") + layerName(layer);
    } catch (const Error&) { // the picture says so
    }
    return text;
}

} // namespace

std::string changesText(const Session& session, const CompareVariant& variant) {
    std::string text;
    for (const auto& [path, value] : variant.changes) {
        std::string title = pathTitle(session, path);
        // The last key is enough, except for settings of a layer.
        if (!path.starts_with("/layers/"))
            if (const auto colon = title.rfind(": "); colon != std::string::npos) title = title.substr(colon + 2);
        const Json parsed = Json::parse(value, nullptr, false);
        std::string shown = parsed.is_string() ? parsed.get<std::string>() : value;
        if (path == "/data/lattice")
            title = "lattice", shown = shown == "bodyCentred" ? "BCC" : shown == "even" ? "to scale" : "CC";
        if (parsed.is_object() && parsed.empty()) shown.clear();
        if (parsed.is_object() && !parsed.empty()) {
            const Json base = toJson(session);
            const Json::json_pointer at(path);
            shown = differingText(parsed, base.contains(at) ? base[at] : Json());
            text += (text.empty() ? "" : ", ") + (shown.empty() ? title : shown);
            continue;
        }
        if (parsed.is_null()) shown = "none";
        if (path == "/layers") title = "shows", shown = layersText(session, value);
        text += (text.empty() ? "" : ", ") + title + (shown.empty() ? "" : " " + shown);
    }
    return text.empty() ? "unchanged" : text;
}

std::string variantName(const Session& session, const CompareVariant& variant) {
    return variant.name.empty() ? changesText(session, variant) : variant.name;
}

namespace {

/// A value as it stands in CompareVariant::changes.
std::string settingText(const Json& value) {
    return value.is_string() ? value.get<std::string>() : jsonText(value);
}

} // namespace

std::vector<std::string> variantPaths(const Session& session) {
    std::vector<std::string> paths = parameterPaths(session);
    const std::vector<DataFile>& files = session.data.files;
    if (files.size() == 1 && codec::namesArchive(files[0].absolutePath)) return paths;
    const Session whole = withOptionalData(session);
    for (const char* place : {kPackedPath, kTimeAxisPath})
        for (const std::string& path : parameterPathsBelow(whole, place)) paths.push_back(path);
    return paths;
}

void startChange(CompareVariant& variant, const Session& session, const std::string& path) {
    variant.changes[path] = settingText(toJson(withOptionalData(session))[Json::json_pointer(path)]);
    if (path.starts_with(kPackedPath) && !session.data.packed) variant.changes.try_emplace(kPackedPath, "{}");
    if (path.starts_with(kTimeAxisPath) && !session.data.timeAxis) variant.changes.try_emplace(kTimeAxisPath, "{}");
}

void recordChange(CompareVariant& variant, const Session& session, const Session& changed, const std::string& path) {
    const Json::json_pointer at(path);
    const Json base = toJson(session), now = toJson(changed);
    if (!now.contains(at)) return;
    if (base.contains(at) && base[at] == now[at])
        variant.changes.erase(path);
    else
        variant.changes[path] = settingText(now[at]);
}

GridShape gridFor(int count, double width, double height) {
    GridShape best;
    double largest = -1;
    for (int columns = 1; columns <= std::max(count, 1); ++columns) {
        const int rows = (count + columns - 1) / columns;
        const double w = width / columns, h = height / rows, edge = std::min(w, h * 4 / 3);
        if (edge <= largest) continue;
        largest = edge;
        best = {columns, rows};
    }
    return best;
}

DataRef drawnData(const Session& session, const volume::DatasetInfo& info) {
    DataRef data = session.data;
    if (!data.packed || !data.derived.empty() || data.other || data.originals || !data.import.parameters.empty())
        return data;
    std::set<std::string> names;
    bool known = true;
    const auto add = [&](const std::string& name) {
        if (name.empty()) return;
        const auto channel = info.findChannel(name);
        known = known && channel;
        if (channel) names.insert(info.parameters[std::size_t(info.channel(*channel).parameter)].name);
    };
    for (const vis::Layer& layer : session.layers) {
        add(vis::shownChannel(layer.technique));
        add(vis::colorByOf(layer.technique));
    }
    for (const vis::Brush& brush : session.selection.brushes)
        for (const std::string& name : vis::regionChannels(brush.region)) add(name);
    if (known) data.import.parameters.assign(names.begin(), names.end());
    return data;
}

} // namespace tessera::app
