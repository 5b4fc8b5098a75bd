#include "app/data/open.h"

#include "app/data/boundary_value.h"
#include "app/data/first_view.h"
#include "app/data/packing_errors.h"
#include "app/data/picture_session.h"
#include "app/edits/layout_brushes.h"
#include "app/edits/other_data.h"
#include "app/session/shown_scene.h"
#include "app/user_files/import_memory.h"

#include "codec/remote/address.h"
#include "volume/base/error.h"
#include "volume/field/quantities.h"
#include "volume/import/import.h"
#include "volume/synthetic/models.h"
#include "volume/system/own_path.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <set>
#include <utility>

namespace tessera::app {

namespace fs = std::filesystem;

namespace {

constexpr const char *kFirstLayout = "overview", *kFirstModel = "fuel-cell";
/// Width by height of the volume pane in a new window, labels taken off: with and without a timeline below it.
double firstAspect(const volume::DatasetInfo& info) {
    return info.times.size() > 1 ? 0.92 : 0.78;
}

bool endsWith(const std::string& path, std::string_view suffix) {
    if (path.size() < suffix.size()) return false;
    return std::equal(suffix.rbegin(), suffix.rend(), path.rbegin(),
                      [](char a, char b) { return a == std::tolower(static_cast<unsigned char>(b)); });
}

enum class Kind { Session, Picture, Data };

Kind kindOf(const std::string& path) {
    if (codec::isRemote(path)) return Kind::Data;
    if (namesPicture(path)) return Kind::Picture;
    if (!endsWith(path, ".json")) return Kind::Data;
    if (endsWith(path, ".tessera.json")) return Kind::Session;
    // Other JSON files are sessions (layouts) or the sidecars of raw files.
    return looksLikeSession(readText(path)) ? Kind::Session : Kind::Data;
}

std::vector<fs::path> layoutFolders() {
    std::vector<fs::path> folders;
    if (const fs::path program = programFolder(); !program.empty()) {
        folders.push_back(program / "../share/tessera/layouts");
        folders.push_back(program / "layouts");
    }
    return folders;
}

bool sameData(const DataRef& a, const DataRef& b) {
    if (a.files.size() != b.files.size() || a.model != b.model) return false;
    if (a.files.empty()) return true;
    return std::equal(a.files.begin(), a.files.end(), b.files.begin(), [](const DataFile& x, const DataFile& y) {
        return x.absolutePath == y.absolutePath || (!x.hash.empty() && x.hash == y.hash);
    });
}

/// Takes over a document read from a file: finds its data and opens it.
Opened openDocument(SessionDocument document, const std::string& folder, const OpenRequest& request,
                    const Progress& progress) {
    Opened opened;
    opened.document = std::move(document);
    opened.folder = folder;
    opened.messages = opened.document.messages;
    if (request.data) {
        DataRef data = *request.data;
        if (data.derived.empty()) data.derived = opened.document.session.data.derived;
        return openWith(std::move(opened), data, progress);
    }
    ResolvedData found = resolveData(opened.document.session.data, folder);
    opened.warnings = std::move(found.warnings);
    if (!found.missing.empty()) {
        opened.missing = std::move(found.missing);
        return opened;
    }
    DataRef data = found.data;
    if (request.import) data.import = *request.import;
    if (request.remote) data.remote = *request.remote;
    return openWith(std::move(opened), data, progress);
}

} // namespace

std::vector<std::string> layoutNames() {
    std::set<std::string> names;
    for (const fs::path& folder : layoutFolders()) {
        std::error_code problem;
        for (const auto& entry : fs::directory_iterator(folder, problem))
            if (entry.path().extension() == ".json") names.insert(entry.path().stem().string());
    }
    return {names.begin(), names.end()};
}

std::string findLayout(const std::string& nameOrPath) {
    std::error_code problem;
    if (endsWith(nameOrPath, ".json") && fs::is_regular_file(nameOrPath, problem)) return nameOrPath;
    for (const fs::path& folder : layoutFolders()) {
        const fs::path path = folder / (nameOrPath + ".json");
        if (nameOrPath.find('/') == std::string::npos && fs::is_regular_file(path, problem)) return path.string();
    }
    std::string known;
    for (const std::string& name : layoutNames()) known += (known.empty() ? "" : ", ") + name;
    throw Error("no layout of that name; there are " + (known.empty() ? "none" : known), {}, nameOrPath);
}

DataRef dataOf(const std::vector<std::string>& paths, const volume::ImportOptions& options) {
    DataRef data;
    data.import = options;
    for (const std::string& path : paths) {
        std::error_code problem;
        if (codec::isRemote(path)) {
            if (paths.size() > 1) throw Error("an archive on another machine is opened by itself", path);
        } else if (!fs::exists(path, problem)) {
            throw Error("no such file", path);
        }
        data.files.push_back(describeFile(path));
    }
    return data;
}

bool namesModel(const std::string& input) {
    const std::vector<std::string> models = volume::modelNames();
    std::error_code problem;
    return std::ranges::find(models, input) != models.end() && !fs::exists(input, problem);
}

volume::Dataset modelNamed(const std::string& input, const volume::ImportOptions& stated, const Progress& progress) {
    if (!(stated == volume::ImportOptions{}))
        throw Error("options about files do not apply to a built-in model", input);
    return volume::makeModel(input, {}, progress);
}

DataRef dataNamed(const std::vector<std::string>& inputs, const volume::ImportOptions& stated,
                  const Progress& progress) {
    if (inputs.size() != 1 || !namesModel(inputs[0])) return dataOf(inputs, recallOptions(inputs, stated, progress));
    DataRef data;
    data.model = inputs[0];
    data.import = stated;
    return data;
}

namespace {

/// When time replaces an axis, moves the cross-hair to the time shown, and vice versa; its former position along that
/// axis is TimeAxis::place. `session` still refers to the former data, described by `from`.
void carryTime(Session& session, const volume::DatasetInfo& from, const volume::DatasetInfo& to,
               const std::optional<volume::TimeAxis>& wanted) {
    const std::optional<volume::TimeAxis>& shown = session.data.timeAxis;
    if (shown.has_value() == wanted.has_value()) return;
    const int axis = int(wanted ? wanted->axis : shown->axis);
    if (wanted) {
        session.cursor[axis] = session.time / volume::timePerLength(to, *wanted);
    } else {
        session.time = session.cursor[axis] * volume::timePerLength(from, *shown);
        for (const double stored : to.times)
            if (std::abs(session.time - stored) < 1e-9 * (to.times.back() - to.times.front())) session.time = stored;
        session.cursor[axis] = to.bounds.lo[axis] + shown->place * to.bounds.size()[axis];
    }
}

} // namespace

Opened openWith(Opened opened, const DataRef& data, const Progress& progress) {
    opened.missing.clear();
    Sources now = openSources(data, opened.messages, progress);
    opened.numbers = std::move(now.numbers);
    opened.origin = std::move(now.origin);
    const auto before = std::exchange(opened.source, std::move(now.pictures));
    moveTo(opened.document.session, opened.document.history, before ? &before->info() : nullptr, opened.source->info(),
           data, opened.messages);
    return opened;
}

void moveTo(Session& session, History& history, const volume::DatasetInfo* from, const volume::DatasetInfo& to,
            const DataRef& data, std::vector<std::string>& messages) {
    if (from) carryTime(session, *from, to, data.timeAxis);
    if (from && from->timeName != to.timeName) // the same state on another time axis
        if (const auto same = volume::findQuantity(*from, to.timeName)) {
            const auto move = [&](double& time) {
                const double now = volume::valueAt(from->times, from->quantities[std::size_t(*same)].values, time);
                if (std::isfinite(now)) time = now;
            };
            move(session.time);
            for (auto& [pane, view] : session.views)
                if (auto* const volume = std::get_if<VolumeView>(&view); volume && volume->time) move(*volume->time);
        }
    session.data = data;
    history.setData(data);
    fitSession(session, to, messages);
}

namespace {

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
                if (own || function.value("autoRange", true)) result[key][channel] = function;
        } else {
            result[key] = value;
        }
    }
    if (!own && result["selection"].is_object()) result["selection"].erase("brushes");
    Session session = sessionFromJson(result, {});
    std::erase_if(session.transfer, [&](const auto& entry) { return !info.findChannel(entry.first); });
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
        if (!channel) return;
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
}

