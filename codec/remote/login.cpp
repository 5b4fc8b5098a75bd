#include "codec/remote/login.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <fstream>

namespace tessera::codec {

namespace {

constexpr std::size_t kLongestNetrc = 1 << 20; // bytes

bool isSpace(char c) {
    return std::isspace(static_cast<unsigned char>(c)) != 0;
}

/// The words of a netrc: between blanks or in quotes, where \ goes before a character that stands for itself.
class NetrcWords {
public:
    explicit NetrcWords(std::string_view text) : text_(text) {}

    /// Nothing at the end. Lines that begin with # are remarks.
    std::optional<std::string> next() {
        for (;;) {
            while (at_ < text_.size() && isSpace(text_[at_])) ++at_;
            if (at_ == text_.size()) return std::nullopt;
            if (text_[at_] != '#' || !beginsLine()) break;
            at_ = std::min(text_.find('\n', at_), text_.size());
        }
        std::string word;
        const bool quoted = text_[at_] == '"';
        if (quoted) ++at_;
        for (; at_ < text_.size() && (quoted ? text_[at_] != '"' : !isSpace(text_[at_])); ++at_) {
            if (quoted && text_[at_] == '\\' && at_ + 1 < text_.size()) ++at_;
            word += text_[at_];
        }
        if (quoted && at_ < text_.size()) ++at_;
        return word;
    }
    /// Goes beyond a macro, which ends with an empty line.
    void skipMacro() {
        const std::size_t end = text_.find("\n\n", at_);
        at_ = end == std::string_view::npos ? text_.size() : end;
    }

private:
    bool beginsLine() const {
        std::size_t before = at_;
        while (before > 0 && (text_[before - 1] == ' ' || text_[before - 1] == '\t')) --before;
        return before == 0 || text_[before - 1] == '\n';
    }

    std::string_view text_;
    std::size_t at_ = 0;
};

bool sameName(std::string_view a, std::string_view b) {
    return std::ranges::equal(a, b,
                              [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

} // namespace

std::optional<Login> loginFor(std::string_view netrc, const std::string& host, const std::string& user) {
    NetrcWords words(netrc);
    std::optional<Login> entry; // while one for this host is read
    const auto fits = [&] { return entry && (user.empty() || entry->user == user); };
    while (const auto word = words.next()) {
        if (*word == "machine" || *word == "default") {
            if (fits()) return entry;
            entry.reset();
            if (*word == "default") continue;
            if (const auto name = words.next(); name && sameName(*name, host)) entry.emplace();
        } else if (*word == "macdef") {
            words.skipMacro();
        } else if (*word == "login" || *word == "password" || *word == "account") {
            const auto value = words.next();
            if (!entry || !value || *word == "account") continue;
            (*word == "login" ? entry->user : entry->password) = *value;
        }
    }
    return fits() ? entry : std::nullopt;
}

std::optional<Login> storedLogin(const std::string& host, const std::string& user) {
    const char* const home = std::getenv("HOME");
    if (!home || !*home) return std::nullopt;
    std::ifstream in(std::string(home) + "/.netrc", std::ios::binary);
    std::string text(kLongestNetrc, '\0');
    in.read(text.data(), std::streamsize(text.size()));
    text.resize(std::size_t(std::max<std::streamsize>(in.gcount(), 0)));
    return loginFor(text, host, user);
}

} // namespace tessera::codec
