#include "volume/import/files/series.h"

#include "volume/base/error.h"
#include "volume/base/number_text.h"
#include "volume/import/files/file_names.h"
#include "volume/import/files/formats.h"
#include "volume/system/input_file.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <glob.h>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

namespace tessera::volume {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostFiles = 1'000'000;
constexpr std::uintmax_t kMostListBytes = 256u << 20;

std::string readText(const std::string& path) {
    return readInput(path, kMostListBytes);
}

std::string ending(const std::string& path) {
    std::string text = fs::path(path).extension().string();
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return text;
}

std::string listedPath(const std::string& list, const std::string& name, Outside outside) {
    try {
        return namedPath(list, name, outside);
    } catch (const Error& error) {
        throw Error(error.reason(), list);
    }
}

std::optional<double> parseTime(std::string_view text) {
    double value = 0;
    const auto parsed = std::from_chars(text.data(), text.data() + text.size(), value);
    if (parsed.ec != std::errc() || !std::isfinite(value)) return std::nullopt;
    return value;
}

/// Replaces the five entities of XML.
std::string unescape(std::string text) {
    static constexpr std::pair<std::string_view, char> kEntities[] = {
        {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}, {"&amp;", '&'}};
    for (const auto& [entity, character] : kEntities)
        for (std::size_t at = 0; (at = text.find(entity, at)) != std::string::npos; ++at)
            text.replace(at, entity.size(), 1, character);
    return text;
}

/// Value of an attribute in the text of one XML tag.
std::optional<std::string> attribute(std::string_view tag, std::string_view name) {
    for (std::size_t at = 0; (at = tag.find(name, at)) != std::string_view::npos; at += name.size()) {
        if (at == 0 || !std::isspace(static_cast<unsigned char>(tag[at - 1]))) continue;
        std::string_view rest = tag.substr(at + name.size());
        while (!rest.empty() && (std::isspace(static_cast<unsigned char>(rest[0])) || rest[0] == '='))
            rest.remove_prefix(1);
        if (rest.empty() || (rest[0] != '"' && rest[0] != '\'')) continue;
        const std::size_t end = rest.find(rest[0], 1);
        if (end == std::string_view::npos) return std::nullopt;
        return unescape(std::string(rest.substr(1, end - 1)));
    }
    return std::nullopt;
}

/// Numeric attributes of a tag, except the standard ones of .pvd.
std::vector<std::pair<std::string, double>> furtherNumbers(std::string_view tag) {
    std::vector<std::pair<std::string, double>> numbers;
    for (std::size_t at = 0; (at = tag.find('=', at)) != std::string_view::npos;) {
        std::size_t end = at, begin;
        while (end > 0 && std::isspace(static_cast<unsigned char>(tag[end - 1]))) --end;
        for (begin = end; begin > 0 && !std::isspace(static_cast<unsigned char>(tag[begin - 1]));) --begin;
        const std::string name(tag.substr(begin, end - begin));
        const std::size_t quote = tag.find_first_of("\"'", at);
        if (quote == std::string_view::npos) break;
        at = tag.find(tag[quote], quote + 1); // skip the value, which may contain an equals sign
        if (at == std::string_view::npos) break;
        static constexpr std::array<std::string_view, 5> kKnown = {"timestep", "group", "part", "file", "name"};
        if (name.empty() || std::ranges::find(kKnown, name) != kKnown.end()) continue;
        const std::string_view text = tag.substr(quote + 1, at - quote - 1);
        double value = 0;
        const auto parsed = std::from_chars(text.data(), text.data() + text.size(), value);
        if (parsed.ec == std::errc() && parsed.ptr == text.data() + text.size() && std::isfinite(value))
            numbers.emplace_back(name, value);
    }
    return numbers;
}

/// The files of a list that exist; the others are said in `missing`. Throws Error for others without it, where there
/// are only others, and for what is no file.
std::vector<SeriesFile> existing(std::vector<SeriesFile> listed, const std::string& list,
                                 std::vector<std::string>* missing) {
    std::vector<SeriesFile> kept;
    std::string first;
    std::vector<std::string> lost;
    for (SeriesFile& entry : listed) {
        std::error_code ignored;
        const std::string why = whyNoFile(entry.path);
        if (why.empty() || fs::is_directory(entry.path, ignored)) {
            kept.push_back(std::move(entry));
            continue;
        }
        const bool absent = why == kNoSuchFile;
        const std::string said = "lists " + entry.path + ", which " + (absent ? "does not exist" : why);
        if (!absent || !missing) throw Error(said, list);
        if (first.empty()) first = said;
        lost.push_back(fs::path(list).filename().string() + " " + said +
                       (entry.time ? ": time " + exactText(*entry.time) + " is left out" : ": it is left out"));
    }
    if (kept.empty()) throw Error(first, list);
    if (missing) missing->insert(missing->end(), lost.begin(), lost.end());
    return kept;
}

/// Files with a single page are slices; they become one entry per volume: pictures by numbers in names, DICOM by
/// folder. Volumes of numbered times become a series.
std::vector<SeriesFile> withSlices(std::vector<SeriesFile> files) {
    std::vector<SeriesFile> out;
    std::map<std::string, std::size_t> fitting, volumes; // files of a name, and where each volume is in `out`
    for (const SeriesFile& entry : files) ++fitting[sliceName(entry.path).volume];
    for (SeriesFile& entry : files) {
        const FileFormat* format = entry.time ? nullptr : formatOfFile(entry.path);
        if (format == nullptr || !format->slices || !isSlice(*format, entry.path)) {
            out.push_back(std::move(entry));
            continue;
        }
        const SliceName name = sliceName(entry.path);
        const std::string pattern = numberedName(entry.path).pattern;
        std::string volume = entry.group; // as a list of files says it
        if (format->name == "DICOM") {
            volume = entry.group = fs::path(entry.path).parent_path().string() + "#DICOM";
        } else if (entry.group == pattern && fitting[name.volume] > 1) { // else the letter z stands for something else
            volume = name.volume;
            entry.group = name.series;
        }
        if (const auto known = volumes.find(volume); known != volumes.end()) {
            out[known->second].slices.push_back(entry.path);
            continue;
        }
        volumes.emplace(volume, out.size());
        entry.slices = {entry.path};
        out.push_back(std::move(entry));
    }
    for (SeriesFile& entry : out) {
        if (entry.slices.size() == 1) entry.slices.clear();
        if (entry.slices.empty()) continue;
        const SliceName name = sliceName(entry.path);
        const bool byLetter = entry.group == name.series && name.slice;
        if (byLetter)
            std::ranges::stable_sort(entry.slices, {},
                                     [](const std::string& path) { return sliceName(path).slice.value_or(0); });
        entry.path = entry.slices.front();
        entry.number = byLetter ? name.time : std::nullopt; // the last number counts slices
    }
    return out;
}

} // namespace

