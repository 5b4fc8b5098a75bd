// NumPy: .npy, and .npz, a zip file of them.
#include "app/importer/arrays/array_file.h"
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
    std::size_t bytes = 0, begin = 0;
    bool swap = false, fortran = false;
    std::vector<std::size_t> dims;
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

NpyForm parseNpy(const std::string& bytes) {
    if (!bytes.starts_with("\x93NUMPY")) throw std::runtime_error("is not a NumPy array");
    NpyForm form;
    const bool old = little(bytes, 6, 1) == 1;
    const std::size_t length = little(bytes, 8, old ? 2 : 4);
    form.begin = (old ? 10 : 12) + length;
    if (form.begin > bytes.size()) throw std::runtime_error("ends within its header: truncated");
    const std::string header = bytes.substr(old ? 10 : 12, length);
    const std::size_t word = header.find('\'', header.find(':', header.find("'descr'")));
    const std::string descr = header.substr(word + 1, header.find('\'', word + 1) - word - 1);
    static constexpr struct {
        const char* code;
        int vtkType;
    } kTypes[] = {{"f4", VTK_FLOAT},
                  {"f8", VTK_DOUBLE},
                  {"u1", VTK_UNSIGNED_CHAR},
                  {"b1", VTK_UNSIGNED_CHAR},
                  {"i1", VTK_SIGNED_CHAR},
                  {"u2", VTK_UNSIGNED_SHORT},
                  {"i2", VTK_SHORT},
                  {"i4", VTK_INT},
                  {"u4", VTK_UNSIGNED_INT},
                  {"i8", VTK_LONG_LONG},
                  {"u8", VTK_UNSIGNED_LONG_LONG}};
    for (const auto& [code, type] : kTypes)
        if (descr.size() == 3 && descr.substr(1) == code) form.vtkType = type;
    if (form.vtkType == VTK_VOID)
        throw std::runtime_error("has numbers of type " + descr.substr(0, 40) +
                                 ", which is not read: write it with astype(numpy.float32)");
    form.bytes = static_cast<std::size_t>(descr[2] - '0');
    form.swap = descr[0] == '>';
    form.fortran = entry(header, "fortran_order").find("True") != std::string::npos;
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
    wantBytes(double(bytes.size() - form.begin), all);
    return form;
}

StoredArray arrayOf(std::shared_ptr<const std::string> bytes, const NpyForm& form, const std::string& name) {
    StoredArray array;
    array.name = name;
    array.dims = form.dims;
    array.read = [bytes = std::move(bytes), form](std::size_t first, std::size_t count) {
        std::size_t inner = 1;
        for (std::size_t axis = 1; axis < form.dims.size(); ++axis) inner *= form.dims[axis];
        auto out = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(form.vtkType));
        out->SetNumberOfTuples(vtkIdType(inner * count));
        char* to = static_cast<char*>(out->GetVoidPointer(0));
        if (!form.fortran) {
            std::memcpy(to, bytes->data() + form.begin + first * inner * form.bytes, inner * count * form.bytes);
        } else { // Fortran order: the first index is the fastest
            std::vector<std::size_t> index(form.dims.size(), 0);
            index[0] = first;
            for (std::size_t n = 0; n < inner * count; ++n) {
                std::size_t from = 0;
                for (std::size_t axis = form.dims.size(); axis-- > 0;) from = from * form.dims[axis] + index[axis];
                std::memcpy(to + n * form.bytes, bytes->data() + form.begin + from * form.bytes, form.bytes);
                for (std::size_t axis = form.dims.size(); axis-- > 0;) {
                    if (++index[axis] < (axis == 0 ? first + count : form.dims[axis])) break;
                    index[axis] = 0;
                }
            }
        }
        if (form.swap)
            for (std::size_t n = 0; n < inner * count; ++n)
                std::reverse(to + n * form.bytes, to + (n + 1) * form.bytes);
        return out;
    };
    return array;
}

/// Unpacks the members of a zip file.
std::vector<StoredArray> readZip(const std::string& bytes) {
    const std::size_t end = bytes.rfind("PK\5\6");
    if (!bytes.starts_with("PK") || end == std::string::npos)
        throw std::runtime_error("has no list of its members at its end: truncated, or no .npz file");
    std::size_t at = little(bytes, end + 16, 4);
    const std::size_t members = little(bytes, end + 10, 2);
    std::vector<StoredArray> arrays;
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
        if (!form.dims.empty()) arrays.push_back(arrayOf(std::move(member), form, name));
    }
    return arrays;
}

} // namespace

void openNumpy(Source& source) {
    auto bytes = std::make_shared<const std::string>(readWhole(source.path));
    if (bytes->starts_with("PK")) {
        openArrays(readZip(*bytes), source);
        return;
    }
    const NpyForm form = parseNpy(*bytes);
    if (form.dims.empty()) throw std::runtime_error("holds a single number");
    openArrays({arrayOf(bytes, form, std::filesystem::path(source.path).stem().string())}, source);
}

} // namespace tessera::importer
