#include "codec/archive/archive.h"
#include "codec/pack/pack.h"
#include "tests/codec/make_dataset.h"
#include "volume/import/import.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <gtest/gtest.h>

namespace tessera::codec {
namespace {

using namespace testing;

std::vector<std::string> sidecars() {
    const char* asked = std::getenv("TESSERA_DATA");
    const std::filesystem::path folder = std::filesystem::path(asked ? asked : TESSERA_TEST_DATA) / "volumes";
    std::vector<std::string> found;
    std::error_code missing;
    for (const auto& entry : std::filesystem::directory_iterator(folder, missing))
        if (entry.path().extension() == ".json" && std::filesystem::file_size(entry.path()) > 0)
            found.push_back(entry.path().string());
    std::sort(found.begin(), found.end());
    return found;
}

template <class Visit> void forFrames(const volume::DatasetInfo& info, Visit&& visit) {
    for (int t = 0; t < int(info.times.size()); ++t)
        for (int p = 0; p < int(info.parameters.size()); ++p)
            for (int c = 0; c < info.parameters[std::size_t(p)].components; ++c) visit(p, c, t);
}

TEST(RealVolumes, ComeBackBitForBitAndWithinTheBound) {
    const std::vector<std::string> files = sidecars();
    if (files.empty()) GTEST_SKIP() << "no volumes under $TESSERA_DATA";
    const TemporaryFolder folder;
    for (const std::string& file : files) {
        SCOPED_TRACE(file);
        volume::Dataset dataset = volume::openFiles({file}, {});
        PackOptions options;
        options.lattice = StoredLattice::CC;
        pack(dataset, options, folder / "exact.tsr");
        const Archive exact(folder / "exact.tsr");
        forFrames(dataset.info, [&](int p, int c, int t) {
            ASSERT_EQ(dataset.read(p, c, t).samples, readField(exact, p, c, t).samples);
        });
        options.maxError = 1e-3;
        pack(dataset, options, folder / "bounded.tsr");
        const Archive bounded(folder / "bounded.tsr");
        forFrames(dataset.info, [&](int p, int c, int t) {
            const volume::Field a = dataset.read(p, c, t), b = readField(bounded, p, c, t);
            const Range range = dataset.info.parameters[std::size_t(p)].ranges[0];
            double worst = 0;
            for (std::size_t i = 0; i < a.count(); ++i)
                if (a.present(i)) worst = std::max(worst, std::abs(a.value(i) - b.value(i)));
            EXPECT_LE(worst, 1e-3 * (range.hi - range.lo));
        });
    }
}

// Headers and models, LZMA, and floats that only look like decimals: what these sizes stand and fall with.
TEST(RealVolumes, ArchivesAreAsShortAsTheyWere) {
    const TemporaryFolder folder;
    const std::pair<const char*, double> ratios[] = {
        {"fuel", 100}, {"silicium", 10.5}, {"nucleon", 11.4}, {"neghip", 8}, {"isabel", 1.55}};
    std::size_t found = 0;
    for (const std::string& file : sidecars())
        for (const auto& [name, least] : ratios) {
            if (std::filesystem::path(file).filename().string().rfind(name, 0) != 0) continue;
            volume::Dataset dataset = volume::openFiles({file}, {});
            PackOptions options;
            options.lattice = StoredLattice::CC;
            const PackSummary summary = pack(dataset, options, folder / "exact.tsr");
            EXPECT_GE(double(summary.sourceBytes) / double(summary.archiveBytes), least) << name;
            ++found;
        }
    if (found == 0) GTEST_SKIP() << "no volumes under $TESSERA_DATA";
}

} // namespace
} // namespace tessera::codec
