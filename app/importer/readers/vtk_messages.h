#pragma once

/// Errors of VTK's readers, which print a message and continue.
namespace tessera::importer {

/// Redirects VTK's messages to stderr from now on, and keeps errors for throwReported.
void catchMessages();

/// Throws the first error that VTK's readers reported since the last call, if any.
void throwReported();

} // namespace tessera::importer
