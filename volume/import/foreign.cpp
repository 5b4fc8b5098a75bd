#include "volume/import/foreign.h"

#include "volume/base/error.h"
#include "volume/import/files/series.h"
#include "volume/import/files/stream.h"
#include "volume/system/own_path.h"
#include "volume/system/process.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string_view>

namespace tessera::volume {

namespace fs = std::filesystem;

namespace {

/// The running tessera-import process; one request at a time.
class Importer {
public:
    Importer(const std::string& program, const std::vector<SeriesFile>& entries, Outside outside)
        : child_({program, "-"}) {
        for (const SeriesFile& entry : entries) paths_.push_back(entry.path);
        child_.write(wordsOf(entries, outside));
    }

    std::vector<FileBlock> header(std::size_t file, const Progress& progress) {
        // No frame is expected, so no frame length is valid.
        const std::vector<std::byte> text = answer(file, MessageKind::Header, Lattice{}, ScalarType::U8, [&] {
            progress.advance(double(file) / double(paths_.size()), fs::path(paths_[file]).filename().string());
        });
        return understood(file, [&] {
            return parseStreamHeader({reinterpret_cast<const char*>(text.data()), text.size()}, paths_[file]);
        });
    }

    Field frame(std::size_t file, std::size_t block, int array, int component, int time, const Lattice& target,
                ScalarType type) {
        char line[128];
        std::snprintf(line, sizeof line, "frame %zu %zu %d %d %d ", file, block, array, component, time);
        const std::lock_guard lock(mutex_);
        child_.write(line + latticeWords(target) + "\n");
        const auto bytes = answer(file, MessageKind::Frame, target, type, {});
        return understood(file, [&] { return parseFrame(bytes, target, type); });
    }

    std::vector<Range> ranges(std::size_t file, std::size_t block, int array, int time, bool between) {
        char line[128];
        std::snprintf(line, sizeof line, "ranges %zu %zu %d %d %d\n", file, block, array, time, between ? 1 : 0);
        const std::lock_guard lock(mutex_);
        child_.write(line);
        const auto text = answer(file, MessageKind::Header, Lattice{}, ScalarType::U8, {});
        return understood(file, [&] {
            return parseRanges({reinterpret_cast<const char*>(text.data()), text.size()}, paths_[file]);
        });
    }

private:
    /// Each word ended by a zero byte, and an empty one in the end.
    static std::string wordsOf(const std::vector<SeriesFile>& entries, Outside outside) {
        std::string words;
        const auto add = [&words](const std::string& word) { words.append(word.c_str(), word.size() + 1); };
        const auto addPath = [&](const std::string& path) {
            if (path.find('\0') != std::string::npos) throw Error("a name with a zero byte", path.c_str());
            add(fs::path(path).is_absolute() ? path : "./" + path);
        };
        if (outside == Outside::Allowed) add("--allow-outside");
        std::string last;
        for (const SeriesFile& entry : entries) {
            const std::string& path = entry.path;
            if (!entry.slices.empty()) {
                add("--slices");
                add(std::to_string(entry.slices.size()));
                for (const std::string& slice : entry.slices) addPath(slice);
                last.clear();
                continue;
            }
            const NumberedName name = numberedName(path);
            const std::string pattern = name.number ? name.pattern : std::string();
            if (!pattern.empty() && pattern == last) add("--like");
            last = pattern;
            addPath(path);
        }
        add({});
        return words;
    }

    std::vector<std::byte> answer(std::size_t file, MessageKind wanted, const Lattice& lattice, ScalarType type,
                                  const std::function<void()>& waiting) {
        std::byte headBytes[kMessageHeadBytes];
        if (!child_.read(headBytes, waiting)) failed(file);
        const MessageHead head = understood(file, [&] { return parseMessageHead(headBytes, lattice, type); });
        std::vector<std::byte> bytes(head.length);
        if (!child_.read(bytes, waiting)) failed(file);
        if (head.kind == MessageKind::Failure)
            throw Error(
                std::string(reinterpret_cast<const char*>(bytes.data()), std::min<std::size_t>(bytes.size(), 500)),
                paths_[file]);
        if (head.kind != wanted) unusable(file, "it answers another request");
        return bytes;
    }

    [[noreturn]] void failed(std::size_t file) {
        const std::string how = child_.ending();
        if (child_.interrupted()) throw Cancelled();
        throw Error(kFailed + (how.empty() ? "it ended early" : "it " + how), paths_[file]);
    }

