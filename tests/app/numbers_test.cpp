#include "app/data/open.h"
#include "app/queries/focus_share.h"
#include "app/queries/statistics_query.h"
#include "app/views/curves/profile_data.h"
#include "codec/archive/archive.h"
#include "codec/pack/pack.h"
#include "tests/volume/cell_lengths.h"
#include "volume/analysis/statistics.h"
#include "volume/reconstruct/probe.h"
#include "volume/reconstruct/sample_grid.h"
#include "volume/sources/centred_source.h"
#include "volume/sources/memory_source.h"
#include "volume/synthetic/models.h"

#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>
#include <unistd.h>

/// Numbers are those of the samples as computed, on whatever lattice pictures are drawn.
namespace tessera::app {
namespace {

constexpr int kCountBins = 24, kTime = 1;

DataRef smallCell() {
    DataRef data;
    data.model = "fuel-cell";
    data.settings = {{"nx", 9}, {"ny", 11}, {"nz", 23}, {"times", 8}};
    data.derived = {{"ratio", "", volume::ExpressionRecipe{"O2 / (O2 + H2O)"}},
                    {"slope", "", volume::GradientRecipe{"T"}}};
    return data;
}

DataRef with(const std::function<void(DataRef&)>& change) {
    DataRef data = smallCell();
    change(data);
    return data;
}

Sources opened(const DataRef& data) {
    std::vector<std::string> messages;
    Sources sources = openSources(data, messages);
    // Of slopes where time is an axis it is said what they are.
    EXPECT_EQ(messages.size(), data.timeAxis ? 1 : 0) << (messages.empty() ? "" : messages.front());
    return sources;
}

using codec::StoredLattice;

codec::PackOptions packing(StoredLattice lattice, double maxError = 0) {
    codec::PackOptions options;
    options.lattice = lattice;
    options.lossless = maxError == 0;
    options.maxError = maxError;
    return options;
}

std::vector<DataRef> shownOtherwise() {
    return {
        with([](DataRef& data) { data.lattice = PictureLattice::Grid; }),
        with([](DataRef& data) { data.packed = packing(StoredLattice::CC); }),
        with([](DataRef& data) { data.packed = packing(StoredLattice::BCC); }),
        with([](DataRef& data) { data.packed = packing(StoredLattice::BCC, 0.05); }),
        with([](DataRef& data) { data.packed = packing(StoredLattice::D4, 0.05); }),
    };
}

constexpr const char* kShown[] = {"O2", "H2O", "T", "|U|", "ratio", "slope.z"};

/// Everything a view counts or reads: with a brush in two parameters and one in space.
struct Numbers {
    volume::Statistics statistics;
    std::string share;
    std::vector<volume::ProbeValue> readout;
    Profile profile;
    std::vector<Range> ranges;
};

Session brushed(const volume::DatasetInfo& info) {
    Session session;
    session.time = info.times[kTime];
    const auto range = [&](const char* name) {
        return info.channelRange(info.channel(info.findChannel(name).value()));
    };
    const Range o2 = range("O2"), t = range("T");
    vis::Brush values, space;
    values.region = vis::RangeRegion{{{.channel = "O2", .lo = o2.lo + 0.3 * (o2.hi - o2.lo), .hi = o2.hi},
                                      {.channel = "T", .lo = t.lo, .hi = t.lo + 0.8 * (t.hi - t.lo)}}};
    space.region = vis::SphereRegion{.center = info.bounds.center(), .radius = 0.45 * info.bounds.size(), .soft = 0.2};
    session.selection.brushes = {values, space};
    return session;
}

std::vector<int> channelsOf(const volume::DatasetInfo& info, const std::string& ending = {}) {
    std::vector<int> channels;
    for (const char* name : kShown) channels.push_back(info.findChannel(name + ending).value());
    return channels;
}

Numbers read(const volume::BrickSource& source, std::shared_ptr<const volume::BrickSource> shared,
             const std::string& ending = {}) {
    const volume::DatasetInfo& info = source.info();
    Numbers out;
    const std::vector<int> channels = channelsOf(info, ending);
    for (const int channel : channels) out.ranges.push_back(info.channelRange(info.channel(channel)));
    StatisticsResult result;
    result.query = brushedQuery(brushed(info), info, channels, out.ranges, kCountBins, true);
    result.brushed = true;
    result.statistics = readStatistics(shared, result.query, 0);
    out.statistics = result.statistics;
    out.share = shareText(focusShare(result, info, source.grid()));
    const glm::dvec3 at = info.bounds.lo + info.bounds.size() * glm::dvec3(0.31, 0.57, 0.43);
    const auto values = volume::probe(source, at, volume::timesAround(info.times, info.times[kTime]));
    for (const int channel : channels) out.readout.push_back(values[std::size_t(channel)]);
    ProfileQuery query;
    query.channels = channels;
    query.corners = {info.bounds.lo, info.bounds.hi};
    query.samples = 41;
    query.times = {volume::timesAround(info.times, 0.4 * info.times.back())};
    out.profile = readProfile(source, query);
    return out;
}

void expectSame(double a, double b, const std::string& what) {
    EXPECT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << what << ": " << a << " and " << b;
}

void expectSame(const volume::Summary& a, const volume::Summary& b, const std::string& what) {
    expectSame(a.samples, b.samples, what + " samples");
    expectSame(a.volume, b.volume, what + " volume");
    expectSame(a.mean, b.mean, what + " mean");
    expectSame(a.deviation, b.deviation, what + " deviation");
    expectSame(a.min, b.min, what + " least");
    expectSame(a.max, b.max, what + " most");
}

/// Equal to the last digit.
void expectSame(const Numbers& a, const Numbers& b) {
    EXPECT_EQ(a.share, b.share);
    EXPECT_EQ(a.ranges, b.ranges);
    ASSERT_EQ(a.statistics.joint.size(), b.statistics.joint.size());
    for (std::size_t c = 0; c < std::size(kShown); ++c) {
        const std::string name = kShown[c];
        const volume::ChannelStatistics &x = a.statistics.channels[c], &y = b.statistics.channels[c];
        expectSame(x.all, y.all, name + " all");
        expectSame(x.inside, y.inside, name + " inside");
        expectSame(x.outside, y.outside, name + " outside");
        EXPECT_EQ(x.histogram.count, y.histogram.count) << name;
        EXPECT_EQ(x.histogram.focus, y.histogram.focus) << name;
        EXPECT_EQ(a.readout[c].interpolated, b.readout[c].interpolated) << name;
        EXPECT_EQ(a.readout[c].nearest, b.readout[c].nearest) << name;
        for (std::size_t i = 0; i < a.profile.values[c].size(); ++i)
            expectSame(a.profile.values[c][i], b.profile.values[c][i], name + " along the line");
    }
    for (std::size_t p = 0; p < a.statistics.joint.size(); ++p) {
        const volume::JointHistogram &x = a.statistics.joint[p], &y = b.statistics.joint[p];
        EXPECT_EQ(x.count, y.count);
        EXPECT_EQ(x.focus, y.focus);
        expectSame(x.correlation, y.correlation, "r");
        expectSame(x.focusCorrelation, y.focusCorrelation, "r inside");
        expectSame(x.outsideCorrelation, y.outsideCorrelation, "r outside");
    }
}

TEST(Numbers, AreTheSameOnEveryLattice) {
    const Sources first = opened(smallCell());
    ASSERT_EQ(first.pictures->grid().lattice.kind, volume::LatticeKind::BCC);
    ASSERT_EQ(first.numbers->grid().lattice.kind, volume::LatticeKind::CC);
    const Numbers wanted = read(*first.numbers, first.numbers);
    EXPECT_NE(wanted.share.find("of where O2 exists"), std::string::npos) << wanted.share;
    for (const DataRef& data : shownOtherwise()) {
        SCOPED_TRACE(toJson(data).dump());
        const Sources other = opened(data);
        EXPECT_EQ(other.pictures->info().parameters.size(), other.numbers->info().parameters.size());
        EXPECT_EQ(other.pictures->info().channels(), other.numbers->info().channels());
        EXPECT_EQ(other.pictures->info().times, other.numbers->info().times);
        expectSame(wanted, read(*other.numbers, other.numbers));
    }
    // What is drawn has other samples: read from those, the same numbers differ.
    EXPECT_NE(read(*first.pictures, first.pictures).statistics.channels[0].all.mean,
              wanted.statistics.channels[0].all.mean);
}

// With the originals at hand the packed parameters are what unpacking gives, at the points of the file.
TEST(Numbers, OfOriginalsBesideWhatWasPacked) {
    const Sources plain = opened(smallCell());
    const auto count = [](const Sources& sources, const std::vector<std::string>& names, Range range) {
        BrushedQuery query;
        for (const std::string& name : names) {
            query.channels.push_back(sources.numbers->info().findChannel(name).value());
            query.ranges.push_back(range);
        }
        if (names.size() == 2) query.pairs = {{0, 1}};
        query.bins = kCountBins;
        query.time = {kTime, kTime, 0};
        return readStatistics(sources.numbers, query, 0);
    };
    for (const auto lattice : {StoredLattice::CC, StoredLattice::BCC}) {
        const Sources sources = opened(with([&](DataRef& of) {
            of.derived.clear();
            of.packed = packing(lattice, 0.02);
            of.originals = true;
        }));
        EXPECT_EQ(sources.numbers->info().lattice, plain.numbers->info().lattice);
        EXPECT_EQ(sources.pictures->info().lattice, plain.numbers->info().lattice)
            << "on that of the archive an error would be drawn without that of resampling";
        for (const std::string name : {"O2", "H2O", "T"}) {
            const volume::DatasetInfo& info = plain.numbers->info();
            const Range range = info.channelRange(info.channel(info.findChannel(name).value()));
            const volume::ChannelStatistics wanted = count(plain, {name}, range).channels[0];
            const volume::Statistics found = count(sources, {name + " as computed", name}, range);
            expectSame(found.channels[0].all, wanted.all, name);
            EXPECT_EQ(found.channels[0].histogram.count, wanted.histogram.count);
            EXPECT_NE(found.channels[1].all.mean, wanted.all.mean) << "it has losses";
            EXPECT_GT(found.joint[0].correlation, 0.9) << "of the same points";
        }
    }
}

/// Samples of a parameter as the model gives them, NaN where absent.
std::vector<double> samplesOf(const volume::Dataset& cell, const std::string& name) {
    for (std::size_t p = 0; p < cell.info.parameters.size(); ++p) {
        if (cell.info.parameters[p].name != name) continue;
        const volume::Field field = cell.read(int(p), 0, kTime);
        std::vector<double> values(field.count());
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = field.present(i) ? field.value(i) : std::nan("");
        return values;
    }
    return {};
}

// Counted anew in the plainest way.
TEST(Numbers, AreThoseOfTheSamplesAsComputed) {
    const DataRef data = smallCell();
    const Sources sources = opened(data);
    const volume::Dataset cell = volume::makeModel(data.model, data.settings);
    const volume::Lattice& lattice = cell.info.lattice;
    EXPECT_EQ(sources.numbers->info().lattice, lattice);
    const Numbers found = read(*sources.numbers, sources.numbers);
    const std::vector<double> o2 = samplesOf(cell, "O2"), t = samplesOf(cell, "T"), h2o = samplesOf(cell, "H2O");
    ASSERT_EQ(o2.size(), lattice.count());
    const vis::Selection selection = brushed(cell.info).selection;
    const auto& box = std::get<vis::SphereRegion>(selection.brushes[1].region);
    const auto& ranges = std::get<vis::RangeRegion>(selection.brushes[0].region).intervals;
    double n = 0, volume = 0, sum = 0, inside = 0;
    std::vector<std::uint64_t> bins(kCountBins, 0), joint(kCountBins * kCountBins, 0);
    const auto binOf = [&](double value, const Range& range) {
        return std::min(kCountBins - 1, int((value - range.lo) / (range.hi - range.lo) * kCountBins));
    };
    double sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0, pairs = 0;
    for (std::size_t i = 0; i < o2.size(); ++i) {
        if (std::isnan(o2[i])) continue;
        ++n;
        ++bins[std::size_t(binOf(o2[i], found.ranges[0]))];
        const glm::ivec3 at(int(i) % lattice.size.x, int(i) / lattice.size.x % lattice.size.y,
                            int(i) / lattice.size.x / lattice.size.y);
        const double share = volume::test::volumeInBox(cell.info, at);
        volume += share;
        sum += share * o2[i];
        const glm::dvec3 away = (lattice.position(at) - box.center) / box.radius;
        const double distance = std::sqrt(away.x * away.x + away.y * away.y + away.z * away.z);
        const bool brushedValue =
            o2[i] >= ranges[0].lo && o2[i] <= ranges[0].hi && t[i] >= ranges[1].lo && t[i] <= ranges[1].hi;
        if (brushedValue && distance < 1 - box.soft) ++inside; // wholly in focus
        if (std::isnan(h2o[i])) continue;
        ++joint[std::size_t(binOf(h2o[i], found.ranges[1]) * kCountBins + binOf(o2[i], found.ranges[0]))];
        const double a = o2[i], b = h2o[i];
        pairs += share;
        sa += share * a, sb += share * b, saa += share * a * a, sbb += share * b * b, sab += share * a * b;
    }
    const volume::ChannelStatistics& own = found.statistics.channels[0];
    EXPECT_EQ(own.all.samples, n);
    EXPECT_LT(n, double(o2.size())) << "O2 exists on one side only";
    EXPECT_NEAR(own.all.mean, sum / volume, 1e-9 * std::abs(sum / volume));
    EXPECT_EQ(own.histogram.count, bins);
    EXPECT_GE(own.inside.samples, inside);
    EXPECT_GT(inside, 0);
    for (const volume::JointHistogram& pair : found.statistics.joint)
        if (pair.x == 0 && pair.y == 1) {
            EXPECT_EQ(pair.count, joint);
            const double r = (pairs * sab - sa * sb) / std::sqrt((pairs * saa - sa * sa) * (pairs * sbb - sb * sb));
            EXPECT_NEAR(pair.correlation, r, 1e-6);
        }
    // At a sample the read-out is that sample.
    for (std::size_t i = 0; i < o2.size(); i += 7) {
        const glm::ivec3 at(int(i) % lattice.size.x, int(i) / lattice.size.x % lattice.size.y,
                            int(i) / lattice.size.x / lattice.size.y);
        const auto value = volume::probeChannel(*sources.numbers, sources.numbers->info().findChannel("O2").value(),
                                                lattice.position(at), kTime);
        EXPECT_EQ(value.nearest.has_value(), !std::isnan(o2[i]));
        if (value.nearest) {
            EXPECT_EQ(*value.nearest, o2[i]);
        }
    }
}

TEST(Numbers, OfAnArchiveOnBccAreThoseOfTheSourceWithinWhatItSays) {
    const std::string path =
        (std::filesystem::temp_directory_path() / ("tessera-numbers-" + std::to_string(getpid()) + ".tsr")).string();
    const DataRef data = smallCell();
    volume::Dataset cell = volume::makeModel(data.model, data.settings);
    codec::pack(cell, packing(StoredLattice::BCC), path);
    const Sources sources = opened(dataOf({path}, {}));
    EXPECT_EQ(sources.numbers->info().lattice, cell.info.lattice);
    EXPECT_EQ(sources.pictures->info().lattice.kind, volume::LatticeKind::BCC);
    const int region = sources.numbers->info().findChannel("region").value();
    const volume::DatasetInfo& info = sources.numbers->info();
    EXPECT_EQ(originText(sources.origin, info, {region}), "stored on BCC and corrected");
    volume::StatisticsQuery query;
    for (int c = 0; c < int(info.channels().size()); ++c) query.channels.push_back(c);
    const auto computed = volume::makeMemorySource(cell, {.lattice = volume::LatticeKind::CC, .budget = 1 << 28});
    const volume::Statistics of = volume::computeStatistics(*sources.numbers, query),
                             wanted = volume::computeStatistics(*computed, query);
    for (std::size_t c = 0; c < query.channels.size(); ++c) {
        SCOPED_TRACE(info.channels()[c].name);
        const double bound = errorBound(sources.origin, info, info.channels()[c]);
        EXPECT_EQ(of.channels[c].all.samples, wanted.channels[c].all.samples);
        EXPECT_NEAR(of.channels[c].all.mean, wanted.channels[c].all.mean, bound);
        EXPECT_NEAR(of.channels[c].all.min, wanted.channels[c].all.min, bound);
        EXPECT_NEAR(of.channels[c].all.max, wanted.channels[c].all.max, bound);
    }
    std::filesystem::remove(path);
}

class PicturesOfArchives : public testing::Test {
protected:
    std::string folder =
        (std::filesystem::temp_directory_path() / "tessera_pictures_").string() + std::to_string(::getpid());
    PicturesOfArchives() { std::filesystem::create_directories(folder); }
    ~PicturesOfArchives() override { std::filesystem::remove_all(folder); }

