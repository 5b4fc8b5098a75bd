#pragma once

/// What VTK's readers report: they write messages and go on.
namespace tessera::importer {

/// Catches VTK's messages from now on: errors are kept for throwReported, all go to stderr.
void catchMessages();

/// Throws what VTK's readers reported since the last call, if anything.
void throwReported();

} // namespace tessera::importer
