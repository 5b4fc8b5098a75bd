#include "app/importer/hdf/xdmf_items.h"

#include "app/importer/readers/check_file.h"
#include "volume/base/trimmed.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>
#include <vtkType.h>
#include <zlib.h>

namespace tessera::importer {

namespace fs = std::filesystem;

namespace {

constexpr int kMostDepth = 8; // of items within items

std::size_t productOf(const std::vector<std::size_t>& dims) {
    double product = 1;
    for (const std::size_t n : dims) product *= double(n);
    if (product > 1e12) throw std::runtime_error("states more numbers than memory can hold");
    return std::size_t(product);
}

int xdmfType(pugi::xml_node item) {
    const std::string type = xdmfWord(xdmfAttribute(item, {"NumberType", "DataType"}));
    const std::string precision = xdmfAttribute(item, {"Precision"});
    if (type == "char") return VTK_SIGNED_CHAR;
    if (type == "uchar") return VTK_UNSIGNED_CHAR;
    if (type == "short") return VTK_SHORT;
    if (type == "ushort") return VTK_UNSIGNED_SHORT;
    if (type == "int" || type == "uint") {
        const bool sign = type == "int";
        if (precision == "1") return sign ? VTK_SIGNED_CHAR : VTK_UNSIGNED_CHAR;
        if (precision == "2") return sign ? VTK_SHORT : VTK_UNSIGNED_SHORT;
        if (precision == "8") return sign ? VTK_LONG_LONG : VTK_UNSIGNED_LONG_LONG;
        return sign ? VTK_INT : VTK_UNSIGNED_INT;
    }
    if (type == "float" || type.empty()) return precision == "8" ? VTK_DOUBLE : VTK_FLOAT;
    throw std::runtime_error("has numbers of the type " + type.substr(0, 20) + ", which is not read");
}

/// Whole numbers beyond 32 bits as double.
vtkSmartPointer<vtkDataArray> inUsualType(vtkSmartPointer<vtkDataArray> values) {
    const int type = values->GetDataType();
    if (type != VTK_LONG_LONG && type != VTK_UNSIGNED_LONG_LONG && type != VTK_UNSIGNED_INT) return values;
    auto out = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(VTK_DOUBLE));
    out->DeepCopy(values);
    return out;
}

vtkSmartPointer<vtkDataArray> arrayOf(int type, std::size_t count) {
    auto out = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
    out->SetNumberOfTuples(vtkIdType(count));
    return out;
}

XdmfNumbers readText(pugi::xml_node item, std::vector<std::size_t> dims) {
    const std::vector<double> numbers = xdmfNumbers(item.text().get());
    if (dims.empty()) dims = {numbers.size()};
    const std::size_t count = productOf(dims);
    wantBytes(double(numbers.size()), double(count), "", "numbers in the XML");
    int type = xdmfType(item);
    if (type == VTK_LONG_LONG || type == VTK_UNSIGNED_LONG_LONG || type == VTK_UNSIGNED_INT) type = VTK_DOUBLE;
    XdmfNumbers out{std::move(dims), arrayOf(type, count)};
    for (std::size_t i = 0; i < count; ++i) out.values->SetComponent(vtkIdType(i), 0, numbers[i]);
    return out;
}

/// The numbers of a block of rows of `from`; slab as in HDF5.
XdmfNumbers partOf(const XdmfNumbers& from, const HdfSlab& slab) {
    if (slab.begin.size() != from.dims.size()) throw std::runtime_error("has a hyperslab of another number of axes");
    for (std::size_t axis = 0; axis < from.dims.size(); ++axis)
        if (slab.count[axis] > 0 && (slab.begin[axis] >= from.dims[axis] ||
                                     (slab.count[axis] - 1) > (from.dims[axis] - 1 - slab.begin[axis]) /
                                                                  std::max<std::size_t>(slab.stride[axis], 1)))
            throw std::runtime_error("has a hyperslab beyond its numbers");
    const std::size_t count = productOf(slab.count);
    XdmfNumbers out{slab.count, arrayOf(from.values->GetDataType(), count)};
    std::vector<std::size_t> index(slab.count.size(), 0);
    for (std::size_t n = 0; n < count; ++n) {
        std::size_t place = 0;
        for (std::size_t axis = 0; axis < index.size(); ++axis)
            place = place * from.dims[axis] + slab.begin[axis] + index[axis] * slab.stride[axis];
        out.values->SetTuple(vtkIdType(n), vtkIdType(place), from.values);
        for (std::size_t axis = index.size(); axis-- > 0 && ++index[axis] == slab.count[axis];) index[axis] = 0;
    }
    return out;
}

/// Start, step and count by axis from three rows of numbers.
HdfSlab slabOf(const std::vector<double>& numbers) {
    const std::size_t axes = numbers.size() / 3;
    if (axes == 0 || numbers.size() % 3 != 0) throw std::runtime_error("has a hyperslab that is not 3 rows of numbers");
    HdfSlab slab;
    for (std::size_t n = 0; n < numbers.size(); ++n) {
        if (!(numbers[n] >= 0 && numbers[n] < 1e12)) throw std::runtime_error("has a hyperslab of negative numbers");
        (n < axes ? slab.begin : n < 2 * axes ? slab.stride : slab.count).push_back(std::size_t(numbers[n]));
    }
    return slab;
}

/// The names of the items that a function joins, "JOIN($0 ; $1)": their number; 0 where it does something else.
std::size_t joinedBy(const std::string& function) {
    std::string rest;
    for (const char c : function)
        if (std::isspace(static_cast<unsigned char>(c)) == 0) rest += c;
    if (!xdmfWord(rest).starts_with("join(") || rest.back() != ')') return 0;
    rest = rest.substr(5, rest.size() - 6);
    std::size_t count = 0;
    for (std::size_t at = 0; at < rest.size();) {
        const std::string wanted = "$" + std::to_string(count);
        if (rest.compare(at, wanted.size(), wanted) != 0) return 0;
        at += wanted.size();
        ++count;
        if (at < rest.size() && rest[at] != ';' && rest[at] != ',') return 0;
        ++at;
    }
    return count;
}

} // namespace

