// Crashes while an archive is written. The writes, syncs and renames of packing and appending are recorded; for every
// prefix of them the file is made as a disk may hold it then, with what was not yet synced there, torn, or missing in
// part, and opened: it shows what was there before or a whole later state, and never less than what was synced.
#include "codec/archive/archive.h"
#include "codec/container/container.h"
#include "codec/pack/pack.h"
#include "tests/codec/make_dataset.h"
#include "volume/system/atomic_file.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <gtest/gtest.h>
#include <map>
#include <optional>
#include <set>
#include <sys/stat.h>
#include <unistd.h>

namespace tessera::codec {
namespace {

using namespace testing;
using volume::ScalarType;
using Content = std::vector<char>;

struct Step {
    enum class Kind { Write, Resize, Sync, Rename, SyncFolder } kind = Kind::Sync;
    int file = 0;
    std::size_t offset = 0; ///< of Resize: the size
    Content bytes;          ///< of Write
    std::string name;       ///< of Rename: the new one
};

struct Disk {
    std::map<int, Content> files;
    std::map<std::string, int> names;

    void apply(const Step& step, std::size_t most = std::size_t(-1)) {
        if (step.kind == Step::Kind::Rename) names[step.name] = step.file;
        Content& content = files[step.file];
        if (step.kind == Step::Kind::Resize) content.resize(step.offset);
        if (step.kind != Step::Kind::Write) return;
        const std::size_t count = std::min(most, step.bytes.size());
        if (content.size() < step.offset + count) content.resize(step.offset + count);
        std::copy_n(step.bytes.begin(), count, content.begin() + std::ptrdiff_t(step.offset));
    }
};

/// What a program does to the files of one folder. Bytes that went through a stream are seen at the next call.
class Recorder {
public:
    /// Of a folder, whose name ends with a slash.
    explicit Recorder(const std::string& folder) : folder_(folder, 0, folder.size() - 1) {
        for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
            const int file = int(before_.files.size());
            before_.files[file] = readFile(entry.path().string());
            before_.names[entry.path().string()] = file;
        }
        now_ = before_;
        current = this;
    }
    ~Recorder() { current = nullptr; }
    Recorder(const Recorder&) = delete;
    Recorder& operator=(const Recorder&) = delete;

    /// The file behind a descriptor, with what was written to it since; nothing for one elsewhere or a folder.
    std::optional<int> look(int descriptor) {
        const std::string path = pathOf(descriptor);
        struct stat about {};
        if (path.rfind(folder_ + "/", 0) != 0 || ::fstat(descriptor, &about) != 0 || !S_ISREG(about.st_mode)) return {};
        const int file = now_.names.try_emplace(path, int(now_.files.size())).first->second;
        Content& known = now_.files[file];
        Content is = readFile(path);
        std::size_t same = 0;
        while (same < std::min(known.size(), is.size()) && known[same] == is[same]) ++same;
        EXPECT_LE(known.size(), is.size()) << "a file was cut unseen";
        if (same < is.size()) add({Step::Kind::Write, file, same, {is.begin() + std::ptrdiff_t(same), is.end()}, {}});
        return file;
    }
    void add(Step step) {
        now_.apply(step);
        steps_.push_back(std::move(step));
    }
    void synced(int descriptor) {
        if (const auto file = look(descriptor))
            add({Step::Kind::Sync, *file, 0, {}, {}});
        else if (pathOf(descriptor) == folder_)
            steps_.push_back({Step::Kind::SyncFolder, 0, 0, {}, {}});
    }
    void renamed(const std::string& from, const std::string& to) {
        const auto found = now_.names.find(from);
        if (found == now_.names.end()) return;
        const int file = found->second;
        now_.names.erase(found);
        add({Step::Kind::Rename, file, 0, {}, to});
    }

    const Disk& before() const { return before_; }
    const std::vector<Step>& steps() const { return steps_; }

    static inline Recorder* current = nullptr;

private:
    static std::string pathOf(int descriptor) {
        std::error_code failed;
        return std::filesystem::read_symlink("/proc/self/fd/" + std::to_string(descriptor), failed).string();
    }

    std::string folder_;
    Disk before_, now_;
    std::vector<Step> steps_;
};

} // namespace
} // namespace tessera::codec

