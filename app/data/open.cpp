#include "app/data/open.h"

#include "app/data/apply_layout.h"
#include "app/data/first_view.h"
#include "app/data/format.h"
#include "app/data/packing_errors.h"
#include "app/data/picture_lattice.h"
#include "app/data/picture_session.h"
#include "app/data/plane_sources.h"
#include "app/described/within_ranges.h"
#include "app/user_files/import_memory.h"

#include "app/history/session_file.h"
#include "codec/remote/address.h"
#include "volume/base/error.h"
#include "volume/field/quantities.h"
#include "volume/import/import.h"
#include "volume/synthetic/models.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

namespace tessera::app {

namespace fs = std::filesystem;

namespace {

constexpr const char *kFirstLayout = "overview", *kFirstModel = "fuel-cell";

enum class Kind { Session, Picture, Data };

Kind kindOf(const std::string& path) {
    if (codec::isRemote(path)) return Kind::Data;
    if (opensAsPicture(path)) return Kind::Picture;
    if (!hasEnding(path, ".json")) return Kind::Data;
    if (hasEnding(path, ".tessera.json")) return Kind::Session;
    // Other JSON files are sessions (layouts) or the sidecars of raw files.
    return looksLikeSession(readText(path)) ? Kind::Session : Kind::Data;
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
    if (request.import) {
        volume::ImportOptions about = *request.import;
        const bool allowed = std::exchange(about.allowOutside, false);
        if (about != volume::ImportOptions{}) data.import = about;
        data.import.allowOutside = allowed;
        if (data.other) data.other->import.allowOutside = allowed;
    }
    if (request.remote) data.remote = *request.remote;
    return openWith(std::move(opened), data, progress);
}

} // namespace

OpenRequest recoveryRequest(const std::string& path) {
    OpenRequest request;
    request.paths = {path};
    request.import.emplace();
    request.import->allowOutside = true;
    return request;
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
    if (inputs.size() != 1 || !namesModel(inputs[0])) requireData(inputs);
    if (inputs.size() != 1 || !namesModel(inputs[0])) return dataOf(inputs, recallOptions(inputs, stated, progress));
    DataRef data;
    data.model = inputs[0];
    data.import = stated;
    return data;
}

namespace {

/// Between data and a plane of theirs in space and time, or between two planes, the cross-hair stays where it is in
/// space and time, as far as the plane has that point. `session` still refers to the former data, described by `from`.
void carryPoint(Session& session, const volume::DatasetInfo& from, const volume::DatasetInfo& to) {
    if (from.plane == to.plane) return;
    const glm::dvec4 point = from.pointAt(session.cursor, session.time);
    if (to.plane) {
        session.cursor = to.plane->positionOf(point);
        return;
    }
    session.cursor = glm::dvec3(point);
    session.time = point.w;
    for (const double stored : to.times)
        if (std::abs(session.time - stored) < 1e-9 * (to.times.back() - to.times.front())) session.time = stored;
}

} // namespace

void Opened::take(Sources sources) {
    source = std::move(sources.pictures);
    numbers = std::move(sources.numbers);
    packed = std::move(sources.packed);
    origin = std::move(sources.origin);
}

Sources Opened::sources() const {
    Sources out{source, numbers, origin};
    out.packed = packed;
    return out;
}

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
    if (from) carryPoint(session, *from, to);
    if (from && from->timeName != to.timeName) // the same state on another time axis
        if (const auto same = volume::findQuantity(*from, to.timeName)) {
            const auto move = [&](double& time) {
                const double now = volume::valueAt(from->times, from->quantities[std::size_t(*same)].values, time);
                if (std::isfinite(now)) time = now;
            };
            move(session.time);
            for (auto& [pane, view] : session.views)
                if (auto* const volume = std::get_if<VolumeView>(&view); volume && volume->time) move(*volume->time);
            for (Callout& callout : session.callouts)
                if (callout.time) move(*callout.time);
            for (vis::Lens& lens : session.lenses)
                for (auto* const end : {&lens.fromTime, &lens.untilTime})
                    if (*end) move(**end);
        }
    session.data = data;
    // Drawn as stored, by cells: so brushes select, too.
    if (data.lattice == PictureLattice::Even && !to.lattice.isEven()) session.data.lattice = PictureLattice::Grid;
    history.setData(session.data);
    fitSession(session, to, messages);
}

