#include "app/importer/readers/hdf_names.h"

#include "app/importer/readers/check_file.h"
#include "app/importer/readers/hdf_id.h"
#include "volume/system/input_file.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>
#include <stdexcept>
#include <vector>

namespace tessera::importer {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kDeepest = 256; // groups within groups

/// A file that the library would open for this name; "" if there is none. It takes an absolute one that is not there
/// for one beside.
std::string linkedFile(const std::string& file, const std::string& name) {
    std::error_code unknown;
    const fs::path folder = fs::path(file).parent_path();
    if (!fs::exists(folder / name, unknown) && !fs::exists(name, unknown) &&
        !fs::exists(folder / fs::path(name).filename(), unknown))
        return {};
    if (fs::path(name).is_absolute() && !fs::exists(name, unknown))
        return besides(file, fs::path(name).filename().string());
    const std::string beside = besides(file, name);
    // One that is not beside the file is looked for from where the program runs.
    return fs::exists(beside, unknown) || !fs::exists(name, unknown) ? beside
                                                                     : besides(file, fs::absolute(name).string());
}

/// The names of other files that hold the samples of a data set; adds those that name others in turn.
void checkStorage(const std::string& file, hid_t dataset, std::vector<std::string>& linked) {
    const HdfId made(H5Dget_create_plist(dataset));
    char name[4096] = {};
    std::size_t parts = 0;
    if (H5Pget_layout(made.id()) == H5D_VIRTUAL && H5Pget_virtual_count(made.id(), &parts) >= 0)
        for (std::size_t p = 0; p < parts; ++p)
            if (H5Pget_virtual_filename(made.id(), p, name, sizeof name) > 0 && std::string(name) != ".")
                linked.push_back(linkedFile(file, name));
    const int externals = H5Pget_external_count(made.id());
    for (int e = 0; e < externals; ++e) {
        off_t offset = 0;
        hsize_t size = 0;
        if (H5Pget_external(made.id(), unsigned(e), sizeof name - 1, name, &offset, &size) >= 0) besides(file, name);
    }
}

/// What one group holds.
struct Members {
    std::vector<std::string> hard, external;
};

Members membersOf(hid_t group) {
    Members members;
    const auto add = [](hid_t, const char* name, const H5L_info_t* info, void* to) -> herr_t {
        auto& all = *static_cast<Members*>(to);
        if (info->type == H5L_TYPE_HARD) all.hard.emplace_back(name);
        if (info->type == H5L_TYPE_EXTERNAL) all.external.emplace_back(name);
        return 0;
    };
    hsize_t at = 0;
    H5Literate(group, H5_INDEX_NAME, H5_ITER_NATIVE, &at, add, &members);
    return members;
}

/// The file that an external link names; "" where the link is damaged.
std::string fileOfLink(hid_t group, const std::string& link) {
    H5L_info_t info{};
    if (H5Lget_info(group, link.c_str(), &info, H5P_DEFAULT) < 0) return {};
    std::vector<char> value(std::min<std::size_t>(info.u.val_size, 1 << 16));
    if (H5Lget_val(group, link.c_str(), value.data(), value.size(), H5P_DEFAULT) < 0) return {};
    unsigned flags = 0;
    const char *file = nullptr, *object = nullptr;
    if (H5Lunpack_elink_val(value.data(), value.size(), &flags, &file, &object) < 0 || file == nullptr) return {};
    return file;
}

/// Each object once, whatever links lead to it.
std::string keyOfObject(hid_t object) {
    H5G_stat_t about{};
    if (H5Gget_objinfo(object, ".", 1, &about) < 0)
        throw std::runtime_error("has an object that cannot be told from others");
    return std::to_string(about.objno[0]) + " " + std::to_string(about.objno[1]);
}

void checkNamesIn(const std::string& path, std::vector<std::string>& linked) {
    const HdfId file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
    if (!file) return;
    struct Group {
        std::shared_ptr<const HdfId> id;
        std::size_t depth = 0;
    };
    std::set<std::string> seen;
    std::vector<Group> pending{{std::make_shared<const HdfId>(H5Gopen2(file.id(), "/", H5P_DEFAULT)), 0}};
    while (!pending.empty()) {
        const Group group = std::move(pending.back());
        pending.pop_back();
        if (!*group.id) continue;
        const Members members = membersOf(group.id->id());
        for (const std::string& link : members.external)
            if (const std::string name = fileOfLink(group.id->id(), link); !name.empty())
                linked.push_back(linkedFile(path, name));
        for (const std::string& name : members.hard) {
            auto object = std::make_shared<const HdfId>(H5Oopen(group.id->id(), name.c_str(), H5P_DEFAULT));
            if (!*object) continue;
            const H5I_type_t kind = H5Iget_type(object->id());
            if (kind != H5I_DATASET && kind != H5I_GROUP) continue;
            if (!seen.insert(keyOfObject(object->id())).second) continue;
            if (kind == H5I_DATASET) checkStorage(path, object->id(), linked);
            if (kind != H5I_GROUP) continue;
            if (group.depth >= kDeepest)
                throw std::runtime_error("nests groups more than " + std::to_string(kDeepest) + " deep");
            pending.push_back({std::move(object), group.depth + 1});
        }
    }
}

} // namespace

void checkHdfNames(const std::string& path) {
    static std::set<std::string> known; // of this process, which reads the files of one request
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    std::vector<std::string> pending{path};
    while (!pending.empty()) {
        const std::string next = std::move(pending.back());
        pending.pop_back();
        if (known.contains(next) || !whyNoFile(next).empty() || H5Fis_hdf5(next.c_str()) <= 0) continue;
        checkNamesIn(next, pending);
        known.insert(next);
    }
}

} // namespace tessera::importer
