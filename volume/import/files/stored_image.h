#pragma once

#include "volume/import/files/file_block.h"
#include "volume/import/files/named_path.h"
#include "volume/import/files/upright.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

/// Grids of samples whose header says where each sample is stored: NRRD, NIfTI, MetaImage and the like.
namespace tessera::volume {

/// Number types of stored samples.
enum class StoredType : std::uint8_t { I8, U8, I16, U16, I32, U32, I64, U64, F32, F64 };

std::size_t sizeOf(StoredType type);

/// Integers that no ScalarType holds as they are; they are read as I32 if all of them fit, else as floats.
inline bool isLongInteger(StoredType type) {
    return type == StoredType::U32 || type == StoredType::I64 || type == StoredType::U64;
}

enum class SampleEncoding : std::uint8_t { Raw, Deflate, Bzip2, Hex, Text };

/// The files that hold the samples, one after the other in equal parts.
struct SampleFiles {
    SampleEncoding encoding = SampleEncoding::Raw;
    std::vector<std::string> names;     ///< from the header's folder; empty: they follow in the header's own file
    Outside outside = Outside::Refused; ///< whether these may lie elsewhere
    std::uint64_t begin = 0;            ///< bytes before all else in each file: the header
    std::uint64_t lineSkip = 0;         ///< then so many lines
    /// Then so many bytes, of deflated samples once they are inflated. Negative: samples end -byteSkip - 1 bytes before
    /// the end.
    std::int64_t byteSkip = 0;
};

/// What an axis of the stored samples runs along.
struct StoredAxis {
    enum class Along : std::uint8_t { Space, Components, Times };
    Along along = Along::Space;
    std::size_t size = 1;
};

/// What the components of a sample are.
enum class ComponentKind : std::uint8_t { Vector, Colors, Complex, Channels };

/// One parameter: a component, or the three of a vector.
struct StoredChannel {
    std::string name;
    std::size_t first = 0; ///< component
    int components = 1;
};

struct StoredImage {
    StoredType type = StoredType::U8;
    bool bigEndian = false;
    SampleFiles files;
    StoredGrid grid;                     ///< sizes, and places of the samples
    bool cells = false;                  ///< samples belong to cells: their box reaches half a step further
    std::size_t stride[3] = {1, 1, 1};   ///< in samples, along the stored axes
    std::vector<std::size_t> offsets{0}; ///< of the components, in samples
    std::size_t timeStride = 0, frames = 1;
    std::vector<StoredChannel> channels;
    std::vector<double> times;    ///< empty, or one for each frame
    double scale = 1, offset = 0; ///< value = offset + scale * stored
    std::string unit, lengthUnit, timeUnit, timeName;
    std::vector<std::string> notes;

    std::size_t samples() const; ///< in all frames
    double bytes() const { return double(samples()) * double(sizeOf(type)); }
};

/// Sets sizes and strides by the axes, fastest first. Throws Error for sizes that are out of range.
void setAxes(StoredImage& image, std::span<const StoredAxis> axes);

/// Names the channels for the components that setAxes has counted. `labels`: names of components, may be empty.
void setChannels(StoredImage& image, const std::string& name, ComponentKind parts,
                 const std::vector<std::string>& labels = {});

/// A grid of one or two axes gets others across them: `axes` of it have been set.
void completeSteps(StoredGrid& grid, int axes);

/// Times first + n * step, one for each frame.
std::vector<double> evenTimes(std::size_t frames, double first, double step);

/// Reads decoded bytes [offset, offset + into.size()) of the samples. Throws Error where they end early.
using ReadBytes = std::function<void(std::uint64_t offset, std::span<char> into)>;

/// One file of samples.
struct SamplePart {
    std::string path, name;  ///< its name in the header; "" for the header's own file
    std::uint64_t begin = 0; ///< of the samples, or of their compressed stream
    std::uint64_t size = 0;  ///< bytes from there on
};

/// The files of the samples of a header, with lines and bytes skipped as far as that can be done before decoding. Raw
/// ones are as long as they must be. Throws Error.
std::vector<SamplePart> partsOf(const StoredImage& image, const std::string& header);

/// Reads raw samples.
ReadBytes readerOf(const StoredImage& image, std::vector<SamplePart> parts);

/// Layers [first, first + count) along the last stored axis of space, at one frame.
struct StoredLayers {
    std::size_t frame = 0, first = 0, count = 0;
};

/// Where the samples of a component go: `stride` apart, in stored order.
template <class To> struct StoredTarget {
    std::size_t component = 0;
    To* to = nullptr;
    std::size_t stride = 1;
};

/// Reads the samples of some components. `To` must hold the stored type, but I32 may stand for longer integers that
/// fit.
template <class To>
void readLayers(const StoredImage& image, const ReadBytes& read, const StoredLayers& layers,
                std::span<const StoredTarget<To>> targets);

/// Whether all samples, which are long integers, are within those of 32 bit with a sign.
bool fitsInt32(const StoredImage& image, const ReadBytes& read);

/// An image whose raw samples are read in parts. `named` is the header's file.
FileBlock openStored(const StoredImage& image, const std::string& named, const std::string& format);

} // namespace tessera::volume
