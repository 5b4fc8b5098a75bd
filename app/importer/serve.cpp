#include "app/importer/serve.h"

#include "app/importer/describe_source.h"
#include "app/importer/frame.h"
#include "app/importer/kept_times.h"
#include "app/importer/open_source.h"
#include "app/importer/readers/check_file.h"
#include "app/importer/readers/vtk_messages.h"
#include "volume/import/files/stream.h"
#include "volume/system/confine.h"
#include "volume/system/free_memory.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <unistd.h>
#include <vtkFieldData.h>

namespace tessera::importer {

namespace {

using volume::Lattice;
using volume::MessageKind;
using volume::ScalarType;

constexpr std::size_t kMostKilobytesKept = 512 * 1024; // of data kept from earlier requests
constexpr const char* kNoMemory = "not enough memory";
constexpr std::chrono::hours kMostTime{1}; // of the processor for one answer

struct OpenFile {
    std::vector<std::string> files; ///< one, or slices of one volume
    std::optional<Source> source;
    std::vector<BlockRef> blocks;
    std::string head; ///< of a mesh whose files need not all be read (meshHead)
};

struct State {
    std::vector<OpenFile> files;
    KeptTimes loaded{kMostKilobytesKept};
    KnownSamplings samplings;
};

void writeAll(const void* bytes, std::size_t size) {
    if (size != 0 && std::fwrite(bytes, 1, size, stdout) != size) std::exit(1); // the reader of the messages has gone
}

void sendMessage(MessageKind kind, const std::string& text) {
    const auto code = static_cast<std::uint32_t>(kind);
    const std::uint64_t length = text.size();
    writeAll(&volume::kStreamMagic, 4);
    writeAll(&code, 4);
    writeAll(&length, 8);
    writeAll(text.data(), text.size());
    std::fflush(stdout);
}

const std::vector<Block>& load(State& state, std::size_t file, int time) {
    if (const std::vector<Block>* const kept = state.loaded.find(file, time)) return *kept;
    OpenFile& opened = state.files[file];
    if (!opened.source) opened.source = openSource(opened.files);
    return state.loaded.add(file, time, readBlocks(*opened.source, time));
}

/// Opens a file and describes it. With `like` the description of the previous file is reused where the header says that
/// the file has the same mesh and arrays, so that only the first file of a long series of meshes is read.
OpenFile openFile(State& state, const std::vector<std::string>& files, bool like) {
    const std::string& path = files.front();
    OpenFile file;
    file.files = files;
    file.source = openSource(files);
    Source& source = *file.source;
    file.blocks = describeImageHeader(source);
    file.head = meshHead(source);
    if (file.blocks.empty() && like && !source.times.empty() && !state.files.empty() && !file.head.empty() &&
        state.files.back().head == file.head) {
        file.blocks = state.files.back().blocks;
        for (BlockRef& ref : file.blocks) {
            ref.block.times = source.times;
            ref.block.quantities.clear();
            std::vector<ArrayRef> none; // arrays are described already
            describeFieldData(fieldDataAlone(path), ref.block, none);
        }
    }
    if (file.blocks.empty()) {
        state.loaded.keepLatest(0);
        for (const std::size_t time : source.shownAt) {
            std::vector<Block> blocks = readBlocks(source, int(time));
            mergeBlocks(file.blocks, describeBlocks(source, blocks));
            state.loaded.add(state.files.size(), int(time), std::move(blocks));
            state.loaded.keepLatest(2);
        }
    }
    bool any = false;
    for (BlockRef& ref : file.blocks) {
        ref.block.file = path;
        ref.block.format = source.format;
        any = any || !ref.arrays.empty();
    }
    if (!any) throw std::runtime_error("holds no array of numbers");
    // Readers keep their data in memory: with many files they are closed, and reopened on request.
    if (state.files.size() > 8) file.source.reset();
    return file;
}

struct Request {
    std::size_t file = 0, block = 0;
    int array = 0, component = 0, time = 0;
    Lattice lattice;
};

Request parseRequest(const std::string& line) {
    std::istringstream in(line);
    std::string word;
    Request r;
    in >> word >> r.file >> r.block >> r.array >> r.component >> r.time;
    r.lattice = volume::parseLatticeWords(in);
    if (!in || word != "frame") throw std::runtime_error("bad request");
    return r;
}

void sendFrame(State& state, const Request& request) {
    if (request.file >= state.files.size()) throw std::runtime_error("no such file in the request");
    OpenFile& file = state.files[request.file];
    if (request.block >= file.blocks.size()) throw std::runtime_error("no such block in the request");
    BlockRef& ref = file.blocks[request.block];
    if (request.array < -1 || request.array >= int(ref.arrays.size()) || request.time < 0 ||
        request.time >= std::max(1, int(ref.block.times.size())))
        throw std::runtime_error("no such array or time in the request");
    const Block* block = blockAt(load(state, request.file, request.time), file.blocks, request.block);
    const Frame frame = frameOf(block, ref, request.array, request.component, request.lattice, state.samplings);
    const std::uint32_t head[2] = {static_cast<std::uint32_t>(frame.type), frame.mask.empty() ? 0u : 1u};
    const auto code = static_cast<std::uint32_t>(MessageKind::Frame);
    const std::uint64_t length = volume::frameBytes(request.lattice, frame.type, !frame.mask.empty());
    writeAll(&volume::kStreamMagic, 4);
    writeAll(&code, 4);
    writeAll(&length, 8);
    writeAll(head, sizeof head);
    const std::int32_t size[3] = {request.lattice.size.x, request.lattice.size.y, request.lattice.size.z};
    writeAll(size, sizeof size);
    writeAll(frame.samples.data(), frame.samples.size());
    writeAll(frame.mask.data(), frame.mask.size());
    std::fflush(stdout);
}

/// Answers a "ranges" request: ranges of an array's values at cells, or at points that a cell uses.
void sendRanges(State& state, const std::string& line) {
    std::istringstream in(line);
    std::string word;
    std::size_t fileIndex = 0, block = 0;
    int arrayIndex = 0, time = 0, between = 0;
    in >> word >> fileIndex >> block >> arrayIndex >> time >> between;
    if (!in || fileIndex >= state.files.size()) throw std::runtime_error("bad request");
    OpenFile& file = state.files[fileIndex];
    if (block >= file.blocks.size() || arrayIndex < 0 || arrayIndex >= int(file.blocks[block].arrays.size()) ||
        time < 0 || time >= std::max(1, int(file.blocks[block].block.times.size())))
        throw std::runtime_error("bad request");
    const BlockRef& ref = file.blocks[block];
    const std::vector<Block>& loaded = load(state, fileIndex, time);
    const ArrayRef& array = ref.arrays[std::size_t(arrayIndex)];
    const Block* at = blockAt(loaded, file.blocks, block);
    vtkDataArray* from = at != nullptr ? findArray(at->data, array) : nullptr;
    sendMessage(MessageKind::Header, rangesJson(at != nullptr ? at->data : nullptr, from, array, between != 0));
}

/// The words of a command line; of "-" those from stdin, each ended by a zero byte, up to an empty one.
std::vector<std::string> wordsGiven(int argc, char** argv) {
    std::vector<std::string> words(argv + 1, argv + argc);
    if (words != std::vector<std::string>{"-"}) return words;
    words.clear();
    for (std::string word; std::getline(std::cin, word, '\0') && !word.empty();) words.push_back(word);
    return words;
}

/// Opens the files and sends the header of each; false where one cannot be opened, which is sent instead.
bool openAll(State& state, const std::vector<std::string>& words) {
    bool like = false;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (words[i] == "--like" || words[i] == "--allow-outside") {
            like = words[i] == "--like";
            if (!like) letNameOutside(volume::Outside::Allowed);
            continue;
        }
        std::vector<std::string> files{words[i]};
        if (words[i] == "--slices" && i + 2 < words.size()) {
            const std::size_t first = i + 2, stated = std::size_t(std::max(std::atoi(words[i + 1].c_str()), 1)),
                              count = std::min(stated, words.size() - first);
            files.assign(words.begin() + std::ptrdiff_t(first), words.begin() + std::ptrdiff_t(first + count));
            i = first + count - 1;
        }
        volume::limitProcessorTime(kMostTime);
        try {
            state.files.push_back(openFile(state, files, like));
            sendMessage(MessageKind::Header, headerJson(state.files.back().blocks));
        } catch (const std::bad_alloc&) {
            sendMessage(MessageKind::Failure, kNoMemory);
            return false;
        } catch (const std::exception& error) {
            sendMessage(MessageKind::Failure, error.what());
            return false;
        }
        like = false;
    }
    return true;
}

} // namespace

