#pragma once

namespace tessera::volume {

/// Gives pages of the heap that hold nothing back to the system, on all threads' behalf; takes some 10 ms a GB. What
/// threads allocate and free for a moment, such as the compilers of drivers, is else kept by the C library for ever.
/// Does nothing where the C library cannot.
void giveBackFreeMemory();

/// Bytes that the system can give to programs without swapping; infinity where it does not say.
double availableMemory();

} // namespace tessera::volume
