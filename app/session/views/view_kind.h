#pragma once

#include <string>
#include <string_view>

/// What a kind of view states about itself in its row of kViewKinds (view_state.h).
namespace tessera::app {

struct ViewContext; // app/pane/view_context.h: what one frame of the window gives to each view

/// Draws a view inside its pane's ImGui window; edits the view and the session. Defined in app/views.
template <class View> using DrawView = void(ViewContext& context, const std::string& pane, View& view);

/// What menus, panes and documentation know of a kind of view. Its name in sessions is its struct's kType.
struct ViewTraits {
    std::string_view title;      ///< of its panes, and of the command that opens one
    std::string_view help;       ///< one line: what it shows
    std::string_view words = {}; ///< others by which the palette finds it
    bool figure = false;         ///< can be exported as vector graphics
    bool csv = false;            ///< can be exported as a table
    bool inSpace = false;        ///< a picture in space: new views do not open as tabs over it
    bool camera = false;         ///< uses the session's camera, so that camera commands act on it
    bool padded = true;          ///< has a margin inside its pane
    bool plays = false;          ///< moves the session's time itself while the session plays
    /// What its pane keeps beside others where the window has room, its tab included, in design pixels.
    float leastWidth = 160, leastHeight = 120;
};

/// A kind of view opened with other settings than the default, by a command of its own.
template <class View> struct ViewPreset {
    std::string_view title = {}, help = {}, words = {}; ///< of the command; "" = there is none
    void (*prepare)(View& view) = nullptr;
};

/// One row of kViewKinds.
template <class StateType, DrawView<StateType>& drawFunction> struct ViewKind {
    using State = StateType;
    static constexpr DrawView<StateType>& draw = drawFunction;
    ViewTraits traits;
    ViewPreset<State> preset = {};
};

} // namespace tessera::app