std::vector<double> XdmfNumbers::list() const {
    std::vector<double> out;
    for (vtkIdType i = 0; i < values->GetNumberOfTuples(); ++i) out.push_back(values->GetComponent(i, 0));
    return out;
}

std::vector<std::int64_t> XdmfNumbers::integers() const {
    std::vector<std::int64_t> out(std::size_t(values->GetNumberOfTuples()));
    for (std::size_t i = 0; i < out.size(); ++i) {
        const double number = values->GetComponent(vtkIdType(i), 0);
        out[i] = number >= -1e15 && number <= 1e15 ? std::int64_t(number) : -1;
    }
    return out;
}

std::string XdmfItems::fileBeside(pugi::xml_node item, const std::string& name) const {
    // A file that has been moved together with its heavy data names them where they were.
    const std::string path = document_.pathOf(item), moved = besides(path, fs::path(name).filename().string());
    std::error_code unknown;
    if (fs::exists(fs::path(path).parent_path() / name, unknown)) return besides(path, name); // or it is refused
    if (!fs::exists(moved)) throw std::runtime_error("its file " + name.substr(0, 200) + " is not there");
    return moved;
}

std::pair<const HdfFile*, std::string> XdmfItems::hdfOf(pugi::xml_node item) const {
    const std::string text(volume::trimmed(item.text().get()));
    const std::size_t colon = text.find(":/") != std::string::npos ? text.find(":/") : text.rfind(':');
    if (colon == std::string::npos)
        throw std::runtime_error("names no place in an HDF5 file: \"" + text.substr(0, 80) + "\"");
    const std::string path = fileBeside(item, std::string(volume::trimmed(text.substr(0, colon))));
    std::shared_ptr<const HdfFile>& file = files_[path];
    if (file == nullptr) {
        try {
            file = std::make_shared<const HdfFile>(path);
        } catch (const std::runtime_error& error) {
            throw std::runtime_error("its file " + fs::path(path).filename().string() + " " + error.what());
        }
    }
    std::string inside = text.substr(colon + 1);
    inside.erase(0, std::min(inside.find_first_not_of('/'), inside.size()));
    return {file.get(), inside};
}

std::vector<std::size_t> XdmfItems::dims(pugi::xml_node item) const {
    const std::vector<std::size_t> stated = xdmfSizes(xdmfAttribute(item, {"Dimensions"}));
    if (!stated.empty()) return stated;
    if (xdmfWord(xdmfAttribute(item, {"Format"})) != "hdf") return readItem(item, 0).dims;
    auto [file, inside] = hdfOf(item);
    const std::optional<HdfShape> shape = file->shape(inside.substr(0, inside.find('|')));
    if (!shape) throw std::runtime_error("data set \"" + inside + "\" is missing");
    return shape->dims;
}