std::vector<std::string> filesOfPattern(const std::string& pattern) {
    glob_t found{};
    const int status = glob(pattern.c_str(), 0, nullptr, &found);
    std::vector<std::string> paths;
    if (status == 0) paths.assign(found.gl_pathv, found.gl_pathv + found.gl_pathc);
    globfree(&found);
    return paths;
}

SliceName sliceName(const std::string& path) {
    const std::string name = fs::path(path).filename().string();
    const std::size_t end = name.rfind('.') == std::string::npos ? name.size() : name.rfind('.');
    const auto isDigit = [&](std::size_t i) { return std::isdigit(static_cast<unsigned char>(name[i])) != 0; };
    const auto isLetter = [&](std::size_t i) { return std::isalpha(static_cast<unsigned char>(name[i])) != 0; };
    /// The digits that follow a letter of their own.
    const auto digitsAfter = [&](char letter) {
        for (std::size_t at = 0; at + 1 < end; ++at) {
            if (std::tolower(static_cast<unsigned char>(name[at])) != letter || !isDigit(at + 1)) continue;
            if (at > 0 && isLetter(at - 1)) continue;
            std::size_t stop = at + 1;
            while (stop < end && isDigit(stop)) ++stop;
            constexpr std::size_t kMostDigits = 15;
            if (stop - at <= kMostDigits) return std::pair(at + 1, stop);
        }
        return std::pair(std::size_t(0), std::size_t(0));
    };
    const auto numberIn = [&](std::pair<std::size_t, std::size_t> digits) {
        return parseTime(std::string_view(name).substr(digits.first, digits.second - digits.first));
    };
    const auto without = [&](std::string text, std::pair<std::size_t, std::size_t> digits) {
        return text.replace(digits.first, digits.second - digits.first, "#");
    };
    const auto slice = digitsAfter('z'), time = digitsAfter('t');
    const std::string folder = fs::path(path).parent_path().string();
    if (slice.second == 0) {
        const NumberedName last = numberedName(path);
        return {last.pattern, last.pattern, last.number, {}};
    }
    SliceName found{(fs::path(folder) / without(name, slice)).string(), {}, numberIn(slice), {}};
    found.series = found.volume;
    if (time.second == 0) return found;
    found.time = numberIn(time);
    const bool timeFirst = time.first < slice.first; // later digits first, so that places stay right
    found.series =
        (fs::path(folder) / (timeFirst ? without(without(name, slice), time) : without(without(name, time), slice)))
            .string();
    return found;
}

