#include "volume/import/files/named_files.h"

#include "volume/base/error.h"
#include "volume/import/files/formats.h"
#include "volume/import/files/series.h"
#include "volume/system/input_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <glob.h>
#include <set>
#include <string_view>

namespace tessera::volume {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostNamed = 100'000;

fs::path plain(const fs::path& path) {
    std::error_code unknown;
    const fs::path whole = fs::absolute(path.empty() ? fs::path(".") : path, unknown).lexically_normal();
    return whole.has_filename() ? whole : whole.parent_path(); // without a slash at its end
}

std::string ending(const fs::path& path) {
    std::string text = path.extension().string();
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return text;
}

bool isHeader(const std::string& kind) {
    constexpr std::array<std::string_view, 18> kHeaders = {".json", ".nhdr", ".mhd",  ".vtm",  ".pvtu",  ".pvti",
                                                           ".pvtr", ".pvts", ".pvtk", ".case", ".encas", ".sos",
                                                           ".vtmb", ".vtpc", ".vtpd", ".xmf",  ".xdmf",  ".vthb"};
    return std::find(kHeaders.begin(), kHeaders.end(), kind) != kHeaders.end();
}

/// The beginning of a file, which contains the header.
std::string headOf(const fs::path& path) {
    constexpr std::size_t kMost = 1 << 20;
    if (!whyNoFile(path.string()).empty()) return {};
    std::string text(kMost, '\0');
    std::ifstream in(path, std::ios::binary);
    in.read(text.data(), std::streamsize(text.size()));
    text.resize(std::size_t(std::max<std::streamsize>(in.gcount(), 0)));
    return text;
}

/// Everything in a text that may be a file name: words, quoted texts, and what follows a colon or equals sign in a
/// line.
std::set<std::string> possibleNames(const std::string& text) {
    constexpr std::size_t kLongest = 1024;
    std::set<std::string> names;
    const auto add = [&names](std::string_view name) {
        constexpr std::string_view kSpace = " \t\r";
        const std::size_t first = name.find_first_not_of(kSpace);
        if (first == std::string_view::npos) return;
        name = name.substr(first, name.find_last_not_of(kSpace) - first + 1);
        if (name.size() <= kLongest && name.find('.') != std::string_view::npos) names.emplace(name);
    };
    const auto addPieces = [&](std::string_view line, std::string_view separators) {
        for (std::size_t at = 0; at < line.size();) {
            const std::size_t end = std::min(line.find_first_of(separators, at), line.size());
            add(line.substr(at, end - at));
            at = end + 1;
        }
    };
    const std::string_view all = text;
    for (std::size_t at = 0; at < all.size();) {
        const std::size_t end = std::min(all.find('\n', at), all.size());
        const std::string_view line = all.substr(at, end - at);
        addPieces(line, " \t\r\"'");
        addPieces(line, "\"'");
        addPieces(line, " \t\r<>:"); // a data set within a file, in XDMF: <DataItem>heavy.h5:/T</DataItem>
        if (const std::size_t mark = line.find_first_of(":="); mark != std::string_view::npos)
            add(line.substr(mark + 1));
        at = end + 1;
    }
    return names;
}

/// "slice%03d.raw" with an asterisk in place of the number.
std::string withAsterisk(const std::string& name) {
    const std::size_t mark = name.find('%'), end = name.find_first_not_of("0123456789", mark + 1);
    if (mark == std::string::npos || end == std::string::npos || name[end] != 'd') return name;
    return name.substr(0, mark) + "*" + name.substr(end + 1);
}

/// Files in the folder of a header that match a name in it, which may contain asterisks, or a number's place.
std::vector<fs::path> fitting(const fs::path& header, const std::string& named) {
    const std::string name = withAsterisk(named);
    const fs::path path = fs::path(name).is_absolute() ? fs::path(name) : header.parent_path() / name;
    if (name.find('*') == std::string::npos) return {path};
    glob_t found{};
    std::vector<fs::path> paths;
    if (glob(path.c_str(), 0, nullptr, &found) == 0) paths.assign(found.gl_pathv, found.gl_pathv + found.gl_pathc);
    globfree(&found);
    return paths;
}

/// Whether OpenFOAM reads this folder of a case: system, constant, processor0, and those of times. Beside them lie logs
/// and whatever was computed from the case.
bool isOfCase(const fs::path& folder) {
    const std::string name = folder.filename().string();
    double time = 0;
    const auto [end, failed] = std::from_chars(name.data(), name.data() + name.size(), time);
    return (failed == std::errc() && end == name.data() + name.size()) || name == "system" || name == "constant" ||
           name == "0.orig" || name.starts_with("processor");
}

/// Files that one names directly.
std::vector<fs::path> namedDirectly(const fs::path& path) {
    std::vector<fs::path> named;
    std::error_code problem;
    const auto addCase = [&](const fs::path& folder) {
        for (fs::recursive_directory_iterator at(folder, problem), end;
             !problem && at != end && named.size() < kMostNamed; at.increment(problem))
            if (at.depth() == 0 && !isOfCase(at->path()))
                at.disable_recursion_pending();
            else if (at.depth() > 0)
                named.push_back(at->path());
    };
    const std::string kind = ending(path);
    if (isZarrFolder(path.string())) {
        for (fs::recursive_directory_iterator at(path, problem), end;
             !problem && at != end && named.size() < kMostNamed; at.increment(problem))
            named.push_back(at->path());
    } else if (fs::is_directory(path, problem) && isFoamCase(path.string())) {
        addCase(path);
    } else if (namesFoamCase(path.string())) {
        const fs::path folder = fs::absolute(path).parent_path();
        addCase(path.filename().string().starts_with("controlDict") ? folder.parent_path() : folder);
    } else if (fs::is_directory(path, problem) || kind == ".pvd" || kind == ".series" || !fs::exists(path, problem)) {
        std::vector<std::string> missing;
        for (const SeriesFile& file : expandPaths({path.string()}, Outside::Allowed, &missing)) {
            named.emplace_back(file.path);
            named.insert(named.end(), file.slices.begin(), file.slices.end());
        }
    } else if (kind == ".cas" || kind == ".msh") { // the values of Fluent, and those of PLOT3D
        for (const char* values : {".dat", ".dat.gz"}) named.push_back(fs::path(path).replace_extension(values));
    } else if (path.string().ends_with(".cas.gz") || path.string().ends_with(".msh.gz")) {
        for (const char* values : {".dat", ".dat.gz"})
            named.push_back(path.parent_path() / path.stem().replace_extension(values));
    } else if (path.string().ends_with(".cas.h5")) {
        named.push_back(path.string().substr(0, path.string().size() - 7) + ".dat.h5");
    } else if (kind == ".xyz" || kind == ".p3d" || kind == ".x") {
        for (const char* values : {".q", ".Q", ".qst", ".f", ".fun", ".F", ".nam"})
            named.push_back(fs::path(path).replace_extension(values));
    } else if (kind == ".hdr" || kind == ".img") { // NIfTI and Analyze in two files
        for (const char* other : {".hdr", ".img", ".img.gz"}) named.push_back(fs::path(path).replace_extension(other));
    } else if (kind == ".raw") {
        named.push_back(fs::path(path).replace_extension(".json"));
    } else if (isHeader(kind)) {
        if (kind == ".json") named.push_back(fs::path(path).replace_extension(".raw"));
        for (const std::string& name : possibleNames(headOf(path)))
            for (fs::path& file : fitting(path, name)) named.push_back(std::move(file));
    }
    return named;
}

} // namespace

