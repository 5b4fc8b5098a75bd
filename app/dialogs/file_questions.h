#pragma once

#include "app/dialogs/import_form.h"

#include <functional>
#include <string>
#include <vector>

namespace tessera::app {

/// The file dialog with a callback for its answer; one question at a time.
class FileQuestions {
public:
    /// Previews are read by the jobs.
    explicit FileQuestions(Jobs& jobs);

    /// Asks for data or a session; the answer includes the import options.
    void
    askData(const std::string& title,
            std::function<void(const std::vector<std::string>& paths, const volume::ImportOptions& stated)> answer);
    bool asksData() const;
    /// Chooses files of one folder in the question that is shown.
    void choose(const std::vector<std::string>& paths) { dialog_.choose(paths); }
    /// Asks for files to open. `folder`: to look in first, "" = the last one.
    void askOpen(const std::string& title, std::function<void(const std::vector<std::string>& paths)> answer,
                 const std::string& folder = {});
    /// Asks where to save. `ending` is added to names without one.
    void askSave(const std::string& title, const std::string& name, const std::string& ending,
                 std::function<void(const std::string& path)> answer);

    /// The next question begins in this folder, that of the data that were opened; later ones where the last one ended.
    void startIn(const std::string& folder) { dialog_.startIn(folder); }

    const std::string& folder() const { return dialog_.folder(); }

    bool shown() const { return dialog_.shown(); }
    /// Draws it if it is shown; the answer is given in the frame the user decides. A cancelled question is dropped.
    void draw();

private:
    ImportForm form_;
    FileDialog dialog_;
    std::function<void(const std::vector<std::string>&)> answer_;
};

} // namespace tessera::app
