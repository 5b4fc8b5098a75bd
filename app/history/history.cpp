#include "app/history/history.h"

#include "app/history/animated_session.h"
#include "app/history/edit_titles.h"
#include "volume/base/error.h"

#include <algorithm>
#include <utility>

namespace tessera::app {

namespace {

constexpr std::size_t kMaximumSteps = 500;

std::vector<std::string> pathsOf(const Json& patch) {
    std::vector<std::string> paths;
    for (const Json& operation : patch) paths.push_back(operation.value("path", std::string()));
    std::sort(paths.begin(), paths.end());
    return paths;
}

/// Whether values were only changed. What comes or goes is a step of its own, so that both together cannot be none.
bool onlyReplaces(const Json& patch) {
    return std::ranges::all_of(patch, [](const Json& operation) { return operation.at("op") == "replace"; });
}

/// Steps hold what Json::diff makes. Other operations (a copy, say, which doubles a document each time) are refused.
bool isDifference(const Json& patch) {
    return patch.is_array() && std::ranges::all_of(patch, [](const Json& operation) {
               const std::string kind = operation.at("op").get<std::string>();
               return kind == "add" || kind == "remove" || kind == "replace";
           });
}

/// Takes over changes that are not edits: those made by an animation, and what is in front.
void followUnrecorded(Session& base, const Session& now) {
    followFront(base, now);
    if (now.animation.playing || base.animation.playing) {
        base.time = now.time;
        for (const Track& track : base.animation.tracks) setNumbersAt(base, track.path, numbersAt(now, track.path));
    }
    // Moving the position in the keyframes is not an edit either.
    if (now.animation.position != base.animation.position) {
        base.animation.position = now.animation.position;
        applyTracks(base, base.animation.position);
    }
    base.animation.playing = now.animation.playing;
}

/// Where a session, as JSON, differs from what its steps lead to, but for changes that are not edits, and for where
/// other data lie, which a saved session says from its own place. Empty: nowhere.
std::string differenceOf(Session end, const Session& session) {
    followFront(end, session);
    Json ended = app::toJson(end);
    const Json now = app::toJson(session);
    std::vector<std::string> unrecorded{"/time", "/animation/position", "/animation/playing", "/data/other"};
    for (const Track& track : session.animation.tracks)
        if (!numbersAt(session, track.path).empty()) unrecorded.push_back(track.path);
    for (const std::string& path : unrecorded) {
        const Json::json_pointer at(path);
        if (ended.contains(at) && now.contains(at)) ended[at] = now[at];
    }
    const Json differs = Json::diff(ended, now);
    return differs.empty() ? std::string() : differs[0].at("path").get<std::string>();
}

} // namespace

void followFront(Session& base, const Session& now) {
    followFocus(base.dock, now.dock);
    for (auto& [pane, view] : base.views) {
        auto* const layers = std::get_if<LayersView>(&view);
        const auto other = now.views.find(pane);
        const auto* const shown = other == now.views.end() ? nullptr : std::get_if<LayersView>(&other->second);
        if (layers && shown) *layers = {layers->selected, shown->task, shown->next};
    }
}

void History::reset(const Session& session) {
    base_ = session;
    document_ = app::toJson(session);
    steps_.clear();
    position_ = 0;
    lastCommit_ = -1e9;
    pending_ = false;
    nextName_.clear();
}

bool History::observe(const Session& session, bool editing, double seconds, double mergeSeconds) {
    followUnrecorded(base_, session);
    pending_ = !(session == base_);
    if (!pending_ && !editing) nextName_.clear(); // the named edit was empty
    if (!pending_ || editing) return false;
    pending_ = false;
    const std::string name = std::exchange(nextName_, {});
    updateDocument();
    Json now = app::toJson(session);
    Json forward = Json::diff(document_, now);
    if (forward.empty()) { // differs only in ways that JSON does not show
        base_ = session;
        return false;
    }
    Json before = document_;
    const bool merges = name.empty() && position_ > 0 && position_ == steps_.size() &&
                        seconds - lastCommit_ < mergeSeconds && onlyReplaces(forward) &&
                        pathsOf(steps_.back().forward) == pathsOf(forward);
    if (merges) {
        before = document_.patch(steps_.back().inverse);
        steps_.pop_back();
        --position_;
        forward = Json::diff(before, now);
    }
    steps_.erase(steps_.begin() + static_cast<std::ptrdiff_t>(position_), steps_.end()); // what was undone
    if (!forward.empty()) {
        steps_.push_back({name.empty() ? editTitle(forward, base_, session) : name, forward, Json::diff(now, before)});
        ++position_;
    }
    document_ = std::move(now);
    base_ = session;
    lastCommit_ = name.empty() ? seconds : -1e9; // never merge with a named step
    trim();
    return true;
}

void History::updateDocument() {
    if (base_.animation.tracks.empty()) {
        document_["time"] = app::toJson(base_.time);
        document_["animation"] = app::toJson(base_.animation);
        document_["data"] = app::toJson(base_.data);
        document_["dock"] = app::toJson(base_.dock);
        document_["views"] = app::toJson(base_.views);
    } else {
        document_ = app::toJson(base_); // any setting may have changed
    }
}

void History::extendDataStep(const Session& session) {
    const auto isOfData = [](const std::string& path) { return path.starts_with("/data/"); };
    if (position_ == 0 || position_ < steps_.size()) return;
    HistoryStep& step = steps_.back();
    if (std::ranges::none_of(pathsOf(step.forward), isOfData)) return;
    followUnrecorded(base_, session);
    updateDocument();
    const Json before = document_.patch(step.inverse);
    document_ = app::toJson(session);
    base_ = session;
    step.forward = Json::diff(before, document_);
    step.inverse = Json::diff(document_, before);
}

void History::trim() {
    if (steps_.size() <= kMaximumSteps) return;
    const std::size_t surplus = std::min(steps_.size() - kMaximumSteps, position_);
    steps_.erase(steps_.begin(), steps_.begin() + static_cast<std::ptrdiff_t>(surplus));
    position_ -= surplus;
}

Session History::undo() {
    return seek(position_ > 0 ? position_ - 1 : 0);
}

Session History::redo() {
    return seek(std::min(position_ + 1, steps_.size()));
}

Session History::seek(std::size_t position) {
    position = std::min(position, steps_.size());
    document_ = app::toJson(base_);
    while (position_ > position) document_ = document_.patch(steps_[--position_].inverse);
    while (position_ < position) document_ = document_.patch(steps_[position_++].forward);
    Session sought = sessionFromJson(document_, {});
    takeAllowed(sought.data, base_.data);
    base_ = std::move(sought);
    pending_ = false;
    lastCommit_ = -1e9;
    nextName_.clear();
    return base_;
}

Json History::toJson() const {
    Json steps = Json::array();
    for (const HistoryStep& step : steps_)
        steps.push_back({{"name", step.name}, {"forward", step.forward}, {"inverse", step.inverse}});
    return {{"position", position_}, {"steps", std::move(steps)}};
}

History History::fromJson(const Json& json, const Session& session) {
    History history;
    history.reset(session);
    try {
        for (const Json& step : json.at("steps"))
            history.steps_.push_back({step.at("name").get<std::string>(), step.at("forward"), step.at("inverse")});
        for (const HistoryStep& step : history.steps_)
            if (!isDifference(step.forward) || !isDifference(step.inverse))
                throw Error("the history contains a step that is not a JSON patch");
        const auto position = json.at("position").get<std::int64_t>();
        if (position < 0 || static_cast<std::size_t>(position) > history.steps_.size())
            throw Error("the position in the history is outside its list of steps");
        history.position_ = static_cast<std::size_t>(position);
        // Walk the whole list once, so that undo and redo cannot fail later.
        History trial = history;
        for (std::size_t i = trial.position_; i-- > 0;) trial.seek(i);
        for (std::size_t i = 1; i <= trial.steps_.size(); ++i) trial.seek(i);
        if (const std::string where = differenceOf(trial.seek(history.position_), session); !where.empty())
            throw Error("the history does not end at the session, but with another " + where);
    } catch (const Json::exception& error) {
        throw Error(std::string("the history cannot be used: ") + error.what());
    }
    return history;
}

bool History::operator==(const History& other) const {
    return toJson() == other.toJson();
}

} // namespace tessera::app
