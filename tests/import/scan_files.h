#pragma once

#include "tests/import/foreign_files.h"

/// Volumes whose samples are told by their places. Files in cases/scans were made by teem, nibabel, rawtominc, or by
/// hand to the format's rules; their samples are x + 10 y + 110 z where nothing else is said.
namespace tessera::volume {

inline std::string scan(const std::string& name) {
    return std::string(TESSERA_SOURCE_DIR) + "/tests/import/cases/scans/" + name;
}

class ScanCases : public ForeignFiles {
protected:
    /// The number of absent samples; others are value(at) at each place, all at one time.
    template <class Value>
    static void expectSamples(const Dataset& dataset, const Value& value, int parameter = 0, int component = 0,
                              int time = 0) {
        const Field field = dataset.read(parameter, component, time);
        const Lattice& lattice = dataset.info.lattice;
        ASSERT_EQ(field.count(), lattice.count());
        for (int z = 0; z < lattice.size.z; ++z)
            for (int y = 0; y < lattice.size.y; ++y)
                for (int x = 0; x < lattice.size.x; ++x) {
                    const std::size_t at = lattice.index({x, y, z});
                    ASSERT_TRUE(field.present(at));
                    ASSERT_EQ(field.value(at), double(value(x, y, z))) << x << " " << y << " " << z;
                }
    }
    static double counted(int x, int y, int z) { return x + 10 * y + 110 * z; }
    /// All but the time of the series, at dimensions 10 x 11 x 12.
    static Dataset openCase(const std::string& name, glm::dvec3 spacing, const std::string& unit) {
        Dataset dataset = openFiles({scan(name)}, {});
        EXPECT_EQ(dataset.info.lattice.size, glm::ivec3(10, 11, 12)) << name;
        EXPECT_EQ(dataset.info.lattice.spacing, spacing) << name;
        EXPECT_EQ(dataset.info.lengthUnit, unit) << name;
        return dataset;
    }
    static std::string notesOf(const std::string& path) {
        std::string all;
        for (const std::string& note : previewFiles({path}, {}).notes) all += note + "\n";
        return all;
    }
    /// A NRRD file of bytes 0, 1, 2 ...
    std::string nrrd(const std::string& sizes, const std::string& fields) const {
        std::string head = "NRRD0005\ntype: uchar\nsizes: " + sizes + "\n" + fields;
        std::string samples;
        for (int i = 0; i < 255; ++i) samples += char(i);
        return write("a.nrrd", head + "encoding: raw\n\n" + samples);
    }
};

} // namespace tessera::volume
