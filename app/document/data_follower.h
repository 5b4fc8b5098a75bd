#pragma once

#include "app/document/archive_growth.h"
#include "app/document/document.h"
#include "app/document/tracked.h"
#include "app/ui/jobs.h"
#include "app/ui/messages.h"

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace tessera::app {

/// Keeps the data up to date with the session: reopens, packs, resamples or derives them in the background when the
/// session's description of them has been edited or an archive has grown. The former data are shown until then.
class DataFollower {
public:
    struct Options {
        bool headless = false;   ///< archives are not watched, and nothing is remembered
        std::string stateFolder; ///< "" remembers no choices
        std::string program;     ///< is run as a child to pack
        std::chrono::milliseconds growthInterval = std::chrono::seconds(1);
    };
    /// `shown` is called when the document has new sources, with the unchanged samples if the data have only grown.
    DataFollower(Document& document, Jobs& jobs, Messages& messages, Options options,
                 std::function<void(std::optional<vis::SameSamples> grown)> shown);

    /// Call after a document was installed: its data are up to date.
    void reset();
    /// Call once per frame: starts jobs for what has been edited, but not during an edit.
    void follow(bool typing, bool dragging);

    /// Opens data in place of those shown, keeping the session.
    void show(const DataRef& data, const std::string& title);
    /// Adds a second data set and the difference of a parameter to it, and opens a comparison of both by `openView`,
    /// all in one step of the history. `stated`: what the files do not contain. `openView` is called on the GUI thread.
    void compareWith(const std::vector<std::string>& paths, const volume::ImportOptions& stated,
                     std::function<void(Session& session, const CompareView& view)> openView);
    /// Removes the second data set with its differences and comparisons.
    void compareNoMore();
    /// Packs the files shown into an archive and shows that.
    void pack(const std::string& path);
    /// Adds the quantities of a table to the data shown.
    void addTable(const std::string& path);
    /// Data opened from now on are drawn on the lattice chosen last.
    OpenRequest withChoices(OpenRequest request) const;

private:
    /// The parts of the session after whose edits the data are opened again: what their times depend on, the unit of
    /// lengths, the other data beside them, and which grids of D4* are shown.
    struct OpenedBy {
        std::string axis;
        std::optional<volume::TimeAxis> along;
        std::string overTime, lengthUnit;
        std::optional<OtherData> other;
        ShownGrids grids = ShownGrids::Both;
        bool operator==(const OpenedBy&) const = default;
    };
    static OpenedBy openedBy(const DataRef& data);

    bool moveTo(RemadeData made);
    void take(Sources sources, std::optional<vis::SameSamples> grown = {});
    void followLattice();
    void followLabels(bool typing);
    void followDerived();
    void followOpening(bool dragging);
    void followGrowth();

    Document& document_;
    Jobs& jobs_;
    Messages& messages_;
    Options options_;
    std::function<void(std::optional<vis::SameSamples>)> shown_;
    Tracked<std::vector<volume::DerivedParameter>> derived_;
    Tracked<PictureLattice> lattice_;
    Tracked<OpenedBy> opened_;
    Tracked<std::vector<std::string>> labels_; ///< names given to regions
    ArchiveGrowth growth_;
};

/// True for files that are not an archive.
bool showsDataFiles(const Document& document);

} // namespace tessera::app