// The linker puts these in place of the system's (--wrap), which gives them their names.
// NOLINTBEGIN(bugprone-reserved-identifier)
extern "C" {
int __real_fsync(int descriptor);
int __real_ftruncate(int descriptor, off_t size);
ssize_t __real_pwrite(int descriptor, const void* bytes, std::size_t count, off_t offset);
int __real_rename(const char* from, const char* to);

int __wrap_fsync(int descriptor) {
    using tessera::codec::Recorder;
    if (Recorder::current) Recorder::current->synced(descriptor);
    return __real_fsync(descriptor);
}
int __wrap_ftruncate(int descriptor, off_t size) {
    using namespace tessera::codec;
    const auto file = Recorder::current ? Recorder::current->look(descriptor) : std::nullopt;
    if (file) Recorder::current->add({Step::Kind::Resize, *file, std::size_t(size), {}, {}});
    return __real_ftruncate(descriptor, size);
}
ssize_t __wrap_pwrite(int descriptor, const void* bytes, std::size_t count, off_t offset) {
    using namespace tessera::codec;
    const auto file = Recorder::current ? Recorder::current->look(descriptor) : std::nullopt;
    const char* const from = static_cast<const char*>(bytes);
    if (file) Recorder::current->add({Step::Kind::Write, *file, std::size_t(offset), {from, from + count}, {}});
    return __real_pwrite(descriptor, bytes, count, offset);
}
int __wrap_rename(const char* from, const char* to) {
    using tessera::codec::Recorder;
    if (Recorder::current) Recorder::current->renamed(from, to);
    return __real_rename(from, to);
}
}
// NOLINTEND(bugprone-reserved-identifier)

