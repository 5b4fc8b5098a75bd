#pragma once

/// Lower priority for threads whose results nobody waits for.
namespace tessera {

/// Lowers the priority of the calling thread.
void workInBackground();
/// Lowers the priority of the threads that parallelFor() starts from now on, below that of its callers.
void helpInBackground();

} // namespace tessera
