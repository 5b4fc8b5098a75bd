// Samples of stored images: which bytes, as which numbers.
#include "volume/base/error.h"
#include "volume/import/files/stored_image.h"
#include "volume/system/input_file.h"

#include <algorithm>
#include <bit>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <utility>

namespace tessera::volume {

namespace fs = std::filesystem;

namespace {

/// Calls body with a number of the stored type.
template <class Body> void withStored(StoredType type, Body&& body) {
    switch (type) {
    case StoredType::I8:
        return body(std::int8_t());
    case StoredType::U8:
        return body(std::uint8_t());
    case StoredType::I16:
        return body(std::int16_t());
    case StoredType::U16:
        return body(std::uint16_t());
    case StoredType::I32:
        return body(std::int32_t());
    case StoredType::U32:
        return body(std::uint32_t());
    case StoredType::I64:
        return body(std::int64_t());
    case StoredType::U64:
        return body(std::uint64_t());
    case StoredType::F32:
        return body(float());
    case StoredType::F64:
        return body(double());
    }
}

template <class From> From numberAt(const char* bytes, bool swap) {
    char one[sizeof(From)];
    std::memcpy(one, bytes, sizeof(From));
    if (swap) std::reverse(one, one + sizeof(From));
    return std::bit_cast<From>(one);
}

/// A row of samples: `from` and `to` advance by so many samples of their own type.
template <class From, class To>
void copyRow(const char* from, std::size_t fromStep, std::size_t count, bool swap, To* to, std::size_t toStep) {
    if constexpr (std::is_same_v<From, To>)
        if (fromStep == 1 && toStep == 1 && !swap) {
            std::memcpy(to, from, count * sizeof(From));
            return;
        }
    for (std::size_t n = 0; n < count; ++n)
        to[n * toStep] = static_cast<To>(numberAt<From>(from + n * fromStep * sizeof(From), swap));
}

std::uint64_t afterLines(std::ifstream& in, std::uint64_t begin, std::uint64_t lines) {
    in.seekg(std::streamoff(begin));
    for (; lines > 0; --lines) {
        in.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
        if (!in) throw Error("ends within the lines to skip");
    }
    return std::uint64_t(in.tellg());
}

SamplePart partOf(const StoredImage& image, const std::string& path, const std::string& name, double wanted) {
    const SampleFiles& files = image.files;
    const std::string which = name.empty() ? "" : "its file " + name + " ";
    if (const std::string why = whyNoFile(path); !why.empty())
        throw Error((name.empty() ? "" : "its samples' file " + name + " cannot be read: ") + why);
    std::ifstream in(path, std::ios::binary);
    std::error_code failed;
    const std::uintmax_t whole = fs::file_size(path, failed);
    if (failed || !in) throw Error(name.empty() ? "cannot be read" : "its samples' file " + name + " cannot be read");
    SamplePart part{path, name, files.begin, 0};
    if (files.lineSkip > 0) part.begin = afterLines(in, part.begin, files.lineSkip);
    const bool packed = files.encoding == SampleEncoding::Deflate || files.encoding == SampleEncoding::Bzip2;
    if (files.byteSkip < 0 && !packed) {
        const double back = wanted - double(files.byteSkip) - 1;
        if (double(whole) < back + double(part.begin))
            throw Error(which + "is shorter than its header announces: truncated");
        part.begin = whole - std::uint64_t(back);
    } else if (!packed) {
        part.begin += std::uint64_t(files.byteSkip);
    }
    part.size = whole > part.begin ? whole - part.begin : 0;
    if (files.encoding == SampleEncoding::Raw && double(part.size) < wanted) {
        char numbers[128];
        std::snprintf(numbers, sizeof numbers, "has %.15g bytes of samples, but its header announces %.15g",
                      double(part.size), wanted);
        throw Error(which + numbers);
    }
    return part;
}

} // namespace

std::vector<SamplePart> partsOf(const StoredImage& image, const std::string& header) {
    const SampleFiles& files = image.files;
    if (files.names.empty()) return {partOf(image, header, {}, image.bytes())};
    if (image.samples() % files.names.size() != 0)
        throw Error("names " + std::to_string(files.names.size()) + " files, which cannot hold equal parts of " +
                    std::to_string(image.samples()) + " samples");
    std::vector<SamplePart> parts;
    for (const std::string& name : files.names)
        parts.push_back(
            partOf(image, namedPath(header, name, files.outside), name, image.bytes() / double(files.names.size())));
    return parts;
}

ReadBytes readerOf(const StoredImage& image, std::vector<SamplePart> parts) {
    struct Open {
        std::ifstream in;
        std::size_t part = std::numeric_limits<std::size_t>::max();
        std::uint64_t at = 0;
    };
    const std::uint64_t each = std::uint64_t(image.bytes()) / parts.size();
    return [parts = std::move(parts), each, open = std::make_shared<Open>()](std::uint64_t offset, std::span<char> to) {
        while (!to.empty()) {
            const auto part = std::size_t(offset / each);
            if (part >= parts.size()) throw Error("ends early");
            const std::uint64_t within = offset % each, wanted = parts[part].begin + within;
            if (open->part != part) {
                open->in = std::ifstream(parts[part].path, std::ios::binary);
                open->part = part;
                open->at = 0;
            }
            if (open->at != wanted) open->in.seekg(std::streamoff(wanted));
            const std::size_t count = std::size_t(std::min<std::uint64_t>(to.size(), each - within));
            open->in.read(to.data(), std::streamsize(count));
            if (std::size_t(open->in.gcount()) != count) {
                open->part = parts.size();
                throw Error("ends early, the file has changed", {}, "byte " + std::to_string(wanted));
            }
            open->at = wanted + count;
            offset += count;
            to = to.subspan(count);
        }
    };
}

template <class To>
void readLayers(const StoredImage& image, const ReadBytes& read, const StoredLayers& layers,
                std::span<const StoredTarget<To>> targets) {
    const std::size_t bytes = sizeOf(image.type);
    const auto nx = std::size_t(image.grid.size[0]), ny = std::size_t(image.grid.size[1]);
    const std::size_t plane = (nx - 1) * image.stride[0] + (ny - 1) * image.stride[1] + 1; // what one layer spans
    const bool swap = image.bigEndian && bytes > 1;
    std::size_t most = 0;
    for (const auto& target : targets) most = std::max(most, image.offsets[target.component]);
    std::vector<char> buffer;
    const auto readSome = [&](std::span<const StoredTarget<To>> some, std::size_t skipped, std::size_t span) {
        for (std::size_t k = 0; k < layers.count; ++k) {
            buffer.resize(span * bytes);
            const std::size_t begin = layers.frame * image.timeStride + (layers.first + k) * image.stride[2] + skipped;
            read(std::uint64_t(begin) * bytes, buffer);
            for (const auto& target : some)
                for (std::size_t j = 0; j < ny; ++j) {
                    const std::size_t within = j * image.stride[1] + image.offsets[target.component] - skipped;
                    To* const to = target.to + (k * ny + j) * nx * target.stride;
                    withStored(image.type, [&]<class From>(From) {
                        copyRow<From, To>(buffer.data() + within * bytes, image.stride[0], nx, swap, to, target.stride);
                    });
                }
        }
    };
    // Components between the samples of a row come with them; others are read one after the other.
    if (most < image.stride[0])
        readSome(targets, 0, plane + most);
    else
        for (const auto& target : targets) readSome(std::span(&target, 1), image.offsets[target.component], plane);
}

#define TESSERA_READ_LAYERS(T)                                                                                         \
    template void readLayers<T>(const StoredImage&, const ReadBytes&, const StoredLayers&,                             \
                                std::span<const StoredTarget<T>>)
TESSERA_READ_LAYERS(signed char);
TESSERA_READ_LAYERS(std::uint8_t);
TESSERA_READ_LAYERS(std::int16_t);
TESSERA_READ_LAYERS(std::uint16_t);
TESSERA_READ_LAYERS(std::int32_t);
TESSERA_READ_LAYERS(float);
TESSERA_READ_LAYERS(double);
#undef TESSERA_READ_LAYERS

bool fitsInt32(const StoredImage& image, const ReadBytes& read) {
    constexpr std::size_t kPiece = 1 << 20;
    const std::size_t bytes = sizeOf(image.type), all = image.samples();
    std::vector<char> buffer(std::min(all, kPiece) * bytes);
    for (std::size_t at = 0; at < all; at += kPiece) {
        const std::size_t count = std::min(kPiece, all - at);
        read(std::uint64_t(at) * bytes, std::span(buffer).first(count * bytes));
        bool fits = true;
        withStored(image.type, [&]<class From>(From) {
            for (std::size_t n = 0; n < count; ++n) {
                const From value = numberAt<From>(buffer.data() + n * bytes, image.bigEndian);
                if constexpr (std::is_integral_v<From>) fits = fits && std::in_range<std::int32_t>(value);
            }
        });
        if (!fits) return false;
    }
    return true;
}

FileBlock openStored(const StoredImage& image, const std::string& named, const std::string& format) {
    const UprightGrid turned = upright(image.grid);
    FileBlock block;
    block.file = named;
    block.format = format;
    block.lattice = turned.lattice;
    block.box = {turned.lattice.origin, turned.lattice.position(turned.lattice.size - 1)};
    if (image.cells) {
        block.cellData = true;
        block.box.lo -= turned.lattice.spacing * 0.5;
        block.box.hi += turned.lattice.spacing * 0.5;
    }
    block.times = image.times;
    block.lengthUnit = image.lengthUnit;
    block.timeUnit = image.timeUnit;
    block.timeName = image.timeName;
    block.notes = image.notes;
    if (!turned.note.empty()) block.notes.push_back(turned.note);
    constexpr ScalarType kTypes[] = {ScalarType::I16, ScalarType::U8,  ScalarType::I16, ScalarType::U16,
                                     ScalarType::I32, ScalarType::F32, ScalarType::F32, ScalarType::F32,
                                     ScalarType::F32, ScalarType::F32};
    const ScalarType type = kTypes[std::size_t(image.type)];
    for (const StoredChannel& channel : image.channels)
        block.arrays.push_back({channel.name, image.unit, channel.components, type, false, {}});
    block.inParts = turned.from[2] == 2; // slices are stored layers
    const auto samples = std::make_shared<const std::vector<SamplePart>>(partsOf(image, named));
    block.read = [image, turned, type, samples, named](int array, int component, int time, const Lattice&,
                                                       SliceRange slices) {
        const SliceRange taken = slices.of(turned.lattice);
        UprightGrid part = turned;
        part.lattice = slicesOf(turned.lattice, slices);
        StoredLayers layers{std::size_t(time), 0, std::size_t(image.grid.size[2])};
        if (turned.from[2] == 2) {
            const int first = turned.turned[2] ? turned.lattice.size.z - taken.first - taken.count : taken.first;
            layers.first = std::size_t(first);
            layers.count = std::size_t(taken.count);
        } else {
            part.lattice = turned.lattice;
        }
        const std::size_t wanted = image.channels[std::size_t(array)].first + std::size_t(component);
        Field field = makeField(part.lattice, type);
        field.scale = image.scale;
        field.offset = image.offset;
        try {
            const ReadBytes read = readerOf(image, *samples);
            dispatch(type, [&]<class T>(T) {
                const StoredTarget<T> target{wanted, field.as<T>().data(), 1};
                readLayers<T>(image, read, layers, {&target, 1});
            });
        } catch (const Error& error) {
            throw Error(error.reason(), named, error.place());
        }
        if (!turned.asStored()) {
            const std::vector<std::byte> ordered = inUprightOrder(field.samples, byteSize(type), part);
            std::copy(ordered.begin(), ordered.end(), field.samples.begin());
        }
        return field;
    };
    return block;
}

} // namespace tessera::volume
