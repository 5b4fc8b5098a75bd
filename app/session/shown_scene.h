#pragma once

#include "app/session/session.h"

#include <iterator>
#include <string>
#include <utility>
#include <vector>

/// What volume views show: each of them shares the session's camera, layers and time, or has its own.
namespace tessera::app {

/// The volume view of a pane; null if it is none.
VolumeView* volumeView(Session& session, const std::string& pane);
const VolumeView* volumeView(const Session& session, const std::string& pane);

int volumeViews(const Session& session);
/// The pane of the volume view clicked last, else of the first one; "" if there is none.
std::string volumePane(const Session& session);

/// What a volume view may have of its own.
enum class Owned { Camera, Layers, Time };
inline constexpr Owned kOwned[] = {Owned::Camera, Owned::Layers, Owned::Time};

bool owns(const VolumeView& view, Owned what);
/// Makes it the view's own, as a copy of what is shared, or shared again.
void setOwned(const Session& session, VolumeView& view, Owned what, bool own);

/// While it lives, the session's camera, layers and time (or only those named) are those of a volume view, to be read
/// and edited like the shared ones; edits of what the view owns are the view's. What it owns must not change meanwhile.
class ShownScene {
public:
    /// Null: a view that shares everything.
    ShownScene(Session& session, VolumeView* view, std::vector<Owned> parts = {std::begin(kOwned), std::end(kOwned)})
        : session_(session), view_(view), parts_(std::move(parts)) {
        swap();
    }
    ShownScene(Session& session, const std::string& pane,
               std::vector<Owned> parts = {std::begin(kOwned), std::end(kOwned)})
        : ShownScene(session, volumeView(session, pane), std::move(parts)) {}
    ~ShownScene() { swap(); }
    ShownScene(const ShownScene&) = delete;
    ShownScene& operator=(const ShownScene&) = delete;

    /// Calls with the session as it is otherwise.
    template <class Call> void outside(Call&& call) {
        swap();
        call();
        swap();
    }

private:
    void swap();

    Session& session_;
    VolumeView* view_;
    std::vector<Owned> parts_;
};

/// A session that shares what a volume view shows.
Session sessionShownIn(const Session& session, const std::string& pane);

/// Every list of layers: the shared one, those of volume views, and those of callouts.
std::vector<std::vector<vis::Layer>*> layerLists(Session& session);
std::vector<const std::vector<vis::Layer>*> layerLists(const Session& session);

/// Whether a layer is drawn wholly in the colour of a stick instead of its own.
bool isDrawing(const vis::Technique& technique);
/// Whether every visible layer is drawn in charcoal or chalk: then box and cross-hair, which no drawing has, are left
/// out unless asked for.
bool onlyDrawings(const Session& session);

} // namespace tessera::app
