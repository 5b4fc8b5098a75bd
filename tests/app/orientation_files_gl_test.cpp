#include "app/data/open.h"
#include "app/dialogs/picture_request.h"
#include "app/history/session_file.h"
#include "app/platform/headless.h"
#include "codec/pack/pack.h"
#include "tests/app/beacon.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <iterator>
#include <sstream>
#include <unistd.h>

/// Where the files that the program writes show one bright place of the data: pictures, figures, frames of an
/// animation, meshes. Written by the program itself, read back here.
namespace tessera::app {
namespace {

namespace fs = std::filesystem;

class OrientationOfFiles : public testing::Test {
protected:
    void SetUp() override {
        folder = fs::temp_directory_path() / ("tessera-orientation-" + std::to_string(getpid()));
        fs::create_directories(folder);
        volume::Dataset data = beacon::makeBeacon();
        codec::PackOptions grid; // the samples themselves
        grid.lattice = codec::StoredLattice::CC;
        codec::pack(data, grid, in("beacon.tsr"));
        OpenRequest request;
        request.paths = {in("beacon.tsr")};
        document = open(request).document;
        Session& session = document.session;
        beacon::color(session);
        session.stretch = {1, 1, 1};
        session.time = 0;
        session.cursor = beacon::position(0);
        session.views.clear();
    }
    void TearDown() override { fs::remove_all(folder); }
    std::string in(const std::string& name) const { return (folder / name).string(); }

