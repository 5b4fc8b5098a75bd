#pragma once

#include "app/dialogs/file_dialog.h"
#include "app/ui/jobs.h"
#include "volume/import/import.h"

#include <map>
#include <string>
#include <vector>

namespace tessera::app {

/// Whether nothing states the layout of a raw file: neither `import` nor a sidecar.
bool lacksLayout(const std::string& path, const volume::ImportOptions& import);

/// The form of the open dialog: a preview of the files, and options that state what they do not contain.
class ImportForm {
public:
    explicit ImportForm(Jobs& jobs) : jobs_(jobs) {}

    /// The options entered so far.
    const volume::ImportOptions& stated() const { return stated_; }
    /// The preview, read in the background: empty until then. If it failed, its text is the reason.
    FilePreview previewOf(const std::string& path);
    /// Call when other files are selected: discards the raw layout of the former ones.
    void filesChosen(const std::vector<std::string>& paths);
    /// The fields, under the list of files.
    void draw();

private:
    void readFields();

    Jobs& jobs_;
    volume::ImportOptions stated_;
    std::string absent_, units_, names_, lengths_; ///< as typed
    bool sidecar_ = false;                         ///< the files have one, which takes precedence over a typed layout
    std::map<std::string, FilePreview> previews_;
};

} // namespace tessera::app
