#include "app/document/data_follower.h"

#include "app/data/open.h"
#include "app/data/pack_child.h"
#include "app/data/plane_sources.h"
#include "app/data/sources.h"
#include "app/edits/compare_files.h"
#include "app/user_files/import_memory.h"
#include "app/user_files/machines.h"
#include "app/user_files/state_dir.h"
#include "app/views/data/derived_list.h"
#include "volume/base/background.h"
#include "volume/base/byte_text.h"
#include "volume/base/error.h"
#include "volume/derived/derived.h"
#include "volume/derived/other_source.h"
#include "volume/import/over_time.h"

#include <filesystem>

namespace tessera::app {

namespace fs = std::filesystem;

namespace {

/// Keys of remembered choices; that for uneven axes means something else.
constexpr const char *kLatticeChoice = "lattice", *kUnevenChoice = "unevenLattice";

std::optional<PictureLattice> rememberedLattice(const std::string& stateFolder, const char* key) {
    const std::string chosen = rememberedChoice(stateFolder, key);
    for (const auto lattice : {PictureLattice::Grid, PictureLattice::BodyCentred, PictureLattice::Even})
        if (chosen == kPictureLatticeNames[std::size_t(lattice)]) return lattice;
    return std::nullopt;
}

/// Another plane of the same data as the one shown, with the derived parameters of `data`: nothing is opened again.
/// None where that cannot be done: no plane is shown or wanted, or the data are shown as an archive would hold them.
std::optional<Sources> cutAgain(const Sources& shown, const DataRef& data, std::vector<std::string>& messages,
                                const Progress& progress) {
    if (!data.timeAxis || !shown.origin.spaceOfPlane || data.packed) return std::nullopt;
    const Sources whole(shown.origin.spaceOfPlane, shown.origin.spaceOfPlane, shown.origin);
    return deriveBoth(cutByPlane(whole, data), data.derived, messages, progress);
}

} // namespace

DataFollower::DataFollower(Document& document, Jobs& jobs, Messages& messages, Options options,
                           std::function<void(std::optional<vis::SameSamples>)> shown)
    : document_(document), jobs_(jobs), messages_(messages), options_(std::move(options)), shown_(std::move(shown)),
      growth_(options_.growthInterval) {}

bool showsDataFiles(const Document& document) {
    const auto& files = document.session().data.files;
    return document.loaded() && !files.empty() && !isArchive(document.session().data);
}

OpenRequest DataFollower::withChoices(OpenRequest request) const {
    request.uneven = rememberedLattice(options_.stateFolder, kUnevenChoice);
    const auto lattice = rememberedLattice(options_.stateFolder, kLatticeChoice);
    if (!lattice || *lattice == PictureLattice::Even) return request;
    request.lattice = lattice;
    if (request.data && request.paths.empty() && request.data->files.empty()) request.data->lattice = *lattice;
    return request;
}

DataFollower::OpenedBy DataFollower::openedBy(const DataRef& data) {
    return {data.axis, data.timeAxis, data.import.overTime, data.import.lengthUnit, data.other, data.grids};
}

void DataFollower::reset() {
    const DataRef& data = document_.session().data;
    derived_.settle(data.derived);
    opened_.settle(openedBy(data));
    lattice_.settle(data.lattice);
    labels_.settle(data.import.labels);
    shown_({});
}

void DataFollower::follow(bool typing, bool dragging) {
    if (!document_.loaded()) return;
    followLattice();
    followLabels(typing);
    followOpening(dragging);
    followDerived();
    followGrowth();
}

/// The document shows other sources from now on.
void DataFollower::take(Sources sources, std::optional<vis::SameSamples> grown) {
    document_.setSources(std::move(sources));
    shown_(grown);
}

/// Shows the result of a job. Returns false and changes nothing if other data are shown by now.
bool DataFollower::moveTo(RemadeData made) {
    if (!document_.moveTo(made)) return false;
    derived_.settle(made.data.derived);
    opened_.settle(openedBy(made.data));
    lattice_.settle(made.data.lattice);
    labels_.shown = made.data.import.labels;
    shown_({});
    for (const std::string& text : made.messages) messages_.add(text);
    return true;
}

void DataFollower::show(const DataRef& data, const std::string& title) {
    jobs_.start("open", title,
                [this, title, from = document_.sources().pictures, data](const Progress& progress) -> Jobs::Finish {
                    const auto made = std::make_shared<RemadeData>(RemadeData{from, {}, data, {}});
                    made->sources = openSources(data, made->messages, progress);
                    return [this, title, made] {
                        if (!moveTo(std::move(*made)))
                            messages_.add(title + ": not shown, as the data have changed since");
                    };
                });
}

void DataFollower::compareWith(const std::vector<std::string>& paths, const volume::ImportOptions& stated,
                               std::function<void(Session&, const CompareView&)> openView) {
    const std::string title = "Comparing with another file";
    allowNamed(paths, options_.stateFolder);
    jobs_.start(
        "open", title,
        [this, title, paths, stated, openView = std::move(openView), from = document_.sources().pictures,
         session = document_.session()](const Progress& progress) -> Jobs::Finish {
            const auto made = std::make_shared<RemadeData>(RemadeData{from, {}, session.data, {}});
            requireData(paths);
            const DataRef other = dataOf(paths, recallOptions(paths, stated, made->messages, progress.part(0, 0.1)));
            made->data.other = OtherData{.files = other.files, .model = {}, .settings = {}, .import = other.import};
            const ComparedData compared = openCompared(made->data, session, made->messages, progress.part(0.1, 1));
            made->sources = compared.sources;
            const auto beside = volume::otherOf(*volume::underived(compared.sources.numbers));
            const std::string name = beside ? beside->info().name : std::string();
            return [this, title, made, openView, stated, name, channel = compared.channel] {
                if (document_.sources().pictures != made->from)
                    return messages_.add(title + ": not shown, as the data have changed since");
                Session& now = document_.session();
                now.data.other = made->data.other;
                moveTo(*made);
                if (!options_.headless) rememberStated(stated, name);
                if (channel.empty()) return;
                showOtherDifference(now, document_.info(), channel);
                CompareView view;
                view.variants = fileVariants(now, document_.info());
                openView(now, view);
                document_.replace(now, title);
            };
        });
}

void DataFollower::compareNoMore() {
    Session session = document_.session();
    dropOtherData(session);
    document_.replace(std::move(session), "Without the other data");
}

void DataFollower::pack(const std::string& path) {
    const DataRef& data = document_.session().data;
    std::vector<std::string> inputs;
    for (const DataFile& file : data.files) inputs.push_back(file.absolutePath);
    jobs_.start("pack", "Packing " + fs::path(path).filename().string(),
                [this, path, inputs, from = document_.sources().pictures, import = data.import, derived = data.derived,
                 other = data.other, program = options_.program](const Progress& progress) -> Jobs::Finish {
                    workInBackground();
                    const PackedArchive archive =
                        packInChild(fs::canonical(program).string(), inputs, import, path, progress.part(0, 0.95));
                    const std::string done =
                        "Packed " + textOfBytes(archive.sourceBytes) + " into " + textOfBytes(archive.archiveBytes);
                    const auto made = std::make_shared<RemadeData>(RemadeData{from, {}, dataOf({path}, {}), {}});
                    made->data.derived = derived;
                    made->data.other = other;
                    made->sources = openSources(made->data, made->messages, progress.part(0.95, 1));
                    return [this, path, done, made] {
                        messages_.add(done + (moveTo(std::move(*made)) ? ", now showing " : ": ") + path);
                    };
                });
}

/// Draws the data on another lattice when that has been edited.
void DataFollower::followLattice() {
    const DataRef& data = document_.session().data;
    const PictureLattice wanted = data.lattice;
    const auto step = lattice_.next(wanted);
    if (step == Tracked<PictureLattice>::Step::Cancel) jobs_.cancel("lattice");
    if (step != Tracked<PictureLattice>::Step::Make) return;
    const volume::BrickSource& numbers = *document_.sources().numbers;
    if (!canChooseLattice(data, numbers, document_.sources().origin)) {
        lattice_.shown = wanted;
        return;
    }
    const bool even = numbers.info().lattice.isEven();
    if (!even || wanted != PictureLattice::Even)
        rememberChoice(options_.stateFolder, even ? kLatticeChoice : kUnevenChoice,
                       std::string(kPictureLatticeNames[std::size_t(wanted)]));
    jobs_.start("lattice", "Resampling for pictures",
                [this, wanted, from = document_.sources()](const Progress&) -> Jobs::Finish {
                    const Sources made = drawnOn(wanted, from);
                    return [this, made, wanted, from] {
                        // The data have grown or changed meanwhile: start again.
                        if (document_.sources().pictures != from.pictures) return lattice_.giveUp();
                        take(made);
                        lattice_.shown = wanted;
                    };
                });
}

/// Opens the data again when the axis of times, the plane whose times run along an axis, the table over time or the
/// other data have been edited; what is shown stays until then.
void DataFollower::followOpening(bool dragging) {
    const DataRef& data = document_.session().data;
    const auto step = opened_.next(openedBy(data), dragging);
    if (step == Tracked<OpenedBy>::Step::Cancel) jobs_.cancel("axis");
    if (step != Tracked<OpenedBy>::Step::Make) return;
    const bool files = !(data.other == opened_.shown.other);
    OpenedBy turned = opened_.shown;
    turned.along = data.timeAxis;
    const bool again = turned == openedBy(data); // the data that a plane is cut from are open
    jobs_.start("axis",
                files   ? "Opening the data"
                : again ? "Cutting the plane"
                        : "Reading the times",
                [this, again, from = document_.sources(), data](const Progress& progress) -> Jobs::Finish {
                    const auto made = std::make_shared<RemadeData>(RemadeData{from.pictures, {}, data, {}});
                    auto plane = again ? cutAgain(from, data, made->messages, progress) : std::nullopt;
                    made->sources = plane ? std::move(*plane) : openSources(data, made->messages, progress);
                    return [this, made] {
                        if (!moveTo(std::move(*made))) opened_.giveUp();
                    };
                });
}

void DataFollower::addTable(const std::string& path) {
    jobs_.start("table", "Reading " + fs::path(path).filename().string(),
                [this, path, from = document_.sources().pictures](const Progress&) -> Jobs::Finish {
                    volume::DatasetInfo info = from->info();
                    const volume::TimeTable table = volume::readTimeTable(path);
                    volume::addTable(info, table);
                    return [this, path, from, columns = table.columns.size()] {
                        if (document_.sources().pictures != from) return;
                        document_.session().data.import.overTime = absolutePath(path).generic_string();
                        messages_.add(std::to_string(columns) + (columns == 1 ? " quantity" : " quantities") +
                                      " over time from " + path);
                    };
                });
}

/// Opens the data again, with the names that regions have been given; not while one is being typed.
void DataFollower::followLabels(bool typing) {
    const DataRef& data = document_.session().data;
    if (labels_.next(data.import.labels, typing) != decltype(labels_)::Step::Make) return;
    if (!options_.headless) rememberLabels(data.import.labels, labels_.shown, document_.info().name);
    show(data, "Naming regions");
}

/// Rebuilds the source after derived parameters have been edited; the former data are shown until then.
void DataFollower::followDerived() {
    if (jobs_.running("axis")) return; // derives them as well
    const auto& wanted = document_.session().data.derived;
    const auto step = derived_.next(wanted);
    if (step == decltype(derived_)::Step::Cancel) jobs_.cancel("derive");
    if (step != decltype(derived_)::Step::Make) return;
    const Sources& now = document_.sources();
    jobs_.start("derive", "Deriving parameters",
                [this, below = underived(now), wanted, from = now.pictures](const Progress& progress) -> Jobs::Finish {
                    auto messages = std::make_shared<std::vector<std::string>>();
                    const Sources made = deriveBoth(below, wanted, *messages, progress);
                    return [this, messages, made, wanted, from] {
                        // The data have grown or changed meanwhile: start again.
                        if (document_.sources().pictures != from) return derived_.giveUp();
                        take(made);
                        derived_.shown = wanted;
                        fitSession(document_.session(), document_.info(), *messages);
                        for (const std::string& text : *messages) messages_.add(text, true);
                    };
                });
}

/// Takes over new times of archives that grow while they are shown; views keep their state.
void DataFollower::followGrowth() {
    const DataRef& data = document_.session().data;
    if (!growth_.changed(options_.headless || data.timeAxis ? nullptr : &data, jobs_.wake)) return;
    jobs_.start(
        "growth", "Reading the new times",
        [this, data, from = document_.sources(), derived = derived_.shown](const Progress& progress) -> Jobs::Finish {
            const auto grown = std::make_shared<std::optional<Grown>>();
            try {
                *grown = readGrown(data, from, derived, progress);
            } catch (const Error&) { // the data shown stay valid
                return [this] { growth_.tellAgain(); };
            }
            if (!*grown) return {};
            return [this, grown, from] {
                // The data have changed meanwhile: look again.
                if (document_.sources().pictures != from.pictures) return growth_.lookAgain();
                Grown& now = **grown;
                take(std::move(now.sources), now.same); // views keep their caches, so that a drag continues
                fitSession(document_.session(), document_.info(), now.problems);
                for (const std::string& text : now.news) messages_.add(text);
                for (const std::string& text : now.problems) messages_.add(text, true);
            };
        },
        true);
}

} // namespace tessera::app
