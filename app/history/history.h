#pragma once

#include "app/session/session_json.h"

#include <chrono>
#include <string>
#include <vector>

/// History of a session: each finished edit as an RFC 6902 patch with its inverse. Used by undo, redo, replay, autosave
/// and the history pane.
namespace tessera::app {

struct HistoryStep {
    std::string name; ///< "Layers 1: density", made from the first path that changed
    Json forward, inverse;
};

/// Takes over what is in front and no edit: tabs of panes and within them, and the volume view clicked last.
void followFront(Session& base, const Session& now);

class History {
public:
    /// Starts over with this session as the base.
    void reset(const Session& session);

    /// Call once per frame with the current session. While `editing` (mouse held, text being typed) no step is
    /// recorded; afterwards all changes become one step. Edits of the same member within `mergeSeconds` become one step
    /// (turning the wheel). Playing (time during an animation) and the choice of tabs are not edits. Returns true when
    /// a step was added.
    bool observe(const Session& session, bool editing, double seconds, double mergeSeconds = 0.6);

    /// Names the step of the next change, which is then not merged with the one before. Dropped if the edit is empty.
    void nameNext(std::string name) { nextName_ = std::move(name); }

    /// Where the last step changed the data, adds to it how the session came to fit them (a time that they have). To be
    /// called when nothing else has changed since. Nothing if steps have been undone: that becomes a step of its own.
    void extendDataStep(const Session& session);

    bool canUndo() const { return position_ > 0; }
    bool canRedo() const { return position_ < steps_.size(); }
    /// The session one step back or forth, which becomes the base. Never throws: steps were checked when loaded.
    Session undo();
    Session redo();
    /// The session after the first `position` steps.
    Session seek(std::size_t position);

    /// Replaces the data of the base, for data found at another place: not a step.
    void setData(const DataRef& data) { base_.data = data; }
    const DataRef& data() const { return base_.data; }

    const std::vector<HistoryStep>& steps() const { return steps_; }
    std::size_t position() const { return position_; }
    /// Whether an edit is in progress: the watched session differs from the base.
    bool pending() const { return pending_; }
    /// The session before that edit.
    const Session& before() const { return base_; }

    /// The list as JSON, and back. A list that does not fit the session is refused with Error.
    Json toJson() const;
    static History fromJson(const Json& json, const Session& session);

    bool operator==(const History& other) const;

private:
    void trim();
    /// Brings document_ up to date with changes of base_ that are not edits, before it is needed.
    void updateDocument();

    Session base_;  ///< after steps_[0, position_)
    Json document_; ///< base_ as JSON
    std::vector<HistoryStep> steps_;
    std::size_t position_ = 0;
    double lastCommit_ = -1e9;
    std::string nextName_; ///< "" = made from what changed
    bool pending_ = false;
};

} // namespace tessera::app
