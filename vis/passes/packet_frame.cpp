#include "vis/passes/packet_frame.h"

#include "vis/packet/packet_refusal.h"
#include "vis/passes/present.h"
#include "vis/passes/tiles.h"
#include "volume/base/error.h"
#include "volume/bricks/source_at_level.h"
#include "volume/field/time_pair.h"

#include <algorithm>

namespace tessera::vis {

namespace {

/// Whether the picture of coarse samples is as good as it becomes: whole at half resolution, if not at full at once.
bool showsCoarse(const ViewTarget& target, bool moving) {
    const PictureState& state = target.state;
    return target.packets.isCoarse && (state.full() || state.half() || (moving && state.reduced()));
}

/// Why OpenGL must cast the rays, in words for users; empty: the processor can.
std::string refusalOfPackets(const RendererState& shared, const ViewTarget& target, const RenderCall& call) {
    if (target.packets.failed) return "damaged samples";
    if (std::string why = packet::packetRefusal(call.scene, call.info(), call.grid().lattice); !why.empty()) return why;
    const double most =
        double(std::min(shared.options.memoryBudget, std::size_t(call.scene.render.limits.brickMemory) << 20));
    return packet::packetBytes(call.scene, call.info(), call.grid().lattice) > most
               ? "data larger than the memory for bricks"
               : "";
}

/// Lets the view be drawn from coarse samples, or from all.
void useSamples(ViewTarget& target, bool coarse) {
    if (target.packets.isCoarse == coarse) return;
    target.packets.isCoarse = coarse;
    ++target.packets.revision;
    target.redraw(target.buffers.everything());
}

/// Chooses the samples that a call is drawn from, coarse ones until all are read; false if neither are there yet.
bool findSamples(RendererState& shared, ViewTarget& target, const RenderCall& call) {
    PacketView& packets = target.packets;
    for (packet::PacketRenderer* renderer : {&packets.full, &packets.coarse})
        renderer->setMixes(call.request.moving && !call.request.wait);
    bool all = call.request.wait || packets.full.has(call.scene), some = false;
    if (!all) {
        if (shared.coarseVolumes) some = packets.coarse.request(call.scene);
        // Reading all of large data leaves little to others, so their picture is drawn first; and who drags through
        // time must not start more reading than memory can hold.
        const bool drawn = some && showsCoarse(target, call.request.moving);
        if (!shared.coarseVolumes || (drawn && !shared.volumes->reading())) all = packets.full.request(call.scene);
    }
    if (all || some) useSamples(target, !all);
    return all || some;
}

/// Whoever drags time sees both stored times mixed; at rest what is computed between them replaces that.
void prepareSamples(ViewTarget& target, const RenderCall& call) {
    packet::PacketRenderer& renderer = target.packets.renderer();
    const bool mixed = renderer.mixed();
    renderer.prepare(call.scene);
    if (!mixed || renderer.mixed()) return;
    ++target.packets.revision;
    target.redraw(target.buffers.everything());
}

/// While an animation runs, the samples of the next stored time are read in the background.
void prefetchTime(PacketView& packets, const RenderCall& call) {
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

void refineByPackets(RendererState& shared, ViewTarget& target, const RenderCall& call, Clock::time_point start) {
    const PictureState& state = target.state;
    const bool moving = call.request.moving;
    if (state.full() ? state.converged() || moving : state.reduced() && moving) return;
    if (!call.request.wait && !presentable(shared, target, call.scene)) return postpone(shared, target, call.scene);
    sayLimits(shared, call, {});
    packet::PacketRenderer& renderer = target.packets.renderer();
    const LightBaker::Rows rows = [&](const LightGrid& grid, int begin, int end, Medium<float>& out) {
        renderer.fillMedium(call.scene, grid, begin, end, out);
    };
    const LightBaker::Medium medium{target.packets.revision, call.scene.time, true};
    const ViewLight::Progress light = target.light.bind(shared.tools, call, medium, rows);
    if (light.changed) target.redraw(target.buffers.everything());
    renderer.setLight(target.light.bound(call.scene.lighting));
    const RayPrograms programs{.packets = &target.packets,
                               .geometry = call.plan.peels > 0 ? &target.geometry.buffer() : nullptr,
                               .beyondPlan = {},
                               .beyondScene = {}};
    drawWithin(shared, target, call, programs, start, light.done);
}

} // namespace

void makePacketVolumes(RendererState& shared) {
    constexpr double kSoonRead = double(1 << 21), kCoarse = double(1 << 20); // samples of a channel
    shared.volumes = shared.coarseVolumes = nullptr;
    if (!shared.source) return;
    const bool soon = double(shared.source->grid().lattice.count()) <= kSoonRead;
    const int level = soon ? 0 : shared.source->grid().levelWithin(kCoarse);
    packet::PacketReading how{.awaited = true, .arrived = shared.options.arrived};
    if (level > 0)
        shared.coarseVolumes =
            std::make_shared<packet::PacketVolumes>(volume::sourceAtLevel(shared.source, level), how);
    how.awaited = !shared.coarseVolumes;
    shared.volumes = std::make_shared<packet::PacketVolumes>(shared.source, how);
}

bool chooseEngine(RendererState& shared, ViewTarget& target, const RenderCall& call, FrameStatus& status) {
    const Engine asked = call.scene.render.engine;
    const bool wanted =
        asked == Engine::Processor || (asked == Engine::Automatic && shared.options.packets == Packets::Always);
    PacketView& packets = target.packets;
    packets.coarse.setVolumes(shared.coarseVolumes);
    if (packets.full.setVolumes(shared.volumes)) {
        packets.failed = packets.isCoarse = false;
        ++packets.revision;
    }
    const std::size_t limit =
        std::min(shared.options.memoryBudget, std::size_t(call.scene.render.limits.brickMemory) << 20);
    const std::size_t kept = wanted || target.meanwhile ? limit / 2 : 0;
    shared.volumes->keep(kept);
    if (shared.coarseVolumes) shared.coarseVolumes->keep(kept / 8);
    const bool rays = !call.plan.layers.empty(); // slices and meshes alone are quickly drawn
    const bool possible = wanted && rays && !shared.options.countSamples;
    EngineUse& use = status.engine;
    if (possible) use.refusal = refusalOfPackets(shared, target, call);
    if (asked == Engine::Automatic && call.info().remote && use.refusal.empty())
        use.refusal = "data on another machine as they come";
    target.byProcessor = use.byProcessor = possible && use.refusal.empty();
    if (use.byProcessor) use.instructions = packet::kInstructionSetNames[std::size_t(packets.full.instructions())];
    return use.byProcessor;
}

bool drawByPackets(RendererState& shared, ViewTarget& target, const RenderCall& call, Clock::time_point start,
                   FrameStatus& status) {
    PacketView& packets = target.packets;
    try {
        const bool here = findSamples(shared, target, call);
        if (here) prepareSamples(target, call);
        showScene(shared, target, call.scene, 0);
        target.shown.compiling = false;
        status.complete = here && !packets.isCoarse;
        if (here) {
            if (!showsCoarse(target, call.request.moving)) refineByPackets(shared, target, call, start);
            status.waits = showsCoarse(target, call.request.moving);
            if (!call.request.wait && !packets.isCoarse) prefetchTime(packets, call);
        } else {
            status.waits = true;
            postpone(shared, target, call.scene);
        }
    } catch (const Error& error) {
        shared.tools.messages.push_back(error.what());
        packets.failed = true;
        target.byProcessor = false;
        status.engine = {.byProcessor = false, .refusal = refusalOfPackets(shared, target, call)};
        return false;
    }
    const packet::PacketRenderer& renderer = packets.renderer();
    status.samples = renderer.volumes() * renderer.source().grid().lattice.count();
    status.bytes = renderer.bytes();
    if (packets.isCoarse) status.bricksMissing = int(call.grid().brickCount());
    return true;
}

bool drawWhileCompiling(RendererState& shared, ViewTarget& target, const RenderCall& call, Clock::time_point start) {
    std::optional<Clock::time_point>& since = target.shown.compilingSince;
    if (!since) since = start;
    const bool may = shared.options.packets == Packets::WhileCompiling &&
                     call.scene.render.engine == Engine::Automatic && !shared.options.countSamples &&
                     !call.info().remote;
    if (!may || millisecondsSince(*since) < shared.options.patience || !refusalOfPackets(shared, target, call).empty())
        return false;
    // It draws too briefly to read all samples of large data.
    packet::PacketRenderer& renderer = shared.coarseVolumes ? target.packets.coarse : target.packets.full;
    try {
        if (!renderer.request(call.scene)) return false;
        renderer.prepare(call.scene);
        useSamples(target, shared.coarseVolumes != nullptr);
        if (!target.meanwhile) target.redraw(target.buffers.everything());
        target.meanwhile = target.byProcessor = true;
        refineByPackets(shared, target, call, start);
        return true;
    } catch (const Error&) { // OpenGL says what is damaged
        target.packets.failed = true;
        target.meanwhile = target.byProcessor = false;
        return false;
    }
}

void handOverToGl(RendererState& shared, ViewTarget& target) {
    target.shown.compilingSince.reset();
    if (!target.meanwhile) return;
    target.meanwhile = false;
    target.packets.release();
    target.shown.resident = shared.residency.revision();
    target.redraw(target.buffers.everything());
}

} // namespace tessera::vis