namespace tessera::codec {
namespace {

/// Calls `visit(step, disk, isLeast)` for what the disk may hold when that many steps are done; isLeast: with nothing
/// that was not synced, which comes first.
template <class Visit> void forCrashes(const Recorder& recorder, const Visit& visit) {
    Disk synced = recorder.before();
    std::vector<const Step*> pending; // may be on the disk or not
    const auto with = [&](auto&& wanted) {
        Disk disk = synced;
        for (std::size_t i = 0; i < pending.size(); ++i)
            if (const std::size_t most = wanted(i)) disk.apply(*pending[i], most);
        return disk;
    };
    static constexpr std::size_t kAll = std::size_t(-1);
    for (std::size_t done = 0; done <= recorder.steps().size(); ++done) {
        visit(done, synced, true);
        const std::size_t count = pending.size(), last = count - 1;
        for (std::size_t one = 0; one < count; ++one) {
            visit(done, with([&](std::size_t i) { return i == one ? kAll : 0; }), false);
            visit(done, with([&](std::size_t i) { return i == one ? 0 : kAll; }), false);
        }
        visit(done, with([](std::size_t) { return kAll; }), false);
        if (count > 0 && pending.back()->kind == Step::Kind::Write) {
            const std::size_t bytes = pending.back()->bytes.size();
            for (std::size_t torn = 1; torn < bytes; torn += std::max<std::size_t>(1, bytes / 12)) {
                visit(done, with([&](std::size_t i) { return i == last ? torn : kAll; }), false);
                visit(done, with([&](std::size_t i) { return i == last ? torn : 0; }), false);
            }
        }
        if (done == recorder.steps().size()) break;
        const Step& step = recorder.steps()[done];
        using Kind = Step::Kind;
        if (step.kind != Kind::Sync && step.kind != Kind::SyncFolder) {
            pending.push_back(&step);
            continue;
        }
        std::vector<const Step*> left;
        for (const Step* before : pending) {
            const bool ofName = before->kind == Kind::Rename;
            const bool lasts = step.kind == Kind::SyncFolder ? ofName : !ofName && before->file == step.file;
            if (lasts)
                synced.apply(*before);
            else
                left.push_back(before);
        }
        pending = std::move(left);
    }
}

/// Everything an archive shows; times after each other.
struct Shown {
    std::vector<std::string> parameters;
    std::vector<std::string> times; ///< and their samples, as bytes
    bool operator==(const Shown&) const = default;
};

Shown shownBy(const std::string& path) {
    const Archive archive(path);
    for (const std::string& line : verifyArchive(archive).damage)
        EXPECT_NE(line.find("one of its two copies"), std::string::npos) << line;
    Shown shown;
    for (const volume::Parameter& parameter : archive.info().parameters) shown.parameters.push_back(parameter.name);
    for (std::size_t t = 0; t < archive.info().times.size(); ++t) {
        std::string& bytes = shown.times.emplace_back(std::to_string(archive.info().times[t]));
        for (std::size_t p = 0; p < shown.parameters.size(); ++p)
            for (int c = 0; c < archive.info().parameters[p].components; ++c) {
                const volume::Field field = readField(archive, int(p), c, int(t));
                const auto* const samples = reinterpret_cast<const char*>(field.samples.data());
                bytes.append(samples, samples + field.samples.size());
                if (field.mask) bytes.append(field.mask->begin(), field.mask->end());
            }
    }
    return shown;
}

struct Crashes {
    std::set<int> states; ///< that were met, by their place among those allowed; -1: no file
    int last = -1;        ///< what is on the disk for certain at the end
};

/// Opens what every crash leaves at `path`: nothing at all where nothing was, else one of the states, which come one
/// after the other.
Crashes crashesOf(const Recorder& recorder, const std::string& path, const std::vector<Shown>& states) {
    const TemporaryFolder folder;
    const std::string crashed = folder / "crashed.tsr";
    std::map<Content, int> known;
    Crashes crashes;
    int least = -1;
    forCrashes(recorder, [&](std::size_t done, const Disk& disk, bool isLeast) {
        int state = -1;
        if (const auto name = disk.names.find(path); name != disk.names.end()) {
            const Content& content = disk.files.at(name->second);
            const auto found = known.find(content);
            if (found == known.end()) {
                writeFile(crashed, content);
                try {
                    const auto same = std::find(states.begin(), states.end(), shownBy(crashed));
                    EXPECT_NE(same, states.end()) << "another state after step " << done;
                    state = int(same - states.begin());
                } catch (const Error& error) {
                    ADD_FAILURE() << "after step " << done << ": " << error.what();
                }
                known.emplace(content, state);
            } else {
                state = found->second;
            }
        }
        EXPECT_GE(state, least) << "what was synced is lost after step " << done;
        if (isLeast) least = crashes.last = state;
        crashes.states.insert(state);
    });
    return crashes;
}

/// Noise that does not pack: whole times of it are worth a commit each.
volume::Dataset crashNoise(int firstTime, int times, const char* name = "T") {
    volume::Dataset made = makeDataset({30, 30, 31}, {{name, ScalarType::F32, 1, Texture::Noise, false, false}}, times);
    for (double& time : made.info.times) time += 0.5 * firstTime;
    made.read = [read = made.read, firstTime, name](int p, int c, int t) {
        volume::Field field = read(p, c, t + firstTime);
        if (name[0] != 'T') field.as<float>()[0] += 1;
        return field;
    };
    return made;
}

/// The first times of what is shown.
Shown firstTimes(const Shown& all, std::size_t times) {
    return {all.parameters, {all.times.begin(), all.times.begin() + std::ptrdiff_t(times)}};
}

PackOptions crashOptions() {
    PackOptions options;
    options.lattice = StoredLattice::CC;
    options.brickSize = 16;
    return options;
}

class Crash : public ::testing::Test {
protected:
    void pack(volume::Dataset made) { codec::pack(made, crashOptions(), path); }
    void append(volume::Dataset made) { codec::append(made, path); }

