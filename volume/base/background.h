#pragma once

/// Threads that nobody waits for at once let the others go first where processors are scarce.
namespace tessera {

/// Puts the calling thread behind others.
void workInBackground();
/// Puts the threads that parallelFor() starts behind those that call it, from now on.
void helpInBackground();

} // namespace tessera
