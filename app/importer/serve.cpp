#include "app/importer/serve.h"

#include "app/importer/describe_source.h"
#include "app/importer/open_source.h"
#include "app/importer/readers/vtk_messages.h"
#include "app/importer/sampler.h"
#include "volume/import/files/stream.h"
#include "volume/system/confine.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <iostream>
#include <list>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <unistd.h>
#include <vtkCellData.h>
#include <vtkCellDataToPointData.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkTypeTraits.h>

namespace tessera::importer {

namespace {

using volume::Lattice;
using volume::MessageKind;
using volume::ScalarType;

constexpr std::size_t kMostKilobytesKept = 512 * 1024; // of data kept from earlier requests
constexpr std::size_t kMostSamplings = 64;
constexpr const char* kNoMemory = "not enough memory";
constexpr std::chrono::hours kMostTime{1}; // of the processor for one answer

struct OpenFile {
    std::vector<std::string> files; ///< one, or slices of one volume
    std::optional<Source> source;
    std::vector<BlockRef> blocks;
};

/// The blocks of a file at one time.
struct Loaded {
    std::size_t file;
    int time;
    std::vector<Block> blocks;
    std::size_t kilobytes;
    std::map<std::size_t, vtkSmartPointer<vtkDataSet>> smoothed; ///< by block: with cell values averaged to points
};

struct State {
    std::vector<OpenFile> files;
    std::list<Loaded> loaded; ///< most recent first
    struct KnownSampling {
        std::uint64_t mesh;
        Lattice lattice;
        std::shared_ptr<const Sampling> sampling;
    };
    std::list<KnownSampling> samplings; ///< most recent first
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

std::size_t kilobytesOf(const std::vector<Block>& blocks) {
    std::size_t sum = 0;
    for (const Block& block : blocks) sum += block.data->GetActualMemorySize();
    return sum;
}

Loaded& load(State& state, std::size_t file, int time) {
    for (auto at = state.loaded.begin(); at != state.loaded.end(); ++at)
        if (at->file == file && at->time == time) {
            state.loaded.splice(state.loaded.begin(), state.loaded, at);
            return state.loaded.front();
        }
    OpenFile& opened = state.files[file];
    if (!opened.source) opened.source = openSource(opened.files);
    Loaded now{file, time, readBlocks(*opened.source, time), 0, {}};
    now.kilobytes = kilobytesOf(now.blocks);
    std::size_t kept = now.kilobytes;
    for (auto at = state.loaded.begin(); at != state.loaded.end();) {
        kept += at->kilobytes;
        at = kept > kMostKilobytesKept ? state.loaded.erase(at) : std::next(at);
    }
    state.loaded.push_front(std::move(now));
    return state.loaded.front();
}

/// Opens a file and describes it. With `like` the description of the previous file is reused if possible, so that only
/// the first file of a long series of meshes is read.
OpenFile openFile(State& state, const std::vector<std::string>& files, bool like) {
    const std::string& path = files.front();
    OpenFile file;
    file.files = files;
    file.source = openSource(files);
    Source& source = *file.source;
    file.blocks = describeImageHeader(source);
    if (file.blocks.empty() && like && !source.times.empty() && !state.files.empty() &&
        !state.files.back().blocks.empty() && source.format != "OpenFOAM" && source.format != "EnSight" &&
        source.format != "NetCDF" &&
        (source.format == "vtu" || state.files.back().blocks.front().block.quantities.empty())) {
        file.blocks = state.files.back().blocks;
        for (BlockRef& ref : file.blocks) {
            ref.block.times = source.times;
            ref.block.quantities.clear();
            std::vector<ArrayRef> none; // arrays are described already
            if (source.format == "vtu") describeFieldData(fieldDataAlone(path), ref.block, none);
        }
    }
    if (file.blocks.empty()) {
        const std::vector<Block> blocks = readBlocks(source, 0);
        file.blocks = describeBlocks(source, blocks);
        Loaded now{state.files.size(), 0, blocks, kilobytesOf(blocks), {}};
        while (!state.loaded.empty()) state.loaded.pop_back();
        state.loaded.push_front(std::move(now));
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

/// FNV-1a hash of a mesh: its points and its number of cells.
std::uint64_t meshHash(vtkDataSet* mesh) {
    std::uint64_t hash = 1469598103934665603ull;
    const auto mix = [&](double value) {
        std::uint64_t bits = 0;
        std::memcpy(&bits, &value, sizeof bits);
        hash = (hash ^ bits) * 1099511628211ull;
    };
    mix(double(mesh->GetNumberOfCells()));
    mix(double(mesh->GetNumberOfPoints()));
    for (vtkIdType p = 0; p < mesh->GetNumberOfPoints(); ++p) {
        double x[3];
        mesh->GetPoint(p, x);
        for (const double coordinate : x) mix(coordinate);
    }
    return hash;
}

std::shared_ptr<const Sampling> samplingOf(State& state, vtkDataSet* mesh, const Lattice& lattice) {
    const std::uint64_t hash = meshHash(mesh);
    for (auto at = state.samplings.begin(); at != state.samplings.end(); ++at)
        if (at->mesh == hash && at->lattice == lattice) {
            state.samplings.splice(state.samplings.begin(), state.samplings, at);
            return state.samplings.front().sampling;
        }
    state.samplings.push_front({hash, lattice, makeSampling(mesh, lattice)});
    if (state.samplings.size() > kMostSamplings) state.samplings.pop_back();
    return state.samplings.front().sampling;
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
    in >> r.lattice.size.x >> r.lattice.size.y >> r.lattice.size.z;
    in >> r.lattice.origin.x >> r.lattice.origin.y >> r.lattice.origin.z;
    in >> r.lattice.spacing.x >> r.lattice.spacing.y >> r.lattice.spacing.z;
    if (!in || word != "frame") throw std::runtime_error("bad request");
    return r;
}

/// Copies the samples of an image on its own grid.
template <class T>
void copyArray(vtkDataArray* array, int component, double scale, double offset, std::vector<T>& values) {
    const int components = array->GetNumberOfComponents();
    if (array->GetDataType() == vtkTypeTraits<T>::VTK_TYPE_ID && scale == 1 && offset == 0 &&
        array->HasStandardMemoryLayout()) {
        const T* from = static_cast<const T*>(array->GetVoidPointer(0)) + component;
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = from[i * std::size_t(components)];
        return;
    }
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = static_cast<T>(offset + scale * array->GetComponent(vtkIdType(i), component));
}

/// vtkValidPointMask and hidden ghosts of a grid's points; empty when all are valid.
std::vector<std::uint8_t> validMask(vtkDataSetAttributes* data, std::size_t count) {
    std::vector<std::uint8_t> mask;
    if (vtkDataArray* valid = data->GetArray("vtkValidPointMask"); valid != nullptr) {
        mask.resize(count);
        for (std::size_t i = 0; i < count; ++i) mask[i] = valid->GetComponent(vtkIdType(i), 0) != 0 ? 1 : 0;
    }
    if (vtkDataArray* ghosts = data->GetArray("vtkGhostType"); ghosts != nullptr) {
        if (mask.empty()) mask.assign(count, 1);
        constexpr int kHidden = int(vtkDataSetAttributes::HIDDENPOINT) | int(vtkDataSetAttributes::HIDDENCELL);
        for (std::size_t i = 0; i < count; ++i)
            if ((int(ghosts->GetComponent(vtkIdType(i), 0)) & kHidden) != 0) mask[i] = 0;
    }
    return mask;
}

void sendFrame(State& state, const Request& request) {
    if (request.file >= state.files.size()) throw std::runtime_error("no such file in the request");
    OpenFile& file = state.files[request.file];
    if (request.block >= file.blocks.size()) throw std::runtime_error("no such block in the request");
    BlockRef& ref = file.blocks[request.block];
    if (request.array < -1 || request.array >= int(ref.arrays.size()) || request.time < 0 ||
        request.time >= std::max(1, int(ref.block.times.size())))
        throw std::runtime_error("no such array or time in the request");
    Loaded& loaded = load(state, request.file, request.time);
    if (request.block >= loaded.blocks.size() || loaded.blocks[request.block].name != ref.block.name)
        throw std::runtime_error("has other blocks at this time or in this file of the series");
    vtkDataSet* data = loaded.blocks[request.block].data;
    const ArrayRef* array = request.array < 0 ? nullptr : &ref.arrays[std::size_t(request.array)];
    vtkDataArray* from = nullptr;
    if (array != nullptr) {
        from = findArray(data, *array);
        if (from == nullptr || from->GetNumberOfComponents() <= array->firstComponent + request.component)
            throw std::runtime_error("array \"" + array->vtkName + "\" is missing in this file or at this time");
    }
    const ScalarType type = array != nullptr ? array->form.type : ScalarType::U8;
    const int component = array != nullptr ? array->firstComponent + request.component : 0;
    const std::size_t count = request.lattice.count();
    std::vector<std::byte> samples(count * volume::byteSize(type));
    std::vector<std::uint8_t> mask;

    const bool direct = !ref.block.mesh && request.lattice == ref.block.lattice;
    if (direct) {
        vtkDataSetAttributes* attributes = data->GetPointData();
        if (array != nullptr && array->ofCells) attributes = data->GetCellData();
        if (from != nullptr && std::size_t(from->GetNumberOfTuples()) != count)
            throw std::runtime_error("array \"" + array->vtkName + "\" has another size than the grid");
        volume::dispatch(type, [&]<class T>(T) {
            std::vector<T> values(count, T{1});
            if (from != nullptr) copyArray(from, component, ref.scale, ref.offset, values);
            std::memcpy(samples.data(), values.data(), samples.size());
        });
        mask = validMask(attributes, count);
    } else {
        const std::shared_ptr<const Sampling> sampling = samplingOf(state, data, request.lattice);
        mask.resize(count);
        for (std::size_t i = 0; i < count; ++i) mask[i] = sampling->cells[i] >= 0 ? 1 : 0;
        if (from == nullptr) {
            std::fill(samples.begin(), samples.end(), std::byte{1});
        } else if (array->ofCells && type == ScalarType::F32) {
            vtkSmartPointer<vtkDataSet>& smoothed = loaded.smoothed[request.block];
            if (smoothed == nullptr) {
                vtkNew<vtkCellDataToPointData> filter;
                filter->SetInputData(data);
                filter->Update();
                smoothed = vtkDataSet::SafeDownCast(filter->GetOutputDataObject(0));
                throwReported();
            }
            vtkDataArray* points = smoothed->GetPointData()->GetArray(array->vtkName.c_str());
            if (points == nullptr) throw std::runtime_error("array \"" + array->vtkName + "\" cannot be interpolated");
            sampleCells(smoothed, *sampling, from, points, component, reinterpret_cast<float*>(samples.data()));
        } else {
            sampleArray(data, *sampling, from, array->ofCells, component, type, samples.data());
        }
    }
    const std::uint32_t head[2] = {static_cast<std::uint32_t>(type), mask.empty() ? 0u : 1u};
    const auto code = static_cast<std::uint32_t>(MessageKind::Frame);
    const std::uint64_t length = volume::frameBytes(request.lattice, type, !mask.empty());
    writeAll(&volume::kStreamMagic, 4);
    writeAll(&code, 4);
    writeAll(&length, 8);
    writeAll(head, sizeof head);
    const std::int32_t size[3] = {request.lattice.size.x, request.lattice.size.y, request.lattice.size.z};
    writeAll(size, sizeof size);
    writeAll(samples.data(), samples.size());
    writeAll(mask.data(), mask.size());
    std::fflush(stdout);
}

/// Answers a "ranges" request: ranges of an array's values at cells, or at points that a cell uses.
void sendRanges(State& state, const std::string& line) {
    std::istringstream in(line);
    std::string word;
    std::size_t fileIndex = 0, block = 0;
    int arrayIndex = 0, time = 0;
    in >> word >> fileIndex >> block >> arrayIndex >> time;
    if (!in || fileIndex >= state.files.size()) throw std::runtime_error("bad request");
    OpenFile& file = state.files[fileIndex];
    if (block >= file.blocks.size() || arrayIndex < 0 || arrayIndex >= int(file.blocks[block].arrays.size()) ||
        time < 0 || time >= std::max(1, int(file.blocks[block].block.times.size())))
        throw std::runtime_error("bad request");
    const BlockRef& ref = file.blocks[block];
    Loaded& loaded = load(state, fileIndex, time);
    if (block >= loaded.blocks.size() || loaded.blocks[block].name != ref.block.name)
        throw std::runtime_error("has other blocks at this time or in this file of the series");
    const ArrayRef& array = ref.arrays[std::size_t(arrayIndex)];
    vtkDataArray* from = findArray(loaded.blocks[block].data, array);
    if (from == nullptr || from->GetNumberOfComponents() < array.firstComponent + array.form.components)
        throw std::runtime_error("array \"" + array.vtkName + "\" is missing in this file or at this time");
    sendMessage(MessageKind::Header, rangesJson(loaded.blocks[block].data, from, array));
}

} // namespace

int serve(int argc, char** argv) {
    if (argc < 2 || std::string(argv[1]) == "--help") {
        std::fprintf(stderr, "tessera-import [--like | --slices N] FILE ...: streams data files to tessera, see "
                             "volume/import/files/stream.h\n");
        return argc < 2 ? 1 : 0;
    }
    // Readers may print to stdout: redirect that to stderr, and send messages to a copy of the original stdout.
    const int out = dup(STDOUT_FILENO);
    dup2(STDERR_FILENO, STDOUT_FILENO);
    stdout = fdopen(out, "wb");
    catchMessages();
    // Files may be damaged or hostile, and readers have errors: they can change nothing and take no more than this.
    volume::confine({.writable = {"/dev/null"}, .memory = volume::machineMemory() / 4 * 3});
    State state;
    bool like = false;
    for (int i = 1; i < argc; ++i) {
        if (std::string(argv[i]) == "--like") {
            like = true;
            continue;
        }
        std::vector<std::string> files{argv[i]};
        if (std::string(argv[i]) == "--slices" && i + 2 < argc) {
            const int first = i + 2, count = std::min(std::atoi(argv[i + 1]), argc - first);
            files.assign(argv + first, argv + first + std::max(count, 1));
            i = first + std::max(count, 1) - 1;
        }
        volume::limitProcessorTime(kMostTime);
        try {
            state.files.push_back(openFile(state, files, like));
            sendMessage(MessageKind::Header, headerJson(state.files.back().blocks));
        } catch (const std::bad_alloc&) {
            sendMessage(MessageKind::Failure, kNoMemory);
            return 0;
        } catch (const std::exception& error) {
            sendMessage(MessageKind::Failure, error.what());
            return 0;
        }
        like = false;
    }
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
