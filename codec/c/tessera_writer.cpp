#include "codec/c/tessera_writer.h"

#include "codec/archive/archive.h"
#include "codec/pack/pack.h"
#include "volume/base/error.h"
#include "volume/base/number_text.h"
#include "volume/base/utf8.h"
#include "volume/field/own_axes.h"
#include "volume/field/slices.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <new>

/// The library `tessera_writer`: what a solver in C calls.
struct tessera_writer {
    std::string path;
    tessera::volume::DatasetInfo info; ///< as every time to append has it, without times
    std::vector<int> numbers;          ///< of the arrays, by parameter
    tessera::codec::PackOptions options;
    bool grows = false; ///< the archive exists and is continued
    long times = 0;
    double lastTime = 0;
};

namespace tessera::codec {

namespace {

using volume::Field;
using volume::SliceRange;

constexpr int kBadInput = 2, kMachineFailed = 3;

/// Of a thread; no allocation, since that may be what failed.
thread_local char lastError[1024] = "";

int failed(int status, const char* reason) {
    std::snprintf(lastError, sizeof lastError, "%s", reason);
    return status;
}

/// Runs `work`; no exception leaves it. Returns 0 or the kind of failure.
template <class Work> int guarded(Work&& work) noexcept {
    lastError[0] = '\0';
    try {
        work();
        return 0;
    } catch (const MachineError& error) {
        return failed(kMachineFailed, error.what());
    } catch (const Error& error) {
        return failed(kBadInput, error.what());
    } catch (const std::bad_alloc&) {
        return failed(kMachineFailed, "not enough memory");
    } catch (const std::exception& error) {
        return failed(kMachineFailed, error.what());
    } catch (...) {
        return failed(kMachineFailed, "an unknown failure");
    }
}

/// A text of the caller. An archive holds UTF-8 only, so that another one would not be the same when it is continued.
std::string textOr(const char* text, const char* otherwise, const std::string& path) {
    const std::string given = text != nullptr ? text : otherwise;
    if (!isUtf8(given)) throw Error("a name or a unit is not UTF-8: " + fromLatin(given), path);
    return given;
}

/// The planes of an axis of `size` samples; null for an even one.
std::shared_ptr<const volume::AxisMap> axisOf(const tessera_axes* axes, int axis, int size, const std::string& path) {
    const double* planes = axes != nullptr ? axes->planes[axis] : nullptr;
    if (planes == nullptr) return nullptr;
    const std::string place = std::string("axes, ") + "xyz"[axis];
    const int of = axes->of[axis];
    if (of != TESSERA_CELLS && of != TESSERA_POINTS)
        throw Error("the planes are neither TESSERA_CELLS nor TESSERA_POINTS", path, place);
    try {
        return std::make_shared<const volume::AxisMap>(
            of == TESSERA_CELLS ? volume::AxisMap::Of::Cells : volume::AxisMap::Of::Points,
            std::vector<double>(planes, planes + size + (of == TESSERA_CELLS ? 1 : 0)));
    } catch (const Error& error) {
        throw Error(error.reason(), path, place);
    }
}

volume::Lattice latticeOf(const tessera_grid& grid, const tessera_axes* axes, const std::string& path) {
    volume::Lattice lattice;
    volume::AxisMaps maps;
    for (int axis = 0; axis < 3; ++axis) {
        constexpr int kMost = 1 << 20;
        if (grid.size[axis] < 1 || grid.size[axis] > kMost)
            throw Error("a size is " + std::to_string(grid.size[axis]) + " samples", path, "grid");
        lattice.size[axis] = grid.size[axis];
        maps.of[std::size_t(axis)] = axisOf(axes, axis, grid.size[axis], path);
        if (maps[axis]) continue;
        if (!(grid.spacing[axis] > 0) || !std::isfinite(grid.spacing[axis]) || !std::isfinite(grid.origin[axis]))
            throw Error("the spacing must be greater than 0, and all lengths finite", path, "grid");
        lattice.spacing[axis] = grid.spacing[axis];
        lattice.origin[axis] = grid.origin[axis];
    }
    return volume::withAxes(lattice, std::move(maps));
}

void addParameter(tessera_writer& writer, const tessera_parameter& given) {
    volume::Parameter parameter;
    parameter.name = textOr(given.name, "", writer.path);
    parameter.unit = textOr(given.unit, "", writer.path);
    parameter.components = given.components == 0 ? 1 : given.components;
    if (parameter.name.empty()) throw Error("a parameter has no name", writer.path);
    if (std::ranges::find(writer.info.parameters, parameter.name, &volume::Parameter::name) !=
        writer.info.parameters.end())
        throw Error("two parameters have this name", writer.path, parameter.name);
    if (parameter.components != 1 && parameter.components != 3)
        throw Error("has " + std::to_string(given.components) + " components, not 1 or 3", writer.path, parameter.name);
    if (given.type != TESSERA_FLOAT && given.type != TESSERA_DOUBLE)
        throw Error("is neither TESSERA_FLOAT nor TESSERA_DOUBLE", writer.path, parameter.name);
    writer.info.parameters.push_back(std::move(parameter));
    writer.numbers.push_back(given.type);
}

PackOptions optionsOf(const tessera_grid& grid, const std::string& path) {
    if (!(grid.max_error >= 0 && grid.max_error < 1))
        throw Error("max_error is " + exactText(grid.max_error) + ", not from 0 to below 1", path);
    if (!(grid.memory_mb >= 0)) throw Error("memory_mb must not be negative", path);
    if (grid.lattice != TESSERA_CC && grid.lattice != TESSERA_BCC)
        throw Error("the lattice is neither TESSERA_CC nor TESSERA_BCC", path);
    PackOptions options;
    options.lattice = grid.lattice == TESSERA_CC ? StoredLattice::CC : StoredLattice::BCC;
    options.maxError = grid.max_error;
    options.lossless = grid.max_error == 0;
    options.memoryMb = grid.memory_mb;
    return options;
}

/// Requires that an archive fits the arguments as far as they tell; the rest is found by the first append.
void continueArchive(tessera_writer& writer) {
    const Archive archive(writer.path);
    const Metadata& metadata = archive.metadata();
    PackOptions given = writer.options;
    given.memoryMb = 0;
    if (metadata.options != given) throw Error("was packed with another lattice or error bound", writer.path);
    if (metadata.source.size != writer.info.lattice.size || !(metadata.source.axes == writer.info.lattice.axes))
        throw Error("has another grid", writer.path);
    const auto same = [](const volume::Parameter& a, const volume::Parameter& b) {
        return a.name == b.name && a.unit == b.unit && a.components == b.components && a.type == b.type;
    };
    if (!std::ranges::equal(metadata.info.parameters, writer.info.parameters, same))
        throw Error("has other parameters", writer.path);
    writer.grows = true;
    writer.times = long(metadata.info.times.size());
    writer.lastTime = metadata.info.times.back();
}

std::unique_ptr<tessera_writer> opened(const char* path, const tessera_grid* grid, const tessera_axes* axes,
                                       const tessera_parameter* parameters, int count) {
    if (path == nullptr || *path == '\0') throw Error("no path is given");
    if (grid == nullptr) throw Error("no grid is given", path);
    if (parameters == nullptr || count < 1) throw Error("no parameter is given", path);
    auto writer = std::make_unique<tessera_writer>();
    writer->path = path;
    volume::DatasetInfo& info = writer->info;
    info.lattice = latticeOf(*grid, axes, path);
    info.bounds = volume::gridBounds(info.lattice);
    info.lengthUnit = textOr(grid->length_unit, "", path);
    info.timeUnit = textOr(grid->time_unit, "s", path);
    info.name = textOr(grid->name, "", path);
    if (info.name.empty()) info.name = std::filesystem::path(path).stem().string();
    for (int p = 0; p < count; ++p) addParameter(*writer, parameters[p]);
    writer->options = optionsOf(*grid, path);
    if (grid->continues != 0 && std::filesystem::exists(path)) continueArchive(*writer);
    return writer;
}

/// Some slices of one component; samples that are not finite are absent.
template <class T>
Field fieldOf(const T* array, const volume::Parameter& parameter, int component, const volume::Lattice& lattice,
              SliceRange slices, const std::string& path) {
    Field field = volume::makeField(volume::slicesOf(lattice, slices), volume::ScalarType::F32);
    const std::size_t perSlice = std::size_t(lattice.size.x) * std::size_t(lattice.size.y);
    const auto stride = std::size_t(parameter.components);
    const T* from = array + std::size_t(slices.first) * perSlice * stride + std::size_t(component);
    volume::Mask mask(field.count(), 1);
    bool gaps = false;
    const auto samples = field.as<float>();
    for (std::size_t i = 0; i < samples.size(); ++i, from += stride) {
        samples[i] = static_cast<float>(*from);
        if (std::isfinite(samples[i])) continue;
        if (std::isfinite(*from))
            throw Error(exactText(double(*from)) + " is too large for a float", path, parameter.name);
        mask[i] = 0;
        gaps = true;
    }
    if (gaps) field.mask = std::make_shared<const volume::Mask>(std::move(mask));
    return field;
}

void appendTime(tessera_writer* writer, double time, const void* const* arrays) {
    if (writer == nullptr) throw Error("no writer is given");
    const std::string& path = writer->path;
    if (!std::isfinite(time)) throw Error("the time is not a finite number", path);
    if (writer->times > 0 && !(time > writer->lastTime))
        throw Error("time " + exactText(time) + " is not after the last one, " + exactText(writer->lastTime), path);
    volume::Dataset data;
    data.info = writer->info;
    data.info.times = {time};
    if (arrays == nullptr) throw Error("no arrays are given", path);
    for (std::size_t p = 0; p < data.info.parameters.size(); ++p)
        if (arrays[p] == nullptr) throw Error("no array is given", path, data.info.parameters[p].name);
    data.read = [&](int parameter, int component, int, SliceRange slices) {
        const auto p = std::size_t(parameter);
        const auto read = [&]<class T>(const T* array) {
            return fieldOf(array, writer->info.parameters[p], component, writer->info.lattice, slices, path);
        };
        return writer->numbers[p] == TESSERA_FLOAT ? read(static_cast<const float*>(arrays[p]))
                                                   : read(static_cast<const double*>(arrays[p]));
    };
    if (writer->grows)
        append(data, path, writer->options.memoryMb);
    else
        pack(data, writer->options, path, {}, {.ofSeries = true});
    writer->grows = true;
    writer->lastTime = time;
    ++writer->times;
}

} // namespace

} // namespace tessera::codec

tessera_writer* tessera_writer_open(const char* path, const tessera_grid* grid, const tessera_parameter* parameters,
                                    int parameter_count) {
    return tessera_writer_open_axes(path, grid, nullptr, parameters, parameter_count);
}

tessera_writer* tessera_writer_open_axes(const char* path, const tessera_grid* grid, const tessera_axes* axes,
                                         const tessera_parameter* parameters, int parameter_count) {
    std::unique_ptr<tessera_writer> writer;
    tessera::codec::guarded([&] { writer = tessera::codec::opened(path, grid, axes, parameters, parameter_count); });
    return writer.release();
}

int tessera_writer_append(tessera_writer* writer, double time, const void* const* arrays) {
    return tessera::codec::guarded([&] { tessera::codec::appendTime(writer, time, arrays); });
}

long tessera_writer_times(const tessera_writer* writer, double* last_time) {
    if (writer == nullptr) return 0;
    if (last_time != nullptr && writer->times > 0) *last_time = writer->lastTime;
    return writer->times;
}

void tessera_writer_close(tessera_writer* writer) {
    delete writer;
}

const char* tessera_writer_error() {
    return tessera::codec::lastError;
}