XdmfNumbers XdmfItems::readHdf(pugi::xml_node item, const HdfSlab* slab) const {
    auto [file, inside] = hdfOf(item);
    // XDMF 3 states a part behind the name: "path|start|step|count|dimensions".
    std::vector<std::string> words;
    for (std::size_t at = 0; at <= inside.size();) {
        const std::size_t end = std::min(inside.find('|', at), inside.size());
        words.push_back(inside.substr(at, end - at));
        at = end + 1;
    }
    HdfSlab own;
    if (words.size() >= 4) {
        own = {xdmfSizes(words[1]), xdmfSizes(words[2]), xdmfSizes(words[3])};
        if (own.stride.size() != own.begin.size()) own.stride.assign(own.begin.size(), 1);
        if (slab == nullptr) slab = &own;
    }
    const std::string path(volume::trimmed(words.front()));
    if (slab != nullptr) return {slab->count, file->array(path, *slab)};
    const std::optional<HdfShape> shape = file->shape(path);
    if (!shape) throw std::runtime_error("data set \"" + path + "\" is missing");
    const std::vector<std::size_t> stated = xdmfSizes(xdmfAttribute(item, {"Dimensions"}));
    if (!stated.empty() && productOf(stated) != shape->count())
        throw std::runtime_error("data set \"" + path + "\" has another size than its XML says");
    return {stated.empty() ? shape->dims : stated, file->all(path)};
}

XdmfNumbers XdmfItems::readBinary(pugi::xml_node item) const {
    const std::string name(volume::trimmed(item.text().get())), path = fileBeside(item, name);
    const std::string packed = xdmfWord(xdmfAttribute(item, {"Compression"}));
    if (!packed.empty() && packed != "raw" && packed != "zlib")
        throw std::runtime_error("is compressed by " + packed.substr(0, 20) + ", which is not read");
    const std::vector<std::size_t> seek = xdmfSizes(xdmfAttribute(item, {"Seek"}));
    XdmfNumbers out;
    out.dims = xdmfSizes(xdmfAttribute(item, {"Dimensions"}));
    const std::size_t count = productOf(out.dims), begin = seek.empty() ? 0 : seek[0];
    const int type = xdmfType(item);
    const auto bytes = std::size_t(vtkDataArray::GetDataTypeSize(type));
    const std::size_t whole = bytesIn(path);
    if (packed == "zlib") {
        refuseHollow(double(count * bytes), double(whole));
        out.values = arrayOf(type, count);
        const std::string stored = readWhole(path);
        uLongf got = uLongf(count * bytes);
        if (uncompress(static_cast<Bytef*>(out.values->GetVoidPointer(0)), &got,
                       reinterpret_cast<const Bytef*>(stored.data()) + std::min(begin, stored.size()),
                       uLong(stored.size() - std::min(begin, stored.size()))) != Z_OK ||
            got != count * bytes)
            throw std::runtime_error("its file " + name + " is damaged or ends early");
    } else {
        wantBytes(double(whole) - double(begin), double(count) * double(bytes), name);
        out.values = arrayOf(type, count);
        const std::string stored = readPart(path, begin, count * bytes);
        std::memcpy(out.values->GetVoidPointer(0), stored.data(), stored.size());
    }
    if (xdmfWord(xdmfAttribute(item, {"Endian"})) == "big" && bytes > 1) {
        auto* at = static_cast<char*>(out.values->GetVoidPointer(0));
        for (std::size_t i = 0; i < count; ++i) std::reverse(at + i * bytes, at + (i + 1) * bytes);
    }
    out.values = inUsualType(out.values);
    return out;
}

XdmfNumbers XdmfItems::readChosen(pugi::xml_node item, const std::string& kind, int depth) const {
    const std::vector<pugi::xml_node> inner = document_.children(item, "DataItem");
    if (inner.size() != 2) throw std::runtime_error("has a part of numbers without both of its items");
    const XdmfNumbers which = readItem(inner[0], depth + 1);
    if (kind == "hyperslab") {
        const HdfSlab slab = slabOf(which.list());
        const std::string source = xdmfWord(xdmfAttribute(inner[1], {"ItemType", "Type"}));
        const bool plain = source.empty() || source == "uniform";
        XdmfNumbers part;
        if (plain && xdmfWord(xdmfAttribute(inner[1], {"Format"})) == "hdf")
            part = readHdf(inner[1], &slab);
        else
            part = partOf(readItem(inner[1], depth + 1), slab);
        const std::vector<std::size_t> stated = xdmfSizes(xdmfAttribute(item, {"Dimensions"}));
        if (!stated.empty() && productOf(stated) == productOf(part.dims)) part.dims = stated;
        return part;
    }
    const XdmfNumbers from = readItem(inner[1], depth + 1);
    const std::vector<std::int64_t> places = which.integers();
    const std::size_t axes = from.dims.size(), count = axes == 0 ? 0 : places.size() / axes;
    XdmfNumbers out{{count}, arrayOf(from.values->GetDataType(), count)};
    for (std::size_t n = 0; n < count; ++n) {
        std::size_t place = 0;
        for (std::size_t axis = 0; axis < axes; ++axis) {
            const std::int64_t at = places[n * axes + axis];
            if (at < 0 || std::size_t(at) >= from.dims[axis])
                throw std::runtime_error("has coordinates beyond its numbers");
            place = place * from.dims[axis] + std::size_t(at);
        }
        out.values->SetTuple(vtkIdType(n), vtkIdType(place), from.values);
    }
    return out;
}