namespace {

/// What is shown for the name of a model alone: the first model in its layout, another with the default session.
Opened openModel(const OpenRequest& request, const Progress& progress) {
    OpenRequest inner = request;
    inner.paths.clear();
    if (request.paths[0] == kFirstModel && request.layout.empty()) inner.layout = kFirstLayout;
    inner.data = dataNamed(request.paths, request.import.value_or(volume::ImportOptions{}));
    if (request.lattice) inner.data->lattice = *request.lattice;
    return open(inner, progress);
}

/// Opens a session, a picture that contains one, or a layout.
Opened openSession(const std::string& path, Kind kind, const OpenRequest& request, const Progress& progress) {
    SessionDocument document =
        kind == Kind::Session ? loadSession(path) : parseSession(sessionTextOfPicture(path), path);
    const std::string folder = fs::absolute(path).parent_path().string();
    // Saved sessions are marked as such; other documents are layouts, which may be incomplete.
    const bool complete = document.raw.contains("app") && (hasData(document.session.data) || request.data);
    if (request.layout.empty() && complete) {
        Opened opened = openDocument(std::move(document), folder, request, progress);
        if (kind == Kind::Session) opened.sessionPath = fs::absolute(path).lexically_normal().string();
        return opened;
    }
    OpenRequest inner = request;
    inner.paths.clear();
    if (request.layout.empty()) {
        inner.layout = path;
    } else { // its data in another layout
        const ResolvedData found = resolveData(document.session.data, folder);
        if (!found.missing.empty()) throw Error("data file is missing", found.missing[0].wanted.path, path);
        inner.data = found.data;
        inner.lattice.reset();
    }
    return open(inner, progress);
}

/// The data of a request, else those of its layout, which lies in `folder`, else the first model.
DataRef dataRequested(const OpenRequest& request, const SessionDocument* layout, const std::string& folder,
                      std::vector<std::string>& messages, const Progress& progress) {
    if (request.data) return *request.data;
    DataRef data;
    if (!request.paths.empty()) {
        requireData(request.paths);
        const volume::ImportOptions stated = request.import.value_or(volume::ImportOptions{});
        data = dataOf(request.paths, recallOptions(request.paths, stated, messages, progress.part(0, 0.1)));
    } else if (hasData(layout->session.data)) {
        const ResolvedData found = resolveData(layout->session.data, folder);
        if (!found.missing.empty()) throw Error("data file is missing", found.missing[0].wanted.path);
        return found.data;
    } else {
        data.model = kFirstModel;
    }
    if (request.lattice) data.lattice = *request.lattice;
    return data;
}

/// The lattice that pictures of data are drawn on first, which were opened for that of `data`.
PictureLattice latticeOfFirst(const DataRef& data, const Sources& sources, const OpenRequest& request) {
    const volume::DatasetInfo& numbers = sources.numbers->info();
    if (numbers.lattice.isEven()) return latticeFor(data.lattice, numbers);
    if (!canChooseLattice(data, *sources.numbers, sources.origin)) return PictureLattice::Grid;
    return request.uneven ? latticeFor(*request.uneven, numbers) : firstLattice(data.lattice, numbers);
}

/// Shows data in a layout, without one in the default session.
Opened openData(DataRef data, std::optional<SessionDocument> layout, const OpenRequest& request,
                const Progress& progress) {
    Opened opened;
    const bool errors = layout && packsForErrors(layout->session, data) && !sameData(layout->session.data, data);
    if (errors) {
        data.packed = layout->session.data.packed;
        data.originals = true;
    } else if (layout && data.derived.empty()) {
        data.derived = layout->session.data.derived;
    }
    Sources sources = openSources(data, opened.messages, progress);
    if (const PictureLattice lattice = latticeOfFirst(data, sources, request); lattice != data.lattice) {
        data.lattice = lattice;
        if (data.other) { // whose numbers depend on the lattice of pictures
            opened.messages.clear();
            sources = openSources(data, opened.messages);
        } else if (!sources.numbers->info().lattice.isEven()) {
            sources = drawnOn(lattice, sources);
        }
    }
    if (layout && layoutCuts(layout->session, data, sources.numbers->info())) {
        data.timeAxis = planeOfLayout(layout->session, sources.numbers->info(), opened.messages);
        if (data.timeAxis) sources = deriveBoth(cutByPlane(underived(sources), data), data.derived, opened.messages);
    } else if (layout && layout->session.data.timeAxis && !data.timeAxis) {
        opened.messages.emplace_back(kNoTimesToCut);
    }
    if (errors)
        showErrors(*layout, data, sources, opened.messages);
    else if (layout && layout->session.data.originals && !data.originals)
        opened.messages.emplace_back(kNoOriginals);
    opened.take(std::move(sources));
    const volume::DatasetInfo& info = opened.source->info();
    Session& session = opened.document.session;
    if (layout) {
        opened.messages.insert(opened.messages.end(), layout->messages.begin(), layout->messages.end());
        session = applyLayout(*layout, info, data, opened.messages);
    } else {
        session = defaultSession(info, data);
        showWhatVaries(session, *opened.numbers, opened.messages);
    }
    if (layout && !sameData(layout->session.data, data)) showLastIfEmpty(session, *opened.numbers, opened.messages);
    if (!layout || !sameData(layout->session.data, data)) aimFirstView(session, *opened.numbers, firstAspect(info));
    if (layout) fitSurfaces(session, *opened.numbers, layout->session, opened.messages);
    keepWithinRanges(session); // cameras of flat data, for example
    opened.document.history.reset(session);
    opened.firstView = true;
    return opened;
}

} // namespace

