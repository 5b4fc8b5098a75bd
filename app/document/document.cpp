#include "app/document/document.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <utility>

namespace tessera::app {

namespace fs = std::filesystem;

Document::Document() {
    history_.reset(session_);
    saved_ = session_;
}

SessionDocument Document::snapshot() const {
    SessionDocument document;
    document.session = session_;
    document.history = history_;
    // An edit in progress (a drag, a text being typed) is a step of what is written: a history ends at its session.
    document.history.observe(session_, false, std::numeric_limits<double>::infinity());
    document.unknown = unknown_;
    return document;
}

std::string Document::windowTitle() const {
    std::string title = path_.empty() ? session_.title : fs::path(path_).filename().string();
    if (!title.empty()) title += dirty() ? " * - " : " - ";
    return title + "Tessera";
}

bool Document::dirty() const {
    Session now = session_;
    now.animation.playing = saved_.animation.playing;
    now.dock = saved_.dock; // rearranging panes is not worth a question
    followFront(now, saved_);
    now.camera = saved_.camera;
    now.time = saved_.time;
    return !(now == saved_);
}

void Document::install(Opened opened) {
    const Appearance appearance = session_.appearance;
    const bool first = !loaded();
    sources_ = opened.sources();
    session_ = std::move(opened.document.session);
    // A data file does not state the window's appearance, so keep the current one; a session does.
    if (!first && opened.document.raw.is_null()) session_.appearance = appearance;
    history_ = std::move(opened.document.history);
    unknown_ = std::move(opened.document.unknown);
    if (history_.steps().empty()) history_.reset(session_);
    path_ = opened.sessionPath;
    saved_ = session_;
    playback_ = {};
}

bool Document::moveTo(RemadeData& made) {
    if (sources_.pictures != made.from) return false;
    DataRef data = made.data;
    const DataRef& now = session_.data;
    data.derived = now.derived; // changed meanwhile: computed next
    data.lattice = now.lattice;
    data.axis = now.axis;
    data.grids = now.grids;
    data.other = now.other;
    data.import.overTime = now.import.overTime;
    data.import.lengthUnit = now.import.lengthUnit;
    if (data.files == now.files) data.import.labels = now.import.labels;
    const DataRef recorded = history_.data();
    const bool noEdit = session_ == history_.before();
    app::moveTo(session_, history_, &info(), made.sources.pictures->info(), data, made.messages);
    data.lattice = recorded.lattice;
    data.axis = recorded.axis;
    data.grids = recorded.grids;
    data.other = recorded.other;
    data.import.overTime = recorded.import.overTime;
    data.import.lengthUnit = recorded.import.lengthUnit;
    if (data.files == recorded.files) data.import.labels = recorded.import.labels;
    data.derived = recorded.derived; // an edit in progress has yet to become a step
    history_.setData(data);
    if (noEdit) history_.extendDataStep(session_);
    sources_ = made.sources;
    playback_ = {};
    ++edits_;
    return true;
}

void Document::save(const std::string& path) {
    SessionDocument written = snapshot();
    saveSession(written, path);
    path_ = fs::absolute(path).lexically_normal().string();
    saved_ = session_;
}

void Document::setUnsaved() {
    saved_ = Session{};
    ++edits_;
}

bool Document::observe(bool editing, double seconds) {
    if (!loaded() || !history_.observe(session_, editing, seconds)) return false;
    ++edits_;
    return true;
}

void Document::replace(Session session) {
    session.animation.playing = false;
    session_ = std::move(session);
    repair(session_.dock, paneKeys(session_));
    ++edits_;
}

void Document::replace(Session session, const std::string& name) {
    replace(std::move(session));
    history_.nameNext(name);
}

void Document::stepTime(int count) {
    if (!loaded()) return;
    const std::vector<double>& times = info().times;
    const int last = static_cast<int>(times.size()) - 1;
    const int at = std::clamp(info().nearestTime(session_.time) + count, 0, last);
    session_.animation.playing = false;
    session_.time = times[static_cast<std::size_t>(at)];
}

void Document::play(double seconds, bool behind) {
    playOn(playback_, session_, info().times, seconds, behind);
}

} // namespace tessera::app
