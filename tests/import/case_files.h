#pragma once

#include "tests/import/foreign_files.h"

/// Stored files of other programs (tests/import/cases) and what a right reader shows of them.
namespace tessera::volume {

class CaseFiles : public ForeignFiles {
protected:
    static std::string stored(const std::string& name) {
        return std::string(TESSERA_SOURCE_DIR) + "/tests/import/cases/" + name;
    }
    /// All notes on a file, parted by line ends.
    static std::string notesOn(const std::string& path) {
        std::string all;
        for (const std::string& note : previewFiles({path}, {}).notes) all += note + "\n";
        return all;
    }
    /// Samples of a parameter that are not those of `wanted` (x, y, z), absent ones included.
    static int wrong(const Dataset& dataset, int parameter, int component, int time,
                     const std::function<double(int, int, int)>& wanted) {
        const Field field = dataset.read(parameter, component, time);
        const glm::ivec3 size = dataset.info.lattice.size;
        int count = 0;
        for (int z = 0; z < size.z; ++z)
            for (int y = 0; y < size.y; ++y)
                for (int x = 0; x < size.x; ++x) {
                    const std::size_t i = dataset.info.lattice.index({x, y, z});
                    count += !field.present(i) || field.value(i) != wanted(x, y, z) ? 1 : 0;
                }
        return count;
    }
    /// Most stored volumes hold this.
    static double ramp(int x, int y, int z) { return x + 10 * y + 110 * z; }
    static std::vector<std::string> names(const Dataset& dataset) {
        std::vector<std::string> all;
        for (const Parameter& parameter : dataset.info.parameters) all.push_back(parameter.name);
        return all;
    }
    static void expectRamp(const Dataset& dataset, glm::dvec3 spacing, const std::string& unit) {
        ASSERT_EQ(dataset.info.lattice.size, glm::ivec3(10, 11, 12));
        for (int axis = 0; axis < 3; ++axis) EXPECT_DOUBLE_EQ(dataset.info.lattice.spacing[axis], spacing[axis]);
        EXPECT_EQ(dataset.info.lengthUnit, unit);
        EXPECT_EQ(wrong(dataset, 0, 0, 0, ramp), 0);
    }
};

} // namespace tessera::volume