XdmfNumbers XdmfItems::readJoined(pugi::xml_node item, int depth) const {
    const std::string function = xdmfAttribute(item, {"Function"});
    const std::vector<pugi::xml_node> inner = document_.children(item, "DataItem");
    const std::size_t count = joinedBy(function);
    if (count == 0 || count > inner.size())
        throw std::runtime_error("is computed by the function " + function.substr(0, 60) +
                                 ", which is not read: write its values themselves");
    std::vector<XdmfNumbers> parts;
    for (std::size_t n = 0; n < count; ++n) parts.push_back(readItem(inner[n], depth + 1));
    const vtkIdType rows = parts.front().values->GetNumberOfTuples();
    XdmfNumbers out{parts.front().dims, arrayOf(parts.front().values->GetDataType(), std::size_t(rows) * count)};
    out.dims.push_back(count);
    for (std::size_t n = 0; n < count; ++n) {
        if (parts[n].values->GetNumberOfTuples() != rows) throw std::runtime_error("joins items of different sizes");
        for (vtkIdType i = 0; i < rows; ++i)
            out.values->SetComponent(i * vtkIdType(count) + vtkIdType(n), 0, parts[n].values->GetComponent(i, 0));
    }
    return out;
}

void XdmfItems::checkItem(pugi::xml_node item, int depth) const {
    if (!item) throw std::runtime_error("has no numbers");
    if (depth > kMostDepth) throw std::runtime_error("has items within items without end");
    const std::string kind = xdmfWord(xdmfAttribute(item, {"ItemType", "Type"}));
    const std::string format = xdmfWord(xdmfAttribute(item, {"Format"}));
    const std::string function = xdmfAttribute(item, {"Function"});
    if (kind == "function" && joinedBy(function) == 0)
        throw std::runtime_error("is computed by the function " + function.substr(0, 60) +
                                 ", which is not read: write its values themselves");
    if (!kind.empty() && kind != "uniform") {
        for (const pugi::xml_node inner : document_.children(item, "DataItem")) checkItem(inner, depth + 1);
    } else if (format == "hdf" || format == "hdf5") {
        auto [file, inside] = hdfOf(item);
        const std::string path(volume::trimmed(inside.substr(0, inside.find('|'))));
        const std::optional<HdfShape> shape = file->shape(path);
        if (!shape || !shape->numbers)
            throw std::runtime_error("names \"" + path + "\", which is missing or holds no numbers");
    } else if (format == "binary") {
        fileBeside(item, std::string(volume::trimmed(item.text().get())));
    }
}

XdmfNumbers XdmfItems::readItem(pugi::xml_node item, int depth) const {
    if (!item) throw std::runtime_error("has no numbers");
    if (depth > kMostDepth) throw std::runtime_error("has items within items without end");
    const std::string kind = xdmfWord(xdmfAttribute(item, {"ItemType", "Type"}));
    if (kind == "hyperslab" || kind == "coordinates" || kind == "coordinate") return readChosen(item, kind, depth);
    if (kind == "function") return readJoined(item, depth);
    if (!kind.empty() && kind != "uniform")
        throw std::runtime_error("is a DataItem of the type " + kind.substr(0, 40) + ", which is not read");
    const std::string format = xdmfWord(xdmfAttribute(item, {"Format"}));
    if (format == "hdf" || format == "hdf5") return readHdf(item, nullptr);
    if (format == "binary") return readBinary(item);
    if (format.empty() || format == "xml") return readText(item, xdmfSizes(xdmfAttribute(item, {"Dimensions"})));
    throw std::runtime_error("is stored in the format " + format.substr(0, 20) + ", which is not read");
}

} // namespace tessera::importer
