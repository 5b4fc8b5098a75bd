#include "vis/processor/processor_renderer.h"

#include "vis/image/turned_rows.h"

#include <algorithm>
#include <cmath>

namespace tessera::vis {

void ProcessorRenderer::setSource(std::shared_ptr<const volume::BrickSource> source) {
    if (source.get() == this->source()) return;
    volumes_ = source ? std::make_shared<packet::PacketVolumes>(std::move(source)) : nullptr;
}

void ProcessorRenderer::draw(ProcessorPicture& picture, const Scene& scene, glm::ivec2 size) {
    const std::size_t bytes = std::min(options_.memoryBudget, std::size_t(scene.render.limits.brickMemory) << 20);
    if (volumes_) volumes_->keep(bytes / 2);
    picture.draw(scene, size, {volumes_, bytes}, [this](std::string text) { messages_.push_back(std::move(text)); });
}

std::optional<glm::dvec3> ProcessorRenderer::pick(const ProcessorPicture& of, glm::ivec2 pixel) const {
    const packet::PacketPicture& picture = of.linear();
    const glm::ivec2 size = picture.size, place(pixel.x, size.y - 1 - pixel.y);
    if (!volumes_ || place.x < 0 || place.y < 0 || place.x >= size.x || place.y >= size.y) return std::nullopt;
    const double distance = double(picture.pick[std::size_t(place.y) * std::size_t(size.x) + std::size_t(place.x)]);
    if (std::abs(distance) > 1e8) return std::nullopt;
    const Scene& scene = of.scene();
    const Ray ray =
        cameraRay(scene.camera, double(size.x) / size.y, (glm::dvec2(place) + 0.5) / glm::dvec2(size) * 2.0 - 1.0);
    const WorldFrame frame = worldFrame(volumes_->source()->info(), scene.stretch);
    return frame.toPhysical(ray.origin + ray.direction * distance);
}

std::vector<glm::vec4> linearRows(const ProcessorPicture& of) {
    const packet::PacketPicture& picture = of.linear();
    std::vector<glm::vec4> pixels;
    for (std::size_t i = 0; i + 3 < picture.rgba.size(); i += 4)
        pixels.emplace_back(picture.rgba[i], picture.rgba[i + 1], picture.rgba[i + 2], picture.rgba[i + 3]);
    return turnedRows(pixels, std::size_t(std::max(picture.size.x, 1)));
}

std::vector<std::uint8_t> shownRows(const ProcessorPicture& picture) {
    const MemoryTexture& texture = picture.texture();
    return turnedRows(texture.rgba, std::size_t(std::max(texture.size.x, 1)) * 4);
}

} // namespace tessera::vis