std::vector<SeriesFile> parsePvd(const std::string& xml, const std::string& file, Outside outside) {
    if (xml.find("<Collection") == std::string::npos) throw Error("holds no Collection: not a .pvd file", file);
    std::vector<SeriesFile> files;
    for (std::size_t at = 0; (at = xml.find("<DataSet", at)) != std::string::npos;) {
        const std::size_t end = xml.find('>', at);
        if (end == std::string::npos) throw Error("ends within a DataSet", file, "byte " + std::to_string(at));
        const std::string_view tag = std::string_view(xml).substr(at, end - at);
        const std::optional<std::string> name = attribute(tag, "file"), time = attribute(tag, "timestep");
        if (!name || name->empty()) throw Error("DataSet without a file", file, "byte " + std::to_string(at));
        SeriesFile entry;
        entry.path = listedPath(file, *name, outside);
        if (time) {
            entry.time = parseTime(*time);
            if (!entry.time)
                throw Error("timestep \"" + time->substr(0, 40) + "\" is not a number", file,
                            "byte " + std::to_string(at));
        }
        const std::string part = attribute(tag, "part").value_or("0");
        entry.group = file + "#" + attribute(tag, "group").value_or("") + "#" + part;
        entry.part = attribute(tag, "name").value_or(attribute(tag, "group").value_or(""));
        entry.numbers = furtherNumbers(tag);
        files.push_back(std::move(entry));
        if (files.size() > kMostFiles) throw Error("lists too many files", file);
        at = end;
    }
    if (files.empty()) throw Error("lists no file", file);
    return files;
}

