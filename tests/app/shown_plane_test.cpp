#include "app/pane/shown_plane.h"
#include "app/queries/probe_values.h"
#include "app/queries/readout.h"
#include "app/views/volume/space_beside.h"
#include "volume/sources/memory_source.h"
#include "volume/sources/plane_source.h"
#include "volume/synthetic/models.h"

#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// Planes in space and time as sessions show them.
namespace tessera::app {
namespace {

using testing::MatchesRegex;

struct ShownPlane : testing::Test {
    void shows(const volume::TimeAxis& plane) {
        source = volume::makePlaneSource(space, plane);
        session.data.timeAxis = plane;
        session.cursor = source->info().bounds.center();
    }
    std::shared_ptr<const volume::BrickSource> space =
        volume::makeMemorySource(volume::makeModel("fuel-cell", {{"nx", 9}, {"ny", 9}, {"nz", 21}, {"times", 5}}), {});
    std::shared_ptr<const volume::BrickSource> source;
    Session session;
};

TEST_F(ShownPlane, ReadOutsGiveThePlaceAndTheTime) {
    shows({volume::SpaceAxis::Z, 0.25}); // the cross-hair at half of the time
    const volume::DatasetInfo &info = source->info(), &whole = space->info();
    Readout readout;
    const std::string csv = readoutCsv(session, info, readout);
    const auto valueOf = [&](const std::string& name, const std::string& unit) {
        const std::string head = "\n" + name + "," + unit + ",";
        const auto at = csv.find(head);
        return at == csv.npos ? std::nan("") : std::stod(csv.substr(at + head.size()));
    };
    for (const int axis : {0, 1})
        EXPECT_NEAR(valueOf(std::string(1, "xyz"[axis]), whole.lengthUnit), session.cursor[axis], 1e-9);
    EXPECT_NEAR(valueOf("z", whole.lengthUnit), whole.bounds.lo.z + 0.25 * whole.bounds.size().z, 1e-9) << csv;
    EXPECT_NEAR(valueOf(whole.timeName, whole.timeUnit), 0.5 * (whole.times.front() + whole.times.back()), 1e-9);
    // What is kept there is a point in space and time: this plane holds it, another does not.
    const Probe& probe = session.probes[addProbe(session, info)];
    EXPECT_NEAR(probe.time, valueOf(whole.timeName, whole.timeUnit), 1e-9);
    const auto temperature = [&](const volume::BrickSource& of) {
        const auto channel = std::size_t(of.info().findChannel("T").value());
        return readProbes(of, session.probes).front()[channel].interpolated;
    };
    ASSERT_TRUE(temperature(*source));
    EXPECT_EQ(probeHere(session, info), 0u);
    const auto other = volume::makePlaneSource(space, {volume::SpaceAxis::Z, 0.75});
    EXPECT_FALSE(temperature(*other));
    EXPECT_NEAR(*temperature(*source), temperature(*space).value(), 0.01);
}

TEST_F(ShownPlane, SaysPlaceTimeAndSpeed) {
    volume::DatasetInfo info;
    info.lengthUnit = "mm";
    info.bounds = {glm::dvec3(0), glm::dvec3(4)};
    info.times = {0, 2, 8};
    const auto textOf = [&](const volume::TimeAxis& plane) { return planeText(info, volume::planeOf(info, plane)); };
    EXPECT_THAT(textOf({volume::SpaceAxis::Z, 0.5}), MatchesRegex("z = 2(\\.0*)? mm at all times"));
    EXPECT_THAT(textOf({.degrees = 0, .time = 0.25}), MatchesRegex("t = 2(\\.0*)? s everywhere"));
    EXPECT_THAT(textOf({volume::SpaceAxis::Y, 0.5, 45}),
                MatchesRegex("y = 0(\\.0*)? mm at t = 0(\\.0*)? s, moving at 0\\.50* mm/s"));
    EXPECT_THAT(textOf({.equation = volume::PlaneEquation{1, 2, 0, -0.5, -3}}),
                MatchesRegex("x \\+ 2(\\.0*)? y - 0\\.50* t - 3(\\.0*)? = 0 \\(mm, s\\)"));
}

TEST_F(ShownPlane, ASliceSaysWhatFollowsThere) {
    shows({volume::SpaceAxis::Z, 0.9, 30, 0.1}); // t follows from z: before the first time where z is small
    const volume::DatasetInfo& info = source->info();
    ASSERT_EQ(info.plane->solved, 3);
    const auto at = [&](double share) { return followsText(info, 2, info.bounds.lo.z + share * info.bounds.size().z); };
    EXPECT_THAT(at(0.2), testing::EndsWith(" outside of the data"));
    EXPECT_THAT(at(0.9), MatchesRegex("t = .* s"));
    EXPECT_EQ(followsText(space->info(), 2, 0), "");
}

TEST_F(ShownPlane, TheTimeShownStaysWhileAPlaneIsMoved) {
    const volume::DatasetInfo& whole = space->info();
    for (const double degrees : {20.0, 70.0}) {
        const volume::TimeAxis cut{volume::SpaceAxis::Z, 0.5, degrees, 0.5};
        shows(cut);
        double time = -1;
        for (const double place : {0.4, 0.3, 0.6}) { // as a hand drags, from frame to frame
            const Session inner = sessionInSpace(session, source->info(), whole);
            if (time >= 0) {
                EXPECT_NEAR(inner.time, time, 1e-9) << degrees;
            }
            time = inner.time;
            Session edited = inner;
            glm::dvec4 to(inner.cursor, inner.time);
            to.z = whole.bounds.lo.z + place * whole.bounds.size().z;
            edited.data.timeAxis = volume::movedTo(volume::planeOf(whole, cut), *inner.data.timeAxis, to);
            takeFromSpace(session, inner, edited, source->info(), whole);
            EXPECT_TRUE(volume::planeOf(whole, *session.data.timeAxis).holds(to));
        }
    }
}

} // namespace
} // namespace tessera::app
