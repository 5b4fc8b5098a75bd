// NumPy: .npy, and .npz, a zip file of them.
#include "app/importer/arrays/array_file.h"
#include "app/importer/arrays/open_arrays.h"
#include "app/importer/arrays/whole_numbers.h"
#include "app/importer/readers/check_file.h"
#include "app/importer/readers/read_files.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <vtkType.h>
#include <zlib.h>

namespace tessera::importer {

namespace {

struct NpyForm {
    int vtkType = VTK_VOID;
    std::string descr, unit; ///< the unit of a time
    std::size_t bytes = 0, begin = 0;
    bool swap = false, fortran = false, half = false;
    Dims dims;
};

std::uint64_t little(const std::string& bytes, std::size_t at, std::size_t count) {
    if (at + count > bytes.size()) throw std::runtime_error("ends too early: truncated");
    std::uint64_t value = 0;
    for (std::size_t i = count; i-- > 0;) value = value * 256 + static_cast<unsigned char>(bytes[at + i]);
    return value;
}

/// Text of a key in the header's dictionary, up to the next key or the end.
std::string entry(const std::string& header, const std::string& key) {
    const std::size_t at = header.find("'" + key + "'");
    if (at == std::string::npos) throw std::runtime_error("has a damaged header");
    const std::size_t colon = header.find(':', at);
    return header.substr(colon + 1, header.find('\'', header.find(',', colon)) - colon - 1);
}

struct NpyType {
    std::string_view code;
    int vtkType;
};
constexpr NpyType kNpyTypes[] = {{"f2", VTK_FLOAT},          {"f4", VTK_FLOAT},         {"f8", VTK_DOUBLE},
                                 {"u1", VTK_UNSIGNED_CHAR},  {"b1", VTK_UNSIGNED_CHAR}, {"i1", VTK_SIGNED_CHAR},
                                 {"u2", VTK_UNSIGNED_SHORT}, {"i2", VTK_SHORT},         {"i4", VTK_INT},
                                 {"u4", VTK_UNSIGNED_INT},   {"i8", VTK_LONG_LONG},     {"u8", VTK_UNSIGNED_LONG_LONG},
                                 {"M8", VTK_LONG_LONG},      {"m8", VTK_LONG_LONG}};

/// The shape of an array; its size must be that of the bytes.
void parseShape(const std::string& header, std::size_t has, NpyForm& form) {
    const std::size_t open = header.find('(', header.find("'shape'")), close = header.find(')', open);
    if (open == std::string::npos || close == std::string::npos || header.find('-', open) < close)
        throw std::runtime_error("has a damaged header");
    double all = double(form.bytes);
    for (std::size_t at = open + 1; at < close;) {
        char* end = nullptr;
        const unsigned long long n = std::strtoull(header.c_str() + at, &end, 10);
        if (end == header.c_str() + at) break;
        form.dims.push_back(n);
        all *= double(n);
        at = static_cast<std::size_t>(end - header.c_str()) + 1;
    }
    if (form.dims.size() > 32) throw std::runtime_error("has a damaged header");
    wantBytes(double(has), all);
}

/// The form of an array of numbers; its `vtkType` is VTK_VOID for others.
NpyForm parseNpy(const std::string& bytes) {
    if (!bytes.starts_with("\x93NUMPY")) throw std::runtime_error("is not a NumPy array");
    NpyForm form;
    const bool old = little(bytes, 6, 1) == 1;
    const std::size_t length = little(bytes, 8, old ? 2 : 4);
    form.begin = (old ? 10 : 12) + length;
    if (form.begin > bytes.size()) throw std::runtime_error("ends within its header: truncated");
    const std::string header = bytes.substr(old ? 10 : 12, length);
    const std::size_t colon = header.find(':', header.find("'descr'")), word = header.find('\'', colon);
    if (colon == std::string::npos || word == std::string::npos) throw std::runtime_error("has a damaged header");
    form.descr = header.substr(word + 1, header.find('\'', word + 1) - word - 1);
    if (header.find('[', colon) < word) form.descr = "a structure";
    for (const auto& [code, type] : kNpyTypes)
        if (form.descr.size() >= 3 && form.descr.substr(1, 2) == code &&
            (form.descr.size() == 3 || (code[1] == '8' && form.descr[3] == '['))) {
            form.vtkType = type;
            form.half = code == "f2";
        }
    if (form.vtkType == VTK_VOID) return form;
    if (form.descr[1] == 'M' || form.descr[1] == 'm') { // [ns], [s], [25s]
        form.unit = form.descr.substr(std::min<std::size_t>(4, form.descr.size()));
        form.unit = form.unit.substr(0, form.unit.find(']'));
        if (form.unit == "m") form.unit = "min";
        if (form.descr[1] == 'M') form.unit += " since 1970-01-01";
    }
    form.bytes = static_cast<std::size_t>(form.descr[2] - '0');
    form.swap = form.descr[0] == '>';
    form.fortran = entry(header, "fortran_order").find("True") != std::string::npos;
    parseShape(header, bytes.size() - form.begin, form);
    return form;
}

/// The numbers of a part of an array, as they are stored, in the machine's order of bytes.
vtkSmartPointer<vtkDataArray> readNpy(const std::string& bytes, const NpyForm& form, const Slab& part) {
    const std::size_t axes = form.dims.size();
    Dims stride(axes, 1);
    for (std::size_t a = 1; a < axes; ++a) {
        const std::size_t axis = form.fortran ? a : axes - 1 - a, faster = form.fortran ? a - 1 : axes - a;
        stride[axis] = stride[faster] * form.dims[faster];
    }
    std::size_t all = 1;
    for (const std::size_t n : part.count) all *= n;
    const std::size_t row = axes == 0 ? 1 : part.count.back(), step = axes == 0 ? 1 : stride.back();
    std::string numbers(all * form.bytes, '\0');
    Dims index(axes, 0);
    for (std::size_t n = 0; n < all; n += row) {
        std::size_t from = 0;
        for (std::size_t a = 0; a < axes; ++a) from += (part.first[a] + index[a]) * stride[a];
        const char* at = bytes.data() + form.begin + from * form.bytes;
        char* to = numbers.data() + n * form.bytes;
        if (step == 1)
            std::memcpy(to, at, row * form.bytes);
        else
            for (std::size_t i = 0; i < row; ++i)
                std::memcpy(to + i * form.bytes, at + i * step * form.bytes, form.bytes);
        for (std::size_t a = axes > 0 ? axes - 1 : 0; a-- > 0;) {
            if (++index[a] < part.count[a]) break;
            index[a] = 0;
        }
    }
    if (form.swap)
        for (std::size_t n = 0; n < all; ++n)
            std::reverse(numbers.data() + n * form.bytes, numbers.data() + (n + 1) * form.bytes);
    auto out = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(form.vtkType));
    out->SetNumberOfTuples(vtkIdType(all));
    if (form.half)
        for (std::size_t n = 0; n < all; ++n) {
            std::uint16_t bits = 0;
            std::memcpy(&bits, numbers.data() + 2 * n, 2);
            out->SetComponent(vtkIdType(n), 0, double(floatOfHalf(bits)));
        }
    else
        std::memcpy(out->GetVoidPointer(0), numbers.data(), numbers.size());
    return out;
}

StoredArray npyArray(std::shared_ptr<const std::string> bytes, const NpyForm& form, const std::string& name) {
    StoredArray array;
    array.name = name;
    array.unit = form.unit;
    array.dims = form.dims;
    array.vtkType = form.vtkType;
    array.statedBytes = array.storedBytes = double(bytes->size());
    array.read = [bytes = std::move(bytes), form](const Slab& part) { return readNpy(*bytes, form, part); };
    return array;
}

/// Unpacks the members of a zip file.
ArrayFile readZip(const std::string& bytes) {
    const std::size_t end = bytes.rfind("PK\5\6");
    if (!bytes.starts_with("PK") || end == std::string::npos)
        throw std::runtime_error("has no list of its members at its end: truncated, or no .npz file");
    std::size_t at = little(bytes, end + 16, 4);
    const std::size_t members = little(bytes, end + 10, 2);
    ArrayFile file;
    for (std::size_t m = 0; m < members; ++m) {
        if (little(bytes, at, 4) != 0x02014b50) throw std::runtime_error("has a damaged list of members");
        const std::size_t method = little(bytes, at + 10, 2), crc = little(bytes, at + 16, 4);
        const std::size_t nameLength = little(bytes, at + 28, 2);
        std::size_t packed = little(bytes, at + 20, 4), size = little(bytes, at + 24, 4),
                    local = little(bytes, at + 42, 4);
        std::string name = bytes.substr(at + 46, nameLength);
        const std::size_t extraEnd = at + 46 + nameLength + little(bytes, at + 30, 2);
        for (std::size_t extra = at + 46 + nameLength; extra + 4 <= extraEnd;) { // sizes beyond 4 GB
            const std::size_t kind = little(bytes, extra, 2), length = little(bytes, extra + 2, 2);
            std::size_t field = extra + 4;
            for (std::size_t* value : {&size, &packed, &local})
                if (kind == 1 && *value == 0xffffffff) {
                    *value = little(bytes, field, 8);
                    field += 8;
                }
            extra += 4 + length;
        }
        at = extraEnd + little(bytes, at + 32, 2);
        const std::size_t begin = local + 30 + little(bytes, local + 26, 2) + little(bytes, local + 28, 2);
        if (begin > bytes.size() || packed > bytes.size() - begin)
            throw std::runtime_error("ends too early: truncated");
        auto member = std::make_shared<std::string>();
        if (method == 0) {
            *member = bytes.substr(begin, packed);
        } else {
            if (size > 1000 * packed + 65536) throw std::runtime_error("has a member of invalid size");
            member->resize(size);
            z_stream stream{};
            stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + begin));
            stream.next_out = reinterpret_cast<Bytef*>(member->data());
            if (inflateInit2(&stream, -15) != Z_OK) throw std::runtime_error("cannot be decompressed");
            std::size_t in = packed, out = size;
            int status = Z_OK;
            while (status == Z_OK && (in > 0 || out > 0)) {
                stream.avail_in = static_cast<unsigned>(std::min<std::size_t>(in, 1u << 30));
                stream.avail_out = static_cast<unsigned>(std::min<std::size_t>(out, 1u << 30));
                const unsigned givenIn = stream.avail_in, givenOut = stream.avail_out;
                status = inflate(&stream, Z_NO_FLUSH);
                in -= givenIn - stream.avail_in;
                out -= givenOut - stream.avail_out;
            }
            inflateEnd(&stream);
            if (out != 0) throw std::runtime_error("member " + name + " is damaged");
        }
        if (crc32_z(crc32_z(0, nullptr, 0), reinterpret_cast<const Bytef*>(member->data()), member->size()) != crc)
            throw std::runtime_error("member " + name + " is damaged");
        if (!name.ends_with(".npy")) continue;
        name.resize(name.size() - 4);
        const NpyForm form = parseNpy(*member);
        if (form.vtkType == VTK_VOID)
            file.unread.push_back("\"" + name + "\" (" + form.descr.substr(0, 40) + ")");
        else
            file.arrays.push_back(npyArray(std::move(member), form, name));
    }
    return file;
}

} // namespace

void openNumpy(Source& source) {
    auto bytes = std::make_shared<const std::string>(readWhole(source.path));
    if (bytes->starts_with("PK")) {
        openArrays(readZip(*bytes), source);
        return;
    }
    const NpyForm form = parseNpy(*bytes);
    if (form.vtkType == VTK_VOID)
        throw std::runtime_error("has numbers of type " + form.descr.substr(0, 40) +
                                 ", which is not read: write it with astype(numpy.float32)");
    if (form.dims.empty()) throw std::runtime_error("holds a single number");
    ArrayFile file;
    file.arrays.push_back(npyArray(bytes, form, std::filesystem::path(source.path).stem().string()));
    openArrays(std::move(file), source);
}

} // namespace tessera::importer
