#include "app/importer/hdf/hdf_file.h"

#include "app/importer/readers/check_file.h"
#include "app/importer/readers/hdf_id.h"
#include "app/importer/readers/hdf_names.h"
#include "volume/system/input_file.h"

#include <algorithm>
#include <hdf5.h>
#include <stdexcept>
#include <vtkType.h>

namespace tessera::importer {

namespace {

hid_t opened(hid_t file, const std::string& path) {
    return path.empty() ? H5Gopen2(file, "/", H5P_DEFAULT) : H5Oopen(file, path.c_str(), H5P_DEFAULT);
}

std::vector<std::size_t> dimsOf(hid_t space) {
    const int axes = H5Sget_simple_extent_ndims(space);
    if (axes <= 0) return {};
    std::vector<hsize_t> dims(std::size_t(axes), 0);
    H5Sget_simple_extent_dims(space, dims.data(), nullptr);
    return {dims.begin(), dims.end()};
}

/// VTK's type for stored numbers.
int vtkTypeFor(hid_t type) {
    const std::size_t bytes = H5Tget_size(type);
    if (H5Tget_class(type) == H5T_FLOAT) return bytes <= 4 ? VTK_FLOAT : VTK_DOUBLE;
    const bool isSigned = H5Tget_sign(type) == H5T_SGN_2;
    if (bytes == 1) return isSigned ? VTK_SIGNED_CHAR : VTK_UNSIGNED_CHAR;
    if (bytes == 2) return isSigned ? VTK_SHORT : VTK_UNSIGNED_SHORT;
    return bytes == 4 && isSigned ? VTK_INT : VTK_DOUBLE;
}

/// Bytes of the file that hold a data set. Those that other files hold are not known: as if they were all there.
double bytesStored(hid_t file, hid_t dataset, double stated) {
    const HdfId made(H5Dget_create_plist(dataset));
    std::size_t parts = 0; // fails where there can be none
    const bool isVirtual = H5Pget_virtual_count(made.id(), &parts) >= 0 && parts > 0;
    if (isVirtual || H5Pget_external_count(made.id()) > 0) return stated;
    hsize_t whole = 0; // a damaged layout may state more than the file has
    H5Fget_filesize(file, &whole);
    return std::min(double(H5Dget_storage_size(dataset)), double(whole));
}

[[noreturn]] void failAt(const std::string& path) {
    throw std::runtime_error("data set \"" + path +
                             "\" cannot be read: damaged, or compressed by a filter that is not installed");
}

/// The data set at a path, and the part of its space that a slab chooses.
struct Selected {
    HdfId dataset, space;
    std::size_t count = 1;

    Selected(hid_t file, const std::string& path, const HdfSlab& slab, std::size_t bytes)
        : dataset(H5Dopen2(file, path.c_str(), H5P_DEFAULT)), space(dataset ? H5Dget_space(dataset.id()) : -1) {
        if (!dataset || !space) failAt(path);
        const std::vector<std::size_t> dims = dimsOf(space.id());
        if (slab.begin.size() != dims.size() || slab.count.size() != dims.size())
            throw std::runtime_error("data set \"" + path + "\" has another number of axes than expected");
        double stated = double(bytes);
        std::vector<hsize_t> begin, step, number;
        for (std::size_t axis = 0; axis < dims.size(); ++axis) {
            const std::size_t stride = slab.stride.empty() ? 1 : std::max<std::size_t>(slab.stride[axis], 1);
            const std::size_t first = slab.begin[axis], n = slab.count[axis];
            if (n > 0 && (first >= dims[axis] || (n - 1) > (dims[axis] - 1 - first) / stride))
                throw std::runtime_error("data set \"" + path + "\" is smaller than its file says: it has " +
                                         std::to_string(dims[axis]) + " values along an axis");
            begin.push_back(first);
            step.push_back(stride);
            number.push_back(n);
            stated *= double(n);
        }
        refuseHollow(stated, bytesStored(file, dataset.id(), stated), "data set \"" + path + "\"");
        for (const hsize_t n : number) count *= std::size_t(n);
        if (number.empty()) return;
        if (count == 0)
            H5Sselect_none(space.id());
        else if (H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, begin.data(), step.data(), number.data(), nullptr) < 0)
            failAt(path);
    }

