#pragma once

namespace tessera::importer {

/// The whole of tessera-import, given the arguments of its main(): reads files of other programs with VTK and streams
/// them (volume/import/files/stream.h). Confines the process that it runs in, for good. Returns the exit status.
int serve(int argc, char** argv);

} // namespace tessera::importer
