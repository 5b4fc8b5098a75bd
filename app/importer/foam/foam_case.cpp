#include "app/importer/foam/foam_case.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>

namespace tessera::importer {

namespace fs = std::filesystem;

namespace {

using NamedTime = std::pair<double, std::string>;

/// The time that a folder's name is; nothing for other names.
std::optional<double> timeNamed(const std::string& name) {
    double value = 0;
    const auto [end, failed] = std::from_chars(name.data(), name.data() + name.size(), value);
    if (failed != std::errc() || end != name.data() + name.size() || !std::isfinite(value)) return std::nullopt;
    return value;
}

std::vector<std::string> foldersIn(const std::string& folder) {
    std::vector<std::string> names;
    std::error_code problem;
    for (fs::directory_iterator at(folder, problem), end; !problem && at != end; at.increment(problem)) {
        std::error_code unknown;
        if (at->is_directory(unknown)) names.push_back(at->path().filename().string());
    }
    std::ranges::sort(names);
    return names;
}

/// Times of a folder, ascending; of those named alike (0.1, 0.10) the first.
std::vector<NamedTime> foamTimesIn(const std::string& folder) {
    std::vector<NamedTime> times;
    for (const std::string& name : foldersIn(folder))
        if (const std::optional<double> value = timeNamed(name)) times.emplace_back(*value, name);
    std::ranges::sort(times);
    const auto same = std::ranges::unique(times, {}, &NamedTime::first);
    times.erase(same.begin(), same.end());
    return times;
}

/// The number in "processor12", -1 in other names.
int processorNamed(const std::string& name, const std::string& word) {
    int number = -1;
    if (!name.starts_with(word)) return -1;
    const char *begin = name.data() + word.size(), *end = name.data() + name.size();
    const auto [stop, failed] = std::from_chars(begin, end, number);
    return failed == std::errc() && (stop == end || *stop == '_') && number >= 0 ? number : -1;
}

/// processor0, processor1 ...; or processors4, or processors4_0-1 and processors4_2-3, whose files have all parts.
std::vector<FoamPiece> processorsOf(const FoamCase& foam, std::vector<std::string>& notes) {
    std::map<int, FoamPiece> own, collated;
    int wanted = 0;
    for (const std::string& name : foldersIn(foam.root)) {
        const std::string folder = foam.root + "/" + name;
        if (const int number = processorNamed(name, "processor"); number >= 0 && name.find('_') == std::string::npos)
            own[number] = {folder, -1};
        const int count = processorNamed(name, "processors");
        if (count < 1 || count > 1'000'000) continue;
        wanted = std::max(wanted, count);
        const std::size_t range = name.find('_'), dash = name.find('-');
        const bool some = range != std::string::npos && dash != std::string::npos;
        const int first = some ? std::atoi(name.c_str() + range + 1) : 0;
        const int last = some ? std::min(std::atoi(name.c_str() + dash + 1), count - 1) : count - 1;
        for (int part = std::max(first, 0); part <= last; ++part) collated[part] = {folder, part - first};
    }
    const bool useOwn = own.size() >= collated.size();
    const std::map<int, FoamPiece>& found = useOwn ? own : collated;
    if (found.empty()) return {};
    const auto count = std::size_t(found.rbegin()->first) + 1;
    if (count != found.size() || (!useOwn && int(count) != wanted))
        notes.push_back("Some of the folders of processors are missing: their part of the mesh is not shown.");
    std::vector<FoamPiece> pieces;
    for (const auto& [number, piece] : found) pieces.push_back(piece);
    return pieces;
}

bool hasMeshFiles(const std::string& folder) {
    return !foamPlace(folder + "/polyMesh", "faces", -1, folder).path.empty() ||
           !foamPlace(folder + "/polyMesh", "points", -1, folder).path.empty();
}

/// Finds the meshes in a folder of a piece, named `inner` ("constant", or a time): of the case, and of its regions.
void findMeshes(FoamCase& foam, const FoamPiece& piece, const std::string& inner, double time,
                std::set<std::string>& regions) {
    const std::string folder = piece.folder + "/" + inner;
    const auto add = [&](const std::string& region) {
        regions.insert(region);
        if (inner != "constant") foam.meshTimes[{piece.folder, region}].emplace_back(time, inner);
    };
    if (hasMeshFiles(folder)) add("");
    for (const std::string& name : foldersIn(folder)) {
        foam.particles = foam.particles || name == "lagrangian" ||
                         (inner != "constant" && fs::is_directory(folder + "/" + name + "/lagrangian"));
        if (name != "polyMesh" && hasMeshFiles(folder + "/" + name)) add(name);
    }
}

/// The times that all processors have.
std::vector<NamedTime> timesOfProcessors(FoamCase& foam) {
    std::map<std::string, std::size_t> counts;
    std::set<std::string> folders;
    std::vector<NamedTime> times;
    for (const FoamPiece& piece : foam.processors) {
        if (!folders.insert(piece.folder).second) continue;
        for (const NamedTime& time : foamTimesIn(piece.folder))
            if (++counts[time.second] == 1) times.push_back(time);
    }
    std::ranges::sort(times);
    std::string missing;
    std::erase_if(times, [&](const NamedTime& time) {
        const bool some = counts[time.second] < folders.size();
        if (some) missing += (missing.empty() ? "" : ", ") + time.second;
        return some;
    });
    if (!missing.empty()) foam.notes.push_back("Not all processors have written time " + missing + ": it is left out.");
    const auto same = std::ranges::unique(times, {}, &NamedTime::first);
    times.erase(same.begin(), same.end());
    return times;
}

/// Of times in the case and in the folders of the processors: those in the case, unless the processors have more.
void joinTimes(FoamCase& foam, const std::vector<NamedTime>& own, const std::vector<NamedTime>& ofProcessors) {
    const auto has = [](const std::vector<NamedTime>& times, double value) {
        return std::ranges::find(times, value, &NamedTime::first) != times.end();
    };
    const bool decomposed =
        std::ranges::any_of(ofProcessors, [&](const NamedTime& time) { return !has(own, time.first); });
    if (decomposed)
        for (const auto& [value, name] : ofProcessors) foam.times.push_back({value, name, true});
    for (const auto& [value, name] : own)
        if (!decomposed || !has(ofProcessors, value)) foam.times.push_back({value, name, false});
    std::ranges::sort(foam.times, {}, &FoamTime::value);
    if (!decomposed) return;
    const auto joined = std::size_t(std::ranges::count_if(foam.times, &FoamTime::processors));
    foam.notes.push_back("Joined from the folders of " + std::to_string(foam.processors.size()) + " processors" +
                         (joined < foam.times.size()
                              ? " at " + std::to_string(joined) + " of " + std::to_string(foam.times.size()) + " times."
                              : "."));
}

std::string rootOf(const std::string& path) {
    const fs::path given(path);
    fs::path root = given;
    if (!fs::is_directory(given)) {
        root = given.parent_path().empty() ? "." : given.parent_path();
        if (given.filename().string().starts_with("controlDict")) root = root.lexically_normal() / "..";
    }
    return root.string();
}

/// Why there is nothing to show.
[[noreturn]] void failWithoutMesh(const FoamCase& foam) {
    std::string maker = "the case's mesher makes it";
    const auto has = [&](const char* name) {
        return !foamPlace(foam.root + "/system", name, -1, foam.root).path.empty() ||
               !foamPlace(foam.root + "/constant/polyMesh", name, -1, foam.root).path.empty();
    };
    if (has("blockMeshDict")) maker = "run blockMesh first";
    if (has("snappyHexMeshDict")) maker = "run its mesher first (blockMesh, snappyHexMesh)";
    throw std::runtime_error("has no mesh: there is no constant/polyMesh/points (" + maker + ")");
}

} // namespace

std::vector<FoamPiece> FoamCase::piecesAt(std::size_t time) const {
    if (time < times.size() && times[time].processors) return processors;
    return {{root, -1}};
}

std::string FoamCase::fieldFolder(const FoamPiece& piece, const std::string& region, std::size_t time) const {
    const std::string inner = time < times.size() ? times[time].folder : "constant";
    return piece.folder + "/" + inner + (region.empty() ? "" : "/" + region);
}

std::vector<FoamMeshFiles> FoamCase::meshAt(const std::string& region, std::size_t time) const {
    std::vector<FoamMeshFiles> all;
    const std::string below = (region.empty() ? "" : "/" + region) + "/polyMesh";
    for (const FoamPiece& piece : piecesAt(time)) {
        std::vector<std::string> folders{piece.folder + "/constant" + below};
        const auto known = meshTimes.find({piece.folder, region});
        if (known != meshTimes.end())
            for (const auto& [value, name] : known->second)
                if (time < times.size() && value <= times[time].value)
                    folders.push_back(piece.folder + "/" + name + below);
        const auto newest = [&](const char* name) {
            for (auto folder = folders.rbegin(); folder != folders.rend(); ++folder)
                if (FoamPlace place = foamPlace(*folder, name, piece.part, root); !place.path.empty()) return place;
            return FoamPlace{};
        };
        all.push_back({newest("points"), newest("faces"), newest("owner"), newest("neighbour"), newest("boundary"),
                       newest("cellZones")});
    }
    return all;
}

bool FoamCase::hasMeshAt(const std::string& region, std::size_t time) const {
    return std::ranges::all_of(meshAt(region, time), [](const FoamMeshFiles& files) {
        return !files.points.path.empty() && !files.faces.path.empty() && !files.owner.path.empty();
    });
}

bool FoamCase::isStill(const std::string& region) const {
    const bool once = std::ranges::none_of(meshTimes, [&](const auto& known) { return known.first.second == region; });
    const auto joined = std::ranges::count_if(times, &FoamTime::processors);
    if (once && (joined == 0 || std::size_t(joined) == times.size())) return true;
    for (std::size_t t = 1; t < times.size(); ++t)
        if (meshAt(region, t) != meshAt(region, 0)) return false;
    return true;
}

std::vector<std::string> foamFilesIn(const std::string& folder) {
    std::set<std::string> names;
    std::error_code problem;
    for (fs::directory_iterator at(folder, problem), end; !problem && at != end; at.increment(problem)) {
        std::error_code unknown;
        if (!at->is_regular_file(unknown)) continue;
        std::string name = at->path().filename().string();
        if (name.ends_with(".gz")) name.resize(name.size() - 3);
        if (!name.starts_with('.')) names.insert(name);
    }
    return {names.begin(), names.end()};
}

FoamCase findFoamCase(const std::string& path) {
    FoamCase foam;
    foam.root = rootOf(path);
    std::vector<std::string> notes;
    foam.processors = processorsOf(foam, notes);
    std::vector<NamedTime> own = foamTimesIn(foam.root);
    if (own.empty() && fs::is_directory(foam.root + "/0.orig")) own.emplace_back(0, "0.orig");
    std::set<std::string> regions, folders;
    const auto find = [&](const FoamPiece& piece, const std::vector<NamedTime>& times) {
        findMeshes(foam, piece, "constant", 0, regions);
        for (const auto& [value, name] : times) findMeshes(foam, piece, name, value, regions);
    };
    find({foam.root, -1}, own);
    const bool ownMesh = !regions.empty();
    std::vector<NamedTime> ofProcessors;
    if (!foam.processors.empty()) {
        ofProcessors = timesOfProcessors(foam);
        for (const FoamPiece& piece : foam.processors)
            if (folders.insert(piece.folder).second) find(piece, foamTimesIn(piece.folder));
    }
    if (regions.empty()) failWithoutMesh(foam);
    joinTimes(foam, ownMesh ? own : std::vector<NamedTime>{}, ofProcessors);
    if (std::ranges::any_of(foam.times, &FoamTime::processors))
        foam.notes.insert(foam.notes.end(), notes.begin(), notes.end());
    if (std::ranges::any_of(foam.times, [](const FoamTime& time) { return time.folder == "0.orig"; }))
        foam.notes.push_back("The folder 0.orig is shown as time 0, since there are no times.");
    for (const std::string& region : regions) {
        bool any = foam.times.empty() && foam.hasMeshAt(region, 0);
        for (std::size_t t = 0; t < foam.times.size() && !any; ++t) any = foam.hasMeshAt(region, t);
        if (any) foam.regions.push_back(region);
    }
    if (foam.regions.empty()) failWithoutMesh(foam);
    return foam;
}

FoamClock clockOfFoam(const FoamCase& foam) {
    if (!foamPlace(foam.root + "/constant", "engineGeometry", -1, foam.root).path.empty())
        return {"deg", "crank angle"};
    std::vector<std::string> folders{foam.root + "/system"};
    for (const std::string& region : foam.regions) folders.push_back(foam.root + "/system/" + region);
    for (const std::string& folder : folders) {
        const FoamPlace place = foamPlace(folder, "fvSchemes", -1, foam.root);
        if (place.path.empty()) continue;
        try {
            const FoamFile file = readFoamFile(place);
            FoamCursor in(file);
            while (in.more() && in.word() != "ddtSchemes") {
            }
            if (!in.more()) continue;
            in.expect('{');
            while (in.peek() != '}') {
                const std::string key(in.word()), scheme = in.statement();
                if (key == "default" && scheme == "steadyState") return {"", "iteration"};
                if (key == "default" && scheme != "none") return {};
            }
        } catch (const std::runtime_error&) { // the values do not depend on it
        }
    }
    return {};
}

} // namespace tessera::importer