    void read(const std::string& path, hid_t type, void* to) const {
        if (count == 0) return;
        const hsize_t all = count;
        const HdfId memory(H5Screate_simple(1, &all, nullptr));
        if (H5Dread(dataset.id(), type, memory.id(), space.id(), H5P_DEFAULT, to) < 0) failAt(path);
    }
};

/// Strings of fixed or own length.
std::vector<std::string> stringsFrom(hid_t type, hid_t space, const auto& read) {
    const auto count = std::size_t(std::max<hssize_t>(H5Sget_simple_extent_npoints(space), 0));
    constexpr std::size_t kMost = std::size_t(16) << 20;
    std::vector<std::string> words;
    if (H5Tis_variable_str(type) > 0) {
        if (count > kMost / sizeof(char*)) return {};
        std::vector<char*> pointers(count, nullptr);
        if (read(type, pointers.data()) < 0) return {};
        for (char* text : pointers) {
            words.emplace_back(text != nullptr ? text : "");
            if (text != nullptr) H5free_memory(text);
        }
        return words;
    }
    const std::size_t length = H5Tget_size(type);
    if (length == 0 || count > kMost / length) return {};
    std::string bytes(count * length, '\0');
    if (read(type, bytes.data()) < 0) return {};
    for (std::size_t i = 0; i < count; ++i) {
        std::string text = bytes.substr(i * length, length);
        text.resize(std::min(text.find('\0'), text.size()));
        text.erase(text.find_last_not_of(' ') + 1);
        words.push_back(std::move(text));
    }
    return words;
}

} // namespace

std::size_t HdfShape::count() const {
    std::size_t all = 1;
    for (const std::size_t n : dims) all *= n;
    return all;
}

HdfFile::HdfFile(const std::string& path) : path_(path) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    if (whyNoFile(path) == kPipeOrDevice) throw std::runtime_error(kPipeOrDevice);
    checkHdfNames(path);
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    if (file < 0)
        throw std::runtime_error(H5Fis_hdf5(path.c_str()) > 0 ? "is truncated or damaged" : "is not an HDF5 file");
    file_ = std::shared_ptr<const std::int64_t>(new std::int64_t(file), [](const std::int64_t* id) {
        H5Idec_ref(hid_t(*id));
        delete id;
    });
}

bool HdfFile::has(const std::string& path) const {
    if (path.empty() || path == "/") return true;
    for (std::size_t end = path.find('/', 1);; end = path.find('/', end + 1)) { // each part must exist to be asked
        const std::string part = path.substr(0, end);
        if (H5Lexists(hid_t(*file_), part.c_str(), H5P_DEFAULT) <= 0) return false;
        if (end == std::string::npos) return H5Oexists_by_name(hid_t(*file_), part.c_str(), H5P_DEFAULT) > 0;
    }
}

bool HdfFile::isGroup(const std::string& path) const {
    if (!has(path)) return false;
    const HdfId object(opened(hid_t(*file_), path));
    return object && H5Iget_type(object.id()) == H5I_GROUP;
}

std::vector<std::string> HdfFile::members(const std::string& group) const {
    std::vector<std::string> names;
    if (!isGroup(group)) return names;
    const HdfId object(opened(hid_t(*file_), group));
    const HdfId made(H5Gget_create_plist(object.id()));
    unsigned order = 0;
    H5Pget_link_creation_order(made.id(), &order);
    const bool created = (order & H5P_CRT_ORDER_TRACKED) != 0;
    const auto add = [](hid_t, const char* name, const H5L_info_t*, void* to) -> herr_t {
        constexpr std::size_t kMost = 1'000'000;
        auto& all = *static_cast<std::vector<std::string>*>(to);
        all.emplace_back(name);
        return all.size() < kMost ? 0 : 1;
    };
    hsize_t at = 0;
    H5Literate(object.id(), created ? H5_INDEX_CRT_ORDER : H5_INDEX_NAME, H5_ITER_INC, &at, add, &names);
    return names;
}

std::uint64_t HdfFile::address(const std::string& path) const {
    const HdfId object(opened(hid_t(*file_), path));
    H5G_stat_t about{};
    if (!object || H5Gget_objinfo(object.id(), ".", 1, &about) < 0) return 0;
    return (std::uint64_t(about.objno[1]) << 32) ^ std::uint64_t(about.objno[0]);
}

std::optional<HdfShape> HdfFile::shape(const std::string& path) const {
    if (!has(path)) return std::nullopt;
    const HdfId dataset(H5Dopen2(hid_t(*file_), path.c_str(), H5P_DEFAULT));
    if (!dataset) return std::nullopt;
    const HdfId type(H5Dget_type(dataset.id())), space(H5Dget_space(dataset.id()));
    const H5T_class_t kind = H5Tget_class(type.id());
    HdfShape shape;
    shape.dims = dimsOf(space.id());
    shape.numbers = kind == H5T_FLOAT || kind == H5T_INTEGER;
    shape.words = kind == H5T_STRING;
    shape.floating = kind == H5T_FLOAT;
    shape.bytes = H5Tget_size(type.id());
    double count = 1; // a damaged one overflows
    for (const std::size_t n : shape.dims) count *= double(n);
    if (count > 1e15) throw std::runtime_error("data set \"" + path + "\" states more values than memory can hold");
    return shape;
}

