#include "app/queries/statistics_query.h"

#include "codec/archive/archive.h"
#include "codec/pack/pack.h"
#include "vis/gl/headless.h"

#include <atomic>
#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>
#include <unistd.h>
#include <vector>

namespace tessera::app {
namespace {

/// An archive that counts what is read of it.
class CountedArchive final : public volume::BrickSource {
public:
    explicit CountedArchive(const std::string& path) : archive_(path) {}
    const volume::DatasetInfo& info() const override { return archive_.info(); }
    const volume::BrickGrid& grid() const override { return archive_.grid(); }
    volume::BrickStats stats(const volume::BrickKey& key) const override { return archive_.stats(key); }
    std::optional<volume::BrickDistribution> distribution(const volume::BrickKey& key) const override {
        return archive_.distribution(key);
    }
    volume::BrickSamples read(const volume::BrickKey& key) const override {
        ++reads;
        return archive_.read(key);
    }
    mutable std::atomic<int> reads = 0;

private:
    codec::Archive archive_;
};

std::shared_ptr<const CountedArchive> packedWave() {
    const std::string path =
        (std::filesystem::temp_directory_path() / ("tessera-feed-" + std::to_string(::getpid()) + ".tsr")).string();
    volume::Dataset made;
    made.info.lattice = {volume::LatticeKind::CC, {96, 96, 96}, {1, 1, 1}, {0, 0, 0}};
    made.info.bounds = {{0, 0, 0}, {95, 95, 95}};
    made.info.times = {0};
    made.info.parameters = {{"T", "K", 1, volume::ScalarType::U16, false, {}, {}},
                            {"p", "Pa", 1, volume::ScalarType::F32, false, {}, {}}};
    made.read = [lattice = made.info.lattice](int parameter, int, int) {
        volume::Field field =
            volume::makeField(lattice, parameter == 0 ? volume::ScalarType::U16 : volume::ScalarType::F32);
        for (std::size_t i = 0; i < field.count(); ++i) {
            const double value = 1000 + 900 * std::sin(double(i) * 1e-3) * std::cos(double(i) * 1e-5);
            if (parameter == 0)
                field.as<std::uint16_t>()[i] = static_cast<std::uint16_t>(value);
            else
                field.as<float>()[i] = static_cast<float>(value);
        }
        return field;
    };
    codec::PackOptions options;
    options.lattice = codec::StoredLattice::CC;
    codec::pack(made, options, path);
    auto source = std::make_shared<const CountedArchive>(path);
    std::filesystem::remove(path); // it is mapped
    return source;
}

// The first answer about a whole archive comes before a sample is read, the last one is exact. With brushes, or pairs
// of parameters, samples have to be looked at from the first.
TEST(StatisticsQueryGl, BeginsWithWhatTheArchiveNotes) {
    const vis::HeadlessContext gl;
    vis::Renderer renderer{vis::RendererOptions{}};
    Jobs jobs;
    std::map<std::string, std::unique_ptr<ViewCache>> caches;
    Session session;
    const auto source = packedWave();
    ViewContext context{session, source, renderer, jobs, caches};
    const int noted = source->grid().levels;
    const auto levelsSeen = [&](const BrushedQuery& query) {
        AsyncStatistics answers;
        std::vector<int> levels;
        for (int frame = 0; frame < 100 && (levels.empty() || levels.back() != 0); ++frame) {
            const auto result = answers.get(context, "feed", query);
            if (result && (levels.empty() || levels.back() != result->statistics.level)) {
                levels.push_back(result->statistics.level);
                if (levels.back() == noted) {
                    EXPECT_EQ(source->reads, 0);
                }
            }
            jobs.wait();
            (void)jobs.collect();
        }
        EXPECT_EQ(answers.failure(), "");
        return levels;
    };
    const auto query = [&](bool pairs) {
        return brushedQuery(session, source->info(), {0, 1}, {{0, 2000}, {0, 2000}}, 32, pairs);
    };
    EXPECT_EQ(levelsSeen(query(false)), (std::vector<int>{noted, 0}));
    EXPECT_GT(source->reads, 0);
    for (const int level : levelsSeen(query(true))) EXPECT_LT(level, noted);
    session.selection.brushes = {vis::rangeBrush({{"T", 500, 900, 0}}, "some")};
    for (const int level : levelsSeen(query(false))) EXPECT_LT(level, noted);
}

} // namespace
} // namespace tessera::app