    /// Saves the session with a view as "pane" and runs the program.
    void run(const std::string& command, const std::optional<ViewState>& view = {}) {
        if (view) document.session.views = {{"pane", *view}};
        document.history.reset(document.session);
        saveSession(document, in("s.tessera.json"));
        const std::string line =
            "cd '" + folder.string() + "' && '" TESSERA_BINARY_DIR "/tessera' " + command + " > /dev/null 2> err.txt";
        ASSERT_EQ(std::system(line.c_str()), 0) << command << '\n' << text("err.txt");
    }
    /// The figure that Export writes of a view, as SVG.
    std::string exported(const ViewState& view) {
        document.session.views = {{"pane", view}};
        document.history.reset(document.session);
        OpenRequest request;
        request.paths = {in("beacon.tsr")};
        std::string svg;
        PictureMaker().render(document, open(request).sources(), pictureRequest(PictureForm{}, "pane"),
                              [&](const Workbench& workbench) {
                                  const ViewExport* offered = workbench.exported("pane");
                                  if (offered && offered->figure) svg = svgOf(offered->figure({}, {}));
                              });
        return svg;
    }
    std::string text(const std::string& name) const {
        std::ifstream file(in(name), std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    /// A picture of the whole of a volume view is bright where the camera has the place of a time.
    void expectAsTheCameraHasIt(const vis::Image& image, int time) const {
        const vis::Camera& camera = document.session.camera;
        const volume::Box bounds{beacon::kOrigin, beacon::kOrigin + beacon::kSpacing * glm::dvec3(beacon::kSize - 1)};
        const vis::WorldFrame world = vis::worldFrame(bounds, document.session.stretch);
        const glm::dmat4 matrix =
            vis::projectionMatrix(camera, double(image.size.x) / image.size.y) * vis::viewMatrix(camera);
        const auto pixel = [&](glm::dvec3 at) {
            const glm::dvec4 clip = matrix * glm::dvec4(world.toWorld(at), 1);
            return beacon::whole(image).at((clip.x / clip.w + 1) / 2, (clip.y / clip.w + 1) / 2);
        };
        const glm::dvec3 place = beacon::position(time);
        double reach = 0;
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 end = place;
            end[axis] += 1.7 * beacon::kSpacing[axis];
            reach = std::max(reach, glm::distance(pixel(place), pixel(end)));
        }
        beacon::expectBrightAt(image, beacon::whole(image), {pixel(place)}, reach + 2);
    }

    fs::path folder;
    SessionDocument document;
};

VolumeView bare() {
    VolumeView view;
    view.showBox = view.showAxes = view.showLegend = view.showCursor = view.showGizmo = view.showScaleBar =
        view.showLenses = false;
    return view;
}

TEST_F(OrientationOfFiles, PicturesAreAsTheCameraSees) {
    document.session.stretch = {1.6, 0.8, 1};
    document.session.time = 4;
    run("render s.tessera.json --view volume --size 240x180 -o out.png", bare());
    expectAsTheCameraHasIt(vis::readPng(in("out.png")), 2);
    run("render s.tessera.json --view volume --time 1 --size 180x240 -o out.png");
    expectAsTheCameraHasIt(vis::readPng(in("out.png")), 1);
}

TEST_F(OrientationOfFiles, FramesOfAnAnimationAreAsTheCameraSees) {
    run("replay s.tessera.json --animation --view volume --size 200x160 -o frames", bare());
    for (int time = 0; time < 3; ++time) {
        SCOPED_TRACE(time);
        expectAsTheCameraHasIt(vis::readPng(in("frames/frame-000" + std::to_string(time) + ".png")), time);
    }
    EXPECT_FALSE(fs::exists(in("frames/frame-0003.png")));
}

/// A picture in a figure, decoded, with the place that the figure gives it.
struct Embedded {
    double x = 0, y = 0, width = 0, height = 0;
    vis::Image image;
};

std::vector<std::uint8_t> fromBase64(std::string_view text) {
    std::vector<std::uint8_t> bytes;
    unsigned buffer = 0;
    int bits = 0;
    for (const char c : text) {
        const int value = c >= 'A' && c <= 'Z'   ? c - 'A'
                          : c >= 'a' && c <= 'z' ? c - 'a' + 26
                          : c >= '0' && c <= '9' ? c - '0' + 52
                          : c == '+'             ? 62
                          : c == '/'             ? 63
                                                 : -1;
        if (value < 0) continue;
        buffer = buffer << 6 | unsigned(value);
        bits += 6;
        if (bits >= 8) {
            bits -= 8;
            bytes.push_back(std::uint8_t(buffer >> bits & 255));
        }
    }
    return bytes;
}

std::vector<Embedded> imagesOf(const std::string& svg) {
    std::vector<Embedded> out;
    for (std::size_t at = svg.find("<image "); at != std::string::npos; at = svg.find("<image ", at + 1)) {
        const std::string element = svg.substr(at, svg.find("/>", at) - at);
        const auto attribute = [&](const std::string& name) {
            const std::size_t from = element.find(' ' + name + "=\"") + name.size() + 3;
            return element.substr(from, element.find('"', from) - from);
        };
        EXPECT_EQ(attribute("preserveAspectRatio"), "none");
        EXPECT_EQ(element.find("transform"), std::string::npos);
        if (std::stod(attribute("width")) < 20) continue; // the key of the colours
        const std::string data = attribute("xlink:href");
        out.push_back({std::stod(attribute("x")), std::stod(attribute("y")), std::stod(attribute("width")),
                       std::stod(attribute("height")),
                       vis::decodePng(fromBase64(std::string_view(data).substr(data.find(',') + 1)), "figure")});
        EXPECT_GT(out.back().width, 50);
        EXPECT_GT(out.back().height, 50);
    }
    return out;
}

/// The middle of the bright pixels, as shares from the left and from below; nothing where there are none.
std::optional<glm::dvec2> brightIn(const vis::Image& image) {
    glm::dvec2 sum(0);
    double count = 0;
    for (int y = 0; y < image.size.y; ++y)
        for (int x = 0; x < image.size.x; ++x)
            if (beacon::Pixels{image}.bright(x, y)) {
                sum += glm::dvec2((x + 0.5) / image.size.x, 1 - (y + 0.5) / image.size.y);
                count += 1;
            }
    return count > 0 ? std::optional(sum / count) : std::nullopt;
}

TEST_F(OrientationOfFiles, FiguresOfSlicesAreThoseOfTheirAxes) {
    document.session.time = 1;
    document.session.cursor = beacon::position(1);
    const std::vector<Embedded> slices = imagesOf(exported(SlicesView{}));
    ASSERT_EQ(slices.size(), 3u);
    constexpr int kAxes[3][2] = {{0, 1}, {2, 1}, {0, 2}};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto middle = brightIn(slices[i].image);
        ASSERT_TRUE(middle);
        EXPECT_NEAR(middle->x, beacon::share(1, kAxes[i][0]), 0.03) << i;
        EXPECT_NEAR(middle->y, beacon::share(1, kAxes[i][1]), 0.03) << i;
    }
    EXPECT_LT(slices[0].x, slices[1].x);
    EXPECT_EQ(slices[0].y, slices[1].y);
    EXPECT_LT(slices[0].y, slices[2].y);

