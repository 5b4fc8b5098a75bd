#pragma once

#include <string>

namespace tessera::codec {

/// An address of a file on another machine, in parts. SCHEME://[USER@]HOST[:PORT]/PATH
struct Address {
    enum class Scheme { Http, Https, Sftp };
    Scheme scheme = Scheme::Https;
    std::string text; ///< the whole
    std::string user; ///< "": not stated
    std::string host;
    std::string port; ///< digits; "": the usual one
    std::string path; ///< from the first slash, with percent signs decoded; "/~/" means the home folder for sftp
};

/// True for http://, https:// and sftp://, in any case.
bool isRemote(const std::string& path);
/// Whether a path or an address names an archive: *.tsr, or on another machine, since only archives are read from
/// there.
bool namesArchive(const std::string& path);
/// Throws Error when the address has no host or no path, an invalid port, characters in the host or the user that no
/// such name needs, or a password: that belongs into ~/.netrc or an agent of ssh, not into sessions and lists of recent
/// files.
Address parseAddress(const std::string& text);

} // namespace tessera::codec
