#pragma once

#include "app/data/sources.h"
#include "app/session/session_file.h"
#include "volume/base/progress.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

/// Opening anything the program is given: sessions, pictures that carry one, layouts, archives, data files and built-in
/// models. Plain functions that work off the GUI thread; the workbench only takes over what they return.
namespace tessera::app {

struct OpenRequest {
    std::vector<std::string> paths;              ///< one session or picture, or data files that belong together
    std::string layout;                          ///< name or file of a layout; "" = none
    std::optional<DataRef> data;                 ///< instead of paths, or instead of the data of a session
    std::optional<volume::ImportOptions> import; ///< for data files
    std::optional<PictureLattice> lattice = {};  ///< of pictures of data that are opened anew
};

struct Opened {
    SessionDocument document;
    std::shared_ptr<const volume::BrickSource> source;  ///< of pictures; null if data are missing
    std::shared_ptr<const volume::BrickSource> numbers; ///< what numbers are read from; null: `source`
    NumberOrigin origin = {};                           ///< of the numbers
    std::vector<MissingData> missing;
    std::string sessionPath; ///< where Save writes; "" for data, layouts and pictures
    std::string folder;      ///< that data paths are relative to
    std::vector<std::string> messages;

    Sources sources() const { return {source, numbers, origin}; }
};

/// Opens a request. Nothing at all means the overview layout with the built-in fuel cell. Files that a session names
/// and that cannot be found come back in `missing`, without a source. Throws Error, MachineError, Cancelled.
Opened open(const OpenRequest& request, const Progress& progress = {});

/// Opens a session document whose data are `data` (found by the user, or another data set). Where it was shown before
/// (`opened.source`) with or without time along an axis, time and cross-hair go over into the other way.
Opened openWith(Opened opened, const DataRef& data, const Progress& progress = {});

/// Puts a session with its history on other data, which `to` describes, or on the same ones made or cut otherwise;
/// `from` describes what it was on, null if nothing. Where only one of the two has time along an axis, time and
/// cross-hair go over into the other way; one message for each thing that does not fit.
void moveTo(Session& session, History& history, const volume::DatasetInfo* from, const volume::DatasetInfo& to,
            const DataRef& data, std::vector<std::string>& messages);

/// The data set that files given together make.
DataRef dataOf(const std::vector<std::string>& paths, const volume::ImportOptions& options);

/// What the words of a command name: a built-in model (where no file is called so), or files with what has been stated
/// of them before. Throws Error.
DataRef dataNamed(const std::vector<std::string>& inputs, const volume::ImportOptions& stated,
                  const Progress& progress = {});

/// The session text inside a PNG of ours. Throws Error when there is none.
std::string sessionTextOfPicture(const std::string& path);

/// Names of the layouts that ship with the program, and the file of a layout given by name or path. Throws Error.
std::vector<std::string> layoutNames();
std::string findLayout(const std::string& nameOrPath);

/// A layout laid over a data set: what it leaves out or cannot mean for this data comes from the data's own defaults.
/// Variants of a comparison that are other sizes of another model are left out.
Session applyLayout(const SessionDocument& layout, const volume::DatasetInfo& info, const DataRef& data,
                    std::vector<std::string>& messages);

/// Surfaces whose value does not exist at the session's time, or, with `own` false, lies near the ends of what does,
/// get the middle of the range at that time: parameters may be far from their overall range then. One message for each
/// parameter that has no surface at all. Reads statistics of the bricks of one time; with a damaged one the rest
/// stays as it is.
void fitSurfaces(Session& session, const volume::BrickSource& source, bool own, std::vector<std::string>& messages);

/// A layout chosen for data that are already shown: theme, time and cross-hair stay as in `shown`, and where the layout
/// was made with other data the camera sees all of these. Throws Error.
Session changeLayout(const SessionDocument& layout, const volume::BrickSource& source, const Session& shown,
                     std::vector<std::string>& messages);

} // namespace tessera::app
