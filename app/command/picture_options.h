#pragma once

#include "app/data/open.h"
#include "app/history/session_file.h"
#include "app/platform/headless.h"

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

namespace tessera::app {

/// Options that render and replay share: the input, and the size of the picture.
struct PictureOptions {
    std::vector<std::string> inputs;
    std::string layout, view, size; ///< view: several are separated by commas; size: "" = as the form says
    int columns = 0;                ///< of several views; 0: as many as suit
    PictureForm form{.size = {.width = 1600, .height = 1000}};
    std::vector<CLI::Option*> onPaper; ///< options of which any makes a picture for paper
    std::vector<std::string> without;  ///< parts of the decoration
    bool undecorated = false;
    std::vector<std::string> settings; ///< "/json/pointer=value"
    std::vector<std::string> transfer; ///< "NAME" or "PARAMETER=NAME" of the library
    volume::ImportOptions import;
    codec::RemoteOptions remote;
};

/// The option --layout, whose help names the layouts that ship; `layout` must outlive the parsing.
void addLayoutOption(CLI::App& command, std::string& layout);

/// The option --transfer, whose help names the library; `transfer` must outlive the parsing.
void addTransferOption(CLI::App& command, std::vector<std::string>& transfer);

/// Adds them to a command; `options` must outlive the parsing.
void addPictureOptions(CLI::App& command, PictureOptions& options);

/// Size, ground and decoration of a picture alone; `options` must outlive the parsing.
void addFormOptions(CLI::App& command, PictureOptions& options);

/// The option --time, for showTime().
void addTimeOption(CLI::App& command, std::optional<double>& time);

/// Shows that time, also in those of the views that have a time of their own. Throws Error if the data do not reach it.
void showTime(Session& session, const volume::DatasetInfo& info, double time, const std::vector<std::string>& views);

/// Opens what the options name, with the settings applied. Throws Error, also for data that cannot be found.
Opened openForPicture(const PictureOptions& options, const Progress& progress);

/// The views that the option --view names.
std::vector<std::string> viewsOf(const PictureOptions& options);

/// The pane with this key, or the first view of this kind; "" if there is none.
std::string paneOf(const Session& session, const std::string& view);

/// Throws Error unless a path ends like a picture: .png, .svg or .pdf.
void requirePictureEnding(const std::string& path);

/// Throws Error where the option --view names none of the session, nor a kind of views.
void requireViews(const Session& session, const PictureOptions& options);

/// What is drawn, as SharedWork::about needs it: the session with its data, and the options of its pictures.
Json aboutPicture(const PictureOptions& options, const Opened& opened);

/// Pane and form. `view` may be the key of a pane or the kind of one. Throws Error.
PictureRequest pictureRequest(const PictureOptions& options, const Session& session);

} // namespace tessera::app
