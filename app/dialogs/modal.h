#pragma once

#include <initializer_list>

/// The frame of a dialog: title, place, Esc and buttons.
namespace tessera::app {

/// Begins a centred modal dialog; `open` becomes false with Esc or the cross. Where it returns true, endDialog()
/// follows.
bool beginDialog(const char* title, bool& open, float width);
void endDialog(bool open);

/// Buttons at the right end of a dialog; returns the index of the one pressed, -1 for none. Enter presses the last.
int dialogButtons(std::initializer_list<const char*> names);

} // namespace tessera::app
