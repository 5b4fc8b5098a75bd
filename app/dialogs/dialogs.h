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

/// Asks where files are that a session shows and that are not where they were.
class MissingFilesDialog {
public:
    /// What open() returned without a source; replaces what was asked for before.
    void show(Opened opened) { opened_ = std::move(opened); }
    bool shown() const { return opened_.has_value(); }
    /// Asks for the file at `index` of the missing ones: title of the question, folder to look in first.
    using Ask = std::function<void(std::size_t index, const std::string& title, const std::string& folder)>;
    /// Returns the session once all files are found.
    std::optional<Opened> draw(const Ask& ask);
    /// States where a missing file is.
    void found(std::size_t index, const std::string& path);

private:
    void drawFile(std::size_t index, const Ask& ask);

    std::optional<Opened> opened_;
};

/// Offers sessions that were open when the program did not end by itself.
class RecoveryDialog {
public:
    void show(std::vector<Recovery> recoveries) { recoveries_ = std::move(recoveries); }
    /// Returns the one to recover.
    std::optional<Recovery> draw();

private:
    std::vector<Recovery> recoveries_; ///< newest first
};

/// Asks what is to be saved as a picture, and how large.
class PictureDialog {
public:
    /// `pane`: proposed, "" = the whole window.
    void show(const std::string& pane);
    /// Returns the picture wanted.
    std::optional<PictureRequest> draw(const Session& session);

private:
    PictureRequest picture_;
    bool shown_ = false;
};

/// Asks whether to save what has changed before it is given up.
class LeaveDialog {
public:
    enum class Answer { None, Discard, Save };
    /// `go` gives it up.
    void show(std::function<void()> go) { go_ = std::move(go); }
    /// `saved`: it has a file. Discard and Save end the question; take() what was to be done then.
    Answer draw(bool saved);
    std::function<void()> take() { return std::exchange(go_, nullptr); }

private:
    std::function<void()> go_;
};

/// The lists of keys, and what the program is.
class HelpDialogs {
public:
    void showShortcuts() { shortcuts_ = true; }
    void showAbout() { about_ = true; }
    void draw(const std::vector<Command>& commands, const Fonts& fonts, const vis::ResidencyInfo& use);

private:
    bool shortcuts_ = false, about_ = false;
};

} // namespace tessera::app
