#include "tests/app/first_picture.h"

#include "app/data/first_view.h"
#include "volume/base/error.h"
#include "volume/synthetic/models.h"

#include <cstdlib>
#include <filesystem>
#include <gtest/gtest.h>

/// Measures of the first picture of data that are opened without a layout, and after another parameter or time is
/// chosen, on the built-in models and on what lies under $TESSERA_DATA.
namespace tessera::app {
namespace {

constexpr glm::ivec2 kPictureSize{160, 130};

/// Where the body fills the box as far as rays go, all of it is seen and must be seen through; bodies that take a small
/// part of the box are seen at most of their own.
void expectWhole(const PictureMeasures& is, const std::string& what) {
    EXPECT_GE(is.seen, std::min(0.15, 0.6 * is.body)) << what << ": " << is.body << " of the box has values";
    EXPECT_TRUE(is.seen <= 0.9 || is.opacity <= 0.8) << what << ": " << is.seen << ", opacity " << is.opacity;
    EXPECT_GE(is.colours, std::min(5, is.parts)) << what;
    EXPECT_GE(is.covered, 0.8) << what;
    EXPECT_GE(is.extent, 0.6) << what;
    EXPECT_FALSE(is.cut) << what;
}

void fitTo(Session& session, const volume::DatasetInfo& info, glm::ivec2 size) {
    vis::fit(session.camera, vis::worldFrame(info, session.stretch), double(size.x) / size.y);
}

/// The picture as data are opened, those of every parameter at three times, and those of other panes and stretches.
void expectAllWhole(const OpenRequest& request, const std::string& name) {
    const Opened opened = open(request);
    const volume::BrickSource& numbers = *opened.numbers;
    const volume::DatasetInfo& info = opened.source->info();
    Session first = opened.document.session;
    fitTo(first, info, kPictureSize);
    expectWhole(measure(first, opened.source, numbers, kPictureSize), name);
    std::vector<double> times{info.times.front()};
    if (info.times.size() > 1) times.push_back(info.times.back());
    if (info.times.size() > 2) times.insert(times.begin() + 1, info.times[info.times.size() / 2]);
    for (const volume::Channel& channel : info.channels()) {
        if (info.parameters[std::size_t(channel.parameter)].categorical) continue;
        Session session = first;
        for (vis::Layer& layer : session.layers)
            if (auto* volume = std::get_if<vis::VolumeLayer>(&layer.technique)) {
                volume->channel = channel.name;
                aimLayer(session, *opened.source, layer);
            }
        for (const double time : times) {
            session.time = time;
            expectWhole(measure(session, opened.source, numbers, kPictureSize),
                        name + ", " + channel.name + " at " + std::to_string(time));
        }
    }
    for (const glm::ivec2 size : {glm::ivec2(80, 160), glm::ivec2(160, 80)})
        for (const glm::dvec3 stretch : {glm::dvec3(1), glm::dvec3(3, 1, 1), glm::dvec3(1, 1, 3)}) {
            Session session = first;
            session.stretch *= stretch;
            fitTo(session, info, size);
            const PictureMeasures is = measure(session, opened.source, numbers, size);
            EXPECT_GE(is.extent, 0.6) << name;
            EXPECT_FALSE(is.cut) << name;
            EXPECT_GE(is.seen, std::min(0.12, 0.5 * is.body)) << name << ": small, so edges weigh more";
        }
}

TEST(FirstPicture, OfEveryModelAllIsSeenAndNothingHidden) {
    for (const std::string& model : volume::modelNames()) {
        // Small balls, of which a third is their edge, in a liquid of exactly 0; a pulse in a small part of its pipe.
        if (model == "bubbles" || model == "branching-pulse") continue;
        OpenRequest request;
        request.data.emplace();
        request.data->model = model; // the default session, also of the model that opens with a layout
        expectAllWhole(request, model);
    }
}

TEST(FirstPicture, OfDataAtHandAllIsSeenAndNothingHidden) {
    const char* named = std::getenv("TESSERA_DATA");
    const std::filesystem::path root = named ? named : TESSERA_TEST_DATA;
    std::vector<std::string> files;
    std::error_code problem;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root, problem))
        if (entry.path().extension() == ".pvd" || entry.path().extension() == ".vtu" ||
            (entry.path().extension() == ".json" && entry.path().parent_path().filename() == "volumes"))
            files.push_back(entry.path().string());
    std::ranges::sort(files);
    std::size_t opened = 0;
    for (const std::string& file : files) {
        OpenRequest request;
        request.paths = {file};
        try {
            expectAllWhole(request, std::filesystem::path(file).filename().string());
            ++opened;
        } catch (const Error& error) { // without the importer, for example
            std::printf("left out: %s\n", error.what());
        }
    }
    if (opened == 0) GTEST_SKIP() << "no data under $TESSERA_DATA";
}

} // namespace
} // namespace tessera::app
