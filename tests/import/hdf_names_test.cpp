// Files that HDF5 files name: by external links, by samples in other files, by virtual data sets.
#include "app/importer/readers/hdf_id.h"
#include "tests/import/foreign_files.h"

#include <gmock/gmock.h>
#include <vector>

namespace tessera::volume {
namespace {

using importer::HdfId;

constexpr hsize_t kDims[3] = {2, 2, 2};

class HdfNames : public ForeignFiles {
protected:
    void SetUp() override {
        ForeignFiles::SetUp();
        if (IsSkipped()) return;
        fs::create_directories(folder_ / "data");
        for (const char* place : {"far.h5", "data/near.h5"}) {
            const HdfId file(create(place));
            addNumbers(file.id(), "T", H5P_DEFAULT);
        }
        write("far.raw", std::string("\0\0\x80\x3f", 4) + std::string(28, '\0'));
        write("data/near.raw", read((folder_ / "far.raw").string()));
    }
    hid_t create(const std::string& name) const {
        return H5Fcreate((folder_ / name).c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    }
    static void addNumbers(hid_t file, const char* name, hid_t made) {
        const HdfId space(H5Screate_simple(3, kDims, nullptr));
        const HdfId set(H5Dcreate2(file, name, H5T_NATIVE_FLOAT, space.id(), H5P_DEFAULT, made, H5P_DEFAULT));
        const std::vector<float> values{1, 2, 3, 4, 5, 6, 7, 8};
        if (made == H5P_DEFAULT) H5Dwrite(set.id(), H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    }
    std::string withLink(const std::string& to) const {
        const HdfId file(create("data/link.h5"));
        H5Lcreate_external(to.c_str(), "/T", file.id(), "T", H5P_DEFAULT, H5P_DEFAULT);
        return (folder_ / "data/link.h5").string();
    }
    std::string withStorage(const std::string& in) const {
        const HdfId file(create("data/storage.h5"));
        const HdfId made(H5Pcreate(H5P_DATASET_CREATE));
        H5Pset_external(made.id(), in.c_str(), 0, 32);
        addNumbers(file.id(), "T", made.id());
        return (folder_ / "data/storage.h5").string();
    }
    std::string withVirtual(const std::string& of) const {
        const HdfId file(create("data/virtual.h5"));
        const HdfId made(H5Pcreate(H5P_DATASET_CREATE)), space(H5Screate_simple(3, kDims, nullptr));
        H5Pset_virtual(made.id(), space.id(), of.c_str(), "/T", space.id());
        addNumbers(file.id(), "T", made.id());
        return (folder_ / "data/virtual.h5").string();
    }
};

TEST_F(HdfNames, OutsideAreRefusedUnlessAllowed) {
    ImportOptions allowed;
    allowed.allowOutside = true;
    const std::string far = (folder_ / "far").string();
    for (const std::string& h5 : {far + ".h5", std::string("../far.h5")}) {
        for (const std::string& path : {withLink(h5), withVirtual(h5)}) {
            EXPECT_THAT(failure(path), testing::HasSubstr("outside of its folder")) << path << " " << h5;
            EXPECT_EQ(openFiles({path}, allowed).read(0, 0, 0).value(0), 1) << path << " " << h5;
        }
    }
    EXPECT_THAT(failure(withStorage(far + ".raw")), testing::HasSubstr("outside of its folder"));
    EXPECT_EQ(openFiles({withStorage(far + ".raw")}, allowed).read(0, 0, 0).value(0), 1);
    EXPECT_THAT(failure(withStorage("../far.raw")), testing::HasSubstr("outside of its folder"));
    withStorage("../far.raw"); // and where a virtual data set leads
    EXPECT_THAT(failure(withVirtual("storage.h5")), testing::HasSubstr("outside of its folder"));
    // Through a file beside it, too.
    fs::rename(withLink("../far.h5"), folder_ / "data/hop.h5");
    EXPECT_THAT(failure(withLink("hop.h5")), testing::HasSubstr("outside of its folder"));
}

TEST_F(HdfNames, BesideAreRead) {
    const std::string near = (folder_ / "data/near.h5").string();
    for (const std::string& name : {near, std::string("near.h5"), std::string("./near.h5")}) {
        EXPECT_EQ(openFiles({withLink(name)}, {}).read(0, 0, 0).value(0), 1) << name;
        EXPECT_EQ(openFiles({withVirtual(name)}, {}).read(0, 0, 0).value(0), 1) << name;
    }
    EXPECT_EQ(openFiles({withStorage("near.raw")}, {}).read(0, 0, 0).value(0), 1);
    {
        const HdfId file(H5Fopen((folder_ / "data/near.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT));
        H5Lcreate_external("../gone.h5", "/T", file.id(), "link to a file that is not there", H5P_DEFAULT, H5P_DEFAULT);
    }
    EXPECT_EQ(openFiles({near}, {}).read(0, 0, 0).value(0), 1);
    // The library takes an absolute name that is not there for one beside: files that were moved together.
    EXPECT_EQ(openFiles({withLink("/nowhere/near.h5")}, {}).read(0, 0, 0).value(0), 1);
}

TEST_F(HdfNames, GroupsAreNotFollowedWithoutEnd) {
    const auto nested = [&](int depth) {
        {
            const HdfId file(create("data/deep.h5"));
            std::string path;
            for (int d = 0; d < depth; ++d) {
                path += "/g";
                const HdfId group(H5Gcreate2(file.id(), path.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
            }
            addNumbers(file.id(), (path + "/T").c_str(), H5P_DEFAULT);
        }
        return (folder_ / "data/deep.h5").string();
    };
    EXPECT_EQ(openFiles({nested(200)}, {}).read(0, 0, 0).value(0), 1);
    EXPECT_THAT(failure(nested(300)), testing::HasSubstr("nests groups more than 256 deep"));
    // Groups that hold themselves are entered once.
    {
        const HdfId file(H5Fopen((folder_ / "data/near.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT));
        H5Lcreate_hard(file.id(), "/", file.id(), "/again", H5P_DEFAULT, H5P_DEFAULT);
    }
    EXPECT_EQ(openFiles({(folder_ / "data/near.h5").string()}, {}).read(0, 0, 0).value(0), 1);
}

} // namespace
} // namespace tessera::volume