    /// What it sent cannot be used: says so, with its last words.
    [[noreturn]] void unusable(std::size_t file, const std::string& why) {
        const std::string how = child_.ending();
        if (child_.interrupted()) throw Cancelled();
        throw Error(kFailed + why + (how.empty() ? "" : "; it " + how), paths_[file]);
    }

    /// What `parse` makes of an answer.
    template <class Parse> auto understood(std::size_t file, const Parse& parse) -> decltype(parse()) {
        try {
            return parse();
        } catch (const Error& error) {
            unusable(file, (error.place().empty() ? "" : error.place() + ": ") + error.reason());
        }
    }

    inline static const std::string kFailed = "the reader of this file (tessera-import) failed: ";

    std::vector<std::string> paths_;
    std::mutex mutex_;
    ChildProcess child_;
};

/// Integer arrays NAME.present say where NAME is present (as exportDataset writes them): no parameters of their own.
/// Gives the index of the flags of each remaining array, -1 for none, and of the array itself among all.
struct Kept {
    int index, flags;
};
std::vector<Kept> withoutPresence(std::vector<Array>& arrays) {
    std::map<std::string_view, int> first; // by name
    for (std::size_t i = 0; i < arrays.size(); ++i) first.emplace(arrays[i].name, int(i));
    const auto find = [&](const std::string& name) {
        const auto at = first.find(name);
        return at == first.end() ? -1 : at->second;
    };
    std::vector<Kept> kept;
    std::vector<Array> remaining;
    constexpr std::string_view kEnding = ".present";
    for (std::size_t i = 0; i < arrays.size(); ++i) {
        const std::string& name = arrays[i].name;
        if (name.ends_with(kEnding) && arrays[i].type == ScalarType::U8 &&
            find(name.substr(0, name.size() - kEnding.size())) >= 0)
            continue;
        const int flags = find(name + std::string(kEnding));
        kept.push_back(
            {static_cast<int>(i), flags >= 0 && arrays[std::size_t(flags)].type == ScalarType::U8 ? flags : -1});
        remaining.push_back(arrays[i]);
    }
    arrays = std::move(remaining);
    return kept;
}

} // namespace

std::string findImporter() {
    if (const char* named = std::getenv("TESSERA_IMPORT"); named != nullptr && *named != '\0') return named;
    return programBeside("tessera-import");
}

std::vector<std::vector<FileBlock>> openForeign(const std::vector<SeriesFile>& entries, Outside outside,
                                                const Progress& progress) {
    std::vector<std::string> paths;
    for (const SeriesFile& entry : entries) paths.push_back(entry.path);
    const std::string program = findImporter();
    if (program.empty())
        throw Error("reading this format needs the program tessera-import, which was not built (it needs VTK)",
                    paths.front());
    const auto importer = std::make_shared<Importer>(program, entries, outside);
    std::vector<std::vector<FileBlock>> files;
    for (std::size_t f = 0; f < paths.size(); ++f) {
        progress.advance(double(f) / double(paths.size()), fs::path(paths[f]).filename().string());
        files.push_back(importer->header(f, progress));
        for (std::size_t p = 0; p < files[f].size(); ++p) {
            FileBlock& block = files[f][p];
            const std::vector<Kept> kept = withoutPresence(block.arrays);
            block.resamples = true;
            std::vector<ScalarType> types;
            for (const Array& array : block.arrays) types.push_back(array.type);
            block.ranges = [importer, f, p, kept](int array, int time, bool between) {
                const Kept from = kept[std::size_t(array)];
                if (from.flags >= 0) return std::vector<Range>{}; // ranges of present samples are not known
                return importer->ranges(f, p, from.index, time, between);
            };
            block.read = [importer, f, p, kept, types](int array, int component, int time, const Lattice& target,
                                                       SliceRange) {
                if (array < 0) return importer->frame(f, p, -1, 0, time, target, ScalarType::U8);
                const Kept from = kept[std::size_t(array)];
                Field field = importer->frame(f, p, from.index, component, time, target, types[std::size_t(array)]);
                if (from.flags < 0) return field;
                const Field flags = importer->frame(f, p, from.flags, 0, time, target, ScalarType::U8);
                Mask mask(field.count());
                for (std::size_t i = 0; i < mask.size(); ++i) mask[i] = field.present(i) && flags.value(i) != 0 ? 1 : 0;
                field.mask = std::make_shared<const Mask>(std::move(mask));
                return field;
            };
        }
    }
    return files;
}

} // namespace tessera::volume
