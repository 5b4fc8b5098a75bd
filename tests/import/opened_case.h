#pragma once

#include "tests/import/foreign_files.h"
#include "volume/import/files/series.h"
#include "volume/import/opened_series.h"

#include <cmath>
#include <string>
#include <vector>

/// Files of other programs in tests/import/cases, and what is read of them.
namespace tessera::volume {

inline std::string caseFile(const std::string& name) {
    return std::string(TESSERA_SOURCE_DIR) + "/tests/import/cases/" + name;
}

struct OpenedCase {
    Dataset data;
    std::string format;
    std::vector<std::string> notes;

    const DatasetInfo& info() const { return data.info; }
    int parameter(const std::string& name) const {
        for (std::size_t p = 0; p < data.info.parameters.size(); ++p)
            if (data.info.parameters[p].name == name) return int(p);
        ADD_FAILURE() << "no parameter " << name;
        return 0;
    }
    bool has(const std::string& name) const {
        return std::ranges::find(data.info.parameters, name, &Parameter::name) != data.info.parameters.end();
    }
    const Parameter& about(const std::string& name) const { return data.info.parameters[std::size_t(parameter(name))]; }
    Field field(const std::string& name, int time = 0, int component = 0) const {
        return data.read(parameter(name), component, time);
    }
    /// The value of a sample, NaN where it is absent.
    double at(const std::string& name, glm::ivec3 index, int time = 0, int component = 0) const {
        const Field values = field(name, time, component);
        const std::size_t n = values.lattice.index(index);
        return values.present(n) ? values.value(n) : std::nan("");
    }
    std::size_t present(const std::string& name, int time = 0) const {
        const Field values = field(name, time);
        std::size_t count = 0;
        for (std::size_t i = 0; i < values.count(); ++i) count += values.present(i) ? 1 : 0;
        return count;
    }
    /// Mean of the present samples, NaN without any.
    double mean(const std::string& name, int time = 0, int component = 0) const {
        const Field values = field(name, time, component);
        double sum = 0, count = 0;
        for (std::size_t i = 0; i < values.count(); ++i)
            if (values.present(i)) {
                sum += values.value(i);
                ++count;
            }
        return sum / count;
    }
    bool isNoted(const std::string& words) const {
        return std::ranges::any_of(notes,
                                   [&](const std::string& note) { return note.find(words) != std::string::npos; });
    }
    /// Samples that differ from x + 10 y + 110 z (of indices) at the first time.
    std::size_t wrongSamples(const std::string& name, double scale = 1) const {
        const Field values = field(name);
        const glm::ivec3 n = values.lattice.size;
        std::size_t wrong = 0;
        for (int z = 0; z < n.z; ++z)
            for (int y = 0; y < n.y; ++y)
                for (int x = 0; x < n.x; ++x) {
                    const std::size_t i = values.lattice.index({x, y, z});
                    wrong += values.present(i) && values.value(i) == scale * (x + 10 * y + 110 * z) ? 0 : 1;
                }
        return wrong;
    }
};

inline OpenedCase openCases(const std::vector<std::string>& paths, const ImportOptions& options = {}) {
    OpenedSeries series = openSeries(expandPaths(paths), options, true, {}, true);
    return {std::move(series.dataset), series.format, std::move(series.notes)};
}
inline OpenedCase openCase(const std::string& name, const ImportOptions& options = {}) {
    return openCases({caseFile(name)}, options);
}

class Cases : public testing::Test {
protected:
    void SetUp() override {
        if (findImporter().empty()) GTEST_SKIP() << "tessera-import was not built";
    }
};

} // namespace tessera::volume
