#pragma once

#include "codec/remote/address.h"
#include "volume/base/error.h"
#include "volume/system/file_bytes.h"

#include <memory>
#include <stop_token>
#include <string>
#include <vector>

namespace tessera::codec {

/// A failure that may be over when the request is tried again: a lost connection, a server that is busy.
class PassingError : public Error {
public:
    using Error::Error;
};

/// What a server answered.
struct Reply {
    std::vector<std::byte> bytes; ///< of the range, as far as the file has them
    std::uint64_t fileBytes = 0;  ///< size of the whole file
    std::string state;            ///< changes when the file does: ETag or time of the last change; "": unknown
};

/// A connection to the machine that has a file. Used by one thread at a time.
class Connection {
public:
    virtual ~Connection() = default;
    /// Throws PassingError or Error; Cancelled when a stop is requested meanwhile.
    virtual Reply read(FileRange range, const std::stop_token& stop) = 0;
    /// The next read is of the file that has the name by then, as long as it is by then.
    virtual void lookAgain() {}
};

/// By libcurl: http and https. Passwords come from an entry for the host in ~/.netrc, and go to no other host; proxies
/// come from the environment, as with curl.
std::unique_ptr<Connection> connectWeb(const Address& address);
/// By the program ssh, with all that the user has set up for it (~/.ssh/config, agent, known hosts, jump hosts). It
/// never asks for anything.
std::unique_ptr<Connection> connectSsh(const Address& address);

} // namespace tessera::codec
