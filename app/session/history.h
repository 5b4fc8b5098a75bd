#pragma once

#include "app/session/session_json.h"

#include <chrono>
#include <string>
#include <vector>

/// What happened to a session: each finished edit as an RFC 6902 patch with its inverse. Undo, redo, replay, autosave
/// and the history pane all read this one list.
namespace tessera::app {

struct HistoryStep {
    std::string name; ///< "Layers 1: density", made from the first path that changed
    Json forward, inverse;
};

class History {
public:
    /// Starts over with this session as the base.
    void reset(const Session& session);

    /// Call once per frame with the session as it is now. While `editing` (mouse held, text being typed) changes are
    /// only watched; when it ends they become one step. Edits of the same member within `mergeSeconds` become one
    /// (turning the wheel). What plays by itself (time during an animation) is no edit, nor which tabs are in front.
    /// Returns true when a step was
    /// added.
    bool observe(const Session& session, bool editing, double seconds, double mergeSeconds = 0.6);

    /// The step that the next change becomes is called so, and joins none before it; one without changes takes
    /// the name away.
    void nameNext(std::string name) { nextName_ = std::move(name); }

    bool canUndo() const { return position_ > 0; }
    bool canRedo() const { return position_ < steps_.size(); }
    /// The session one step back or forth, which becomes the base. Never throws: steps were checked when loaded.
    Session undo();
    Session redo();
    /// The session after the first `position` steps.
    Session seek(std::size_t position);

    /// The same history of a session whose data were found elsewhere: no step.
    void setData(const DataRef& data) { base_.data = data; }
    const DataRef& data() const { return base_.data; }

    const std::vector<HistoryStep>& steps() const { return steps_; }
    std::size_t position() const { return position_; }
    /// True while the watched session differs from the base: an edit is going on.
    bool pending() const { return pending_; }

    /// The list as JSON, and back. A list that does not fit the session is refused with Error.
    Json toJson() const;
    static History fromJson(const Json& json, const Session& session);

    bool operator==(const History& other) const;

private:
    void trim();

    Session base_;  ///< after steps_[0, position_)
    Json document_; ///< base_ as JSON
    std::vector<HistoryStep> steps_;
    std::size_t position_ = 0;
    double lastCommit_ = -1e9;
    std::string nextName_; ///< "" = made from what changed
    bool pending_ = false;
};

/// A readable name for a patch: "Layers 1: density".
std::string describePatch(const Json& patch);

} // namespace tessera::app
