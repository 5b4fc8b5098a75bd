#include "tests/packet/packet_pictures.h"

/// Transfer functions of two dimensions, and classification before and over interpolation, drawn by packets of rays
/// against the double-precision reference.
namespace tessera::vis::packet {
namespace {

Layer composite(const char* channel, Classification classification = Classification::Post, bool shaded = true) {
    return layerOf(VolumeLayer{.channel = channel, .classification = classification, .shaded = shaded, .density = 3});
}
void setRegions(TransferFunction& function) {
    function.kind = TransferKind::Regions;
    function.regions = {
        {.shape = RegionShape::Triangle, .centre = {0.55f, 0.4f}, .size = {0.5f, 0.9f}, .opacity = 0.25f},
        {.shape = RegionShape::Gaussian,
         .centre = {0.8f, 0.3f},
         .size = {0.3f, 0.7f},
         .opacity = 0.4f,
         .ownColor = false},
        {.shape = RegionShape::Rectangle,
         .centre = {0.2f, 0.5f},
         .size = {0.2f, 1.4f},
         .soft = 0.8f,
         .opacity = 0.2f,
         .color = {0.2f, 0.6f, 0.9f}}};
}

const Mode kByRegions[] = {
    {"regions",
     [](Scene& s) {
         s.layers = {composite("a")};
         setRegions(s.transfer["a"]);
     }},
    {"unshaded regions, brushed and clipped",
     [](Scene& s) {
         s.layers = {composite("a", Classification::PreIntegrated, false)};
         setRegions(s.transfer["a"]);
         s.clips = {{.kind = ClipKind::Box, .size = {0.6f, 0.5f, 0.85f}}};
         s.selection.brushes = {rangeBrush({{.channel = "b", .lo = 0.2, .hi = 0.9, .soft = 0.2}})};
     }},
    {"regions of parts, over a curve",
     [](Scene& s) {
         s.layers = {composite("parted"), composite("a")};
         setRegions(s.transfer["parted"]);
     }},
    {"regions in shadows",
     [](Scene& s) {
         s.layers = {composite("a")};
         setRegions(s.transfer["a"]);
         s.lighting.shadows.strength = 1;
     }},
    {"regions of labels",
     [](Scene& s) {
         s.layers = {composite("label")};
         setRegions(s.transfer["label"]);
         for (TransferRegion& region : s.transfer["label"].regions) region.centre.y = 0;
     }},
    {"a look of regions, and a projection that has none",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "a", .density = 3, .look = *Look::preset("illustration")}),
                     layerOf(VolumeLayer{.channel = "a", .style = RayStyle::Maximum, .density = 0.3f})};
         setRegions(s.transfer["a"]);
     }},
};

const Mode kPre[] = {
    {"before interpolation", [](Scene& s) { s.layers = {composite("a", Classification::Pre)}; }},
    {"before interpolation, unshaded and without a filter",
     [](Scene& s) {
         s.layers = {composite("b", Classification::Pre, false), composite("whole", Classification::Post, false)};
         s.transfer["b"].opacity = {{0, 0}, {0.5f, 0}, {0.55f, 0.3f}, {0.6f, 0}, {1, 0.1f}};
         s.render.filter = Filter::Average;
     }},
    {"parts before interpolation, in shadows",
     [](Scene& s) {
         s.layers = {composite("parted", Classification::Pre)};
         s.transfer["parted"].opacity = {{0, 0}, {0.4f, 0}, {1, 0.2f}};
         s.lighting.shadows.strength = 0.8f;
     }},
};

const Mode kOver[] = {
    {"over segments", [](Scene& s) { s.layers = {composite("a", Classification::PreIntegrated)}; }},
    {"thin shells over long segments",
     [](Scene& s) {
         s.layers = {composite("a", Classification::PreIntegrated, false)};
         s.transfer["a"].opacity = {{0, 0},    {0.4f, 0},     {0.41f, 0.6f}, {0.42f, 0},
                                    {0.7f, 0}, {0.71f, 0.9f}, {0.72f, 0},    {1, 0}};
         s.render.stepVoxels = 2;
     }},
    {"narrow range over segments",
     [](Scene& s) {
         s.layers = {composite("b", Classification::PreIntegrated)};
         s.transfer["b"].opacity = {{0, 0}, {0.4f, 0.2f}, {0.9f, 0}};
         s.transfer["b"].autoRange = false;
         s.transfer["b"].range = {0.4, 0.6};
         s.render.jitter = true;
     }},
    {"parts over segments, with a hole",
     [](Scene& s) {
         s.layers = {composite("parted", Classification::PreIntegrated)};
         s.transfer["parted"].opacity = {{0, 0}, {0.4f, 0}, {1, 0.2f}};
         s.clips = {
             {.kind = ClipKind::Sphere, .keep = ClipKeep::Outside, .center = {0.4f, 0.3f, 0.6f}, .radius = 0.2f}};
     }},
};

/// Shells at both ends of a block, which segments around samples of the empty blocks beside it meet.
const Mode kBesideBlocks[] = {
    {"shells beside empty blocks",
     [](Scene& s) {
         s.layers = {composite("z", Classification::PreIntegrated, false)};
         const auto at = [](double z) { return float(z / 24); };
         s.transfer["z"].opacity = {{0, 0},        {at(6.2), 0},     {at(6.5), 0.9f}, {at(6.8), 0},
                                    {at(13.2), 0}, {at(13.5), 0.9f}, {at(13.8), 0},   {1, 0}};
         s.render.stepVoxels = 2;
     }},
};

class PacketClasses : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(All, PacketClasses, testing::ValuesIn(cases()), nameOf);

TEST_P(PacketClasses, RegionsAgreeWithTheReference) {
    expectAgreement(GetParam(), kByRegions);
}

TEST_P(PacketClasses, BeforeInterpolationAgreesWithTheReference) {
    expectAgreement(GetParam(), kPre);
}

TEST_P(PacketClasses, OverSegmentsAgreesWithTheReference) {
    expectAgreement(GetParam(), kOver);
}

TEST_P(PacketClasses, SegmentsReachIntoOtherBlocks) {
    const auto height = [](glm::dvec3 p) -> std::optional<double> { return p.z; };
    const auto data = std::make_shared<FunctionSource>(GetParam().kind, glm::ivec3(12, 12, 25), glm::dvec3(1),
                                                       std::vector<FunctionSource::Channel>{{"z", height, {0, 24}}});
    expectAgreement(data, kBesideBlocks);
}

} // namespace
} // namespace tessera::vis::packet
