#pragma once

#include <string>

/// The session inside a picture that Tessera exported.
namespace tessera::app {

/// True for the suffixes .png, .svg and .pdf, in any case: of files that are opened as pictures with a session.
bool namesPicture(const std::string& path);

/// Whether a file is such a picture with a session that can be read.
bool holdsSession(const std::string& path);

/// Whether a file is opened as a session: a figure (.svg, .pdf) always, a .png only with a session in it, be it
/// damaged. Others of these are data: one slice.
bool opensAsPicture(const std::string& path);

/// The session's text. Throws Error where there is none or the picture is damaged.
std::string sessionTextOfPicture(const std::string& path);

} // namespace tessera::app
