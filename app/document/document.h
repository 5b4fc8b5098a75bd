#pragma once

#include "app/data/open.h"
#include "app/views/timeline/playback.h"

#include <string>
#include <vector>

namespace tessera::app {

/// Data made to be shown in place of `from`: the same otherwise.
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
    /// Of the data shown, which there must be.
    const volume::DatasetInfo& info() const { return sources_.pictures->info(); }
    /// Where Save writes; "" = not known.
    const std::string& path() const { return path_; }
    /// The session with its history, as it is written.
    SessionDocument snapshot() const;
    /// "fuel cell * - Tessera"; the star: there is something to save.
    std::string windowTitle() const;
    /// True where saving would lose what one may want to keep: more than looking around and playing.
    bool dirty() const;
    bool asSaved() const { return session_ == saved_; }
    /// Counts what has changed the session: a number that is another one has something new to keep.
    std::size_t edits() const { return edits_; }

    /// Takes over what open() returned, as saved.
    void install(Opened opened);
    /// Shows the data from these from now on.
    void setSources(Sources sources) { sources_ = std::move(sources); }
    /// Puts the session as it is now on data remade: what was edited meanwhile stays, and can be undone. False, and
    /// nothing changes, where other data are shown by now. Adds to made.messages what does not fit.
    bool moveTo(RemadeData& made);
    /// Writes the session file. Throws Error.
    void save(const std::string& path);
    /// Counts as never saved.
    void setUnsaved();

    /// Notices edits; true where one is finished, which makes a step. `editing`: one goes on.
    bool observe(bool editing, double seconds);
    void undo() { replace(history_.undo()); }
    void redo() { replace(history_.redo()); }
    /// As after so many steps of the history.
    void goToStep(std::size_t position) { replace(history_.seek(position)); }
    /// Another session on the same data.
    void replace(Session session);
    /// The same as a step of this name.
    void replace(Session session, const std::string& name);
    /// Goes on by so many stored times; does not play any more.
    void stepTime(int count);
    /// Plays on by so many seconds.
    void play(double seconds);

private:
    Session session_, saved_; ///< as it is, and as last saved or opened
    History history_;
    std::vector<JsonIssue> unknown_;
    std::string path_;
    Sources sources_;
    Playback playback_;
    std::size_t edits_ = 0;
};

} // namespace tessera::app