Opened open(const OpenRequest& request, const Progress& progress) {
    if (!request.data && request.paths.size() == 1 && namesModel(request.paths[0])) return openModel(request, progress);
    if (request.paths.size() == 1) {
        const std::string& path = request.paths[0];
        std::error_code problem;
        if (!codec::isRemote(path) && !fs::exists(path, problem)) throw Error("no such file", path);
        if (const Kind kind = kindOf(path); kind != Kind::Data) return openSession(path, kind, request, progress);
    }
    std::optional<SessionDocument> layout;
    std::string folder;
    if (!request.layout.empty() || (request.paths.empty() && !request.data)) {
        const std::string path = findLayout(request.layout.empty() ? kFirstLayout : request.layout);
        layout = loadSession(path);
        folder = fs::path(path).parent_path().string();
    }
    std::vector<std::string> said;
    DataRef data = dataRequested(request, layout ? &*layout : nullptr, folder, said, progress);
    if (request.remote) data.remote = *request.remote;
    Opened opened = openData(std::move(data), std::move(layout), request, progress);
    opened.messages.insert(opened.messages.begin(), said.begin(), said.end());
    return opened;
}

void requireData(const std::vector<std::string>& paths) {
    const bool alone = paths.size() == 1;
    for (const std::string& path : paths) {
        std::error_code unknown;
        if (codec::isRemote(path) || !std::filesystem::is_regular_file(path, unknown)) continue;
        if (!alone && codec::namesArchive(path))
            throw Error("is an archive, which is opened alone; tessera compare --with compares two data sets", path);
        if (hasEnding(path, ".tessera.json") || (hasEnding(path, ".json") && looksLikeSession(readText(path)))) {
            (void)loadSession(path); // a broken one says what is broken
            throw Error(alone ? "is a session, and data are expected here" : "is a session, which is opened alone",
                        path);
        }
        if (alone && namesPicture(path) && holdsSession(path))
            throw Error("is a picture that contains a session, and data are expected here", path);
    }
}

} // namespace tessera::app
