#include "vis/passes/render_stages.h"

#include "vis/packet/packet_refusal.h"
#include "volume/base/error.h"
#include "volume/bricks/source_at_level.h"
#include "volume/field/time_pair.h"

#include <algorithm>

/// Pictures whose rays the processor casts: the same buffers, tiles and passes as those of OpenGL, which presents them.
namespace tessera::vis {

/// Makes what views share of the source's samples.
void RenderStages::setVolumes() {
    constexpr double kSoonRead = double(1 << 21), kCoarse = double(1 << 20); // samples of a channel
    volumes = coarseVolumes = nullptr;
    if (!source) return;
    const bool soon = double(source->grid().lattice.count()) <= kSoonRead;
    const int level = soon ? 0 : source->grid().levelWithin(kCoarse);
    packet::PacketReading how{.awaited = true, .arrived = options.arrived};
    if (level > 0) coarseVolumes = std::make_shared<packet::PacketVolumes>(volume::sourceAtLevel(source, level), how);
    how.awaited = !coarseVolumes;
    volumes = std::make_shared<packet::PacketVolumes>(source, how);
}

/// Why OpenGL must cast the rays, in words for users; empty: the processor can.
std::string RenderStages::refusalOfPackets(const ViewTarget& target, const RenderCall& call) const {
    if (target.packets.failed) return "damaged samples";
    if (std::string why = packet::packetRefusal(call.scene, call.info(), call.grid().lattice); !why.empty()) return why;
    const double most = double(std::min(options.memoryBudget, std::size_t(call.scene.render.limits.brickMemory) << 20));
    return packet::packetBytes(call.scene, call.info(), call.grid().lattice) > most
               ? "data larger than the memory for bricks"
               : "";
}

/// Whether the processor casts the rays of a call.
bool RenderStages::chooseEngine(ViewTarget& target, const RenderCall& call, FrameStatus& status) {
    const Engine asked = call.scene.render.engine;
    const bool wanted =
        asked == Engine::Processor || (asked == Engine::Automatic && options.packets == Packets::Always);
    PacketView& packets = target.packets;
    packets.coarse.setVolumes(coarseVolumes);
    if (packets.full.setVolumes(volumes)) {
        packets.failed = packets.isCoarse = false;
        packets.lackingSince.reset();
        ++packets.revision;
    }
    const std::size_t limit = std::min(options.memoryBudget, std::size_t(call.scene.render.limits.brickMemory) << 20);
    const std::size_t kept = wanted || target.meanwhile ? limit / 2 : 0;
    volumes->keep(kept);
    if (coarseVolumes) coarseVolumes->keep(kept / 8);
    const bool rays = !call.plan.layers.empty(); // slices and meshes alone are quickly drawn
    const bool possible = wanted && rays && !options.countSamples;
    EngineUse& use = status.engine;
    if (possible) use.refusal = refusalOfPackets(target, call);
    if (asked == Engine::Automatic && call.info().remote && use.refusal.empty())
        use.refusal = "data on another machine as they come";
    target.byProcessor = use.byProcessor = possible && use.refusal.empty();
    if (use.byProcessor) use.instructions = packet::kInstructionSetNames[std::size_t(packets.full.instructions())];
    return use.byProcessor;
}

/// Lets the view be drawn from coarse samples, or from all.
void RenderStages::useSamples(ViewTarget& target, bool coarse) {
    if (target.packets.isCoarse == coarse) return;
    target.packets.isCoarse = coarse;
    ++target.packets.revision;
    target.redraw(target.buffers.everything());
}

namespace {

/// Whether the picture of coarse samples is as good as it becomes: whole at half resolution, if not at full at once.
bool showsCoarse(const ViewTarget& target, bool moving) {
    const PictureState& state = target.state;
    return target.packets.isCoarse && (state.full() || state.half() || (moving && state.reduced()));
}

} // namespace

/// Chooses the samples that a call is drawn from, coarse ones until all are read; false if neither are there yet.
bool RenderStages::findSamples(ViewTarget& target, const RenderCall& call) {
    PacketView& packets = target.packets;
    bool all = call.request.wait || packets.full.has(call.scene), some = false;
    if (!all) {
        if (!packets.lackingSince) packets.lackingSince = Clock::now();
        const bool brief = target.state.presented() && !call.request.moving &&
                           millisecondsSince(*packets.lackingSince) < options.patience;
        if (coarseVolumes && !brief) some = packets.coarse.request(call.scene);
        // Reading all of large data leaves little to others, so their picture is drawn first; and who drags through
        // time must not start more reading than memory can hold.
        const bool drawn = some && showsCoarse(target, call.request.moving);
        if (!coarseVolumes || ((drawn || brief) && !volumes->reading())) all = packets.full.request(call.scene);
    }
    if (all) packets.lackingSince.reset();
    if (all || some) useSamples(target, !all);
    return all || some;
}

/// Draws a call, or keeps the former picture while its samples are being read; false if they cannot be read.
bool RenderStages::drawByPackets(ViewTarget& target, const RenderCall& call, Clock::time_point start,
                                 FrameStatus& status) {
    PacketView& packets = target.packets;
    try {
        const bool here = findSamples(target, call);
        if (here) packets.renderer().prepare(call.scene);
        show(target, call.scene, 0);
        target.shown.compiling = false;
        status.complete = here && !packets.isCoarse;
        if (here) {
            if (!showsCoarse(target, call.request.moving)) refineByPackets(target, call, start);
            status.waits = showsCoarse(target, call.request.moving);
            if (!call.request.wait && !packets.isCoarse) prefetchTime(packets, call);
        } else {
            status.waits = true;
            postpone(target, call.scene);
        }
    } catch (const Error& error) {
        tools.messages.push_back(error.what());
        packets.failed = true;
        target.byProcessor = false;
        status.engine = {.byProcessor = false, .refusal = refusalOfPackets(target, call)};
        return false;
    }
    const packet::PacketRenderer& renderer = packets.renderer();
    status.samples = renderer.volumes() * renderer.source().grid().lattice.count();
    status.bytes = renderer.bytes();
    if (packets.isCoarse) status.bricksMissing = int(call.grid().brickCount());
    return true;
}

/// Draws a call whose program is being compiled, where the processor may and can and its samples are here; false if
/// not.
bool RenderStages::drawMeanwhile(ViewTarget& target, const RenderCall& call, Clock::time_point start) {
    std::optional<Clock::time_point>& since = target.shown.compilingSince;
    if (!since) since = start;
    const bool may = options.packets == Packets::WhileCompiling && call.scene.render.engine == Engine::Automatic &&
                     !options.countSamples && !call.info().remote;
    if (!may || millisecondsSince(*since) < options.patience || !refusalOfPackets(target, call).empty()) return false;
    // It draws too briefly to read all samples of large data.
    packet::PacketRenderer& renderer = coarseVolumes ? target.packets.coarse : target.packets.full;
    try {
        if (!renderer.request(call.scene)) return false;
        renderer.prepare(call.scene);
        useSamples(target, coarseVolumes != nullptr);
        if (!target.meanwhile) target.redraw(target.buffers.everything());
        target.meanwhile = target.byProcessor = true;
        refineByPackets(target, call, start);
        return true;
    } catch (const Error&) { // OpenGL says what is damaged
        target.packets.failed = true;
        target.meanwhile = target.byProcessor = false;
        return false;
    }
}

/// OpenGL draws what the processor began, in tiles of its own.
void RenderStages::endMeanwhile(ViewTarget& target) {
    target.shown.compilingSince.reset();
    if (!target.meanwhile) return;
    target.meanwhile = false;
    target.packets.release();
    target.shown.resident = residency.revision();
    target.redraw(target.buffers.everything());
}

/// While an animation runs, the samples of the next stored time are read in the background.
void RenderStages::prefetchTime(PacketView& packets, const RenderCall& call) {
    const std::vector<double>& times = call.info().times;
    const volume::TimePair around = volume::timesAround(times, call.scene.time);
    const int now = around.earlier;
    if (now != packets.time) packets.step = packets.time < 0 ? 0 : now - packets.time;
    packets.time = now;
    const int next = (packets.step > 0 ? around.later : now) + packets.step;
    if (packets.step == 0 || next < 0 || next >= int(times.size())) return;
    Scene coming = call.scene;
    coming.time = times[std::size_t(next)];
    packets.full.prefetch(coming);
}

void RenderStages::refineByPackets(ViewTarget& target, const RenderCall& call, Clock::time_point start) {
    const PictureState& state = target.state;
    const bool moving = call.request.moving;
    if (state.full() ? state.converged() || moving : state.reduced() && moving) return;
    if (!call.request.wait && !presentable(target, call.scene)) return postpone(target, call.scene);
    sayLimits(call, {});
    packet::PacketRenderer& renderer = target.packets.renderer();
    const LightBaker::Rows rows = [&](const LightGrid& grid, int begin, int end, Medium<float>& out) {
        renderer.fillMedium(call.scene, grid, begin, end, out);
    };
    const LightBaker::Medium medium{target.packets.revision, call.scene.time, true};
    const ViewLight::Progress light = target.light.bind(tools, call, medium, rows);
    if (light.changed) target.redraw(target.buffers.everything());
    renderer.setLight(target.light.bound(call.scene.lighting));
    const RayPrograms programs{.packets = &target.packets,
                               .geometry = call.plan.peels > 0 ? &target.geometry.buffer() : nullptr,
                               .beyondPlan = {},
                               .beyondScene = {}};
    drawWithin(target, call, programs, start, light.done);
}

namespace {

/// Reads rasterised surfaces back, `extent` texels from `first` on.
void readGeometry(const GeometryBuffer& buffer, glm::ivec2 first, glm::ivec2 extent, packet::PacketGeometry& out) {
    out.peels = buffer.peels;
    const std::size_t texels = std::size_t(extent.x) * std::size_t(extent.y) * std::size_t(out.peels);
    out.distance.resize(texels * 2);
    out.color.resize(texels * 4);
    const auto read = [&](const Texture& texture, GLenum parts, std::vector<float>& to) {
        glGetTextureSubImage(texture.name(), 0, first.x, first.y, 0, extent.x, extent.y, out.peels, parts, GL_FLOAT,
                             GLsizei(to.size() * sizeof(float)), to.data());
    };
    read(buffer.distance, GL_RG, out.distance);
    read(buffer.color, GL_RGBA, out.color);
}

} // namespace

/// Draws a tile with the rays of one pass; replaces all but termination depths, which rays of the processor have not.
void RenderStages::castPackets(const RayPrograms& programs, const RenderCall& call, const RayBuffer& buffer,
                               const RayTile& what) {
    PacketView& packets = *programs.packets;
    const Tile& tile = what.tile;
    const glm::ivec2 at = buffer.first + tile.begin, extent = tile.end - tile.begin;
    packet::PacketPicture& picture = packets.picture;
    picture.begin(what.size, {tile.begin, tile.end}, what.pass == 0);
    packets.geometry.peels = 0;
    if (programs.geometry) readGeometry(*programs.geometry, at, extent, packets.geometry);
    packets.renderer().draw(call.scene, what.pass, 1, what.stepFactor, picture, packets.geometry);
    const auto store = [&](const Texture& texture, GLenum parts, const std::vector<float>& values) {
        glTextureSubImage2D(texture.name(), 0, at.x, at.y, extent.x, extent.y, parts, GL_FLOAT, values.data());
    };
    store(buffer.color, GL_RGBA, picture.rgba);
    if (!picture.pick.empty()) store(buffer.pick, GL_RED, picture.pick);
}

} // namespace tessera::vis
