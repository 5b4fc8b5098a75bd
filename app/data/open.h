#pragma once

#include "app/data/sources.h"
#include "app/history/session_file.h"
#include "volume/base/progress.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

/// Opens anything: sessions, pictures that contain one, layouts, archives, data files and built-in models. Plain
/// functions that run off the GUI thread; the workbench only installs what they return.
namespace tessera::app {

struct OpenRequest {
    std::vector<std::string> paths;                  ///< one session or picture, or data files that belong together
    std::string layout;                              ///< name or file of a layout; "" = none
    std::optional<DataRef> data;                     ///< instead of paths, or instead of the data of a session
    std::optional<volume::ImportOptions> import;     ///< for data files
    std::optional<PictureLattice> lattice = {};      ///< of pictures of data that are opened anew
    std::optional<PictureLattice> uneven = {};       ///< the same where their axes are uneven
    std::optional<codec::RemoteOptions> remote = {}; ///< for archives on other machines
};

/// Of a session that was kept automatically. Its data were shown, so the files elsewhere that they name were allowed.
OpenRequest recoveryRequest(const std::string& path);

struct Opened {
    SessionDocument document;
    std::shared_ptr<const volume::BrickSource> source;  ///< of pictures; null if data are missing
    std::shared_ptr<const volume::BrickSource> numbers; ///< what numbers are read from; null: `source`
    NumberOrigin origin = {};                           ///< of the numbers
    std::shared_ptr<const volume::BrickSource> packed;  ///< Sources::packed
    std::vector<MissingData> missing;
    std::string sessionPath; ///< where Save writes; "" for data, layouts and pictures
    std::string folder;      ///< that data paths are relative to
    std::vector<std::string> messages;
    bool firstView = false;            ///< its cameras are of a layout or of nobody, not of a saved session
    std::vector<std::string> warnings; ///< data have changed since the session was saved

    void take(Sources sources);
    Sources sources() const;
};

/// Opens a request. Nothing at all means the overview layout with the built-in fuel cell. Files that a session names
/// and that cannot be found come back in `missing`, without a source. Throws Error, MachineError, Cancelled.
Opened open(const OpenRequest& request, const Progress& progress = {});

/// Opens a session document whose data are `data` (found by the user, or another data set). Where it was shown before
/// (`opened.source`) with or without time along an axis, time and cross-hair go over into the other way.
Opened openWith(Opened opened, const DataRef& data, const Progress& progress = {});

/// Moves a session with its history to other data, which `to` describes, or to the same data on another lattice or cut;
/// `from` describes its previous data, null if none. If only one of the two has time along an axis, time and cross-hair
/// are converted; one message for each thing that does not fit.
void moveTo(Session& session, History& history, const volume::DatasetInfo* from, const volume::DatasetInfo& to,
            const DataRef& data, std::vector<std::string>& messages);

/// The data set of files that are opened together.
DataRef dataOf(const std::vector<std::string>& paths, const volume::ImportOptions& options);

/// Whether an input of a command is a built-in model, which it is if no file has that name.
bool namesModel(const std::string& input);
/// That model. Throws Error if anything is stated, since only files can use it.
volume::Dataset modelNamed(const std::string& input, const volume::ImportOptions& stated, const Progress& progress);

/// The data set named on a command line: a built-in model, or files with what has been stated about them before. Throws
/// Error.
DataRef dataNamed(const std::vector<std::string>& inputs, const volume::ImportOptions& stated,
                  const Progress& progress = {});

/// Throws Error for a file among `paths` that is no data file: a session or a picture that contains one, or an archive
/// beside other files. Throws nothing for files that are missing.
void requireData(const std::vector<std::string>& paths);

} // namespace tessera::app
