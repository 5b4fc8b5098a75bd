#include "volume/import/files/file_names.h"

#include "volume/base/error.h"
#include "volume/import/files/formats.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>

namespace tessera::volume {

namespace fs = std::filesystem;

namespace {

std::string endingOf(const std::string& path) {
    std::string text = fs::path(path).extension().string();
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return text;
}

bool isDigit(char c) {
    return c >= '0' && c <= '9';
}

std::size_t digitsBefore(std::string_view text, std::size_t end) {
    std::size_t begin = end;
    while (begin > 0 && isDigit(text[begin - 1])) --begin;
    return begin;
}

/// Begin of the number whose last digits are [begin, end), with its decimals, exponent and sign if it has them and
/// stands by itself: "run_0.05", "t1e-05", "V_-0.7"; but not the 2 of "run2.0001" or of "v1.2".
std::size_t beginOfNumber(std::string_view text, std::size_t begin) {
    std::size_t start = begin;
    const bool sign = start > 1 && (text[start - 1] == '-' || text[start - 1] == '+');
    const std::size_t e = start - (sign ? 2 : 1);
    if (start > 1 && e < text.size() && (text[e] == 'e' || text[e] == 'E') && e > 0 && isDigit(text[e - 1]))
        start = digitsBefore(text, e);
    if (start > 1 && text[start - 1] == '.') {
        const std::size_t whole = digitsBefore(text, start - 1);
        const bool padded = start - 1 - whole > 1 && text[whole] == '0';
        if (whole < start - 1 && !padded) start = whole;
    }
    if (start == begin) return begin; // a plain number
    const std::string_view before = text.substr(0, start);
    static constexpr std::string_view kBefore[] = {"_", "-", "=", "@", "(", " ", "t", "time", "Time", "T", "U", "V"};
    const auto standsAlone = [&](std::string_view word) {
        if (!before.ends_with(word)) return false;
        return word.size() == before.size() || !std::isalpha(static_cast<unsigned char>(word[0])) ||
               !std::isalpha(static_cast<unsigned char>(before[before.size() - word.size() - 1]));
    };
    if (!before.empty() && std::ranges::none_of(kBefore, standsAlone)) return begin;
    const bool negative = before.ends_with("_-") || before.ends_with("=-") || before == "-";
    return start - (negative ? 1 : 0);
}

} // namespace

NumberedName numberedName(const std::string& path) {
    const fs::path file(path);
    std::string stem = file.filename().string(), tail;
    if (const std::size_t dot = stem.rfind('.'); dot != std::string::npos && dot > 0) {
        tail = stem.substr(dot);
        stem.resize(dot);
        if (tail == ".gz" && stem.ends_with(".nii")) {
            stem.resize(stem.size() - 4);
            tail = ".nii.gz";
        }
    }
    std::size_t end = stem.size();
    while (end > 0 && !isDigit(stem[end - 1])) --end;
    std::size_t begin = digitsBefore(stem, end);
    NumberedName name;
    if (begin == end || end - begin > 15) {
        name.pattern = (file.parent_path() / (stem + tail)).string();
        return name;
    }
    begin = beginOfNumber(stem, begin);
    double number = 0;
    const auto parsed = std::from_chars(stem.data() + begin, stem.data() + end, number);
    if (parsed.ec == std::errc() && std::isfinite(number)) name.number = number;
    name.pattern = (file.parent_path() / (stem.substr(0, begin) + "#" + stem.substr(end) + tail)).string();
    return name;
}

std::vector<std::string> filesOfFolder(const std::string& folder) {
    std::map<std::string, std::vector<std::string>> byEnding;
    std::map<const FileFormat*, std::vector<std::string>> byFormat;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with(".")) continue;
        if (!entry.is_regular_file() && !isZarrFolder(entry.path().string())) continue;
        byEnding[endingOf(name)].push_back(entry.path().string());
        const FileFormat* format =
            endingOf(name) == ".txt" ? nullptr : formatOfFile(entry.path().string()); // usually plain text
        if (format != nullptr && format->advice.empty()) byFormat[format].push_back(entry.path().string());
    }
    if (isFoamCase(folder)) { // any .foam file stands for it
        std::vector<std::string>& named = byEnding[".foam"];
        std::ranges::sort(named);
        return {named.empty() ? folder : named.front()};
    }
    for (const char* list : {".foam", ".pvd", ".series"})
        if (const auto at = byEnding.find(list); at != byEnding.end()) {
            if (at->second.size() > 1) throw Error("holds several " + std::string(list) + " files, name one", folder);
            return at->second;
        }
    std::vector<std::string> best; // others are the samples of a header beside them
    for (const std::string& path : byEnding[".raw"])
        if (fs::exists(fs::path(path).replace_extension(".json"))) best.push_back(path);
    const auto choose = [&](bool pictures) {
        for (const auto& [format, paths] : byFormat) // in the order of the table
            if (isPicture(*format) == pictures && paths.size() > best.size()) best = paths;
    };
    choose(false);
    if (best.empty()) { // pictures, which may also stand beside data, and beside the stack: a logo
        choose(true);
        std::map<std::string, std::size_t> alike;
        for (const std::string& path : best) ++alike[numberedName(path).pattern];
        const auto single = [&](const std::string& path) { return alike[numberedName(path).pattern] == 1; };
        if (!std::ranges::all_of(best, single)) std::erase_if(best, single);
    }
    const auto is = [](const char* kind) { return [kind](const std::string& path) { return path.ends_with(kind); }; };
    if (std::ranges::any_of(best, is(".cas.h5"))) std::erase_if(best, is(".dat.h5")); // Fluent's cases open their data
    if (best.empty()) best = byEnding[".raw"];
    if (best.empty()) throw Error("holds no data file", folder);
    std::sort(best.begin(), best.end());
    return best;
}

} // namespace tessera::volume
