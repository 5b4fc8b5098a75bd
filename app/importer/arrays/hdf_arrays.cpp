#include "app/importer/arrays/hdf_arrays.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <vtkType.h>

namespace tessera::importer {

namespace {

namespace fs = std::filesystem;

int vtkTypeOf(hid_t type) {
    const std::size_t bytes = H5Tget_size(type);
    if (H5Tget_class(type) == H5T_FLOAT) return bytes <= 4 ? VTK_FLOAT : VTK_DOUBLE;
    if (H5Tget_class(type) != H5T_INTEGER) return VTK_VOID;
    const bool isSigned = H5Tget_sign(type) == H5T_SGN_2;
    if (bytes == 1) return isSigned ? VTK_SIGNED_CHAR : VTK_UNSIGNED_CHAR;
    if (bytes == 2) return isSigned ? VTK_SHORT : VTK_UNSIGNED_SHORT;
    if (bytes <= 4) return isSigned ? VTK_INT : VTK_UNSIGNED_INT;
    return isSigned ? VTK_LONG_LONG : VTK_UNSIGNED_LONG_LONG;
}

std::string kindOf(hid_t type) {
    switch (H5Tget_class(type)) {
    case H5T_STRING:
        return "text";
    case H5T_COMPOUND:
        return "compound";
    case H5T_ENUM:
        return H5Tget_nmembers(type) == 2 && H5Tget_size(type) == 1 ? "bool" : "names";
    default:
        return "no numbers";
    }
}

/// The same for two identifiers of one object.
std::string keyOf(hid_t object) {
    H5O_info_t info;
#if H5_VERSION_GE(1, 12, 0)
    if (H5Oget_info3(object, &info, H5O_INFO_BASIC) < 0) return {};
    std::string key(reinterpret_cast<const char*>(&info.token), sizeof info.token);
#else
    if (H5Oget_info(object, &info) < 0) return {};
    std::string key = std::to_string(info.addr);
#endif
    return key + "/" + std::to_string(info.fileno);
}

/// Texts of an attribute; none if it holds something else.
std::vector<std::string> textsOf(hid_t attribute, hid_t type, std::size_t count) {
    std::vector<std::string> out;
    if (H5Tis_variable_str(type) > 0) {
        std::vector<char*> words(count, nullptr);
        if (H5Aread(attribute, type, words.data()) < 0) return out;
        for (char* word : words) {
            out.emplace_back(word != nullptr ? word : "");
            if (word != nullptr) H5free_memory(word);
        }
        return out;
    }
    const std::size_t bytes = H5Tget_size(type);
    if (bytes == 0 || bytes * count > 1'000'000) return out;
    std::string all(bytes * count, '\0');
    if (H5Aread(attribute, type, all.data()) < 0) return out;
    for (std::size_t i = 0; i < count; ++i) {
        std::string word = all.substr(i * bytes, bytes);
        word.resize(std::min(word.find('\0'), word.size()));
        word.erase(word.find_last_not_of(' ') + 1);
        out.push_back(std::move(word));
    }
    return out;
}

std::vector<std::string> textsOf(hid_t object, const char* name) {
    if (H5Aexists(object, name) <= 0) return {};
    const HdfId attribute(H5Aopen(object, name, H5P_DEFAULT));
    const HdfId type(H5Aget_type(attribute.id())), space(H5Aget_space(attribute.id()));
    const hssize_t count = H5Sget_simple_extent_npoints(space.id());
    if (H5Tget_class(type.id()) != H5T_STRING || count < 1 || count > 1000) return {};
    return textsOf(attribute.id(), type.id(), std::size_t(count));
}

herr_t addHdfAttribute(hid_t object, const char* name, const H5A_info_t*, void* to) {
    auto& out = *static_cast<Attributes*>(to);
    const HdfId attribute(H5Aopen(object, name, H5P_DEFAULT));
    if (attribute.id() < 0) return 0;
    const HdfId type(H5Aget_type(attribute.id())), space(H5Aget_space(attribute.id()));
    const hssize_t count = H5Sget_simple_extent_npoints(space.id());
    if (count < 1 || count > 10000) return 0;
    Attribute own;
    const H5T_class_t kind = H5Tget_class(type.id());
    if (kind == H5T_STRING) {
        for (const std::string& word : textsOf(attribute.id(), type.id(), std::size_t(count)))
            own.text += (own.text.empty() ? "" : " ") + word;
    } else if (kind == H5T_INTEGER || kind == H5T_FLOAT) {
        own.numbers.resize(std::size_t(count));
        if (H5Aread(attribute.id(), H5T_NATIVE_DOUBLE, own.numbers.data()) < 0) return 0;
        own.floating = kind == H5T_FLOAT;
    } else {
        return 0;
    }
    out[name] = std::move(own);
    return 0;
}

Attributes hdfAttributes(hid_t object) {
    Attributes out;
    H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, nullptr, addHdfAttribute, &out);
    return out;
}

/// Keys of the scales of a data set's axes, by the attribute DIMENSION_LIST.
std::vector<std::string> scalesOf(hid_t dataset, std::size_t axes) {
    if (H5Aexists(dataset, "DIMENSION_LIST") <= 0) return {};
    const HdfId attribute(H5Aopen(dataset, "DIMENSION_LIST", H5P_DEFAULT));
    const HdfId type(H5Aget_type(attribute.id())), space(H5Aget_space(attribute.id()));
    if (H5Tget_class(type.id()) != H5T_VLEN || H5Sget_simple_extent_npoints(space.id()) != hssize_t(axes)) return {};
    const HdfId inner(H5Tget_super(type.id()));
    if (H5Tequal(inner.id(), H5T_STD_REF_OBJ) <= 0) return {};
    std::vector<hvl_t> lists(axes, hvl_t{0, nullptr});
    if (H5Aread(attribute.id(), type.id(), lists.data()) < 0) return {};
    std::vector<std::string> out(axes);
    for (std::size_t a = 0; a < axes; ++a)
        if (lists[a].len > 0) {
            const HdfId scale(H5Rdereference2(dataset, H5P_DEFAULT, H5R_OBJECT, lists[a].p));
            if (scale.id() >= 0) out[a] = keyOf(scale.id());
        }
    H5Dvlen_reclaim(type.id(), space.id(), H5P_DEFAULT, lists.data());
    return out;
}

/// A data set whose files beside this one are found from its folder, not from where the program runs.
hid_t openDataset(hid_t file, const std::string& path) {
    const HdfId access(H5Pcreate(H5P_DATASET_ACCESS));
    H5Pset_efile_prefix(access.id(), "${ORIGIN}");
    H5Pset_virtual_prefix(access.id(), "${ORIGIN}");
    const hid_t dataset = H5Dopen2(file, path.c_str(), access.id());
    // Through a link to another file the library takes no prefix that differs from its own.
    return dataset >= 0 ? dataset : H5Oopen(file, path.c_str(), H5P_DEFAULT);
}

/// The first file that a data set has its samples in and that is not there; "" if all are.
std::string missingFile(hid_t made, const fs::path& folder) {
    const auto isThere = [&](const std::string& name) {
        return name == "." || fs::exists(fs::path(name).is_absolute() ? fs::path(name) : folder / name);
    };
    std::size_t parts = 0;
    if (H5Pget_layout(made) == H5D_VIRTUAL && H5Pget_virtual_count(made, &parts) >= 0)
        for (std::size_t p = 0; p < parts && p < 100'000; ++p) {
            char name[4096] = {};
            if (H5Pget_virtual_filename(made, p, name, sizeof name) > 0 && !isThere(name)) return name;
        }
    for (int e = 0; e < H5Pget_external_count(made) && e < 100'000; ++e) {
        char name[4096] = {};
        off_t offset = 0;
        hsize_t size = 0;
        if (H5Pget_external(made, unsigned(e), sizeof name - 1, name, &offset, &size) >= 0 && !isThere(name))
            return name;
    }
    return {};
}

vtkSmartPointer<vtkDataArray> readSlab(hid_t file, const std::string& name, int vtkType, const Slab& part) {
    const HdfId dataset(openDataset(file, name));
    const HdfId space(H5Dget_space(dataset.id()));
    const std::vector<hsize_t> first(part.first.begin(), part.first.end()), count(part.count.begin(), part.count.end());
    vtkIdType numbers = 1;
    for (const hsize_t n : count) numbers *= vtkIdType(n);
    auto out = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(vtkType));
    out->SetNumberOfTuples(numbers);
    const HdfId memory(count.empty() ? H5Screate(H5S_SCALAR)
                                     : H5Screate_simple(int(count.size()), count.data(), nullptr));
    const bool chosen = count.empty() || H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, first.data(), nullptr,
                                                             count.data(), nullptr) >= 0;
    if (!chosen || H5Dread(dataset.id(), hdfTypeInMemory(vtkType), memory.id(), space.id(), H5P_DEFAULT,
                           out->GetVoidPointer(0)) < 0)
        throw std::runtime_error("dataset \"" + name +
                                 "\" cannot be read: damaged, or compressed by a filter that is not installed");
    return out;
}

