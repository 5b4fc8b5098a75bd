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

/// Letters, digits, and those of `others`: nothing that ssh, a shell, a terminal or another reader of addresses could
/// take for something else.
bool isPlain(std::string_view text, std::string_view others) {
    return std::ranges::all_of(text, [&](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               others.find(c) != std::string_view::npos;
    });
}

/// A host without the brackets around one of IPv6; nothing for what is none.
std::optional<std::string> hostIn(const std::string& text) {
    const bool brackets = text.size() > 2 && text.front() == '[' && text.back() == ']';
    const std::string host = brackets ? text.substr(1, text.size() - 2) : text;
    // ssh would take one that begins with a minus sign for an option.
    if (host.empty() || host.front() == '-' || !isPlain(host, brackets ? ".:" : "._-")) return std::nullopt;
    return host;
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
        if (address.user.empty() || address.user.front() == '-' || !isPlain(address.user, "._-"))
            throw Error("the user of the address may have letters, digits and . _ - only", text);
    }
    const std::size_t colon = host.rfind(':');
    if (colon != std::string::npos && host.find(']', colon) == std::string::npos) {
        address.port = host.substr(colon + 1);
        host.resize(colon);
        const auto isDigit = [](char c) { return c >= '0' && c <= '9'; };
        if (address.port.empty() || address.port.size() > 5 || !std::ranges::all_of(address.port, isDigit) ||
            std::stoi(address.port) > 65535)
            throw Error("the port of the address is no number up to 65535", text);
    }
    const std::optional<std::string> name = hostIn(host);
    if (!name)
        throw Error("the address has no valid host: letters, digits and . _ - only, or an address of IPv6 in []", text);
    address.host = *name;
    return address;
}

} // namespace tessera::codec