int serve(int argc, char** argv) {
    if (argc < 2 || std::string(argv[1]) == "--help") {
        std::fprintf(stderr, "tessera-import [--allow-outside] [--like | --slices N] FILE ...: streams data files to "
                             "tessera, see volume/import/files/stream.h\n");
        return argc < 2 ? 1 : 0;
    }
    // Readers may print to stdout: redirect that to stderr, and send messages to a copy of the original stdout.
    const int out = dup(STDOUT_FILENO);
    dup2(STDERR_FILENO, STDOUT_FILENO);
    stdout = fdopen(out, "wb");
    catchMessages();
    // Files may be damaged or hostile, and readers have errors: they can change nothing and take no more than this.
    volume::confine({.writable = {"/dev/null"}, .memory = volume::machineMemory() / 4 * 3});
    // Names in HDF5 files count from these, not from where the program runs or where others have their files.
    ::setenv("HDF5_EXTFILE_PREFIX", "${ORIGIN}", 1);
    ::setenv("HDF5_VDS_PREFIX", "${ORIGIN}", 1);
    ::unsetenv("HDF5_EXT_PREFIX");
    State state;
    if (!openAll(state, wordsGiven(argc, argv))) return 0;
    for (std::string line; std::getline(std::cin, line);) {
        volume::limitProcessorTime(kMostTime);
        try {
            if (line.starts_with("ranges "))
                sendRanges(state, line);
            else
                sendFrame(state, parseRequest(line));
        } catch (const std::bad_alloc&) {
            sendMessage(MessageKind::Failure, kNoMemory);
        } catch (const std::exception& error) {
            sendMessage(MessageKind::Failure, error.what());
        }
    }
    return 0;
}

} // namespace tessera::importer
