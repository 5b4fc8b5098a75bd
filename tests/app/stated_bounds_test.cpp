// Error bounds as users state them (options, presets, the JSON of a session), for files whose numbers are stored with
// scales below and above 1: what comes back is compared with what was written.
#include "app/data/sources.h"
#include "app/described/describe_json.h"
#include "app/session/session.h"
#include "codec/archive/archive.h"
#include "volume/reconstruct/probe.h"
#include "volume/system/process.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <random>
#include <unistd.h>

namespace tessera::app {
namespace {

namespace fs = std::filesystem;

constexpr int kMadeWide = 11, kMadeDeep = 9, kMadeHigh = 8, kMadeCount = kMadeWide * kMadeDeep * kMadeHigh,
              kMadeTimes = 2;

struct ScaledArray {
    const char* name;
    double scale, offset;
};
constexpr std::array<ScaledArray, 3> kScaledArrays{{{"fine", 0.002, -5}, {"coarse", 40, 1000}, {"down", -3, 7}}};

/// What came back of each array.
struct WorstErrors {
    std::array<double, kScaledArrays.size()> largest{};
    void add(std::size_t array, double is, double wanted) {
        largest[array] = std::max(largest[array], std::abs(is - wanted));
    }
};

class StatedBounds : public testing::Test {
protected:
    void SetUp() override {
        fs::create_directories(folder_);
        std::mt19937 random(3);
        for (auto& time : numbers_)
            for (auto& array : time)
                for (std::int16_t& number : array) number = static_cast<std::int16_t>(random() % 4001);
        write("whole", 0, kMadeTimes), write("early", 0, 1), write("late", 1, 1);
    }
    void TearDown() override { fs::remove_all(folder_); }
    std::string in(const std::string& name) const { return (folder_ / name).string(); }

    /// The physical value of a sample, by what is written.
    double value(int time, std::size_t array, int sample) const {
        return kScaledArrays[array].offset +
               kScaledArrays[array].scale * numbers_[std::size_t(time)][array][std::size_t(sample)];
    }
    double extent(std::size_t array) const {
        double lo = value(0, array, 0), hi = lo;
        for (int t = 0; t < kMadeTimes; ++t)
            for (int i = 0; i < kMadeCount; ++i)
                lo = std::min(lo, value(t, array, i)), hi = std::max(hi, value(t, array, i));
        return hi - lo;
    }
    /// Runs the program; what it says on failure.
    static std::string run(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), std::string(TESSERA_BINARY_DIR) + "/tessera");
        volume::ChildProcess child(arguments);
        std::byte byte{};
        while (child.read({&byte, 1}, [] {})) {
        }
        return child.ending();
    }
    WorstErrors ofArchive(const std::string& name) const {
        const codec::Archive archive(in(name));
        EXPECT_EQ(archive.info().times.size(), std::size_t(kMadeTimes));
        WorstErrors errors;
        for (std::size_t a = 0; a < kScaledArrays.size(); ++a) {
            EXPECT_EQ(archive.info().parameters.at(a).name, kScaledArrays[a].name);
            for (int t = 0; t < kMadeTimes; ++t) {
                const volume::Field field = codec::readField(archive, int(a), 0, t);
                EXPECT_EQ(field.count(), std::size_t(kMadeCount));
                for (int i = 0; i < kMadeCount; ++i) errors.add(a, field.value(std::size_t(i)), value(t, a, i));
            }
        }
        return errors;
    }
    /// Of what the archive holds that a session shows whose `data.packed` is this.
    WorstErrors ofSession(const std::string& packed) const {
        DataRef data;
        std::vector<JsonIssue> issues;
        fromJson(data, parseJson("{\"packed\": " + packed + "}", "test"), issues);
        EXPECT_TRUE(issues.empty()) << packed;
        data.files.resize(1);
        data.files[0].absolutePath = in("whole.json");
        std::vector<std::string> messages;
        const Sources sources = openSources(data, messages);
        EXPECT_EQ(sources.pictures->info().lattice.kind, volume::LatticeKind::BCC) << packed;
        const volume::DatasetInfo& info = sources.packed->info();
        EXPECT_EQ(info.lattice.kind, volume::LatticeKind::CC) << packed;
        WorstErrors errors;
        std::vector<glm::dvec3> places;
        for (int i = 0; i < kMadeCount; ++i)
            places.push_back(
                info.lattice.position({i % kMadeWide, i / kMadeWide % kMadeDeep, i / kMadeWide / kMadeDeep}));
        for (std::size_t a = 0; a < kScaledArrays.size(); ++a)
            for (int t = 0; t < kMadeTimes; ++t) {
                const auto values = volume::probeAlong(*sources.packed, int(a), places, t);
                for (int i = 0; i < kMadeCount; ++i)
                    errors.add(a, values[std::size_t(i)].nearest.value(), value(t, a, i));
            }
        return errors;
    }
    /// Within the bounds of each array, which are used where they are larger than a stored number. Values of sources
    /// are single precision.
    void expectWithin(const WorstErrors& errors, const std::array<double, kScaledArrays.size()>& bounds) const {
        for (std::size_t a = 0; a < kScaledArrays.size(); ++a) {
            const double step = std::abs(kScaledArrays[a].scale),
                         single = 1e-7 * (extent(a) + std::abs(kScaledArrays[a].offset));
            EXPECT_LE(errors.largest[a], bounds[a] + single) << kScaledArrays[a].name;
            if (bounds[a] < step)
                EXPECT_LE(errors.largest[a], single) << kScaledArrays[a].name;
            else
                EXPECT_GE(errors.largest[a], 0.3 * bounds[a]) << kScaledArrays[a].name;
        }
    }
    std::array<double, kScaledArrays.size()> same(double bound) const { return {bound, bound, bound}; }
    std::array<double, kScaledArrays.size()> relative(double bound) const {
        return {bound * extent(0), bound * extent(1), bound * extent(2)};
    }

private:
    void write(const std::string& name, int firstTime, int times) const {
        std::ofstream bytes(in(name + ".raw"), std::ios::binary);
        std::string components, when;
        for (int t = firstTime; t < firstTime + times; ++t) {
            when += (when.empty() ? "" : ", ") + std::to_string(t);
            for (const auto& array : numbers_[std::size_t(t)])
                bytes.write(reinterpret_cast<const char*>(array.data()), 2 * kMadeCount);
        }
        for (const ScaledArray& array : kScaledArrays)
            components += (components.empty() ? "" : ", ") + std::string("{\"name\": \"") + array.name +
                          "\", \"scale\": " + std::to_string(array.scale) +
                          ", \"offset\": " + std::to_string(array.offset) + "}";
        std::ofstream(in(name + ".json"))
            << "{\"dims\": [" << kMadeWide << ", " << kMadeDeep << ", " << kMadeHigh
            << "], \"dtype\": \"int16\", \"times\": [" << when << "], \"components\": [" << components << "]}";
    }

