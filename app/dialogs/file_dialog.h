#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

/// A file browser as a modal dialog: folders, files with size and date, and a preview of the one that is chosen.
namespace tessera::app {

enum class FileMode { Open, Save };

/// Preview of a file before it is opened.
struct FilePreview {
    std::string text;    ///< "" while it is being read
    bool failed = false; ///< it cannot be opened, for the reason that `text` gives
};

class FileDialog {
public:
    /// Shows the dialog. `purpose` comes back with the answer. `suffix` is added to names that are saved without one.
    void show(FileMode mode, std::string title, std::string purpose, std::string folder, std::string name = {},
              std::string suffix = {});

    /// Shown or about to be: chooses files in it, as clicks would. They lie in one folder.
    void choose(const std::vector<std::string>& paths);

    struct Answer {
        std::string purpose;
        std::vector<std::string> paths;
    };
    /// Draws it if it is shown; answers in the frame the user decides.
    std::optional<Answer> draw();

    bool shown() const { return shown_; }
    const std::string& folder() const { return folder_; }
    /// The folder of the next question.
    void startIn(const std::string& folder) { folder_ = folder; }
    const std::string& purpose() const { return purpose_; }
    /// Why the last answer was refused, e.g. a file name that does not exist; "" if it was not. Shown below the name.
    const std::string& problem() const { return problem_; }

    /// Called every frame for the file that would be opened. A file whose preview failed is not opened.
    std::function<FilePreview(const std::string& path)> preview;
    /// Called when the files that would be opened have changed, before `preview`; with none when the dialog is shown.
    std::function<void(const std::vector<std::string>& paths)> filesChosen;
    /// Further widgets under the list when opening (import options).
    std::function<void()> options;

private:
    struct Entry {
        std::string name;
        bool folder = false;
        double bytes = 0;
        long long time = 0;
    };
    void enter(const std::string& folder);
    void drawList(std::optional<Answer>& answer, float height);
    void drawPreview(float height);
    void drawName(std::optional<Answer>& answer, bool& open);
    void answerWith(std::optional<Answer>& answer);
    std::vector<std::string> filesNamed() const;
    void noticeChoice();
    std::size_t stemLength() const;

    bool shown_ = false, opening_ = false, confirm_ = false;
    bool selectStem_ = false; ///< of the name, as soon as its field takes the keyboard
    bool focusName_ = false;  ///< the field of the name takes the keyboard in the next frame
    bool deciding_ = false;   ///< the user has decided, the preview is still being read
    FileMode mode_ = FileMode::Open;
    std::string title_, purpose_, folder_, name_, suffix_, filter_, problem_;
    std::vector<Entry> entries_;
    std::vector<std::string> chosen_;
    std::vector<std::string> noticed_; ///< paths last passed to filesChosen
};

/// For any dialog, just before it ends (a table in a window that has moved since its begin may fail an assertion of
/// ImGui): moves it back into the program's window, which may have become smaller since; its buttons are at the lower
/// right end.
void keepInView();

} // namespace tessera::app
