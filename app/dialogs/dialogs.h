#pragma once

#include "app/data/open.h"
#include "app/dialogs/picture_request.h"
#include "app/ui/commands.h"
#include "app/ui/theme.h"
#include "app/user_files/state_dir.h"
#include "vis/passes/renderer.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

/// Dialogs of the window besides that for files. Each is drawn every frame, shows itself when its state says so, is
/// closed by Esc, and returns what the user has decided in the frame that happens.
namespace tessera::app {

/// Asks for the new paths of missing files of a session.
class MissingFilesDialog {
public:
    /// Shows the missing files in the result of open(), replacing former ones.
    void show(Opened opened) { opened_ = std::move(opened); }
    bool shown() const { return opened_.has_value(); }
    /// Asks for the file at `index` of the missing ones: title of the question, folder to look in first.
    using Ask = std::function<void(std::size_t index, const std::string& title, const std::string& folder)>;
    /// Returns the session once all files are found.
    std::optional<Opened> draw(const Ask& ask);
    /// Sets the new path of a missing file.
    void found(std::size_t index, const std::string& path);
    /// Takes files for the missing ones that are called the same; one file also for the only one that is missing,
    /// whatever it is called. False where none is taken.
    bool found(const std::vector<std::string>& paths);

private:
    void drawFile(std::size_t index, const Ask& ask);

    std::optional<Opened> opened_;
};

/// Offers to recover sessions of crashed runs.
class RecoveryDialog {
public:
    void show(std::vector<Recovery> recoveries) { recoveries_ = std::move(recoveries); }
    /// Returns the one to recover.
    std::optional<Recovery> draw();

private:
    std::vector<Recovery> recoveries_; ///< newest first
};

/// All panes, those that show data first.
std::vector<std::string> panesForPictures(const Session& session);

/// Asks what is to be saved as a picture, and in what form; the form chosen last is remembered.
class PictureDialog {
public:
    /// `pane`: proposed, "" = the whole window.
    void show(const std::string& pane);
    /// Returns the picture wanted. `stateFolder` keeps the form; what figures of the session are like at any time, such
    /// as the form of legends, is set in the session.
    std::optional<PictureRequest> draw(Session& session, const volume::DatasetInfo& info,
                                       const std::string& stateFolder);

private:
    void drawWhat(const Session& session, const volume::DatasetInfo& info);
    void drawPanels(const Session& session, const volume::DatasetInfo& info);
    std::optional<PictureRequest> drawForm(Session& session);
    /// What is chosen. Throws Error where it cannot be drawn.
    PictureRequest request() const;

    std::string pane_;
    bool several_ = false;            ///< panels in place of one pane
    std::vector<std::string> panels_; ///< in the order in which they were chosen
    int columns_ = 0;                 ///< of panels; 0: usualColumns
    std::optional<PictureForm> form_; ///< nothing until it is first shown
    bool shown_ = false;
};

/// Asks whether to save changes before they are lost.
class LeaveDialog {
public:
    enum class Answer { None, Discard, Save };
    /// `go` is the action that discards the session.
    void show(std::function<void()> go) { go_ = std::move(go); }
    /// `saved`: the session has a file. After Discard and Save, take() returns the pending action.
    Answer draw(bool saved);
    std::function<void()> take() { return std::exchange(go_, nullptr); }

private:
    std::function<void()> go_;
};

/// Asks before something is done that may not have been meant.
class QuestionDialog {
public:
    /// `yes`: the word on the button that does it.
    void show(std::string text, std::string yes, std::function<void()> go) {
        text_ = std::move(text);
        yes_ = std::move(yes);
        go_ = std::move(go);
    }
    /// Returns what is to be done, when the user has agreed.
    std::function<void()> draw();

private:
    std::string text_, yes_;
    std::function<void()> go_;
};

/// The lists of keys, and the About dialog.
class HelpDialogs {
public:
    void showShortcuts() {
        shortcuts_ = true;
        search_.clear();
    }
    void showAbout() { about_ = true; }
    void draw(const std::vector<Command>& commands, const Fonts& fonts, const vis::ResidencyInfo& use);

private:
    bool shortcuts_ = false, about_ = false;
    std::string search_; ///< in the list of keys
};

} // namespace tessera::app
