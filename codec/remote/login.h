#pragma once

#include <optional>
#include <string>
#include <string_view>

/// Passwords for web servers, as the user keeps them in ~/.netrc.
namespace tessera::codec {

struct Login {
    std::string user, password;
};

/// The first entry of a netrc for exactly this host, in any case, and for this user unless that is "". The entry
/// "default" is for every host and so for none here: a file could name any host, which would be told the password.
std::optional<Login> loginFor(std::string_view netrc, const std::string& host, const std::string& user);

/// The same from ~/.netrc; nothing where that cannot be read.
std::optional<Login> storedLogin(const std::string& host, const std::string& user);

} // namespace tessera::codec
