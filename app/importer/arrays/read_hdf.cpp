// HDF5 files without a known structure: their datasets by their paths.
#include "app/importer/arrays/array_file.h"
#include "app/importer/readers/read_files.h"

#include <algorithm>
#include <hdf5.h>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vtkType.h>

namespace tessera::importer {

namespace {

/// Owns an identifier of the library and closes it.
class Handle {
public:
    Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
    ~Handle() {
        if (id_ >= 0) close_(id_);
    }
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    hid_t id() const { return id_; }

private:
    hid_t id_;
    herr_t (*close_)(hid_t);
};

int vtkTypeOf(hid_t type) {
    const std::size_t bytes = H5Tget_size(type);
    if (H5Tget_class(type) == H5T_FLOAT) return bytes <= 4 ? VTK_FLOAT : VTK_DOUBLE;
    const bool isSigned = H5Tget_sign(type) == H5T_SGN_2;
    if (bytes == 1) return isSigned ? VTK_SIGNED_CHAR : VTK_UNSIGNED_CHAR;
    if (bytes == 2) return isSigned ? VTK_SHORT : VTK_UNSIGNED_SHORT;
    return bytes == 4 && isSigned ? VTK_INT : VTK_DOUBLE;
}

hid_t memoryType(int vtkType) {
    switch (vtkType) {
    case VTK_FLOAT:
        return H5T_NATIVE_FLOAT;
    case VTK_SIGNED_CHAR:
        return H5T_NATIVE_SCHAR;
    case VTK_UNSIGNED_CHAR:
        return H5T_NATIVE_UCHAR;
    case VTK_SHORT:
        return H5T_NATIVE_SHORT;
    case VTK_UNSIGNED_SHORT:
        return H5T_NATIVE_USHORT;
    case VTK_INT:
        return H5T_NATIVE_INT;
    default:
        return H5T_NATIVE_DOUBLE;
    }
}

/// The attribute `units` or `unit`, or "".
std::string unitOf(hid_t dataset) {
    for (const char* name : {"units", "unit", "Units", "Unit", "UNITS"}) {
        if (H5Aexists(dataset, name) <= 0) continue;
        const Handle attribute(H5Aopen(dataset, name, H5P_DEFAULT), H5Aclose);
        const Handle type(H5Aget_type(attribute.id()), H5Tclose);
        if (H5Tget_class(type.id()) != H5T_STRING) continue;
        const Handle space(H5Aget_space(attribute.id()), H5Sclose);
        if (H5Sget_simple_extent_npoints(space.id()) != 1) continue;
        std::string text;
        if (H5Tis_variable_str(type.id()) > 0) {
            char* words = nullptr;
            if (H5Aread(attribute.id(), type.id(), &words) < 0 || words == nullptr) continue;
            text = words;
            H5free_memory(words);
        } else {
            text.resize(H5Tget_size(type.id()));
            if (H5Aread(attribute.id(), type.id(), text.data()) < 0) continue;
            text.resize(std::min(text.find('\0'), text.size()));
        }
        text.erase(text.find_last_not_of(' ') + 1);
        return text == "-" || text == "1" ? "" : text;
    }
    return {};
}

vtkSmartPointer<vtkDataArray> readSlab(hid_t file, const std::string& name, int vtkType, std::size_t first,
                                       std::size_t count) {
    const Handle dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
    const Handle space(H5Dget_space(dataset.id()), H5Sclose);
    std::vector<hsize_t> dims(std::size_t(std::max(H5Sget_simple_extent_ndims(space.id()), 1)), 1);
    H5Sget_simple_extent_dims(space.id(), dims.data(), nullptr);
    std::vector<hsize_t> begin(dims.size(), 0);
    begin[0] = first;
    dims[0] = count;
    vtkIdType numbers = 1;
    for (const hsize_t n : dims) numbers *= vtkIdType(n);
    auto out = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(vtkType));
    out->SetNumberOfTuples(numbers);
    const Handle memory(H5Screate_simple(int(dims.size()), dims.data(), nullptr), H5Sclose);
    if (H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, begin.data(), nullptr, dims.data(), nullptr) < 0 ||
        H5Dread(dataset.id(), memoryType(vtkType), memory.id(), space.id(), H5P_DEFAULT, out->GetVoidPointer(0)) < 0)
        throw std::runtime_error("dataset \"" + name +
                                 "\" cannot be read: damaged, or compressed by a filter that is not installed");
    return out;
}