    DataRef archived(StoredLattice lattice) const {
        const std::string path = folder + "/cell.tsr";
        const DataRef data = smallCell();
        volume::Dataset cell = volume::makeModel(data.model, data.settings);
        codec::pack(cell, packing(lattice), path);
        DataRef of = dataOf({path}, {});
        of.derived = data.derived;
        return of;
    }
    static void expectSamePictures(const Sources& a, const Sources& b) {
        ASSERT_EQ(a.pictures->grid().lattice, b.pictures->grid().lattice); // bricks may have other sizes
        const auto channels = a.pictures->info().channels();
        for (int c = 0; c < int(channels.size()); ++c) {
            const volume::SampleGrid one = volume::readSamples(*a.pictures, c, kTime, 0),
                                     other = volume::readSamples(*b.pictures, c, kTime, 0);
            ASSERT_EQ(one.values.size(), other.values.size());
            for (std::size_t i = 0; i < one.values.size(); ++i) {
                const bool there = one.present.empty() || one.present[i] != 0;
                ASSERT_EQ(there, other.present.empty() || other.present[i] != 0) << channels[std::size_t(c)].name;
                if (!there) continue;
                ASSERT_EQ(one.values[i], other.values[i]) << channels[std::size_t(c)].name;
            }
        }
    }
};

TEST_F(PicturesOfArchives, AreThoseOfTheFile) {
    const Sources archive = opened(archived(StoredLattice::CC)), file = opened(smallCell());
    EXPECT_EQ(archive.pictures->info().lattice, volume::bccFor(archive.numbers->info().lattice));
    EXPECT_EQ(archive.pictures->info().parameters[0].ranges, archive.numbers->info().parameters[0].ranges);
    expectSamePictures(archive, file);
    // What is derived is computed from the samples of the grid, not from those that are made for pictures.
    EXPECT_EQ(volume::centredFrom(*archive.pictures), archive.numbers);
    EXPECT_EQ(volume::centredFrom(*underived(archive).pictures), underived(archive).numbers);
}

TEST_F(PicturesOfArchives, AreDrawnOnTheGridAsStoredIfAsked) {
    DataRef data = archived(StoredLattice::CC);
    data.lattice = PictureLattice::Grid;
    const Sources grid = opened(data);
    EXPECT_EQ(grid.pictures, grid.numbers);
    EXPECT_EQ(grid.pictures->info().lattice.kind, volume::LatticeKind::CC);
    EXPECT_TRUE(canChooseLattice(data, *grid.numbers, grid.origin));
    data.lattice = PictureLattice::BodyCentred;
    const Sources centred = opened(data), moved = drawnOn(PictureLattice::BodyCentred, grid);
    EXPECT_EQ(moved.numbers, grid.numbers);
    expectSamePictures(centred, moved);
    EXPECT_EQ(drawnOn(PictureLattice::Grid, centred).pictures, centred.numbers);
}

TEST_F(PicturesOfArchives, OnAnotherLatticeAreDrawnFromTheSamplesOfTheSource) {
    const Sources file = opened(smallCell());
    for (const StoredLattice lattice : {StoredLattice::BCC, StoredLattice::D4}) {
        const DataRef data = archived(lattice);
        const Sources sources = opened(data);
        EXPECT_EQ(sources.numbers->info().lattice, file.numbers->info().lattice);
        EXPECT_EQ(sources.numbers->info().times, file.numbers->info().times);
        EXPECT_EQ(sources.pictures->info().lattice, file.pictures->info().lattice);
        EXPECT_EQ(volume::centredFrom(*sources.pictures), sources.numbers);
        EXPECT_TRUE(canChooseLattice(data, *sources.numbers, sources.origin));
    }
}

TEST_F(PicturesOfArchives, OfAPackedCopyAreDrawnAlike) {
    const DataRef data = with([](DataRef& changed) { changed.packed = packing(StoredLattice::CC); });
    const Sources packed = opened(data), file = opened(smallCell());
    expectSamePictures(packed, file);
    ASSERT_TRUE(packed.packed);
    EXPECT_EQ(packed.packed->info().lattice, packed.numbers->info().lattice);
    EXPECT_TRUE(packed.packed->info().findChannel("ratio"));
    const Sources grid = drawnOn(PictureLattice::Grid, packed);
    EXPECT_EQ(grid.pictures, packed.packed) << "what the archive holds, not the file";
    const Sources onBcc = opened(with([](DataRef& changed) { changed.packed = packing(StoredLattice::BCC); }));
    EXPECT_EQ(onBcc.packed->info().lattice, onBcc.numbers->info().lattice) << "unpacked";
}

TEST(Numbers, WhatIsDrawnOnAnotherLatticeHasTheSameNumbers) {
    const DataRef data = smallCell();
    const Sources first = opened(data);
    const Sources other = drawnOn(PictureLattice::Grid, first);
    EXPECT_EQ(other.numbers, first.numbers);
    EXPECT_EQ(other.pictures->info().lattice, first.numbers->info().lattice);
    const Sources back = drawnOn(PictureLattice::BodyCentred, other);
    EXPECT_EQ(back.pictures->info(), first.pictures->info());
    const volume::BrickKey key{first.pictures->info().findChannel("slope.z").value(), kTime, 0, {0, 0, 0}};
    EXPECT_EQ(back.pictures->read(key).values, first.pictures->read(key).values);
}

TEST(Numbers, WithTimeAlongAnAxisAreTheSameOnEveryLattice) {
    const auto along = [](PictureLattice lattice) {
        return opened(with([&](DataRef& data) {
            data.lattice = lattice;
            data.timeAxis = volume::TimeAxis{volume::SpaceAxis::Z, 0.5};
        }));
    };
    const Sources grid = along(PictureLattice::Grid), bcc = along(PictureLattice::BodyCentred);
    EXPECT_EQ(bcc.pictures->grid().lattice.kind, volume::LatticeKind::BCC);
    EXPECT_EQ(grid.numbers->info(), bcc.numbers->info());
    for (int channel = 0; channel < int(grid.numbers->info().channels().size()); ++channel)
        EXPECT_EQ(grid.numbers->read({channel, 0, 0, {0, 0, 0}}).values,
                  bcc.numbers->read({channel, 0, 0, {0, 0, 0}}).values);
}

TEST(Numbers, OneGridOfAnArchiveInSpaceAndTimeIsReadAsStored) {
    const std::string folder =
        (std::filesystem::temp_directory_path() / "tessera_one_grid_").string() + std::to_string(::getpid());
    std::filesystem::create_directories(folder);
    const std::string path = folder + "/d4.tsr";
    volume::Dataset cell = volume::makeModel("fuel-cell", {{"nx", 9}, {"ny", 11}, {"nz", 23}, {"times", 8}});
    codec::pack(cell, packing(StoredLattice::D4), path);
    const codec::Archive archive(path);
    const std::size_t frames = archive.info().times.size();
    ASSERT_GE(frames, 4u);
    DataRef data = dataOf({path}, {});
    const Sources both = opened(data);
    EXPECT_EQ(both.numbers->info().lattice, cell.info.lattice);
    EXPECT_EQ(both.numbers->info().times, cell.info.times);
    for (const ShownGrids grids : {ShownGrids::First, ShownGrids::Second}) {
        data.grids = grids;
        const int parity = grids == ShownGrids::First ? 0 : 1;
        const Sources one = opened(data);
        const volume::DatasetInfo& info = one.numbers->info();
        EXPECT_EQ(one.origin.lattice, "one grid of D4*");
        EXPECT_EQ(info.lattice.kind, volume::LatticeKind::CC);
        EXPECT_EQ(one.numbers->grid().lattice, info.lattice);
        EXPECT_EQ(info.lattice.origin, archive.info().lattice.origin + 0.5 * parity * info.lattice.spacing);
        ASSERT_EQ(info.times.size(), (frames + 1 - std::size_t(parity)) / 2);
        const int channel = info.findChannel("T").value();
        for (std::size_t t = 0; t < info.times.size(); ++t) {
            const int frame = 2 * int(t) + parity;
            EXPECT_EQ(info.times[t], archive.info().times[std::size_t(frame)]);
            for (const volume::Quantity& quantity : info.quantities)
                EXPECT_EQ(quantity.values.size(), info.times.size());
            EXPECT_EQ(one.numbers->read({channel, int(t), 0, {0, 0, 0}}).values,
                      archive.read({channel, frame, 0, {0, 0, 0}}).values);
        }
    }
    std::filesystem::remove_all(folder);
}

TEST(Numbers, OneGridOfABodyCentredArchiveIsReadAsStored) {
    const std::string folder =
        (std::filesystem::temp_directory_path() / "tessera_one_of_bcc_").string() + std::to_string(::getpid());
    std::filesystem::create_directories(folder);
    const std::string path = folder + "/bcc.tsr";
    // An odd number of slices: the first grid has one more.
    volume::Dataset cell = volume::makeModel("fuel-cell", {{"nx", 9}, {"ny", 11}, {"nz", 24}});
    codec::pack(cell, packing(StoredLattice::BCC), path);
    const codec::Archive archive(path);
    const volume::Lattice& both = archive.info().lattice;
    DataRef data = dataOf({path}, {});
    std::size_t samples = 0;
    for (const ShownGrids grids : {ShownGrids::First, ShownGrids::Second}) {
        data.grids = grids;
        const int sublattice = grids == ShownGrids::First ? 0 : 1;
        const Sources one = opened(data);
        const volume::DatasetInfo& info = one.numbers->info();
        EXPECT_EQ(one.origin.lattice, "one grid of BCC");
        EXPECT_EQ(info.lattice.kind, volume::LatticeKind::CC);
        EXPECT_EQ(one.pictures->info().lattice, info.lattice) << "drawn as stored";
        samples += info.lattice.count();
        const int channel = info.findChannel("T").value();
        for (int level = 0; level < one.numbers->grid().levels; ++level)
            for (std::size_t n = 0; n < one.numbers->grid().brickCount(); ++n) {
                const volume::BrickKey key{channel, 0, level, one.numbers->grid().indexOf(n)};
                const volume::BrickSamples own = one.numbers->read(key), all = archive.read(key);
                ASSERT_EQ(own.size, one.numbers->grid().brickSamples(key.index, level));
                const glm::ivec3 size = own.size;
                for (int z = 0; z < size.z; ++z)
                    for (int at = 0; at < size.x * size.y; ++at) {
                        const auto from = std::size_t((2 * z + sublattice) * size.x * size.y + at),
                                   to = std::size_t(z * size.x * size.y + at);
                        ASSERT_EQ(own.isPresent(to), all.isPresent(from));
                        ASSERT_EQ(own.values[to], all.values[from]);
                    }
            }
        for (const glm::ivec3 at : {glm::ivec3(0), info.lattice.size - 1})
            EXPECT_LT(glm::length(info.lattice.position(at) - both.position({at.x, at.y, 2 * at.z + sublattice})),
                      1e-12)
                << "they lie where they did";
    }
    EXPECT_EQ(samples, both.count()) << "each sample is in one of them";
    std::filesystem::remove_all(folder);
}

TEST(Numbers, TheUncertaintyOfAnArchiveBoundsWhatPackingChanged) {
    const std::string folder =
        (std::filesystem::temp_directory_path() / "tessera_uncertainty_").string() + std::to_string(::getpid());
    std::filesystem::create_directories(folder);
    const std::string path = folder + "/bounded.tsr";
    volume::Dataset cell = volume::makeModel("fuel-cell", {{"nx", 9}, {"ny", 11}, {"nz", 24}});
    const auto computed = volume::makeMemorySource(cell, {.lattice = volume::LatticeKind::CC, .budget = 1 << 28});
    for (const StoredLattice lattice : {StoredLattice::CC, StoredLattice::BCC}) {
        codec::pack(cell, packing(lattice, 0.01), path);
        DataRef data = dataOf({path}, {});
        data.derived = {{"u", "K", volume::UncertaintyRecipe{"T"}}};
        const Sources sources = opened(data);
        const volume::DatasetInfo& info = sources.numbers->info();
        const int t = info.findChannel("T").value(), u = info.findChannel("u").value();
        const auto bound = packingBound(sources.origin, info, info.channel(t));
        ASSERT_TRUE(bound && bound->most > 0);
        EXPECT_EQ(bound->beforeLattice, lattice == StoredLattice::BCC) << "without corrections";
        double worst = 0;
        const glm::ivec3 size = cell.info.lattice.size;
        for (int z = 0; z < size.z; ++z)
            for (int y = 0; y < size.y; ++y)
                for (int x = 0; x < size.x; x += 2) {
                    const glm::dvec3 at = cell.info.lattice.position({x, y, z});
                    const auto was = volume::probeChannel(*computed, computed->info().findChannel("T").value(), at, 0);
                    const auto is = volume::probeChannel(*sources.numbers, t, at, 0);
                    const auto stated = volume::probeChannel(*sources.numbers, u, at, 0);
                    ASSERT_EQ(was.nearest.has_value(), is.nearest.has_value());
                    ASSERT_EQ(stated.nearest.has_value(), is.nearest.has_value());
                    if (!is.nearest) continue;
                    EXPECT_EQ(*stated.nearest, double(float(bound->most)));
                    worst = std::max(worst, std::abs(*was.nearest - *is.nearest));
                }
        EXPECT_GT(worst, 0) << "something was lost";
        if (!bound->beforeLattice) {
            EXPECT_LE(worst, bound->most * (1 + 1e-6));
        }
    }
    std::filesystem::remove_all(folder);
}

} // namespace
} // namespace tessera::app
