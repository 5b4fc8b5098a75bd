#include "vis/passes/ray_pass.h"

#include "vis/demand/lens_pixels.h"
#include "vis/optics/jitter.h"
#include "vis/raycast/lens_uniforms.h"
#include "vis/raycast/ray_uniforms.h"
#include "vis/shapes/proxy.h"
#include "volume/base/error.h"

#include <algorithm>
#include <span>

namespace tessera::vis {

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

/// Blends the proxy surfaces front to back into the cleared part of the buffer inside the scissor rectangle.
void proxies(const Program& program, const RenderCall& call, const RayBuffer& buffer, double stepFactor) {
    const ProxySurfaces surfaces = proxySurfaces(call.scene, call.grid().lattice, call.frame(), stepFactor);
    program.set("proxyShells", surfaces.shells ? 1 : 0);
    program.set("proxyNormal", glm::vec3(surfaces.normal));
    program.set("proxyFirst", float(surfaces.first));
    program.set("proxySpacing", float(surfaces.spacing));
    const float unknown[] = {1e9f, 0, 0, 0};
    glClearNamedFramebufferfv(buffer.framebuffer.name(), GL_COLOR, 1, unknown);
    glUseProgram(program.name());
    glEnable(GL_BLEND);
    glBlendFunci(0, GL_ONE_MINUS_DST_ALPHA, GL_ONE);
    glBlendEquationi(1, GL_MIN); // keep the nearest noticeable surface
    glDrawArraysInstanced(GL_TRIANGLES, 0, 3, surfaces.count);
    glBlendEquation(GL_FUNC_ADD);
    glDisable(GL_BLEND);
}

/// Begins the picture of packets with a tile, and what was rasterised there.
void beginPackets(const RayPrograms& programs, const RayBuffer& buffer, const RayTile& what) {
    PacketView& packets = *programs.packets;
    packets.picture.begin(what.size, {what.tile.begin, what.tile.end}, what.pass == 0);
    packets.geometry.peels = 0;
    if (programs.geometry)
        readGeometry(*programs.geometry, buffer.first + what.tile.begin, what.tile.end - what.tile.begin,
                     packets.geometry);
}

/// Draws a tile with the rays of one pass; replaces all but termination depths, which rays of the processor have not.
void castPackets(const RayPrograms& programs, const RenderCall& call, const RayBuffer& buffer, const RayTile& what) {
    PacketView& packets = *programs.packets;
    beginPackets(programs, buffer, what);
    packets.renderer().draw(call.scene, what.pass, 1, what.stepFactor, packets.picture, packets.geometry);
    storePackets(packets.picture, buffer);
}

/// The pixels of the box in a picture of `size` pixels: rays are cast for these only.
Tile seenPixels(const RenderCall& call, glm::ivec2 size) {
    const glm::ivec4 box = boxPixels(call.scene.camera, call.frame().halfSize, size);
    return {{box.x, box.y}, {box.z, box.w}};
}

} // namespace

void storePackets(const packet::PacketPicture& picture, const RayBuffer& buffer) {
    const glm::ivec2 at = buffer.first + picture.box.begin, extent = picture.box.extent();
    const auto store = [&](const Texture& texture, GLenum parts, const std::vector<float>& values) {
        glTextureSubImage2D(texture.name(), 0, at.x, at.y, extent.x, extent.y, parts, GL_FLOAT, values.data());
    };
    store(buffer.color, GL_RGBA, picture.rgba);
    if (!picture.pick.empty()) store(buffer.pick, GL_RED, picture.pick);
}

void castBoxes(const RayPrograms& programs, const RenderCall& call, const RayBuffer& buffer, const RayTile& what,
               std::span<const packet::PixelBox> boxes) {
    PacketView& packets = *programs.packets;
    RayTile seen = what;
    seen.tile = intersection(what.tile, seenPixels(call, what.size));
    if (seen.tile.empty()) return packets.picture.begin(what.size, {}, false);
    beginPackets(programs, buffer, seen);
    packets.renderer().draw(call.scene, what.pass, 1, what.stepFactor, packets.picture, packets.geometry, boxes);
}