/// Bytes of the file that hold the samples of a dataset. Those of other files, which a virtual or external dataset
/// names, are not known: as if they were all there.
double storedBytes(hid_t file, hid_t dataset, double stated) {
    const Handle made(H5Dget_create_plist(dataset), H5Pclose);
    std::size_t parts = 0; // fails where there can be none
    const bool isVirtual = H5Pget_virtual_count(made.id(), &parts) >= 0 && parts > 0;
    if (isVirtual || H5Pget_external_count(made.id()) > 0) return stated;
    hsize_t whole = 0; // a damaged layout may state more than the file has
    H5Fget_filesize(file, &whole);
    return std::min(double(H5Dget_storage_size(dataset)), double(whole));
}

struct Visit {
    std::shared_ptr<const Handle> file;
    std::vector<StoredArray> arrays;
};

herr_t visitDataset(hid_t root, const char* name, const H5O_info_t* info, void* to) {
    if (info->type != H5O_TYPE_DATASET) return 0;
    auto& visit = *static_cast<Visit*>(to);
    const Handle dataset(H5Dopen2(root, name, H5P_DEFAULT), H5Dclose);
    if (dataset.id() < 0) return -1;
    const Handle type(H5Dget_type(dataset.id()), H5Tclose), space(H5Dget_space(dataset.id()), H5Sclose);
    const H5T_class_t kind = H5Tget_class(type.id());
    const int axes = H5Sget_simple_extent_ndims(space.id());
    if ((kind != H5T_FLOAT && kind != H5T_INTEGER) || axes < 1 || axes > 8) return 0;
    std::vector<hsize_t> dims(static_cast<std::size_t>(axes));
    H5Sget_simple_extent_dims(space.id(), dims.data(), nullptr);
    double stated = double(H5Tget_size(type.id()));
    for (const hsize_t n : dims) stated *= double(n);
    StoredArray array{name,
                      unitOf(dataset.id()),
                      {dims.begin(), dims.end()},
                      stated,
                      storedBytes(visit.file->id(), dataset.id(), stated),
                      {}};
    array.read = [file = visit.file, path = array.name, vtkType = vtkTypeOf(type.id())](std::size_t first,
                                                                                        std::size_t count) {
        return readSlab(file->id(), path, vtkType, first, count);
    };
    visit.arrays.push_back(std::move(array));
    return 0;
}

} // namespace

void openHdf(Source& source) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    const auto file =
        std::make_shared<const Handle>(H5Fopen(source.path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    if (file->id() < 0)
        throw std::runtime_error(H5Fis_hdf5(source.path.c_str()) > 0 ? "is truncated or damaged"
                                                                     : "is not an HDF5 file");
    if (H5Lexists(file->id(), "VTKHDF", H5P_DEFAULT) > 0) return openVtkHdf(source);
    if (H5Lexists(file->id(), "CGNSLibraryVersion", H5P_DEFAULT) > 0)
        throw std::runtime_error("is a CGNS file: give it the ending .cgns");
    if (H5Lexists(file->id(), "meshes", H5P_DEFAULT) > 0 && H5Lexists(file->id(), "settings", H5P_DEFAULT) > 0)
        return openFluentHdf(source);
    Visit visit{file, {}};
#if H5_VERSION_GE(1, 12, 0) // takes the fields to query as a further argument
    const herr_t visited = H5Ovisit(file->id(), H5_INDEX_NAME, H5_ITER_INC, visitDataset, &visit, H5O_INFO_BASIC);
#else
    const herr_t visited = H5Ovisit(file->id(), H5_INDEX_NAME, H5_ITER_INC, visitDataset, &visit);
#endif
    if (visited < 0) throw std::runtime_error("is truncated or damaged");
    openArrays(std::move(visit.arrays), source);
}

} // namespace tessera::importer
