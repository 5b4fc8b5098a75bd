#include "app/data/open.h"
#include "app/data/sources.h"
#include "app/described/within_ranges.h"
#include "randomise.h"
#include "tests/app/open_fixture.h"

#include <array>
#include <cmath>
#include <limits>

/// Sessions of any data can be read back.
namespace tessera::app {
namespace {

void expectReadBack(const SessionDocument& document, const std::string& what) {
    try {
        const SessionDocument back = parseSession(printSession(document, "/somewhere/session"), "session");
        EXPECT_TRUE(back.messages.empty()) << what << ": " << back.messages.front();
        EXPECT_TRUE(back.session.stretch == document.session.stretch) << what;
        EXPECT_TRUE(back.session.camera == document.session.camera) << what;
        EXPECT_TRUE(back.session.transfer == document.session.transfer) << what;
        EXPECT_EQ(back.session.layers.size(), document.session.layers.size()) << what;
    } catch (const Error& error) {
        ADD_FAILURE() << what << ": " << error.what();
    }
}

using Shape = std::array<int, 3>;

TEST_F(OpenTest, SessionsOfAnyShapeOfDataAreReadBack) {
    std::mt19937 random(5);
    const auto anyOf = [&](const auto& list) { return list[random() % std::size(list)]; };
    static constexpr Shape kShapes[] = {{1, 1, 1}, {1, 1, 60000}, {60000, 16, 1}, {6000, 1, 2},
                                        {2, 2, 2}, {1, 300, 1},   {7, 1, 5},      {16, 4000, 2}};
    static constexpr const char* kSpacings[] = {"1", "1e-9", "1e9", "0.001", "12345.678", "3e-5"};
    static constexpr const char* kOrigins[] = {"0", "-1e9", "1e-12", "17"};
    for (int i = 0; i < 60; ++i) {
        const Shape shape = anyOf(kShapes);
        const std::size_t count = std::size_t(shape[0]) * std::size_t(shape[1]) * std::size_t(shape[2]);
        const int times = 1 + int(random() % 3);
        static constexpr float kLargest = std::numeric_limits<float>::max();
        static constexpr std::array<float, 2> kRanges[] = {
            {0, 1}, {3, 3}, {-1e30f, 1e30f}, {0, 1e-40f}, {-kLargest, kLargest}, {1e20f, 1.0001e20f}};
        const auto [lo, hi] = anyOf(kRanges);
        std::vector<float> samples(count * std::size_t(times), lo);
        samples.back() = hi;
        std::ofstream(folder / "shape.raw", std::ios::binary)
            .write(reinterpret_cast<const char*>(samples.data()), std::streamsize(samples.size() * sizeof(float)));
        const std::string x = "x", comma = ",";
        OpenRequest request;
        request.paths = {in("shape.raw")};
        request.import.emplace();
        request.import->raw = "dims=" + std::to_string(shape[0]) + x + std::to_string(shape[1]) + x +
                              std::to_string(shape[2]) + ",type=f32,times=" + std::to_string(times) +
                              ",spacing=" + anyOf(kSpacings) + x + anyOf(kSpacings) + x + anyOf(kSpacings) +
                              ",origin=" + anyOf(kOrigins) + x + anyOf(kOrigins) + x + anyOf(kOrigins);
        if (times == 3 && (i & 1) != 0) request.import->times = {-1e30, 1e-30, 1e30};
        SCOPED_TRACE(request.import->raw);
        request.layout = std::array{"", "overview", "lens", ""}[random() % 4];
        const Opened opened = open(request);
        SessionDocument document = opened.document;
        expectReadBack(document, "first view");
        document.session.camera.distance *= 1.01f;
        document.history.observe(document.session, false, 10);
        expectReadBack(document, "edited");
    }
}

TEST(WithinRanges, AnySessionCanBeReadOnceItsNumbersAreWithinThem) {
    std::mt19937 random(11);
    for (int i = 0; i < 30; ++i) {
        auto camera = randomValue<vis::Camera>(random);
        Session session;
        session.camera = camera;
        session.stretch = {1e300, -5, std::nan("")};
        session.camera.distance = std::numeric_limits<float>::infinity();
        SessionDocument document;
        document.session = session;
        EXPECT_NO_THROW((void)parseSession(printSession(document, "/a"), "session"));
        keepWithinRanges(session);
        EXPECT_EQ(session.stretch, glm::dvec3(1e6, 0.01, 0.01));
        Session again = session;
        keepWithinRanges(again);
        EXPECT_TRUE(again == session);
    }
}

} // namespace
} // namespace tessera::app
