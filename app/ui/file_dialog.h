#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

/// A file browser as a modal dialog: folders, files with size and date, and a preview of the one that is chosen.
namespace tessera::app {

enum class FileMode { Open, Save };

class FileDialog {
public:
    /// Shows the dialog. `purpose` comes back with the answer. `suffix` is added to names that are saved without one.
    void show(FileMode mode, std::string title, std::string purpose, std::string folder, std::string name = {},
              std::string suffix = {});

    struct Answer {
        std::string purpose;
        std::vector<std::string> paths;
    };
    /// Draws it if it is shown; answers in the frame the user decides.
    std::optional<Answer> draw();

    bool shown() const { return shown_; }
    const std::string& folder() const { return folder_; }

    /// Asked for a file that becomes selected; gives its preview when it is known, "" while it is being read.
    std::function<std::string(const std::string& path)> preview;
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
    void answerWith(std::optional<Answer>& answer);

    bool shown_ = false, opening_ = false, confirm_ = false;
    FileMode mode_ = FileMode::Open;
    std::string title_, purpose_, folder_, name_, suffix_, filter_, problem_;
    std::vector<Entry> entries_;
    std::vector<std::string> chosen_;
};

/// "12.3 MB".
std::string textOfBytes(double bytes);

} // namespace tessera::app