ProgramRecipe rayVariant(const RendererState& shared, const ViewTarget& target, const Scene& scene,
                         const RayPlan& plan) {
    const TablesContent& tables = target.tables.content();
    ProgramRecipe made = rayRecipe(plan, scene, shared.source->grid(), tables.skip && !lensesBend(scene));
    addDriver(made, shared.tools.driver);
    if (shared.options.countSamples) made.defines.emplace_back("COUNT_SAMPLES", "1");
    if (tables.adaptive && made.slots["skip"] == "slots/skip_distance.glsl") made.defines.emplace_back("ADAPTIVE", "1");
    if (findsHidden(shared, scene)) made.defines.emplace_back("REACH", "1");
    return made;
}

void rasteriseGeometry(RendererState& shared, ViewTarget& target, const RenderCall& call, const RayBuffer& rays,
                       const Tile& tile, int pass) {
    const int peels = peelsOf(call.scene);
    if (peels == 0) return;
    const glm::ivec2 whole = target.buffers.size, size = rays.used;
    GeometryBuffer& buffer = target.geometry.buffer();
    if (!target.geometry.shows(size, tile, pass)) {
        buffer.resize(whole, peels);
        shared.tools.geometryPass.draw(buffer,
                                       {.scene = call.scene,
                                        .info = call.info(),
                                        .lenses = call.plan.lenses,
                                        .size = size,
                                        .first = rays.first,
                                        .tile = tile,
                                        .pictureSize = whole,
                                        .most = &rays == &target.buffers.reduced ? std::min(peels, 2) : peels,
                                        .lightUnit = rayUnits(call.plan).light,
                                        .jitter = pixelJitter(pass)},
                                       shared.tools.grain);
        target.geometry.setShown(size, tile, pass);
    }
    glBindTextureUnit(GLuint(RayUnits::kGeometry), buffer.color.name());
    glBindTextureUnit(GLuint(RayUnits::kGeometry) + 1, buffer.distance.name());
}

