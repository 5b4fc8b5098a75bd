#include "vis/processor/processor_picture.h"

#include "vis/demand/added_rays.h"
#include "vis/demand/box_lines.h"
#include "vis/image/light_picture.h"
#include "vis/optics/jitter.h"
#include "vis/packet/packet_refusal.h"
#include "vis/processor/masked_depths.h"
#include "vis/processor/presented.h"
#include "vis/processor/rasterized.h"
#include "volume/base/error.h"

#include <utility>

namespace tessera::vis {

namespace {

/// Throws what keeps the processor from drawing a scene.
void refuse(const Scene& scene, const volume::BrickSource& source, std::size_t bytes) {
    const volume::DatasetInfo& info = source.info();
    const volume::Lattice& lattice = source.grid().lattice;
    std::string why = packet::packetRefusal(scene, info, lattice);
    if (why.empty() && packet::packetBytes(scene, info, lattice) > double(bytes))
        why = "data larger than the memory for bricks";
    if (!why.empty()) throw MachineError("without OpenGL " + why + " cannot be drawn");
}

/// The picture that lights a scene; none if it cannot be read.
std::optional<CubeMap> surroundingsIn(const EnvironmentLight& light, const std::function<void(std::string)>& say) {
    if (light.kind != Environment::Picture || light.picture.empty()) return std::nullopt;
    try {
        return readSurroundings(light.picture);
    } catch (const Error& error) {
        say(std::string("The surroundings cannot be shown: ") + error.what());
        return std::nullopt;
    }
}

/// Makes a picture of first rays that of all. Returns how many were cast for a pixel.
template <class Geometry>
double castFurther(packet::PacketRenderer& renderer, const Scene& scene, const Geometry& geometry,
                   packet::PacketPicture& picture) {
    const Tile all{picture.box.begin, picture.box.end};
    const int passes = raysPerPixel(scene);
    AddedRays added;
    added.begin(scene, picture.size, all);
    added.takeFirst(picture, all);
    added.choose(all);
    packet::PacketPicture own{.box = {}, .rgba = {}};
    do {
        const std::vector<packet::PixelBox> boxes = added.blocks(all);
        for (int pass = 1; pass < passes && !boxes.empty(); ++pass) {
            Scene seen = scene;
            seen.camera = lensCamera(seen.camera, pass, passes);
            own.begin(picture.size, picture.box, false);
            renderer.draw(seen, pass, 1, 1, own, geometry(seen, pass), boxes);
            added.take(own, all, pass);
        }
    } while (added.chooseMore());
    added.show(all, own);
    picture.rgba = std::move(own.rgba); // the first rays are picked
    return 1 + added.share() * (passes - 1);
}

} // namespace

void ProcessorPicture::draw(const Scene& scene, glm::ivec2 size, const Data& data,
                            const std::function<void(std::string)>& say) {
    if (scene_ == scene && volumes_ == data.volumes && linear_.size == size) return;
    linear_.size = {}; // until it is whole
    packet::PacketPicture made{.box = {}, .rgba = {}};
    made.begin(size, {{0, 0}, size}, true);
    BoxLines lines;
    if (data.volumes) {
        const volume::BrickSource& source = *data.volumes->source();
        refuse(scene, source, data.bytes);
        renderer_.setVolumes(data.volumes);
        renderer_.prepare(scene);
        const std::optional<CubeMap> surroundings = surroundingsIn(scene.lighting.environment, say);
        const packet::SceneLight light = renderer_.lightOf(scene, surroundings ? &*surroundings : nullptr);
        renderer_.setLight(light);
        const auto geometry = [&](const Scene& seen, int pass) {
            return rasterized(seen, source.info(), light, size, pixelJitter(pass));
        };
        renderer_.draw(scene, 0, 1, 1, made, geometry(scene, 0));
        raysCast_ = raysPerPixel(scene) > 1 ? castFurther(renderer_, scene, geometry, made) : 1;
        if (scene.showBox) lines = boxLines(scene.camera, worldFrame(source.info(), scene.stretch).halfSize, size);
    }
    texture_.size = size;
    const bool masks = scene.depthMask.any() && data.volumes;
    texture_.rgba =
        presented(masks ? maskedDepths(made, scene, worldFrame(data.volumes->source()->info(), scene.stretch)) : made,
                  made.box, scene, lines);
    volumes_ = data.volumes;
    scene_ = scene;
    linear_ = std::move(made);
}

} // namespace tessera::vis
