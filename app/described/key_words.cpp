#include "app/described/key_words.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <utility>

namespace tessera::app {

namespace {

/// Keys are never changed, so that old sessions open; what users read follows docs/glossary.md.
constexpr std::pair<std::string_view, std::string_view> kReplacements[] = {
    {"center", "centre"},
    {"channel", "parameter"},
    {"channels", "parameters"},
    {"color", "colour"},
    {"colormap", "colour map"},
    {"colors", "colours"},
    {"cursor", "cross-hair"},
    {"dpi", "DPI"},
    {"hardpencil", "hard pencil"},
    {"least", "minimum"},
    {"localmaximum", "local maximum"},
    {"most", "maximum"},
    {"pdf", "PDF"},
    {"png", "PNG"},
    {"pointer", "mouse"},
    {"softpencil", "soft pencil"},
    {"svg", "SVG"},
    {"xray", "X-ray"},
};

std::string_view replaced(std::string_view word) {
    const auto* const found = std::find_if(std::begin(kReplacements), std::end(kReplacements),
                                           [&](const auto& r) { return r.first == word; });
    return found == std::end(kReplacements) ? word : found->second;
}

} // namespace

std::string keyWords(std::string_view key) {
    std::string out, word;
    const auto endWord = [&] {
        if (!out.empty() && !word.empty()) out += ' ';
        out += replaced(word);
        word.clear();
    };
    for (const char c : key) {
        if (std::isupper(static_cast<unsigned char>(c)) != 0) endWord();
        word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    endWord();
    return out;
}

std::string oneOf(std::string_view list) {
    std::string words = keyWords(list);
    if (words.ends_with('s')) words.pop_back();
    return words;
}

bool sameName(std::string_view a, std::string_view b) {
    const auto folded = [](std::string_view name) {
        std::string out;
        for (const char c : name)
            if (c != '_' && c != '-' && c != ' ') out += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
        return out;
    };
    return folded(a) == folded(b);
}

} // namespace tessera::app