    fs::path folder_ = fs::path(testing::TempDir()) / ("stated_bounds_" + std::to_string(getpid()));
    std::array<std::array<std::array<std::int16_t, kMadeCount>, kScaledArrays.size()>, kMadeTimes> numbers_{};
};

TEST_F(StatedBounds, ByOption) {
    for (const double bound : {0.021, 33.0, 450.0}) {
        SCOPED_TRACE(bound);
        ASSERT_EQ(
            run({"pack", in("whole.json"), "-o", in("a.tsr"), "--lattice", "cc", "--abs-error", std::to_string(bound)}),
            "");
        // A bound beyond what there is allows no more than that.
        std::array<double, kScaledArrays.size()> bounds = same(bound);
        const WorstErrors errors = ofArchive("a.tsr");
        for (std::size_t a = 0; a < kScaledArrays.size(); ++a)
            if (bound > extent(a)) {
                EXPECT_LE(errors.largest[a], bound);
                bounds[a] = errors.largest[a];
            }
        expectWithin(errors, bounds);
    }
    ASSERT_EQ(run({"pack", in("whole.json"), "-o", in("a.tsr"), "--lattice", "cc", "--max-error", "0.02"}), "");
    expectWithin(ofArchive("a.tsr"), relative(0.02));
    // Of several the strictest.
    ASSERT_EQ(run({"pack", in("whole.json"), "-o", in("a.tsr"), "--lattice", "cc", "--max-error", "0.02", "--abs-error",
                   "31"}),
              "");
    expectWithin(ofArchive("a.tsr"), {0.02 * extent(0), 31, 31});
}

TEST_F(StatedBounds, ByPreset) {
    for (const auto& [preset, bound] :
         {std::pair("visual", 1e-3), std::pair("small", 1e-2), std::pair("lossless", 0.0)}) {
        SCOPED_TRACE(preset);
        ASSERT_EQ(run({"pack", in("whole.json"), "-o", in("a.tsr"), "--preset", preset, "--lattice", "cc"}), "");
        expectWithin(ofArchive("a.tsr"), relative(bound));
    }
    ASSERT_EQ(run({"pack", in("whole.json"), "-o", in("a.tsr"), "--abs-error", "0.05", "--preset", "small", "--lattice",
                   "cc"}),
              "");
    expectWithin(ofArchive("a.tsr"), {std::min(0.05, 0.01 * extent(0)), 0.05, 0.05});
}

TEST_F(StatedBounds, OfAppendedAndConvertedArchives) {
    ASSERT_EQ(run({"pack", in("early.json"), "-o", in("a.tsr"), "--lattice", "cc", "--abs-error", "33"}), "");
    ASSERT_EQ(run({"pack", "--append", in("late.json"), "-o", in("a.tsr")}), "");
    WorstErrors errors = ofArchive("a.tsr");
    expectWithin(errors, {errors.largest[0], 33, 33});
    EXPECT_GT(errors.largest[0], 0.9) << "all of a range of 8 may go";

    ASSERT_EQ(run({"pack", in("whole.json"), "-o", in("exact.tsr"), "--lattice", "cc"}), "");
    expectWithin(ofArchive("exact.tsr"), same(0));
    ASSERT_EQ(run({"convert", in("exact.tsr"), "-o", in("b.tsr"), "--abs-error", "0.021"}), "");
    expectWithin(ofArchive("b.tsr"), same(0.021));
    ASSERT_EQ(run({"convert", in("exact.tsr"), "-o", in("b.tsr"), "--preset", "small"}), "");
    expectWithin(ofArchive("b.tsr"), relative(0.01));
    // What is converted again has both errors.
    ASSERT_EQ(run({"convert", in("b.tsr"), "-o", in("c.tsr"), "--max-error", "0.3"}), "");
    expectWithin(ofArchive("c.tsr"), relative(0.31));
}

TEST_F(StatedBounds, ByTheJsonOfASession) {
    expectWithin(ofSession(R"({"lattice": "cc", "lossless": false, "absError": 0.021})"), same(0.021));
    expectWithin(ofSession(R"({"lattice": "cc", "lossless": false, "maxError": 0.02})"), relative(0.02));
    expectWithin(ofSession(R"({"lattice": "cc", "preset": "small"})"), relative(0.01));
    expectWithin(ofSession(R"("lossless")"), same(0));
}

} // namespace
} // namespace tessera::app
