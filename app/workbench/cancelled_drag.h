#pragma once

namespace tessera::app {

/// Esc gives up what is being dragged with the mouse, or changed by keys, and does nothing else then: it closes no menu
/// and clears no brush. The mouse counts as let go until its buttons are.
class CancelledDrag {
public:
    /// Call first in a frame. True in the one in which something is given up: the session is to be what it was before,
    /// also after views have seen the key.
    bool begin();
    /// Call last in a frame.
    void end();

private:
    bool active_ = false; ///< a widget other than a text was in use in the last frame
    bool letGo_ = false;  ///< buttons are held that no longer count
};

} // namespace tessera::app
