// MetaImage: a header of "Key = Value" lines, and samples behind it or in files that it names.
#include "app/importer/images/serve_stored.h"
#include "app/importer/readers/check_file.h"
#include "app/importer/readers/read_files.h"
#include "volume/base/trimmed.h"
#include "volume/base/unit_conversion.h"
#include "volume/import/files/nrrd_header.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <sstream>
#include <stdexcept>

namespace tessera::importer {

namespace {

using volume::ComponentKind;
using volume::SampleEncoding;
using volume::StoredAxis;
using volume::StoredImage;
using volume::StoredType;

struct MetaHeader {
    std::map<std::string, std::string> fields;
    std::vector<std::string> lines; ///< behind ElementDataFile, where that is a list
    std::size_t end = 0;

    /// The value of the first of these keys that is stated, else "".
    std::string field(std::initializer_list<const char*> keys) const {
        for (const char* key : keys)
            if (const auto at = fields.find(key); at != fields.end()) return at->second;
        return {};
    }
    std::vector<double> numbers(std::initializer_list<const char*> keys) const {
        try {
            return volume::nrrdNumbers(field(keys), *keys.begin());
        } catch (const std::runtime_error&) {
            throw std::runtime_error(std::string(*keys.begin()) + " is no list of numbers");
        }
    }
    bool flag(std::initializer_list<const char*> keys, bool otherwise) const {
        const std::string word = field(keys);
        return word.empty() ? otherwise : word[0] == 'T' || word[0] == 't' || word[0] == '1';
    }
};

MetaHeader readMetaHeader(const std::string& path) {
    constexpr std::size_t kHead = 1 << 20;
    const std::string head = readPart(path, 0, kHead);
    MetaHeader header;
    while (header.end < head.size()) {
        const std::size_t stop = std::min(head.find('\n', header.end), head.size());
        const std::string_view line = std::string_view(head).substr(header.end, stop - header.end);
        const std::size_t equals = line.find_first_of("=:");
        header.end = std::min(stop + 1, head.size());
        if (volume::trimmed(line).empty()) continue;
        if (equals == std::string_view::npos) throw std::runtime_error("is damaged or has another format");
        const std::string key(volume::trimmed(line.substr(0, equals)));
        header.fields[key] = std::string(volume::trimmed(line.substr(equals + 1)));
        if (key != "ElementDataFile") continue;
        if (!header.fields[key].starts_with("LIST")) return header;
        std::istringstream rest(head.substr(header.end));
        for (std::string name; std::getline(rest, name);)
            if (const std::string_view plain = volume::trimmed(name); !plain.empty()) header.lines.emplace_back(plain);
        return header;
    }
    throw std::runtime_error(header.fields.contains("NDims") ? "ends within its header: truncated"
                                                             : "is damaged or has another format");
}

StoredType typeOfMeta(std::string word) {
    static const std::map<std::string, StoredType> kTypes = {
        {"MET_CHAR", StoredType::I8},       {"MET_ASCII_CHAR", StoredType::I8},  {"MET_UCHAR", StoredType::U8},
        {"MET_SHORT", StoredType::I16},     {"MET_USHORT", StoredType::U16},     {"MET_INT", StoredType::I32},
        {"MET_UINT", StoredType::U32},      {"MET_LONG", StoredType::I32},       {"MET_ULONG", StoredType::U32},
        {"MET_LONG_LONG", StoredType::I64}, {"MET_ULONG_LONG", StoredType::U64}, {"MET_FLOAT", StoredType::F32},
        {"MET_DOUBLE", StoredType::F64}};
    if (word.ends_with("_ARRAY")) word.resize(word.size() - 6);
    const auto type = kTypes.find(word);
    if (type == kTypes.end()) throw std::runtime_error("has samples of unknown type " + word.substr(0, 40));
    return type->second;
}

/// The files of "LIST", "slice%03d.raw 1 10 1", or one.
std::vector<std::string> dataFilesOf(const MetaHeader& header) {
    const std::string stated = header.field({"ElementDataFile"});
    if (stated == "LOCAL" || stated == "Local" || stated == "local") return {};
    if (stated.empty()) throw std::runtime_error("names no file of samples");
    if (stated.starts_with("LIST")) {
        if (header.lines.empty()) throw std::runtime_error("names no file of samples");
        return header.lines;
    }
    std::istringstream in(stated);
    std::string pattern;
    long first = 1, last = 0, step = 1;
    in >> pattern;
    if (!volume::numberedFile(pattern, 1)) return {stated};
    if (!(in >> first >> last)) {
        const std::vector<double> sizes = header.numbers({"DimSize"});
        last = first + (sizes.size() > 2 ? long(std::clamp(sizes[2], 1.0, 1e5)) : 1) - 1;
    } else if (!(in >> step)) {
        step = 1;
    }
    constexpr long kMostFiles = 100'000;
    if (step < 1 || last < first || (last - first) / step >= kMostFiles)
        throw std::runtime_error("\"" + stated.substr(0, 60) + "\" states no files of samples");
    std::vector<std::string> names;
    for (long n = first; n <= last; n += step) names.push_back(*volume::numberedFile(pattern, n));
    return names;
}

void readPlacesOfMeta(const MetaHeader& header, StoredImage& image) {
    image.bigEndian = header.flag({"BinaryDataByteOrderMSB", "ElementByteOrderMSB"}, false);
    volume::SampleFiles& files = image.files;
    files.names = dataFilesOf(header);
    if (files.names.empty()) files.begin = header.end;
    if (!header.flag({"BinaryData"}, true))
        files.encoding = SampleEncoding::Text;
    else if (header.flag({"CompressedData"}, false))
        files.encoding = SampleEncoding::Deflate; // CompressedDataSize may be wrong: the stream tells where it ends
    const std::vector<double> skip = header.numbers({"HeaderSize"});
    if (skip.empty() || skip[0] == 0) return;
    if (!(skip[0] >= -1 && skip[0] < 1e15)) throw std::runtime_error("HeaderSize is out of range");
    if (files.encoding == SampleEncoding::Raw)
        files.byteSkip = std::int64_t(skip[0]);
    else if (skip[0] > 0)
        files.begin += std::uint64_t(skip[0]);
}

/// A row of the matrix is the direction of a stored axis.
void placeMeta(const MetaHeader& header, std::size_t dimensions, StoredImage& image) {
    std::vector<double> spacing = header.numbers({"ElementSpacing", "ElementSize"}),
                        origin = header.numbers({"Offset", "Position", "Origin"}),
                        matrix = header.numbers({"TransformMatrix", "Rotation", "Orientation"});
    spacing.resize(dimensions, 1);
    origin.resize(dimensions, 0);
    if (matrix.size() != dimensions * dimensions) {
        if (!matrix.empty()) image.notes.emplace_back("its TransformMatrix has another size and was left out");
        matrix.assign(dimensions * dimensions, 0);
        for (std::size_t d = 0; d < dimensions; ++d) matrix[d * dimensions + d] = 1;
    }
    const int space = int(std::min<std::size_t>(3, dimensions));
    for (int axis = 0; axis < space; ++axis) {
        glm::dvec3 direction(0);
        for (int row = 0; row < space; ++row)
            direction[row] = matrix[std::size_t(axis) * dimensions + std::size_t(row)];
        const double length = glm::length(direction);
        if (!std::isfinite(length) || !(length > 0)) {
            direction = glm::dvec3(0);
            direction[axis] = 1;
        }
        const double step = spacing[std::size_t(axis)];
        const bool isLength = std::isfinite(step) && step != 0;
        if (!isLength)
            image.notes.push_back(std::string("its spacing along ") + "xyz"[axis] + " is no length: 1 was taken");
        image.grid.steps[axis] = direction * (isLength ? step : 1);
        image.grid.origin[axis] = std::isfinite(origin[std::size_t(axis)]) ? origin[std::size_t(axis)] : 0;
    }
    volume::completeSteps(image.grid, space);
    image.lengthUnit = volume::lengthUnitNamed(header.field({"DistanceUnits"}));
    if (image.frames < 2) return;
    image.times = volume::evenTimes(image.frames, std::isfinite(origin[3]) ? origin[3] : 0, 1);
    if (spacing[3] > 0 && std::isfinite(spacing[3]))
        image.times = volume::evenTimes(image.frames, image.times[0], spacing[3]);
}

} // namespace

void openMetaImage(Source& source) {
    const MetaHeader header = readMetaHeader(source.path);
    const std::string object = header.field({"ObjectType"});
    if (!object.empty() && object != "Image")
        throw std::runtime_error("holds \"" + object.substr(0, 40) + "\", no image");
    StoredImage image;
    image.type = typeOfMeta(header.field({"ElementType"}));
    const std::vector<double> sizes = header.numbers({"DimSize"}), stated = header.numbers({"NDims"}),
                              channels = header.numbers({"ElementNumberOfChannels"});
    if (sizes.empty() || (!stated.empty() && stated[0] != double(sizes.size())))
        throw std::runtime_error("DimSize has another number of sizes than NDims");
    const double components = channels.empty() ? 1 : channels[0];
    std::vector<StoredAxis> axes{{StoredAxis::Along::Components, 1}};
    if (!(components >= 1 && components <= 1e6)) throw std::runtime_error("ElementNumberOfChannels is out of range");
    axes[0].size = std::size_t(components);
    for (std::size_t d = 0; d < sizes.size(); ++d) {
        if (!(sizes[d] >= 1 && sizes[d] <= 1e9)) throw std::runtime_error("DimSize is out of range");
        axes.push_back({d < 3    ? StoredAxis::Along::Space
                        : d == 3 ? StoredAxis::Along::Times
                                 : StoredAxis::Along::Components,
                        std::size_t(sizes[d])});
    }
    volume::setAxes(image, axes);
    readPlacesOfMeta(header, image);
    placeMeta(header, sizes.size(), image);
    const bool colors = image.type == StoredType::U8 && (components == 3 || components == 4);
    if (sizes.size() > 4 && components > 1)
        volume::setChannels(image, "value", ComponentKind::Channels);
    else
        volume::setChannels(image, "value",
                            colors                               ? ComponentKind::Colors
                            : components == 3 || components == 2 ? ComponentKind::Vector
                                                                 : ComponentKind::Channels);
    if (colors) image.notes.emplace_back("its channels of 8 bits are taken as red, green and blue");
    const std::vector<double> slope = header.numbers({"ElementToIntensityFunctionSlope"}),
                              offset = header.numbers({"ElementToIntensityFunctionOffset"});
    if (!slope.empty() && std::isfinite(slope[0]) && slope[0] != 0) image.scale = slope[0];
    if (!offset.empty() && std::isfinite(offset[0])) image.offset = offset[0];
    if (image.scale != 1 || image.offset != 0)
        image.notes.emplace_back("stored numbers are scaled by the header's ElementToIntensityFunction");
    serveStored(source, std::move(image));
}

} // namespace tessera::importer
