#include "app/data/apply_layout.h"

#include "app/data/boundary_value.h"
#include "app/data/first_view.h"
#include "app/data/format.h"
#include "app/data/packing_errors.h"
#include "app/described/key_words.h"
#include "app/edits/layout_brushes.h"
#include "app/edits/other_data.h"
#include "app/session/own_functions.h"
#include "app/session/shown_scene.h"
#include "volume/base/error.h"
#include "volume/system/own_path.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>

namespace tessera::app {

namespace fs = std::filesystem;

namespace {

std::vector<fs::path> layoutFolders() {
    std::vector<fs::path> folders;
    if (const fs::path program = programFolder(); !program.empty()) {
        folders.push_back(program / "../share/tessera/layouts");
        folders.push_back(program / "layouts");
    }
    return folders;
}

/// Minimum and maximum of the present samples of a channel at one time; nothing if there are none.
std::optional<Range> rangeAt(const volume::BrickSource& source, int channel, int time) {
    const glm::ivec3 count = source.grid().count();
    std::optional<Range> range;
    for (int z = 0; z < count.z; ++z)
        for (int y = 0; y < count.y; ++y)
            for (int x = 0; x < count.x; ++x) {
                const volume::BrickStats stats = source.stats({channel, time, 0, {x, y, z}});
                if (!(stats.presentFraction > 0) || !(stats.min <= stats.max)) continue;
                const double lo = double(stats.min), hi = double(stats.max);
                range = range ? Range{std::min(range->lo, lo), std::max(range->hi, hi)} : Range{lo, hi};
            }
    return range;
}

} // namespace

bool sameData(const DataRef& a, const DataRef& b) {
    if (a.files.size() != b.files.size() || a.model != b.model) return false;
    if (a.files.empty()) return true;
    return std::equal(a.files.begin(), a.files.end(), b.files.begin(), [](const DataFile& x, const DataFile& y) {
        return x.absolutePath == y.absolutePath || (!x.hash.empty() && x.hash == y.hash);
    });
}

std::vector<std::string> layoutNames() {
    std::set<std::string> names;
    for (const fs::path& folder : layoutFolders()) {
        std::error_code problem;
        for (const auto& entry : fs::directory_iterator(folder, problem))
            if (entry.path().extension() == ".json") names.insert(entry.path().stem().string());
    }
    return {names.begin(), names.end()};
}

bool isDemonstration(std::string_view layout) {
    static constexpr std::string_view kNames[] = {"animation", "charcoal", "compareLattice", "evening", "illustration"};
    return std::ranges::find(kNames, layout) != std::end(kNames);
}

std::string findLayout(const std::string& nameOrPath) {
    std::error_code problem;
    if (hasEnding(nameOrPath, ".json") && fs::is_regular_file(nameOrPath, problem)) return nameOrPath;
    std::string known;
    std::vector<std::string> names = layoutNames();
    std::ranges::stable_partition(names, [&](const std::string& name) { return name == nameOrPath; });
    for (const std::string& name : names) {
        known += (known.empty() ? "" : ", ") + name;
        if (!sameName(name, nameOrPath)) continue;
        for (const fs::path& folder : layoutFolders())
            if (const fs::path path = folder / (name + ".json"); fs::is_regular_file(path, problem))
                return path.string();
    }
    throw Error("no layout of that name; there are " + (known.empty() ? "none" : known), {}, nameOrPath);
}

Session applyLayout(const SessionDocument& layout, const volume::DatasetInfo& info, const DataRef& data,
                    std::vector<std::string>& messages) {
    const bool own = sameData(layout.session.data, data);
    Json result = toJson(defaultSession(info, data));
    for (const auto& [key, value] : layout.raw.items()) {
        if (key == "data" || key == "schema" || key == "app" || key == "history") continue;
        // Remove what only applies to the data the layout was made with.
        if (!own && (key == "title" || key == "time" || key == "cursor" || key == "stretch")) continue;
        if (key == "transfer") {
            for (const auto& [channel, function] : value.items())
                if (own || function.value("autoRange", true))
                    result[key][channel] = function;
                else if (info.findChannel(channel))
                    messages.push_back("the layout's colours of " + channel +
                                       " have a range of other data, so they are not taken");
        } else {
            result[key] = value;
        }
    }
    if (!own && result["selection"].is_object() && result["selection"].erase("brushes") > 0 &&
        !layout.session.selection.brushes.empty())
        messages.emplace_back("the layout's brushes were made for other data and are left out: brush in a plot");
    Session session = sessionFromJson(result, {});
    takeAllowed(session.data, data);
    std::erase_if(session.transfer, [&](const auto& entry) {
        return !info.findChannel(entry.first) && !ownFunction(session, entry.first);
    });
    fitSession(session, info, messages);
    if (!own || data.settings != layout.session.data.settings)
        suitOtherData(session, info, layout.session.data, messages);
    session.layoutBrushes = session.selection.brushes;
    return session;
}

void fitSurfaces(Session& session, const volume::BrickSource& source, const Session& layout,
                 std::vector<std::string>& messages) {
    const volume::DatasetInfo& info = source.info();
    const bool own = sameData(layout.data, session.data);
    std::set<std::string> without;
    const auto fit = [&](vis::Layer& layer, const vis::Layer* former, int time) {
        auto* iso = std::get_if<vis::IsoLayer>(&layer.technique);
        const auto channel = iso ? info.findChannel(iso->channel) : std::nullopt;
        if (!channel || info.parameters[std::size_t(info.channel(*channel).parameter)].categorical) return;
        try {
            const std::optional<Range> range = rangeAt(source, *channel, time);
            if (!range || !(range->hi > range->lo)) {
                if (layer.visible && without.insert(iso->channel).second)
                    messages.push_back(iso->channel + (range ? " has one value everywhere" : " has no value anywhere") +
                                       " at this time, so its surface is empty: choose another time or parameter");
                return;
            }
            const auto* made = former ? std::get_if<vis::IsoLayer>(&former->technique) : nullptr;
            const double share = (double(iso->value) - range->lo) / (range->hi - range->lo), margin = own ? 0 : 0.1;
            if (made && made->channel == iso->channel && share > margin && share < 1 - margin) return;
            iso->value = surfaceValue(source, *channel, time).value_or(0.5 * (range->lo + range->hi));
        } catch (const Error&) { // a damaged brick: use what could be read
        }
    };
    const auto fitAll = [&](std::vector<vis::Layer>& layers, const std::vector<vis::Layer>& former, double time) {
        for (std::size_t i = 0; i < layers.size(); ++i)
            fit(layers[i], i < former.size() ? &former[i] : nullptr, info.nearestTime(time));
    };
    fitAll(session.layers, layout.layers, session.time);
    for (auto& [pane, view] : session.views) {
        auto* const volume = std::get_if<VolumeView>(&view);
        if (!volume || !volume->layers) continue;
        const VolumeView* former = volumeView(layout, pane);
        fitAll(*volume->layers, former ? former->layers.value_or(layout.layers) : layout.layers,
               volume->time.value_or(session.time));
    }
    for (std::size_t i = 0; i < session.callouts.size(); ++i) {
        Callout& callout = session.callouts[i];
        if (!callout.layers) continue;
        const bool made = i < layout.callouts.size() && layout.callouts[i].layers.has_value();
        fitAll(*callout.layers, made ? *layout.callouts[i].layers : layout.layers, callout.time.value_or(session.time));
    }
}

Session changeLayout(const SessionDocument& layout, const volume::BrickSource& source, const Session& shown,
                     std::vector<std::string>& messages) {
    Session next = applyLayout(layout, source.info(), shown.data, messages);
    if (layout.session.data.originals && !shown.data.originals) messages.emplace_back(kNoOriginals);
    next.appearance = shown.appearance;
    next.time = shown.time;
    next.cursor = shown.cursor;
    next.probes = shown.probes;
    keepOwnBrushes(next, shown, messages);
    const auto refit = [&](vis::Camera& camera) {
        vis::fit(camera, vis::worldFrame(source.info(), next.stretch), firstAspect(source.info()));
    };
    if (!sameData(layout.session.data, shown.data)) {
        refit(next.camera);
        for (auto& [pane, view] : next.views)
            if (auto* const volume = std::get_if<VolumeView>(&view); volume && volume->camera) refit(*volume->camera);
    }
    fitSurfaces(next, source, layout.session, messages);
    return next;
}

} // namespace tessera::app