    TemporaryFolder folder;
    std::string path = folder / "a.tsr";
};

TEST_F(Crash, OfPackingLeavesWholeTimes) {
    const Recorder recorder(folder / "");
    pack(crashNoise(0, 3));
    const Shown all = shownBy(path);
    ASSERT_EQ(all.times.size(), 3u);
    const Crashes crashes = crashesOf(recorder, path, {firstTimes(all, 1), firstTimes(all, 2), all});
    EXPECT_EQ(crashes.states, (std::set<int>{-1, 0, 1, 2}));
    EXPECT_EQ(crashes.last, 2);
}

TEST_F(Crash, OfPackingOverAnArchiveLeavesThatOrTheNewOne) {
    pack(crashNoise(5, 1));
    const Shown old = shownBy(path);
    const Recorder recorder(folder / "");
    pack(crashNoise(0, 2));
    const Crashes crashes = crashesOf(recorder, path, {old, shownBy(path)});
    EXPECT_EQ(crashes.states, (std::set<int>{0, 1}));
    EXPECT_EQ(crashes.last, 1);
}

TEST_F(Crash, OfAppendingTimesLeavesWholeOnes) {
    pack(crashNoise(0, 1));
    const Recorder recorder(folder / "");
    append(crashNoise(1, 2));
    const Shown all = shownBy(path);
    ASSERT_EQ(all.times.size(), 3u);
    const Crashes crashes = crashesOf(recorder, path, {firstTimes(all, 1), firstTimes(all, 2), all});
    EXPECT_EQ(crashes.states, (std::set<int>{0, 1, 2}));
    EXPECT_EQ(crashes.last, 2);
}

TEST_F(Crash, OfAppendingAParameterLeavesAllOfItOrNothing) {
    pack(crashNoise(0, 2));
    const Shown old = shownBy(path);
    const Recorder recorder(folder / "");
    append(crashNoise(0, 2, "U"));
    const Shown all = shownBy(path);
    ASSERT_EQ(all.parameters, (std::vector<std::string>{"T", "U"}));
    const Crashes crashes = crashesOf(recorder, path, {old, all});
    EXPECT_EQ(crashes.states, (std::set<int>{0, 1}));
    EXPECT_EQ(crashes.last, 1);
}

TEST_F(Crash, OfAppendingThatFailedKeepsTheTimesBefore) {
    pack(crashNoise(0, 1));
    const Recorder recorder(folder / "");
    volume::Dataset made = crashNoise(1, 3);
    made.read = [read = made.read](int p, int c, int t) {
        if (t == 1) throw Error("truncated", "x.raw");
        return read(p, c, t);
    };
    EXPECT_THROW(append(made), Error);
    const Shown all = shownBy(path);
    ASSERT_EQ(all.times.size(), 2u);
    const Crashes crashes = crashesOf(recorder, path, {firstTimes(all, 1), all});
    EXPECT_EQ(crashes.states, (std::set<int>{0, 1}));
    EXPECT_EQ(crashes.last, 1);
}

// Sessions, autosaves, exports: whatever is written as a whole.
TEST_F(Crash, OfAFileWrittenAsAWholeLeavesTheOldOneOrTheNew) {
    const std::string old(100, 'a'), now(3000, 'b');
    writeAtomically(path, old);
    const Recorder recorder(folder / "");
    writeAtomically(path, now);
    std::set<std::string> seen;
    std::string last;
    forCrashes(recorder, [&](std::size_t, const Disk& disk, bool isLeast) {
        const Content& content = disk.files.at(disk.names.at(path));
        seen.emplace(content.begin(), content.end());
        if (isLeast) last.assign(content.begin(), content.end());
    });
    EXPECT_EQ(seen, (std::set<std::string>{old, now}));
    EXPECT_EQ(last, now) << "it is on the disk when writing it returns";
}

// A crash left either copy of the header torn, and bytes behind the end: the next one must not take the other copy.
TEST_F(Crash, OfAppendingAfterACrashLeavesWholeTimes) {
    for (const std::size_t copy : {0u, 1u}) {
        std::filesystem::remove(path);
        pack(crashNoise(0, 1));
        Content bytes = readFile(path);
        std::fill_n(bytes.begin() + std::ptrdiff_t(copy * kHeaderBytes + 20), 30, char(0x55));
        bytes.insert(bytes.end(), 5000, char(0x77));
        writeFile(path, bytes);
        const Recorder recorder(folder / "");
        append(crashNoise(1, 1));
        const Shown all = shownBy(path);
        ASSERT_EQ(all.times.size(), 2u);
        const Crashes crashes = crashesOf(recorder, path, {firstTimes(all, 1), all});
        EXPECT_EQ(crashes.states, (std::set<int>{0, 1})) << copy;
        EXPECT_EQ(crashes.last, 1) << copy;
    }
}

} // namespace
} // namespace tessera::codec
