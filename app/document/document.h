#pragma once

#include "app/data/open.h"
#include "app/views/timeline/playback.h"

#include <string>
#include <vector>

namespace tessera::app {

/// Data that replace `from` in the document.
struct RemadeData {
    std::shared_ptr<const volume::BrickSource> from; ///< of pictures
    Sources sources;
    DataRef data;
    std::vector<std::string> messages;
};

/// What is open: a session with its history, the data it shows, and how it was last saved. Knows nothing of windows.
class Document {
public:
    Document();

    const Session& session() const { return session_; }
    Session& session() { return session_; }
    const History& history() const { return history_; }
    /// Null pointers until something is installed.
    const Sources& sources() const { return sources_; }
    bool loaded() const { return sources_.pictures != nullptr; }
    /// Description of the data shown. Requires installed data.
    const volume::DatasetInfo& info() const { return sources_.pictures->info(); }
    /// Where Save writes; "" = not known.
    const std::string& path() const { return path_; }
    /// The session with its history, as it is written.
    SessionDocument snapshot() const;
    /// "fuel cell * - Tessera"; the star: there is something to save.
    std::string windowTitle() const;
    /// True if there are unsaved changes, other than camera, time, arrangement of panes and playing.
    bool dirty() const;
    bool asSaved() const { return session_ == saved_; }
    /// A counter that increases with every change of the session, for autosave.
    std::size_t edits() const { return edits_; }

    /// Installs the result of open(), as an unmodified document.
    void install(Opened opened);
    /// Replaces the sources of the data.
    void setSources(Sources sources) { sources_ = std::move(sources); }
    /// Installs remade data under the current session, keeping later edits and the history. Returns false and changes
    /// nothing if other data are shown by now. Adds messages about what does not fit to made.messages.
    bool moveTo(RemadeData& made);
    /// Writes the session file. Throws Error.
    void save(const std::string& path);
    /// Marks the document as never saved.
    void setUnsaved();

    /// Records edits; returns true if one was finished and became a step. `editing`: an edit is in progress.
    bool observe(bool editing, double seconds);
    /// Takes back the edit in progress: the session is what it was, and no step is made.
    void giveUpEdit() { session_ = history_.before(); }
    void undo() { replace(history_.undo()); }
    void redo() { replace(history_.redo()); }
    /// Goes to the state after this number of steps of the history.
    void goToStep(std::size_t position) { replace(history_.seek(position)); }
    /// Another session on the same data.
    void replace(Session session);
    /// Replaces the session as a step of this name.
    void replace(Session session, const std::string& name);
    /// Moves by this number of stored times, and stops playing.
    void stepTime(int count);
    /// Advances playing by this number of seconds; `behind`: views do not show its time yet.
    void play(double seconds, bool behind = false);

private:
    Session session_, saved_; ///< current, and as last saved or opened
    History history_;
    std::vector<JsonIssue> unknown_;
    std::string path_;
    Sources sources_;
    Playback playback_;
    std::size_t edits_ = 0;
};

} // namespace tessera::app
