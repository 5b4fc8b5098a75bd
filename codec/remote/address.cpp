#include "codec/remote/address.h"

#include "volume/base/error.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <optional>
#include <string_view>
#include <utility>

namespace tessera::codec {

namespace {

using Scheme = Address::Scheme;
constexpr std::array<std::pair<std::string_view, Scheme>, 3> kSchemes{
    {{"http://", Scheme::Http}, {"https://", Scheme::Https}, {"sftp://", Scheme::Sftp}}};

bool startsWith(const std::string& text, std::string_view lower) {
    return text.size() >= lower.size() && std::equal(lower.begin(), lower.end(), text.begin(), [](char a, char b) {
               return a == std::tolower(static_cast<unsigned char>(b));
           });
}

/// %41 becomes A; what is no such code stays.
std::string decoded(const std::string& text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        unsigned code = 0;
        if (text[i] == '%' && i + 2 < text.size() &&
            std::from_chars(text.data() + i + 1, text.data() + i + 3, code, 16).ptr == text.data() + i + 3) {
            out += static_cast<char>(code);
            i += 2;
        } else {
            out += text[i];
        }
    }
    return out;
}

} // namespace

bool isRemote(const std::string& path) {
    return std::ranges::any_of(kSchemes, [&](const auto& scheme) { return startsWith(path, scheme.first); });
}

bool namesArchive(const std::string& path) {
    constexpr std::string_view kEnding = ".tsr";
    return isRemote(path) ||
           (path.size() >= kEnding.size() && startsWith(path.substr(path.size() - kEnding.size()), kEnding));
}

Address parseAddress(const std::string& text) {
    const auto scheme =
        std::ranges::find_if(kSchemes, [&](const auto& known) { return startsWith(text, known.first); });
    if (scheme == kSchemes.end()) throw Error("not an address: http://, https:// or sftp://", text);
    Address address{scheme->second, text, {}, {}, {}, {}};
    const std::string rest = text.substr(scheme->first.size());
    const std::size_t slash = rest.find('/');
    if (slash == std::string::npos || slash + 1 == rest.size()) throw Error("the address names no file", text);
    address.path = decoded(rest.substr(slash));
    std::string host = rest.substr(0, slash);
    if (const std::size_t at = host.rfind('@'); at != std::string::npos) {
        address.user = decoded(host.substr(0, at));
        host.erase(0, at + 1);
        if (address.user.find(':') != std::string::npos)
            throw Error("an address with a password is not opened, since it would be stored in sessions: put the "
                        "password into ~/.netrc, or use ssh keys",
                        scheme->first.data() + host + address.path);
    }
    const std::size_t colon = host.rfind(':');
    if (colon != std::string::npos && host.find(']', colon) == std::string::npos) {
        address.port = host.substr(colon + 1);
        host.resize(colon);
        const auto isDigit = [](char c) { return c >= '0' && c <= '9'; };
        if (address.port.empty() || address.port.size() > 5 || !std::ranges::all_of(address.port, isDigit))
            throw Error("the port of the address is no number", text);
    }
    if (host.size() > 2 && host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
    // ssh would take a host or a user that begins with a minus sign for an option.
    if (host.empty() || host.front() == '-' || (!address.user.empty() && address.user.front() == '-'))
        throw Error("the address has no valid host", text);
    address.host = host;
    return address;
}

} // namespace tessera::codec
