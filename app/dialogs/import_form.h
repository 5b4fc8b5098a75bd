#pragma once

#include "app/ui/file_dialog.h"
#include "app/ui/jobs.h"
#include "volume/import/import.h"

#include <map>
#include <string>
#include <vector>

namespace tessera::app {

/// What the dialog for opening shows of files before they are opened, and what can be stated about them there.
class ImportForm {
public:
    explicit ImportForm(Jobs& jobs) : jobs_(jobs) {}

    /// What has been stated.
    const volume::ImportOptions& stated() const { return stated_; }
    /// Read in the background; an empty text until it is known. One that failed says why.
    FilePreview previewOf(const std::string& path);
    /// Other files are chosen: a raw layout was stated for the former ones.
    void filesChosen(const std::vector<std::string>& paths);
    /// The fields, under the list of files.
    void draw();

private:
    void readFields();

    Jobs& jobs_;
    volume::ImportOptions stated_;
    std::string absent_, units_, names_; ///< as typed
    bool sidecar_ = false;               ///< of the files chosen: it wins over a layout typed before
    std::map<std::string, FilePreview> previews_;
};

} // namespace tessera::app