    SliceMatrixView matrix;
    matrix.channels = {"beacon"};
    matrix.planes = 2;
    document.session.time = 0;
    const std::vector<Embedded> planes = imagesOf(exported(matrix));
    ASSERT_EQ(planes.size(), 2u);
    const auto middle = brightIn(planes[0].image);
    ASSERT_TRUE(middle);
    EXPECT_NEAR(middle->x, beacon::share(0, 1), 0.03) << "y, which is longer, to the right";
    EXPECT_NEAR(middle->y, beacon::share(0, 0), 0.03);
    EXPECT_FALSE(brightIn(planes[1].image));
}

TEST_F(OrientationOfFiles, FiguresOfProfilesOverTimeHaveTimeUp) {
    for (int time = 0; time < 3; ++time) {
        ProfileView view;
        view.channels = {"beacon"};
        view.over = ProfileOver::LineAndTime;
        glm::dvec3 from = beacon::position(time), to = from;
        from.x = beacon::kOrigin.x, to.x = beacon::kOrigin.x + beacon::kSpacing.x * (beacon::kSize.x - 1);
        view.points = {from, to};
        run("render s.tessera.json --view profile -o out.svg", view);
        const std::vector<Embedded> images = imagesOf(text("out.svg"));
        ASSERT_FALSE(images.empty());
        // One picture over all times, or one for each row; the place in the figure counts.
        double top = 1e9, bottom = -1e9;
        for (const Embedded& each : images) {
            top = std::min(top, each.y);
            bottom = std::max(bottom, each.y + each.height);
        }
        int bright = 0;
        for (const Embedded& each : images) {
            const auto middle = brightIn(each.image);
            if (!middle) continue;
            ++bright;
            EXPECT_NEAR(middle->x, beacon::share(time, 0), 0.03);
            const double up = (bottom - each.y - each.height * (1 - middle->y)) / (bottom - top);
            constexpr double kMiddles[] = {0.0625, 0.375, 0.8125}; // half way to the times before and after
            EXPECT_NEAR(up, kMiddles[time], 0.03) << time;
        }
        EXPECT_EQ(bright, 1);
    }
}

TEST_F(OrientationOfFiles, FiguresOfScatterplotsHaveLowValuesAtTheLowerLeft) {
    ScatterMatrixView view;
    view.channels = {"a", "b"};
    view.bins = 16;
    const std::vector<Embedded> images = imagesOf(exported(view));
    ASSERT_EQ(images.size(), 1u);
    const vis::Image& image = images[0].image;
    ASSERT_EQ(image.size, glm::ivec2(16));
    // Bins of 2 and 10 of a to the right, of 1, 5 and 21 of b up, a fiftieth of room at either end.
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) {
            const int up = 15 - y;
            const bool some = (x == 0 && (up == 0 || up == 15)) || (x == 15 && up == 3);
            EXPECT_EQ(image.rgba[std::size_t(4 * (y * 16 + x) + 3)] > 0, some) << x << ' ' << up;
        }
}

template <class T> T readAs(const char* at) {
    T value;
    std::memcpy(&value, at, sizeof value);
    return value;
}

/// Ends of what a list of positions reaches.
struct Reach {
    glm::dvec3 lo{1e30}, hi{-1e30};
    void add(glm::dvec3 at) { lo = glm::min(lo, at), hi = glm::max(hi, at); }
};

void expectAround(const Reach& reach, int time) {
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR((reach.lo[axis] + reach.hi[axis]) / 2, beacon::position(time)[axis], 0.25 * beacon::kSpacing[axis]);
        // exp(-r^2 / 2) = 1/2 at 1.18 samples.
        EXPECT_NEAR((reach.hi[axis] - reach.lo[axis]) / 2, 1.18 * beacon::kSpacing[axis], 0.4 * beacon::kSpacing[axis]);
    }
}

TEST_F(OrientationOfFiles, MeshesLieWhereTheSurfaceIs) {
    for (int time = 0; time < 3; ++time) {
        SCOPED_TRACE(time);
        const std::string surface =
            "mesh beacon.tsr --channel beacon --iso 0.5 --time " + std::to_string(int(beacon::kTimes[time]));
        run(surface + " -o out.stl");
        const std::string stl = text("out.stl");
        ASSERT_GE(stl.size(), 84u);
        const auto triangles = readAs<std::uint32_t>(stl.data() + 80);
        ASSERT_GT(triangles, 8u);
        ASSERT_EQ(stl.size(), 84 + 50 * std::size_t(triangles));
        Reach reach;
        for (std::size_t t = 0; t < triangles; ++t)
            for (std::size_t corner = 1; corner < 4; ++corner) {
                const char* at = stl.data() + 84 + 50 * t + 12 * corner;
                reach.add({readAs<float>(at), readAs<float>(at + 4), readAs<float>(at + 8)});
            }
        expectAround(reach, time);

        run(surface + " -o out.ply");
        const std::string ply = text("out.ply");
        std::istringstream head(ply);
        std::string line;
        std::size_t vertices = 0, stride = 0, properties = 0;
        bool ofVertices = false;
        std::vector<std::string> names;
        while (std::getline(head, line) && line != "end_header") {
            if (line.starts_with("element")) ofVertices = line.starts_with("element vertex ");
            if (line.starts_with("element vertex ")) vertices = std::stoul(line.substr(15));
            if (!ofVertices || !line.starts_with("property ")) continue;
            ASSERT_TRUE(line.starts_with("property float ")) << line;
            names.push_back(line.substr(15));
            stride += 4, ++properties;
        }
        ASSERT_GE(properties, 3u);
        EXPECT_EQ(names[0] + names[1] + names[2], "xyz");
        ASSERT_GT(vertices, 8u);
        const auto body = std::size_t(head.tellg());
        Reach points;
        for (std::size_t v = 0; v < vertices; ++v) {
            const char* at = ply.data() + body + stride * v;
            points.add({readAs<float>(at), readAs<float>(at + 4), readAs<float>(at + 8)});
        }
        expectAround(points, time);
    }
}

} // namespace
} // namespace tessera::app
