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

/// The data under a session that stays: opened, packed, resampled or derived anew, in the background, where the part of
/// the session that describes them has been edited or an archive has grown. What is shown stays until then.
class DataFollower {
public:
    struct Options {
        bool headless = false;   ///< archives are not watched, and nothing is remembered
        std::string stateFolder; ///< "" remembers no choices
        std::string program;     ///< is run as a child to pack
        std::chrono::milliseconds growthInterval = std::chrono::seconds(1);
    };
    /// `shown` is called when the document has other sources; with what they have of the former ones where those have
    /// only grown.
    DataFollower(Document& document, Jobs& jobs, Messages& messages, Options options,
                 std::function<void(std::optional<vis::SameSamples> grown)> shown);

    /// The document has just been installed: it is as it wants to be, and shown.
    void reset();
    /// Once per frame: starts what has to be made anew. Not while something is typed or dragged that changes on.
    void follow(bool typing, bool dragging);

    /// Opens data in place of those shown, for the session as it is then.
    void show(const DataRef& data, const std::string& title);
    /// Another data set beside the one shown, and how the parameter shown first differs; no paths: takes it away.
    void compareWith(const std::vector<std::string>& paths);
    /// Packs the files shown into an archive and shows that.
    void pack(const std::string& path);
    /// Adds the quantities of a table to the data shown.
    void addTable(const std::string& path);
    /// Data opened anew are drawn on the lattice chosen last.
    OpenRequest withChoices(OpenRequest request) const;

private:
    /// What the times of the data depend on.
    struct CountedBy {
        std::string axis;
        std::optional<volume::TimeAxis> along;
        std::string overTime;
        bool operator==(const CountedBy&) const = default;
    };
    static CountedBy countedBy(const DataRef& data);

    bool moveTo(RemadeData made);
    void take(Sources sources, std::optional<vis::SameSamples> grown = {});
    void followLattice();
    void followLabels(bool typing);
    void followDerived();
    void followAxis(bool dragging);
    void followGrowth();
    void addDifference();

    Document& document_;
    Jobs& jobs_;
    Messages& messages_;
    Options options_;
    std::function<void(std::optional<vis::SameSamples>)> shown_;
    Tracked<std::vector<volume::DerivedParameter>> derived_;
    Tracked<PictureLattice> lattice_;
    Tracked<CountedBy> counted_;
    Tracked<std::vector<std::string>> labels_; ///< names that regions have been given
    ArchiveGrowth growth_;
};

/// True for files that are not an archive.
bool showsDataFiles(const Document& document);

} // namespace tessera::app