/// Bytes of the file that hold the samples of a dataset. Those of other files, which a virtual or external dataset
/// names, are not known: as if they were all there.
double storedBytesOf(hid_t file, hid_t dataset, hid_t made, double stated) {
    if (H5Pget_layout(made) == H5D_VIRTUAL || H5Pget_external_count(made) > 0) return stated;
    hsize_t whole = 0; // a damaged layout may state more than the file has
    H5Fget_filesize(file, &whole);
    return std::min(double(H5Dget_storage_size(dataset)), double(whole));
}

} // namespace

HdfArrays::HdfArrays(const std::string& path) : folder_(fs::path(path).parent_path().string()) {
    file_ = std::make_shared<const HdfId>(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
    if (file_->id() < 0)
        throw std::runtime_error(H5Fis_hdf5(path.c_str()) > 0 ? "is truncated or damaged" : "is not an HDF5 file");
    if (folder_.empty()) folder_ = ".";
#if H5_VERSION_GE(1, 12, 0) // takes the fields to query as a further argument
    const herr_t visited = H5Ovisit(file_->id(), H5_INDEX_NAME, H5_ITER_INC, visitObject, this, H5O_INFO_BASIC);
#else
    const herr_t visited = H5Ovisit(file_->id(), H5_INDEX_NAME, H5_ITER_INC, visitObject, this);
#endif
    if (visited < 0 || H5Lvisit(file_->id(), H5_INDEX_NAME, H5_ITER_INC, visitLink, this) < 0)
        throw std::runtime_error("is truncated or damaged");
    for (const std::string& link : external_) {
        const HdfId object(H5Oopen(file_->id(), link.c_str(), H5P_DEFAULT));
        if (object.id() < 0)
            lost_.push_back(link);
        else if (H5Iget_type(object.id()) == H5I_DATASET)
            addDataset(link);
    }
}

herr_t HdfArrays::visitObject(hid_t, const char* name, const H5O_info_t* info, void* self) {
    auto& file = *static_cast<HdfArrays*>(self);
    const std::string path = std::string(name) == "." ? "" : name;
    if (info->type == H5O_TYPE_GROUP) file.groups_.push_back(path);
    if (info->type != H5O_TYPE_DATASET) return 0;
    try {
        file.addDataset(path);
    } catch (const std::exception&) { // must not pass through the library
        return -1;
    }
    return 0;
}

herr_t HdfArrays::visitLink(hid_t, const char* name, const H5L_info_t* info, void* self) {
    if (info->type == H5L_TYPE_EXTERNAL) static_cast<HdfArrays*>(self)->external_.emplace_back(name);
    return 0;
}

void HdfArrays::addDataset(const std::string& path) {
    const HdfId dataset(openDataset(file_->id(), path));
    if (dataset.id() < 0) throw std::runtime_error("is truncated or damaged");
    const HdfId type(H5Dget_type(dataset.id())), space(H5Dget_space(dataset.id()));
    const HdfId made(H5Dget_create_plist(dataset.id()));
    HdfDataset out;
    out.path = path;
    out.key = keyOf(dataset.id());
    out.vtkType = vtkTypeOf(type.id());
    const int axes = H5Sget_simple_extent_ndims(space.id());
    if (axes < 0 || H5Sget_simple_extent_type(space.id()) == H5S_NULL) return;
    std::vector<hsize_t> dims(static_cast<std::size_t>(axes));
    if (axes > 0) H5Sget_simple_extent_dims(space.id(), dims.data(), nullptr);
    out.dims.assign(dims.begin(), dims.end());
    out.attributes = hdfAttributes(dataset.id());
    out.scales = scalesOf(dataset.id(), out.dims.size());
    out.labels = textsOf(dataset.id(), "DIMENSION_LABELS");
    if (out.labels.size() != out.dims.size()) out.labels.clear();
    if (out.vtkType == VTK_VOID) out.problem = kindOf(type.id());
    if (const std::string missing = missingFile(made.id(), folder_); !missing.empty())
        out.problem = "its file " + missing + " is missing";
    out.statedBytes = double(H5Tget_size(type.id()));
    for (const hsize_t n : dims) out.statedBytes *= double(n);
    out.storedBytes = storedBytesOf(file_->id(), dataset.id(), made.id(), out.statedBytes);
    datasets_.push_back(std::move(out));
}

const HdfDataset* HdfArrays::find(const std::string& path) const {
    const auto at = std::ranges::find(datasets_, path, &HdfDataset::path);
    if (at != datasets_.end()) return &*at;
    if (!has(path)) return nullptr; // another path to a data set that is known
    const HdfId object(H5Oopen(file_->id(), path.c_str(), H5P_DEFAULT));
    return object.id() < 0 || H5Iget_type(object.id()) != H5I_DATASET ? nullptr : findKey(keyOf(object.id()));
}

const HdfDataset* HdfArrays::findKey(const std::string& key) const {
    const auto at = std::ranges::find(datasets_, key, &HdfDataset::key);
    return key.empty() || at == datasets_.end() ? nullptr : &*at;
}

Attributes HdfArrays::attributesOf(const std::string& object) const {
    const HdfId opened(H5Oopen(file_->id(), object.empty() ? "/" : object.c_str(), H5P_DEFAULT));
    return opened.id() < 0 ? Attributes() : hdfAttributes(opened.id());
}

bool HdfArrays::has(const std::string& path) const {
    for (std::size_t slash = path.find('/', 1);; slash = path.find('/', slash + 1)) {
        if (H5Lexists(file_->id(), path.substr(0, slash).c_str(), H5P_DEFAULT) <= 0) return false;
        if (slash == std::string::npos) return true;
    }
}

StoredArray HdfArrays::arrayOf(const HdfDataset& dataset) const {
    StoredArray array;
    array.name = dataset.path;
    for (const char* name : {"units", "unit", "Units", "Unit", "UNITS"})
        if (array.unit.empty()) array.unit = textOf(dataset.attributes, name);
    array.dims = dataset.dims;
    array.vtkType = dataset.vtkType;
    array.form = formBy(dataset.attributes, dataset.vtkType);
    array.statedBytes = dataset.statedBytes;
    array.storedBytes = dataset.storedBytes;
    array.words = wordsOfFlags(dataset.attributes);
    array.read = [file = file_, path = dataset.path, type = dataset.vtkType](const Slab& part) {
        return readSlab(file->id(), path, type, part);
    };
    return array;
}

std::vector<double> HdfArrays::numbers(const HdfDataset& dataset) const {
    const StoredArray array = arrayOf(dataset);
    refuseHollow(array);
    return valuesBy(array.form, numbersOf(array));
}

} // namespace tessera::importer