std::vector<SeriesFile> parseSeries(const std::string& text, const std::string& file, Outside outside) {
    const nlohmann::json document = nlohmann::json::parse(text, nullptr, false);
    if (document.is_discarded() || !document.is_object()) throw Error("is not JSON of a file series", file);
    const auto list = document.find("files");
    if (list == document.end() || !list->is_array() || list->empty()) throw Error("lists no file", file, "files");
    if (list->size() > kMostFiles) throw Error("lists too many files", file);
    std::vector<SeriesFile> files;
    for (std::size_t i = 0; i < list->size(); ++i) {
        const nlohmann::json& item = (*list)[i];
        const std::string place = "files[" + std::to_string(i) + "]";
        if (!item.is_object() || !item.contains("name") || !item["name"].is_string())
            throw Error("needs a name", file, place);
        SeriesFile entry;
        entry.path = listedPath(file, item["name"].get<std::string>(), outside);
        if (item.contains("time")) {
            if (!item["time"].is_number()) throw Error("time is not a number", file, place);
            entry.time = item["time"].get<double>();
        }
        for (const auto& [key, value] : item.items())
            if (key != "time" && value.is_number()) entry.numbers.emplace_back(key, value.get<double>());
        entry.group = file;
        files.push_back(std::move(entry));
    }
    return files;
}

std::vector<SeriesFile> expandPaths(const std::vector<std::string>& paths, Outside outside,
                                    std::vector<std::string>* missing) {
    std::vector<SeriesFile> files;
    std::vector<std::string> pending(paths.rbegin(), paths.rend());
    std::set<std::string> seen; // ignore duplicate paths
    int rounds = 0;
    while (!pending.empty()) {
        std::string path = pending.back();
        pending.pop_back();
        while (path.size() > 1 && path.back() == '/') path.pop_back();
        if (!seen.insert(path).second) continue;
        if (++rounds > int(kMostFiles)) throw Error("names too many files", path);
        std::error_code ignored;
        if (isZarrFolder(path)) {
            const NumberedName name = numberedName(path);
            files.push_back({path, {}, name.number, name.pattern, {}});
            continue;
        }
        if (fs::is_directory(path, ignored) && !isFoamCase(path)) {
            const std::vector<std::string> inside = filesOfFolder(path);
            pending.insert(pending.end(), inside.rbegin(), inside.rend());
            continue;
        }
        if (fs::is_directory(path, ignored)) {
            const std::vector<std::string> inside = filesOfFolder(path);
            files.push_back({inside.front(), {}, {}, inside.front(), {}});
            continue;
        }
        if (!fs::exists(path, ignored)) {
            if (path.find_first_of("*?[") == std::string::npos) throw Error("no such file", path);
            const std::vector<std::string> fits = filesOfPattern(path);
            if (fits.empty()) throw Error("no file fits this pattern", path);
            pending.insert(pending.end(), fits.rbegin(), fits.rend());
            continue;
        }
        requireFile(path);
        const std::string kind = ending(path);
        if (kind == ".pvd" || kind == ".series") {
            const std::vector<SeriesFile> listed = existing(kind == ".pvd" ? parsePvd(readText(path), path, outside)
                                                                           : parseSeries(readText(path), path, outside),
                                                            path, missing);
            files.insert(files.end(), listed.begin(), listed.end());
            continue;
        }
        const NumberedName name = numberedName(path);
        files.push_back({path, {}, name.number, name.pattern, {}});
    }
    // Groups in the order of their first file; within a group by time, then number.
    std::map<std::string, std::size_t> rank;
    for (const SeriesFile& entry : files) rank.emplace(entry.group, rank.size());
    std::stable_sort(files.begin(), files.end(), [&](const SeriesFile& a, const SeriesFile& b) {
        if (a.group != b.group) return rank[a.group] < rank[b.group];
        if (a.time && b.time && *a.time != *b.time) return *a.time < *b.time;
        return a.number && b.number && *a.number < *b.number;
    });
    const auto same = [](const SeriesFile& a, const SeriesFile& b) { return a.path == b.path && a.time == b.time; };
    files.erase(std::unique(files.begin(), files.end(), same), files.end());
    files = withSlices(std::move(files));
    for (const SeriesFile& entry : files) rank.emplace(entry.group, rank.size());
    std::stable_sort(files.begin(), files.end(),
                     [&](const SeriesFile& a, const SeriesFile& b) { return rank[a.group] < rank[b.group]; });
    return files;
}

} // namespace tessera::volume