vtkSmartPointer<vtkDataArray> HdfFile::array(const std::string& path, const HdfSlab& slab) const {
    const std::optional<HdfShape> about = shape(path);
    if (!about || !about->numbers) throw std::runtime_error("data set \"" + path + "\" is missing or holds no numbers");
    const Selected part(hid_t(*file_), path, slab, about->bytes);
    const HdfId type(H5Dget_type(part.dataset.id()));
    const int vtkType = vtkTypeFor(type.id());
    auto out = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(vtkType));
    out->SetNumberOfTuples(vtkIdType(part.count));
    part.read(path, hdfTypeInMemory(vtkType), out->GetVoidPointer(0));
    return out;
}

vtkSmartPointer<vtkDataArray> HdfFile::rows(const std::string& path, std::size_t first, std::size_t count) const {
    const std::optional<HdfShape> about = shape(path);
    if (!about || about->dims.empty()) throw std::runtime_error("data set \"" + path + "\" is missing");
    HdfSlab slab{std::vector<std::size_t>(about->dims.size(), 0), {}, about->dims};
    slab.begin[0] = first;
    slab.count[0] = count;
    return array(path, slab);
}

vtkSmartPointer<vtkDataArray> HdfFile::all(const std::string& path) const {
    const std::optional<HdfShape> about = shape(path);
    if (!about) throw std::runtime_error("data set \"" + path + "\" is missing");
    return array(path, {std::vector<std::size_t>(about->dims.size(), 0), {}, about->dims});
}

std::vector<std::int64_t> HdfFile::integers(const std::string& path, std::size_t first, std::size_t count) const {
    const std::optional<HdfShape> about = shape(path);
    if (!about || !about->numbers) throw std::runtime_error("data set \"" + path + "\" is missing or holds no numbers");
    HdfSlab slab{std::vector<std::size_t>(about->dims.size(), 0), {}, about->dims};
    if (!slab.begin.empty()) {
        slab.begin[0] = first;
        slab.count[0] = count;
    }
    const Selected part(hid_t(*file_), path, slab, sizeof(std::int64_t));
    std::vector<std::int64_t> out(part.count);
    part.read(path, H5T_NATIVE_INT64, out.data());
    return out;
}

std::vector<std::int64_t> HdfFile::integers(const std::string& path) const {
    const std::optional<HdfShape> about = shape(path);
    if (!about) return {};
    return integers(path, 0, about->dims.empty() ? 1 : about->dims[0]);
}

std::vector<double> HdfFile::doubles(const std::string& path) const {
    const std::optional<HdfShape> about = shape(path);
    if (!about || !about->numbers) return {};
    const Selected part(hid_t(*file_), path, {std::vector<std::size_t>(about->dims.size(), 0), {}, about->dims},
                        sizeof(double));
    std::vector<double> out(part.count);
    part.read(path, H5T_NATIVE_DOUBLE, out.data());
    return out;
}

std::vector<std::string> HdfFile::texts(const std::string& path) const {
    const std::optional<HdfShape> about = shape(path);
    if (!about || !about->words) return {};
    const HdfId dataset(H5Dopen2(hid_t(*file_), path.c_str(), H5P_DEFAULT));
    const HdfId type(H5Dget_type(dataset.id())), space(H5Dget_space(dataset.id()));
    return stringsFrom(type.id(), space.id(), [&](hid_t kind, void* to) {
        return H5Dread(dataset.id(), kind, H5S_ALL, H5S_ALL, H5P_DEFAULT, to);
    });
}

std::vector<double> HdfFile::attribute(const std::string& path, const std::string& name) const {
    const HdfId object(opened(hid_t(*file_), path));
    if (!object || H5Aexists(object.id(), name.c_str()) <= 0) return {};
    const HdfId attribute(H5Aopen(object.id(), name.c_str(), H5P_DEFAULT));
    const HdfId type(H5Aget_type(attribute.id())), space(H5Aget_space(attribute.id()));
    const H5T_class_t kind = H5Tget_class(type.id());
    const hssize_t count = H5Sget_simple_extent_npoints(space.id());
    if ((kind != H5T_FLOAT && kind != H5T_INTEGER) || count < 1 || count > 100'000) return {};
    std::vector<double> out{};
    out.resize(std::size_t(count));
    if (H5Aread(attribute.id(), H5T_NATIVE_DOUBLE, out.data()) < 0) return {};
    return out;
}

std::string HdfFile::word(const std::string& path, const std::string& name) const {
    const HdfId object(opened(hid_t(*file_), path));
    if (!object || H5Aexists(object.id(), name.c_str()) <= 0) return {};
    const HdfId attribute(H5Aopen(object.id(), name.c_str(), H5P_DEFAULT));
    const HdfId type(H5Aget_type(attribute.id())), space(H5Aget_space(attribute.id()));
    if (H5Tget_class(type.id()) != H5T_STRING) return {};
    const std::vector<std::string> words =
        stringsFrom(type.id(), space.id(), [&](hid_t kind, void* to) { return H5Aread(attribute.id(), kind, to); });
    return words.empty() ? std::string() : words.front();
}

} // namespace tessera::importer