void castRays(RendererState& shared, const RayPrograms& programs, const RenderCall& call, RayBuffer& buffer,
              const RayTile& what) {
    const Scene& scene = call.scene;
    const glm::ivec2 size = what.size;
    const Tile& tile = what.tile;
    const float nothing[] = {0, 0, 0, 0}, nowhere[] = {-1e9f, 0, 0, 0}, unseen[] = {0, 0, 0, 0};
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, buffer.framebuffer.name());
    glViewport(buffer.first.x, buffer.first.y, size.x, size.y);
    glEnable(GL_SCISSOR_TEST);
    const auto texels = [&](const Tile& of) { return Tile{buffer.first + of.begin, buffer.first + of.end}; };
    const auto within = [&](glm::ivec2 from, glm::ivec2 to) {
        glScissor(buffer.first.x + from.x, buffer.first.y + from.y, to.x - from.x, to.y - from.y);
    };
    const auto clear = [&](const Tile& part) {
        within(part.begin, part.end);
        glClearNamedFramebufferfv(buffer.framebuffer.name(), GL_COLOR, 0, nothing);
        glClearNamedFramebufferfv(buffer.framebuffer.name(), GL_COLOR, 1, nowhere);
    };
    // A clear of the framebuffer before pixels beside it are written as texels is lost by some drivers (zink of
    // Mesa 22.3).
    const auto forget = [&](const Tile& part) {
        const glm::ivec2 extent = part.end - part.begin;
        glClearTexSubImage(buffer.color.name(), 0, part.begin.x, part.begin.y, 0, extent.x, extent.y, 1, GL_RGBA,
                           GL_FLOAT, nothing);
        glClearTexSubImage(buffer.pick.name(), 0, part.begin.x, part.begin.y, 0, extent.x, extent.y, 1, GL_RG, GL_FLOAT,
                           nowhere);
    };
    const Tile seen = intersection(tile, seenPixels(call, size));
    const Tile held{buffer.drawn.begin - buffer.first, buffer.drawn.end - buffer.first};
    buffer.drew(texels(tile), seen.empty() ? Tile{} : texels(seen));
    if (programs.packets) { // these replace what is there, and find no termination depths
        for (const Tile& beside : remainder(tile, std::span(&seen, seen.empty() ? 0 : 1)))
            if (const Tile full = intersection(beside, held); !full.empty()) forget(texels(full));
        if (!seen.empty()) castPackets(programs, call, buffer, {size, seen, nullptr, what.stepFactor, what.pass});
        return;
    }
    clear(tile);
    glClearNamedFramebufferfv(buffer.framebuffer.name(), GL_COLOR, 2, unseen);
    if (seen.empty()) return;
    within(seen.begin, seen.end);
    const std::vector<Tile> whole{seen};
    glBindVertexArray(shared.tools.vertices.name());
    const auto prepare = [&](const Program& program) {
        program.set("ndcScale", 2.0f / glm::vec2(size));
        program.set("ndcOffset",
                    glm::vec2((pixelJitter(what.pass) - glm::dvec2(buffer.first)) * 2.0 / glm::dvec2(size) - 1.0));
        program.set("passNumber", what.pass);
        glUseProgram(program.name());
    };
    prepare(*programs.program);
    if (drawnByProxy(scene)) return proxies(*programs.program, call, buffer, what.stepFactor);
    const auto draw = [&](std::span<const Tile> where) {
        for (const Tile& part : what.parts ? *what.parts : whole)
            for (const Tile& each : where) {
                const Tile drawn = intersection(whole.front(), intersection(part, each));
                if (drawn.empty()) continue;
                within(drawn.begin, drawn.end);
                glDrawArrays(GL_TRIANGLES, 0, 3);
            }
    };
    const std::optional<std::vector<Tile>> lensed =
        programs.beyond ? lensTiles(call.plan.lenses, scene, size) : std::nullopt;
    if (!lensed) return draw(whole);
    draw(*lensed);
    prepare(*programs.beyond);
    draw(remainder(whole.front(), *lensed));
}

void accumulate(RendererState& shared, ViewTarget& target, const RenderCall& call, const RayPrograms& programs,
                const RayTile& what) {
    const Tile& tile = what.tile;
    RayBuffer& beside = target.buffers.reduced;
    const Program* average = shared.tools.programs.find({"screen.vert.glsl", "accumulate.frag.glsl", {}, {}});
    if (!average) throw Error("the shader that averages passes does not compile");
    target.state.dropReduced();
    beside.first = {0, 0};
    castRays(shared, programs, call, beside, what);
    average->set("source", 0);
    average->set("sourceTermination", 1);
    glBindTextureUnit(0, beside.color.name());
    glBindTextureUnit(1, beside.termination.name());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.buffers.full.framebuffer.name());
    glScissor(tile.begin.x, tile.begin.y, tile.end.x - tile.begin.x, tile.end.y - tile.begin.y);
    glUseProgram(average->name());
    glBindVertexArray(shared.tools.vertices.name()); // no ray was drawn for a tile outside the box
    glEnablei(GL_BLEND, 0);
    glBlendColor(0, 0, 0, 1 / float(what.pass + 1));
    glBlendFunc(GL_CONSTANT_ALPHA, GL_ONE_MINUS_CONSTANT_ALPHA);
    glColorMaski(1, GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glEnablei(GL_BLEND, 2); // keep the largest termination depth of all passes
    glBlendEquationi(2, GL_MAX);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBlendEquationi(2, GL_FUNC_ADD);
    glDisablei(GL_BLEND, 2);
    glDisablei(GL_BLEND, 0);
    glColorMaski(1, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

} // namespace tessera::vis
