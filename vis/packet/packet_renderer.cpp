#include "vis/packet/packet_renderer.h"

#include "vis/optics/jitter.h"
#include "vis/optics/shade.h"
#include "vis/packed/packet_blend.h"
#include "vis/packet/cast.h"
#include "vis/shapes/mesh_medium.h"
#include "volume/base/background.h"
#include "volume/base/parallel.h"
#include "volume/bricks/source_at_time.h"

#include <algorithm>
#include <exception>

namespace tessera::vis::packet {

namespace {

constexpr int kTile = 32; ///< pixels along the edge of what one core draws in one go

/// What is compiled for one instruction set.
struct Compiled {
    void (*castPixels)(const CastJob& job, glm::ivec2 begin, glm::ivec2 end);
    void (*fillRow)(const CastJob& job, const LightGrid& grid, int row, glm::vec4* out);
};

Compiled compiledFor([[maybe_unused]] InstructionSet with) {
#ifdef TESSERA_X86
    if (with == InstructionSet::Avx512) return {castAvx512, mediumAvx512};
    if (with == InstructionSet::Avx2) return {castAvx2, mediumAvx2};
#endif
    return {castPlain, mediumPlain};
}

bool isReady(const std::future<SharedVolume>& coming) {
    return coming.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

/// Whether tables and maps of two scenes are the same.
bool sameTables(const Scene& a, const Scene& b) {
    const auto sameLens = [&](const Lens& one, const Lens& other) {
        return one.name == other.name && activeAt(one, a.time) == activeAt(other, b.time) && one.marks == other.marks;
    };
    const auto sameLayer = [](const Layer& one, const Layer& other) {
        const auto* slice = std::get_if<SliceLayer>(&one.technique);
        if (!slice || !std::holds_alternative<SliceLayer>(other.technique)) return one == other;
        Layer moved = other; // where a slice lies is no matter of tables
        moved.technique = *slice;
        std::get<SliceLayer>(moved.technique).channel = std::get<SliceLayer>(other.technique).channel;
        return one == moved;
    };
    return std::ranges::equal(a.layers, b.layers, sameLayer) && a.transfer == b.transfer && a.time == b.time &&
           a.render.filter == b.render.filter && a.selection == b.selection &&
           std::ranges::equal(a.lenses, b.lenses, sameLens);
}

} // namespace

std::vector<InstructionSet> instructionSets() {
    std::vector<InstructionSet> out{InstructionSet::Plain};
#ifdef TESSERA_X86
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) out.push_back(InstructionSet::Avx2);
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl"))
        out.push_back(InstructionSet::Avx512);
#endif
    return out;
}

void PacketPicture::begin(glm::ivec2 whole, const PixelBox& wanted, bool picks) {
    size = whole;
    box = wanted;
    const glm::ivec2 extent = box.extent();
    const std::size_t count = std::size_t(extent.x) * std::size_t(extent.y);
    rgba.assign(count * 4, 0);
    pick.assign(picks ? count : 0, kNowhere);
}

PacketVolumes::Held& PacketVolumes::entry(const PacketChannel& channel) {
    constexpr std::uint64_t kForgotten = 64; // what nobody has asked for that often is not taken any more
    ++asked_;
    std::erase_if(held_, [&](const Held& each) {
        if (each.channel == channel || !each.volume.expired()) return false;
        return !each.coming.valid() || (each.asked + kForgotten < asked_ && isReady(each.coming));
    });
    auto found = std::ranges::find_if(held_, [&](const Held& each) { return each.channel == channel; });
    if (found == held_.end()) found = held_.insert(held_.end(), {.channel = channel, .volume = {}, .coming = {}});
    found->asked = asked_;
    return *found;
}

PacketVolumes::~PacketVolumes() {
    for (Held& each : held_) each.stop.request_stop();
}

void PacketVolumes::keep(std::size_t bytes) {
    keep_ = bytes;
}

/// Marks a volume as the last one used.
SharedVolume PacketVolumes::use(const SharedVolume& volume) {
    std::erase(recent_, volume);
    recent_.push_back(volume);
    std::size_t sum = 0;
    for (std::size_t i = recent_.size(); i-- > 0;)
        if ((sum += recent_[i]->bytes()) > keep_) {
            recent_.erase(recent_.begin(), recent_.begin() + std::ptrdiff_t(i) + 1);
            break;
        }
    return volume;
}

/// Samples between two stored times, whose own samples are held as long.
SharedVolume PacketVolumes::blend(const PacketChannel& channel) {
    if (SharedVolume volume = entry(channel).volume.lock()) return volume;
    const SharedVolume earlier = get(channel.at(channel.time.earlier)), later = get(channel.at(channel.time.later));
    auto volume = std::make_shared<const PacketVolume>(blendedVolume(*earlier, *later, channel.time.weight));
    Held& own = entry(channel);
    own.volume = volume;
    own.earlier = earlier;
    own.later = later;
    return volume;
}

/// Whether samples between two stored times are those of both, blended; else they are computed as bricks.
bool PacketVolumes::blends(const PacketChannel& channel) const {
    return channel.time.between() && (channel.mixed || !volume::isComputedBetween(*source_, channel.channel));
}

SharedVolume PacketVolumes::get(const PacketChannel& channel) {
    if (blends(channel)) return blend(channel);
    Held& own = entry(channel);
    SharedVolume volume = own.volume.lock();
    if (volume) return use(volume);
    if (own.coming.valid())
        volume = own.coming.get();
    else
        volume = std::make_shared<const PacketVolume>(readPacketVolume(*source_, channel));
    own.volume = volume;
    return use(volume);
}

bool PacketVolumes::has(const PacketChannel& channel) const {
    const volume::TimePair& time = channel.time;
    if (blends(channel)) return has(channel.at(time.earlier)) && has(channel.at(time.later));
    const auto found = std::ranges::find_if(held_, [&](const Held& each) { return each.channel == channel; });
    return found != held_.end() && (!found->volume.expired() || (found->coming.valid() && isReady(found->coming)));
}

bool PacketVolumes::reading() const {
    return std::ranges::any_of(held_, [](const Held& each) { return each.coming.valid() && !isReady(each.coming); });
}

bool PacketVolumes::request(const PacketChannel& channel) {
    if (blends(channel)) {
        const bool earlier = request(channel.at(channel.time.earlier)), later = request(channel.at(channel.time.later));
        return earlier && later;
    }
    Held& own = entry(channel);
    if (!own.volume.expired()) return true;
    if (own.coming.valid()) return isReady(own.coming);
    std::promise<SharedVolume> made;
    own.coming = made.get_future();
    own.reader = std::async(std::launch::async, [source = source_, channel, how = how_, stop = own.stop.get_token(),
                                                 made = std::move(made)]() mutable {
        if (!how.awaited) workInBackground();
        try {
            made.set_value(std::make_shared<const PacketVolume>(readPacketVolume(*source, channel, std::move(stop))));
        } catch (...) {
            made.set_exception(std::current_exception());
        }
        if (how.arrived) how.arrived();
    });
    return false;
}

PacketRenderer::PacketRenderer(std::optional<InstructionSet> with) : with_(with.value_or(instructionSets().back())) {}

void PacketRenderer::setSource(std::shared_ptr<const volume::BrickSource> source) {
    setVolumes(std::make_shared<PacketVolumes>(std::move(source)));
}

bool PacketRenderer::setVolumes(std::shared_ptr<PacketVolumes> volumes) {
    if (volumes == volumes_) return false;
    volumes_ = std::move(volumes);
    release();
    return true;
}

void PacketRenderer::release() {
    held_.clear();
    scene_.reset();
}

bool PacketRenderer::isPrepared(const Scene& scene) const {
    return scene_ && sameTables(scene, prepared_) && (mixes_ || !mixed_);
}

/// All samples that a scene needs.
std::vector<PacketChannel> PacketRenderer::channels(const Scene& scene) const {
    std::vector<PacketChannel> out = packetChannels(scene, source().info());
    for (PacketChannel& channel : out)
        channel.mixed = mixes_ && channel.time.between() && volume::isComputedBetween(source(), channel.channel);
    return out;
}

bool PacketRenderer::has(const Scene& scene) const {
    return isPrepared(scene) ||
           std::ranges::all_of(channels(scene), [&](const PacketChannel& channel) { return volumes_->has(channel); });
}

bool PacketRenderer::request(const Scene& scene) {
    return isPrepared(scene) || prefetch(scene);
}

bool PacketRenderer::prefetch(const Scene& scene) {
    bool all = true;
    for (const PacketChannel& channel : channels(scene)) all = volumes_->request(channel) && all;
    return all;
}

void PacketRenderer::prepare(const Scene& scene) {
    if (isPrepared(scene)) return;
    const volume::DatasetInfo& info = source().info();
    std::vector<SharedVolume> volumes;
    mixed_ = false;
    for (const PacketChannel& channel : channels(scene)) {
        volumes.push_back(volumes_->get(channel));
        mixed_ = mixed_ || channel.mixed;
    }
    held_ = volumes;
    scene_ = std::make_unique<PacketScene>(scene, info, std::move(volumes));
    prepared_ = scene;
}

void PacketRenderer::draw(const Scene& scene, int pass, int passes, double stepFactor, PacketPicture& picture,
                          const PacketGeometry& geometry) {
    const PixelBox& box = picture.box;
    const glm::ivec2 tiles = (box.extent() + kTile - 1) / kTile;
    std::vector<PixelBox> all;
    for (int y = 0; y < tiles.y; ++y)
        for (int x = 0; x < tiles.x; ++x) {
            const glm::ivec2 begin = box.begin + kTile * glm::ivec2(x, y);
            all.push_back({begin, glm::min(begin + kTile, box.end)});
        }
    draw(scene, pass, passes, stepFactor, picture, geometry, all);
}

void PacketRenderer::draw(const Scene& scene, int pass, int passes, double stepFactor, PacketPicture& picture,
                          const PacketGeometry& geometry, std::span<const PixelBox> only) {
    const PixelBox& box = picture.box;
    if (!scene_ || (scene_->empty() && geometry.peels == 0)) return;
    CastJob job = scene_->job(scene, source().info(), source().grid().lattice, picture.size, stepFactor, packedLight_);
    job.jitter = glm::vec2(pixelJitter(pass));
    job.pass = std::uint32_t(pass);
    job.share = 1 / float(passes);
    job.first = box.begin;
    job.rowLength = box.extent().x;
    job.picture = picture.rgba.data();
    job.pick = picture.pick.empty() || pass > 0 ? nullptr : picture.pick.data();
    job.peels = geometry.peels;
    job.pixels = std::size_t(box.extent().x) * std::size_t(box.extent().y);
    job.peelDistance = geometry.distance.data();
    job.peelColor = geometry.color.data();
    job.samples = counts_ ? &samples_ : nullptr;
    const auto cast = compiledFor(with_).castPixels;
    parallelFor(only.size(), [&](std::size_t i) {
        const glm::ivec2 begin = glm::max(only[i].begin, box.begin), end = glm::min(only[i].end, box.end);
        if (begin.x < end.x && begin.y < end.y) cast(job, begin, end);
    });
}

void PacketRenderer::setLight(const SceneLight& light) {
    if (light.maps == light_.maps && light.volume == light_.volume) return;
    light_ = light;
    packedLight_ = packLight(light);
}

void PacketRenderer::fillMedium(const Scene& scene, const LightGrid& grid, int begin, int end, Medium<float>& out) {
    if (!scene_) return;
    const CastJob job = scene_->job(scene, source().info(), source().grid().lattice, {1, 1}, 1, packedLight_);
    const auto fill = compiledFor(with_).fillRow;
    parallelFor(std::size_t(end - begin), [&](std::size_t i) {
        const int row = begin + int(i);
        fill(job, grid, row, out.data() + std::size_t(row) * std::size_t(grid.size.x));
    });
}

SceneLight PacketRenderer::lightOf(const Scene& scene, const CubeMap* surroundings) {
    const volume::DatasetInfo& info = source().info();
    SceneLight out;
    out.maps = illuminate(scene.lighting, scene.camera, surroundings).maps;
    if (!scene.lighting.shadows.any()) return out;
    const LightGrid grid = lightGrid(worldFrame(info, scene.stretch), scene.lighting.shadows);
    Medium<float> medium(grid.count());
    fillMedium(scene, grid, 0, grid.size.y * grid.size.z, medium);
    const Medium<float> meshes = meshMedium<float>(grid, meshCasters(scene, info));
    for (std::size_t i = 0; i < medium.size(); ++i) medium[i] += meshes[i];
    const std::vector<PlacedLight> lights = placeLights(scene.lighting, scene.camera);
    out.volume =
        std::make_shared<const LightVolume<float>>(spreadLight<float>(grid, medium, lights, scene.lighting.shadows));
    return out;
}

PacketPicture PacketRenderer::render(const Scene& scene, glm::ivec2 size, const CubeMap* surroundings) {
    PacketPicture picture;
    picture.begin(size, {{0, 0}, size}, false);
    prepare(scene);
    setLight(lightOf(scene, surroundings));
    const int passes = std::max(scene.render.samples, 1);
    for (int pass = 0; pass < passes; ++pass) draw(scene, pass, passes, 1, picture);
    return picture;
}

std::size_t PacketRenderer::bytes() const {
    std::size_t out = 0;
    for (std::size_t i = 0; i < held_.size(); ++i)
        if (std::find(held_.begin(), held_.begin() + std::ptrdiff_t(i), held_[i]) == held_.begin() + std::ptrdiff_t(i))
            out += held_[i]->bytes();
    return out;
}

} // namespace tessera::vis::packet