Session changeLayout(const SessionDocument& layout, const volume::BrickSource& source, const Session& shown,
                     std::vector<std::string>& messages) {
    Session next = applyLayout(layout, source.info(), shown.data, messages);
    if (layout.session.data.originals && !shown.data.originals) messages.emplace_back(kNoOriginals);
    next.appearance = shown.appearance;
    next.time = shown.time;
    next.cursor = shown.cursor;
    keepOwnBrushes(next, shown, messages);
    const auto refit = [&](vis::Camera& camera) {
        vis::fit(camera, vis::worldFrame(source.info().bounds, next.stretch), firstAspect(source.info()));
    };
    if (!sameData(layout.session.data, shown.data)) {
        refit(next.camera);
        for (auto& [pane, view] : next.views)
            if (auto* const volume = std::get_if<VolumeView>(&view); volume && volume->camera) refit(*volume->camera);
    }
    fitSurfaces(next, source, layout.session, messages);
    return next;
}

Opened open(const OpenRequest& request, const Progress& progress) {
    if (!request.data && request.paths.size() == 1 && namesModel(request.paths[0])) {
        OpenRequest inner = request;
        inner.paths.clear();
        if (request.paths[0] == kFirstModel && request.layout.empty()) inner.layout = kFirstLayout;
        inner.data = dataNamed(request.paths, request.import.value_or(volume::ImportOptions{}));
        if (request.lattice) inner.data->lattice = *request.lattice;
        return open(inner, progress);
    }
    Opened opened;
    if (request.paths.size() == 1) {
        const std::string& path = request.paths[0];
        std::error_code problem;
        if (!codec::isRemote(path) && !fs::exists(path, problem)) throw Error("no such file", path);
        const Kind kind = kindOf(path);
        if (kind != Kind::Data) {
            SessionDocument document =
                kind == Kind::Session ? loadSession(path) : parseSession(sessionTextOfPicture(path), path);
            const std::string folder = fs::absolute(path).parent_path().string();
            // Saved sessions are marked as such; other documents are layouts, which may be incomplete.
            const bool complete = document.raw.contains("app") && (hasData(document.session.data) || request.data);
            if (request.layout.empty() && complete) {
                opened = openDocument(std::move(document), folder, request, progress);
                if (kind == Kind::Session) opened.sessionPath = fs::absolute(path).lexically_normal().string();
                return opened;
            }
            if (!request.layout.empty()) {
                // A session's data shown in another layout.
                const ResolvedData found = resolveData(document.session.data, folder);
                if (!found.missing.empty()) throw Error("data file is missing", found.missing[0].wanted.path, path);
                OpenRequest inner{{}, request.layout, found.data, request.import, {}, request.remote};
                return open(inner, progress);
            }
            OpenRequest inner{
                {}, path, request.data, request.import, request.lattice, request.remote}; // a layout without data
            return open(inner, progress);
        }
    }
    std::optional<SessionDocument> layout;
    std::string layoutFolder;
    if (!request.layout.empty() || (request.paths.empty() && !request.data)) {
        const std::string path = findLayout(request.layout.empty() ? kFirstLayout : request.layout);
        layout = loadSession(path);
        layoutFolder = fs::path(path).parent_path().string();
    }
    DataRef data;
    if (request.data) {
        data = *request.data;
    } else if (!request.paths.empty()) {
        const volume::ImportOptions stated = request.import.value_or(volume::ImportOptions{});
        data = dataOf(request.paths, recallOptions(request.paths, stated, progress.part(0, 0.1)));
        if (request.lattice) data.lattice = *request.lattice;
    } else if (hasData(layout->session.data)) {
        const ResolvedData found = resolveData(layout->session.data, layoutFolder);
        if (!found.missing.empty()) throw Error("data file is missing", found.missing[0].wanted.path);
        data = found.data;
    } else {
        data.model = kFirstModel;
        if (request.lattice) data.lattice = *request.lattice;
    }
    if (request.remote) data.remote = *request.remote;
    const bool errors = layout && packsForErrors(layout->session, data) && !sameData(layout->session.data, data);
    if (errors) {
        data.packed = layout->session.data.packed;
        data.originals = true;
    } else if (layout && data.derived.empty()) {
        data.derived = layout->session.data.derived;
    }
    Sources sources = openSources(data, opened.messages, progress);
    if (errors)
        showErrors(*layout, data, sources, opened.messages);
    else if (layout && layout->session.data.originals && !data.originals)
        opened.messages.emplace_back(kNoOriginals);
    opened.source = std::move(sources.pictures);
    opened.numbers = std::move(sources.numbers);
    opened.origin = std::move(sources.origin);
    const volume::DatasetInfo& info = opened.source->info();
    if (layout) {
        opened.messages.insert(opened.messages.end(), layout->messages.begin(), layout->messages.end());
        opened.document.session = applyLayout(*layout, info, data, opened.messages);
        const bool own = sameData(layout->session.data, data);
        if (!own) aimFirstView(opened.document.session, *opened.source, firstAspect(info));
        fitSurfaces(opened.document.session, *opened.source, layout->session, opened.messages);
    } else {
        opened.document.session = defaultSession(info, data);
        aimFirstView(opened.document.session, *opened.source, firstAspect(info));
    }
    opened.document.history.reset(opened.document.session);
    opened.firstView = true;
    return opened;
}

} // namespace tessera::app