bool liesWithin(const std::string& folder, const std::string& path) {
    const auto within = [](const fs::path& base, const fs::path& at) {
        return std::mismatch(base.begin(), base.end(), at.begin(), at.end()).first == base.end();
    };
    const fs::path base = plain(folder), at = plain(path);
    if (within(base, at)) return true;
    std::error_code unknown; // a link to the folder itself
    const fs::path realBase = fs::weakly_canonical(base, unknown), realAt = fs::weakly_canonical(at, unknown);
    return !unknown && within(realBase, realAt);
}

std::string namedPathIn(const std::string& folder, const std::string& name, Outside outside) {
    const std::string path = (fs::path(folder) / name).string(); // an absolute name stays as it is
    if (path.find('\0') != std::string::npos) // where the system ends the name, but not what is checked
        throw Error("names \"" + std::string(path.c_str()).substr(0, 200) + "\" with a zero byte behind it");
    if (outside == Outside::Refused && !liesWithin(folder, path))
        throw Error("names \"" + name.substr(0, 200) + "\", which lies outside of its folder: --allow-outside, or " +
                    "Files elsewhere in File > Open, reads it all the same");
    return path;
}

std::string namedPath(const std::string& file, const std::string& name, Outside outside) {
    return namedPathIn(fs::path(file).parent_path().string(), name, outside);
}

std::vector<std::string> filesNamedBy(const std::string& path) {
    const auto normal = [](const fs::path& file) {
        std::error_code problem;
        return fs::absolute(file, problem).lexically_normal();
    };
    const fs::path first = normal(path);
    std::set<fs::path> found;
    std::vector<fs::path> pending{first};
    while (!pending.empty() && found.size() < kMostNamed) {
        const fs::path next = std::move(pending.back());
        pending.pop_back();
        std::vector<fs::path> named;
        try {
            named = namedDirectly(next);
        } catch (const Error&) {
            continue; // opening it reports the reason
        }
        for (const fs::path& file : named) {
            std::error_code problem;
            const fs::path known = normal(file);
            if (known != first && fs::is_regular_file(known, problem) && found.insert(known).second)
                pending.push_back(known);
        }
    }
    std::vector<std::string> files;
    for (const fs::path& file : found) files.push_back(file.string());
    return files;
}

} // namespace tessera::volume
