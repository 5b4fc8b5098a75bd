#include "tests/packet/packet_pictures.h"
#include "vis/optics/ray_setup.h"

/// Rasterised surfaces among the layers of the packet ray caster: planes of one colour, which the reference draws as
/// slices.
namespace tessera::vis::packet {
namespace {

/// A plane through the whole data set.
struct PlaneSurface {
    SliceLayer slice;
    glm::vec3 color{0.5f}; ///< sRGB
    BrushEffect brushes = BrushEffect::Fade;
};

/// What a rasteriser gives for planes: surfaces of each pixel, nearest first.
PacketGeometry rasterised(const Scene& scene, const volume::DatasetInfo& info,
                          const std::vector<PlaneSurface>& planes) {
    const WorldFrame frame = worldFrame(info, scene.stretch);
    const std::size_t pixels = std::size_t(kSize.x) * std::size_t(kSize.y);
    PacketGeometry out{.peels = int(planes.size())};
    out.distance.resize(pixels * planes.size() * 2);
    out.color.resize(pixels * planes.size() * 4);
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        const glm::dvec2 at(double(pixel % std::size_t(kSize.x)), double(pixel / std::size_t(kSize.x)));
        const Ray ray = cameraRay(scene.camera, double(kSize.x) / kSize.y, (at + 0.5) / glm::dvec2(kSize) * 2.0 - 1.0);
        struct Hit {
            double t;
            const PlaneSurface* plane;
        };
        std::vector<Hit> hits;
        for (const PlaneSurface& plane : planes) {
            const double t = planeDistance(slicePlane(plane.slice, frame, scene.cursor), ray.origin, ray.direction);
            const glm::dvec3 place = glm::abs(ray.origin + t * ray.direction);
            const bool within = glm::all(glm::lessThan(place, frame.halfSize + 1e-9));
            hits.push_back({within ? t : 1e9, &plane});
        }
        std::ranges::sort(hits, {}, &Hit::t);
        for (std::size_t peel = 0; peel < hits.size(); ++peel) {
            const Hit& hit = hits[peel];
            const std::size_t to = peel * pixels + pixel;
            out.distance[to * 2] = float(hit.t);
            out.distance[to * 2 + 1] = float(hit.plane->brushes);
            const float alpha = hit.t < 1e8 ? hit.plane->slice.opacity : 0;
            const glm::vec3 color = glm::vec3(linearFromSrgb(glm::dvec3(hit.plane->color))) * alpha;
            for (int c = 0; c < 3; ++c) out.color[to * 4 + std::size_t(c)] = color[c];
            out.color[to * 4 + 3] = alpha;
        }
    }
    return out;
}

struct GeometryMode {
    const char* name;
    std::vector<PlaneSurface> planes;
    std::function<void(Scene&)> apply;
};

const PlaneSurface kAcross{{.channel = "whole", .orientation = SliceOrientation::X, .opacity = 0.5f},
                           {0.9f, 0.3f, 0.2f}},
    kTilted{
        {.channel = "whole", .orientation = SliceOrientation::Oblique, .normal = {0.4f, 0.6f, 0.5f}, .opacity = 0.7f},
        {0.2f, 0.6f, 0.9f}},
    kOpaquePlane{{.channel = "whole", .atCursor = false, .position = 0.6}, {0.4f, 0.8f, 0.3f}};

const GeometryMode kGeometryModes[] = {
    {"in a haze",
     {kAcross, kTilted, kOpaquePlane},
     [](Scene& s) { s.layers = {layerOf(VolumeLayer{.channel = "a", .shaded = false})}; }},
    {"in a lit volume",
     {kAcross, kTilted},
     [](Scene& s) { s.layers = {layerOf(VolumeLayer{.channel = "a", .density = 3})}; }},
    {"and a surface",
     {kAcross, kOpaquePlane},
     [](Scene& s) { s.layers = {layerOf(IsoLayer{.channel = "a", .value = 317, .opacity = 0.5f})}; }},
    {"and slices",
     {kAcross, kTilted},
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "a", .shaded = false}),
                     layerOf(SliceLayer{.channel = "b", .orientation = SliceOrientation::Y, .opacity = 0.6f})};
     }},
    {"before a mean",
     {kAcross, kTilted},
     [](Scene& s) { s.layers = {layerOf(VolumeLayer{.channel = "b", .style = RayStyle::Average})}; }},
    {"brushed",
     {kAcross, kTilted},
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "a", .density = 3})};
         s.selection.brushes = {rangeBrush({{.channel = "whole", .lo = 0.6, .hi = 1.1, .soft = 0.2}})};
         s.selection.contextOpacity = 0.3f;
         s.selection.contextSaturation = 0.2f;
     }},
};

class PacketGeometryPictures : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(All, PacketGeometryPictures, testing::ValuesIn(cases()), nameOf);

TEST_P(PacketGeometryPictures, AgreeWithSlicesOfTheReference) {
    const auto data = source(GetParam().kind, GetParam().masked);
    std::vector<PacketRenderer> renderers = everyRenderer(data);
    for (const GeometryMode& mode : kGeometryModes)
        for (const bool perspective : {false, true}) {
            Scene scene = wavyScene(perspective);
            scene.cursor = {9, 8, 12};
            mode.apply(scene);
            Scene sliced = scene;
            std::vector<PlaneSurface> planes = mode.planes;
            if (scene.selection.active()) planes[0].brushes = BrushEffect::ContextOnly;
            for (const PlaneSurface& plane : planes) {
                const std::string name = "plain " + std::to_string(sliced.layers.size());
                sliced.transfer[name].colors = {{0, plane.color}, {1, plane.color}};
                sliced.layers.push_back(layerOf(plane.slice));
                sliced.layers.back().transfer = name;
                sliced.layers.back().brushes = plane.brushes;
            }
            const reference::Image wanted = reference::render(sliced, *data, kSize);
            const PacketGeometry surfaces = rasterised(scene, data->info(), planes);
            for (PacketRenderer& renderer : renderers) {
                PacketPicture picture;
                picture.begin(kSize, {{0, 0}, kSize}, false);
                renderer.prepare(scene);
                renderer.draw(scene, 0, 1, 1, picture, surfaces);
                expectAlike(renderer, picture, wanted, 2 * kOutliers,
                            std::string(mode.name) + (perspective ? " perspective" : " parallel"));
            }
        }
}

} // namespace
} // namespace tessera::vis::packet
