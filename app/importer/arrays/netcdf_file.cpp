#include "app/importer/arrays/netcdf_file.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vtk_netcdf.h>

namespace tessera::importer {

namespace {

struct NcType {
    nc_type type;
    int vtkType;
    double unwritten; ///< 0: of one byte, all of whose numbers are values
};
constexpr NcType kNcTypes[] = {{NC_BYTE, VTK_SIGNED_CHAR, 0},
                               {NC_UBYTE, VTK_UNSIGNED_CHAR, 0},
                               {NC_CHAR, VTK_CHAR, 0},
                               {NC_SHORT, VTK_SHORT, NC_FILL_SHORT},
                               {NC_USHORT, VTK_UNSIGNED_SHORT, NC_FILL_USHORT},
                               {NC_INT, VTK_INT, NC_FILL_INT},
                               {NC_UINT, VTK_UNSIGNED_INT, NC_FILL_UINT},
                               {NC_INT64, VTK_LONG_LONG, double(NC_FILL_INT64)},
                               {NC_UINT64, VTK_UNSIGNED_LONG_LONG, double(NC_FILL_UINT64)},
                               {NC_FLOAT, VTK_FLOAT, double(NC_FILL_FLOAT)},
                               {NC_DOUBLE, VTK_DOUBLE, NC_FILL_DOUBLE}};

const NcType* ncTypeOf(nc_type type) {
    const auto* known = std::ranges::find(kNcTypes, type, &NcType::type);
    return known == std::end(kNcTypes) ? nullptr : known;
}

/// Throws where a call of the library failed.
void wantNc(int status) {
    if (status != NC_NOERR) throw std::runtime_error("is truncated or damaged: " + std::string(nc_strerror(status)));
}

Attribute ncAttribute(int group, int variable, const char* name) {
    constexpr std::size_t kMost = 100'000;
    Attribute attribute;
    nc_type type = NC_NAT;
    std::size_t length = 0;
    if (nc_inq_att(group, variable, name, &type, &length) != NC_NOERR || length == 0 || length > kMost)
        return attribute;
    if (type == NC_CHAR) {
        attribute.text.resize(length);
        if (nc_get_att_text(group, variable, name, attribute.text.data()) != NC_NOERR) attribute.text.clear();
        attribute.text.resize(std::min(attribute.text.find('\0'), attribute.text.size()));
    } else if (type == NC_STRING) {
        std::vector<char*> words(length, nullptr);
        if (nc_get_att_string(group, variable, name, words.data()) != NC_NOERR) return attribute;
        for (const char* word : words)
            if (word != nullptr) attribute.text += (attribute.text.empty() ? "" : " ") + std::string(word);
        nc_free_string(length, words.data());
    } else if (ncTypeOf(type) != nullptr) {
        attribute.numbers.resize(length);
        if (nc_get_att_double(group, variable, name, attribute.numbers.data()) != NC_NOERR) attribute.numbers.clear();
        attribute.floating = type == NC_FLOAT || type == NC_DOUBLE;
    }
    return attribute;
}

Attributes ncAttributes(int group, int variable) {
    Attributes out;
    int count = 0;
    if (nc_inq_varnatts(group, variable, &count) != NC_NOERR) return out;
    for (int a = 0; a < count; ++a) {
        char name[NC_MAX_NAME + 1] = {};
        if (nc_inq_attname(group, variable, a, name) == NC_NOERR) out[name] = ncAttribute(group, variable, name);
    }
    return out;
}

/// The type of the numbers of an enumeration, and their names.
nc_type baseOfEnum(int group, nc_type type, std::string& words) {
    std::size_t members = 0;
    nc_type base = NC_NAT;
    if (nc_inq_enum(group, type, nullptr, &base, nullptr, &members) != NC_NOERR) return NC_NAT;
    for (std::size_t m = 0; m < members && members <= 1000; ++m) {
        char name[NC_MAX_NAME + 1] = {};
        unsigned char value[8] = {};
        if (nc_inq_enum_member(group, type, int(m), name, value) != NC_NOERR) break;
        long long number = 0;
        if (base == NC_BYTE) number = static_cast<signed char>(value[0]);
        if (base == NC_UBYTE) number = value[0];
        if (base == NC_SHORT || base == NC_USHORT) number = *reinterpret_cast<const short*>(value);
        if (base == NC_INT || base == NC_UINT) number = *reinterpret_cast<const int*>(value);
        if (base == NC_INT64 || base == NC_UINT64) number = *reinterpret_cast<const long long*>(value);
        words += (words.empty() ? "" : "; ") + std::to_string(number) + " " + name;
    }
    return base;
}

std::string kindOfNc(int group, nc_type type) {
    if (type == NC_CHAR || type == NC_STRING) return "text";
    int kind = 0;
    if (type <= NC_MAX_ATOMIC_TYPE ||
        nc_inq_user_type(group, type, nullptr, nullptr, nullptr, nullptr, &kind) != NC_NOERR)
        return {};
    return kind == NC_COMPOUND ? "compound" : kind == NC_VLEN ? "lists" : kind == NC_OPAQUE ? "opaque" : "";
}

int unsignedOf(int vtkType) {
    switch (vtkType) {
    case VTK_SIGNED_CHAR:
        return VTK_UNSIGNED_CHAR;
    case VTK_SHORT:
        return VTK_UNSIGNED_SHORT;
    case VTK_INT:
        return VTK_UNSIGNED_INT;
    case VTK_LONG_LONG:
        return VTK_UNSIGNED_LONG_LONG;
    default:
        return vtkType;
    }
}

/// Makes negative numbers of attributes those that an unsigned number of so many bytes stores.
void makeUnsigned(Attributes& attributes, int bytes) {
    const double whole = std::ldexp(1.0, 8 * bytes);
    for (const char* name : {"_FillValue", "missing_value", "valid_min", "valid_max", "valid_range", "flag_values"})
        if (const auto at = attributes.find(name); at != attributes.end())
            for (double& number : at->second.numbers)
                if (number < 0) number += whole;
}

} // namespace

NetCdfFile::NetCdfFile(const std::string& path) {
    const int status = nc_open(path.c_str(), NC_NOWRITE, &file_);
    if (status == NC_ENOTNC) throw std::runtime_error("is not a NetCDF file");
    wantNc(status);
    try {
        addGroup(file_, "", 0);
    } catch (...) {
        nc_close(file_);
        throw;
    }
}

NetCdfFile::~NetCdfFile() {
    nc_close(file_);
}

void NetCdfFile::addGroup(int group, const std::string& path, int depth) {
    constexpr int kMost = 100'000, kDeepest = 50;
    int count = 0;
    wantNc(nc_inq_dimids(group, &count, nullptr, 0));
    std::vector<int> ids(std::size_t(std::clamp(count, 0, kMost)));
    if (count > 0 && count <= kMost) wantNc(nc_inq_dimids(group, &count, ids.data(), 0));
    int growing = 0;
    nc_inq_unlimdims(group, &growing, nullptr);
    std::vector<int> grows(std::size_t(std::clamp(growing, 0, kMost)));
    if (growing > 0 && growing <= kMost) nc_inq_unlimdims(group, &growing, grows.data());
    for (const int id : ids) {
        NetCdfDimension dimension;
        char name[NC_MAX_NAME + 1] = {};
        wantNc(nc_inq_dim(group, id, name, &dimension.length));
        dimension.id = id;
        dimension.path = path + name;
        dimension.grows = std::ranges::find(grows, id) != grows.end();
        dimensions.push_back(std::move(dimension));
    }
    wantNc(nc_inq_nvars(group, &count));
    for (int id = 0; id < count && id < kMost; ++id) addVariable(group, id, path);
    wantNc(nc_inq_grps(group, &count, nullptr));
    if (count <= 0 || count > kMost || depth > kDeepest) return;
    std::vector<int> groups(static_cast<std::size_t>(count));
    wantNc(nc_inq_grps(group, &count, groups.data()));
    for (const int inner : groups) {
        char name[NC_MAX_NAME + 1] = {};
        wantNc(nc_inq_grpname(inner, name));
        addGroup(inner, path + name + "/", depth + 1);
    }
}

void NetCdfFile::addVariable(int group, int id, const std::string& path) {
    NetCdfVariable variable;
    char name[NC_MAX_NAME + 1] = {};
    nc_type type = NC_NAT;
    int axes = 0, ids[NC_MAX_VAR_DIMS] = {};
    wantNc(nc_inq_var(group, id, name, &type, &axes, ids, nullptr));
    variable.group = group;
    variable.id = id;
    variable.path = path + name;
    variable.kind = kindOfNc(group, type);
    if (type > NC_MAX_ATOMIC_TYPE) type = baseOfEnum(group, type, variable.words);
    const NcType* known = ncTypeOf(type);
    if (known != nullptr) variable.vtkType = known->vtkType;
    for (int a = 0; a < axes; ++a) {
        const auto at = std::ranges::find(dimensions, ids[a], &NetCdfDimension::id);
        if (at == dimensions.end()) throw std::runtime_error("is truncated or damaged: a variable without its axes");
        variable.dimensions.push_back(int(at - dimensions.begin()));
        variable.dims.push_back(at->length);
    }
    variable.attributes = ncAttributes(group, id);
    int noFill = 0;
    const bool filled = nc_inq_var_fill(group, id, &noFill, nullptr) != NC_NOERR || noFill == 0;
    if (known != nullptr && known->unwritten != 0 && filled && !variable.attributes.contains("_FillValue"))
        variable.unwritten = {known->unwritten};
    const bool isUnsigned = lowered(textOf(variable.attributes, "_Unsigned")) == "true";
    if (const int other = unsignedOf(variable.vtkType); isUnsigned && other != variable.vtkType) {
        variable.vtkType = other;
        makeUnsigned(variable.attributes, vtkDataArray::GetDataTypeSize(other));
        const int bytes = vtkDataArray::GetDataTypeSize(other);
        if (!variable.unwritten.empty()) variable.unwritten[0] += std::ldexp(1.0, 8 * bytes);
    }
    variables.push_back(std::move(variable));
}

vtkSmartPointer<vtkDataArray> NetCdfFile::read(const NetCdfVariable& variable, const Slab& part) const {
    std::size_t all = 1;
    for (const std::size_t n : part.count) all *= n;
    auto out = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(variable.vtkType));
    out->SetNumberOfTuples(vtkIdType(all));
    const std::size_t zero = 0, one = 1;
    const int status = nc_get_vara(variable.group, variable.id, part.first.empty() ? &zero : part.first.data(),
                                   part.count.empty() ? &one : part.count.data(), out->GetVoidPointer(0));
    if (status != NC_NOERR)
        throw std::runtime_error("variable \"" + variable.path + "\" cannot be read: " + nc_strerror(status));
    return out;
}

std::vector<std::string> NetCdfFile::lines(const NetCdfVariable& variable) const {
    if (variable.vtkType != VTK_CHAR || variable.dims.size() != 2) return {};
    const std::size_t length = variable.dims[1], count = variable.dims[0];
    if (length == 0 || length > 1000 || count > 1'000'000) return {};
    std::string text(length * count, '\0');
    const std::size_t first[] = {0, 0}, all[] = {count, length};
    if (nc_get_vara_text(variable.group, variable.id, first, all, text.data()) != NC_NOERR) return {};
    std::vector<std::string> out;
    for (std::size_t i = 0; i < count; ++i) {
        std::string line = text.substr(i * length, length);
        line.resize(std::min(line.find('\0'), line.size()));
        out.push_back(std::move(line));
    }
    return out;
}

} // namespace tessera::importer
