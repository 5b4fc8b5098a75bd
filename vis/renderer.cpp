#include "vis/renderer.h"

#include "vis/gl/residency.h"
#include "vis/gl/view_target.h"
#include "vis/technique/box_lines.h"
#include "vis/technique/ray_plan.h"
#include "volume/error.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace tessera::vis {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kUploadPerFrame = std::size_t(24) << 20;
constexpr std::size_t kSmallTexels = std::size_t(1) << 20; ///< channels up to here need no coarse picture first
constexpr double kSkipOccupancy = 0.7;                     ///< above, leaping costs more than it saves

double millisecondsSince(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// What drawing needs and leaves as it was.
struct SavedState {
    GLint framebuffer = 0, viewport[4] = {0, 0, 0, 0};
    SavedState() {
        glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &framebuffer);
        glGetIntegerv(GL_VIEWPORT, viewport);
        for (GLenum capability : {GL_BLEND, GL_DEPTH_TEST, GL_CULL_FACE, GL_SCISSOR_TEST, GL_STENCIL_TEST})
            glDisable(capability);
        glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    }
    ~SavedState() {
        glDisable(GL_SCISSOR_TEST);
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(framebuffer));
        glViewport(viewport[0], viewport[1], viewport[2], viewport[3]);
        glUseProgram(0);
        glBindVertexArray(0);
        glActiveTexture(GL_TEXTURE0);
    }
};

/// Pixels [begin, end) of a picture.
struct Tile {
    glm::ivec2 begin, end;
};

std::vector<Tile> tilesOf(glm::ivec2 size, int edge) {
    std::vector<Tile> tiles;
    for (int y = 0; y < size.y; y += edge)
        for (int x = 0; x < size.x; x += edge) tiles.push_back({{x, y}, glm::min(glm::ivec2(x, y) + edge, size)});
    return tiles;
}

} // namespace

struct Renderer::Impl {
    RendererOptions options;
    Residency residency;
    std::shared_ptr<const volume::BrickSource> source;
    VertexArray vertices = makeVertexArray("no vertices");
    std::map<std::string, Program> programs; ///< by recipe; an empty one did not compile
    std::set<GLuint> warm;                   ///< programs that have drawn
    std::vector<std::string> messages;
    Program resolve;

    explicit Impl(const RendererOptions& given) : options(given), residency(given) {}

    const Program* program(const ProgramRecipe& recipe);
    bool bind(ViewTarget& target, const Scene& scene, const FrameRequest& request, RayPlan& plan, FrameStatus& status);
    const Program* prepare(ViewTarget& target, const Scene& scene, const RayPlan& plan);
    void rays(const Program& program, const Scene& scene, const RayBuffer& buffer, glm::ivec2 size, const Tile& tile);
    void present(ViewTarget& target, const Scene& scene, bool reduced, const Tile& tile);
    void nothing(ViewTarget& target, const Scene& scene);
    void refine(ViewTarget& target, const Scene& scene, const FrameRequest& request, const RayPlan& plan,
                Clock::time_point start);
};

const Program* Renderer::Impl::program(const ProgramRecipe& recipe) {
    const std::string key = recipe.key();
    auto found = programs.find(key);
    if (found == programs.end()) {
        Program made;
        try {
            made = makeProgram(recipe);
        } catch (const Error& error) {
            messages.push_back(error.what());
        }
        found = programs.emplace(key, std::move(made)).first;
    }
    return found->second ? &found->second : nullptr;
}

/// Asks for what the plan samples and binds what is here; false when nothing of it is here yet.
bool Renderer::Impl::bind(ViewTarget& target, const Scene& scene, const FrameRequest& request, RayPlan& plan,
                          FrameStatus& status) {
    const volume::DatasetInfo& info = source->info();
    const bool prefiltered = scene.render.filter == Filter::AverageQuasi;
    const int wantedTime = info.nearestTime(scene.time);
    const auto keyOf = [&](const BoundField& field, int time) {
        return ChannelKey{field.channel, time, prefiltered && !field.categorical};
    };
    const volume::Lattice& lattice = source->grid().lattice;
    const WorldFrame frame = worldFrame(info.bounds, scene.stretch);
    const glm::dvec3 eye = lattice.toCells(frame.toPhysical(cameraRay(scene.camera, 1, {0, 0}).origin));
    const glm::ivec3 texels = lattice.texels();
    const bool large = std::size_t(texels.x) * std::size_t(texels.y) * std::size_t(texels.z) > kSmallTexels;
    for (std::size_t i = 0; i < plan.fields.size(); ++i)
        residency.want(keyOf(plan.fields[i], wantedTime), double(i), large && !request.wait, eye);
    if (request.wait) residency.finish();

    // All channels of one picture show one time: the wanted one if each has something there, else the former one.
    const auto here = [&](int time) {
        return std::all_of(plan.fields.begin(), plan.fields.end(), [&](const BoundField& field) {
            const ChannelKey key = keyOf(field, time);
            return residency.find(key) || residency.settled(key); // or it will never come
        });
    };
    int time = wantedTime;
    if (!here(time) && target.lastTime >= 0 && target.lastTime < int(info.times.size()) && here(target.lastTime)) {
        time = target.lastTime;
        for (const BoundField& field : plan.fields) residency.keep(keyOf(field, time));
    }
    bool any = false, settled = true;
    for (BoundField& field : plan.fields) {
        const ChannelKey wanted = keyOf(field, wantedTime);
        settled = settled && residency.settled(wanted);
        status.bricksMissing += residency.missing(wanted);
        const ChannelTexture* texture = residency.find(keyOf(field, time));
        if (!texture) texture = &residency.nothing();
        any = any || texture != &residency.nothing();
        field.texture = texture->texture.name();
        field.level = texture->level;
        field.encoding = texture->encoding;
        field.textureSize = texture->size;
        field.blocks = &texture->blocks;
        field.pages = texture->pages && texture->atlas ? texture->pages->texture.name() : 0;
        field.atlas = field.pages ? texture->atlas->texture() : 0;
        if (field.atlas) field.atlasSize = texture->atlas->size();
        field.everyBrick = texture->bricksMissing == 0;
    }
    if (any) target.lastTime = time;
    status.complete = settled;
    return any;
}

/// Program, tables and uniforms of a bound plan. Null when the program does not compile.
const Program* Renderer::Impl::prepare(ViewTarget& target, const Scene& scene, const RayPlan& plan) {
    // Tables depend on these alone; a camera that moves keeps them.
    if (target.tablesFor && target.tablesRevision == residency.revision() && target.tablesFor->layers == scene.layers &&
        target.tablesFor->transfer == scene.transfer && target.tablesFor->render.filter == scene.render.filter &&
        target.tablesTime == target.lastTime)
        return program(rayRecipe(plan, scene, source->grid(), target.skip));
    target.tablesFor = scene;
    target.tablesRevision = residency.revision();
    target.tablesTime = target.lastTime;

    const std::optional<BlockDistances> blocks = blockDistances(plan, scene, source->info());
    target.skip = blocks && blocks->occupied < kSkipOccupancy;
    const std::vector<glm::vec4> table = transferTables(plan, scene, source->info());
    const int rows = int(table.size()) / kTableSize;
    if (rows != target.tableRows) {
        target.table = makeTexture2D({kTableSize, rows}, GL_RGBA32F, GL_NEAREST, "transfer tables");
        target.tableRows = rows;
    }
    glTextureSubImage2D(target.table.name(), 0, 0, 0, kTableSize, rows, GL_RGBA, GL_FLOAT, table.data());
    if (target.skip) {
        if (target.blockCount != blocks->count || !target.blocks)
            target.blocks = makeTexture3D(blocks->count, GL_R8UI, GL_NEAREST, "block distances");
        target.blockCount = blocks->count;
        glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
        glTextureSubImage3D(target.blocks.name(), 0, 0, 0, 0, blocks->count.x, blocks->count.y, blocks->count.z,
                            GL_RED_INTEGER, GL_UNSIGNED_BYTE, blocks->distance.data());
        glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    }
    return program(rayRecipe(plan, scene, source->grid(), target.skip));
}

void Renderer::Impl::rays(const Program& rayProgram, const Scene& scene, const RayBuffer& buffer, glm::ivec2 size,
                          const Tile& tile) {
    const float nothing[] = {0, 0, 0, 0}, nowhere[] = {-1e9f, 0, 0, 0};
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, buffer.framebuffer.name());
    glViewport(0, 0, size.x, size.y);
    glEnable(GL_SCISSOR_TEST);
    glScissor(tile.begin.x, tile.begin.y, tile.end.x - tile.begin.x, tile.end.y - tile.begin.y);
    glClearNamedFramebufferfv(buffer.framebuffer.name(), GL_COLOR, 0, nothing);
    glClearNamedFramebufferfv(buffer.framebuffer.name(), GL_COLOR, 1, nowhere);
    // Only where the box is.
    const glm::ivec4 box = boxPixels(scene.camera, worldFrame(source->info().bounds, scene.stretch).halfSize, size);
    const glm::ivec2 begin = glm::max(tile.begin, glm::ivec2(box)), end = glm::min(tile.end, glm::ivec2(box.z, box.w));
    if (begin.x >= end.x || begin.y >= end.y) return;
    glScissor(begin.x, begin.y, end.x - begin.x, end.y - begin.y);
    rayProgram.set("ndcScale", 2.0f / glm::vec2(size));
    rayProgram.set("ndcOffset", glm::vec2(-1));
    glUseProgram(rayProgram.name());
    glBindVertexArray(vertices.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

void Renderer::Impl::present(ViewTarget& target, const Scene& scene, bool reduced, const Tile& tile) {
    if (!resolve) resolve = makeProgram({"screen.vert.glsl", "resolve.frag.glsl", {}, {}});
    const RayBuffer& from = reduced ? target.reduced : target.full;
    const glm::vec2 used(reduced ? target.reducedSize : target.size), whole(from.size);
    resolve.set("source", 0);
    resolve.set("sourceScale", used / glm::vec2(target.size) / whole);
    resolve.set("sourceLimit", (used - 0.5f) / whole);
    resolve.set("background", glm::vec3(linearFromSrgb(glm::dvec3(scene.background))));
    resolve.set("boxColor", glm::vec3(linearFromSrgb(glm::dvec3(scene.boxColor))));
    resolve.set("lineWidth", 1.3f);
    BoxLines lines;
    if (scene.showBox && source)
        lines = boxLines(scene.camera, worldFrame(source->info().bounds, scene.stretch).halfSize, target.size);
    resolve.set("edgeCount", int(lines.edges.size()));
    resolve.set("frontCount", lines.front);
    resolve.set("edges", lines.edges);
    glBindTextureUnit(0, from.color.name());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.outputFramebuffer.name());
    glViewport(0, 0, target.size.x, target.size.y);
    glEnable(GL_SCISSOR_TEST);
    glScissor(tile.begin.x, tile.begin.y, tile.end.x - tile.begin.x, tile.end.y - tile.begin.y);
    glUseProgram(resolve.name());
    glBindVertexArray(vertices.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

/// The background alone: nothing is loaded, or the program does not compile.
void Renderer::Impl::nothing(ViewTarget& target, const Scene& scene) {
    const float empty[] = {0, 0, 0, 0}, nowhere[] = {-1e9f, 0, 0, 0};
    glDisable(GL_SCISSOR_TEST);
    glClearNamedFramebufferfv(target.full.framebuffer.name(), GL_COLOR, 0, empty);
    glClearNamedFramebufferfv(target.full.framebuffer.name(), GL_COLOR, 1, nowhere);
    present(target, scene, false, {{0, 0}, target.size});
    target.fullValid = true;
}

/// Draws as much of the bound plan as the budget allows.
void Renderer::Impl::refine(ViewTarget& target, const Scene& scene, const FrameRequest& request, const RayPlan& plan,
                            Clock::time_point start) {
    if (target.fullValid) return;
    const Program* rayProgram = prepare(target, scene, plan);
    if (!rayProgram) return nothing(target, scene);
    const double aspect = double(target.size.x) / target.size.y;
    const RayUnits units = rayUnits(plan);
    for (std::size_t i = 0; i < plan.fields.size(); ++i) {
        const BoundField& field = plan.fields[i];
        glBindTextureUnit(GLuint(i), field.texture);
        if (!field.atlas) continue;
        glBindTextureUnit(GLuint(units.pages) + GLuint(i), field.pages);
        glBindTextureUnit(GLuint(units.atlases) + GLuint(i), field.atlas);
    }
    glBindTextureUnit(GLuint(units.table), target.table.name());
    glBindTextureUnit(GLuint(units.blocks), target.blocks.name());
    const volume::DatasetInfo& info = source->info();
    const double pixels = double(target.size.x) * target.size.y;
    const Tile everything{{0, 0}, target.size};

    // Software GL compiles at the first draw: do that before any clock runs.
    if (warm.insert(rayProgram->name()).second) {
        setRayUniforms(*rayProgram, plan, scene, info, source->grid(), aspect, 1);
        rays(*rayProgram, scene, target.reduced, target.size, {target.size / 2, target.size / 2 + 1});
        glFinish();
        target.reducedValid = false;
    }

    const auto drawReduced = [&](double shrink, double stepFactor) {
        const Clock::time_point begin = Clock::now();
        target.reducedSize = glm::max(glm::ivec2(glm::vec2(target.size) / float(shrink)), glm::ivec2(1));
        setRayUniforms(*rayProgram, plan, scene, info, source->grid(), aspect, stepFactor);
        rays(*rayProgram, scene, target.reduced, target.reducedSize, {{0, 0}, target.reducedSize});
        glFinish();
        const double cost =
            millisecondsSince(begin) * stepFactor / std::max(1.0, double(target.reducedSize.x) * target.reducedSize.y);
        target.msPerPixel = target.msPerPixel > 0 ? 0.5 * (target.msPerPixel + cost) : cost;
        target.reducedValid = true;
        present(target, scene, true, everything);
        glBindTextureUnit(0, plan.fields[0].texture);
    };
    const auto left = [&] { return request.budgetMs - millisecondsSince(start); };
    const double expected = target.msPerPixel * pixels;
    const bool fast = target.msPerPixel > 0 && expected < std::max(left(), 1.0);
    if (!request.wait && !fast && (request.moving || !target.reducedValid)) {
        double shrink = 4, stepFactor = 2;
        if (target.msPerPixel > 0)
            for (double candidate : {1.5, 2.0, 3.0, 4.0, 6.0}) {
                shrink = candidate;
                stepFactor = candidate < 2 ? 1.5 : 2;
                if (expected / (shrink * shrink * stepFactor) < left()) break;
            }
        drawReduced(shrink, stepFactor);
        if (request.moving) return;
    }

    // Tiles as large as a third of the budget allows; the same grid until the picture is done.
    if (target.tilesDone == 0) {
        target.passMilliseconds = 0;
        target.tileEdge = 1024;
        const double perTile = request.wait ? 1e9 : std::max(request.budgetMs / 3, 2.0);
        while (target.tileEdge > 64 && target.msPerPixel * target.tileEdge * target.tileEdge > perTile)
            target.tileEdge /= 2;
    }
    const std::vector<Tile> tiles = tilesOf(target.size, target.tileEdge);
    setRayUniforms(*rayProgram, plan, scene, info, source->grid(), aspect, 1);
    bool first = true;
    while (target.tilesDone < int(tiles.size()) && (request.wait || first || left() > 0)) {
        const Tile& tile = tiles[std::size_t(target.tilesDone)];
        const Clock::time_point begin = Clock::now();
        rays(*rayProgram, scene, target.full, target.size, tile);
        glFinish();
        target.passMilliseconds += millisecondsSince(begin);
        present(target, scene, false, tile);
        glBindTextureUnit(0, plan.fields[0].texture);
        ++target.tilesDone;
        first = false;
    }
    if (target.tilesDone == int(tiles.size())) {
        target.fullValid = true;
        target.msPerPixel = target.passMilliseconds / pixels;
    }
}

Renderer::Renderer(const RendererOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Renderer::~Renderer() = default;

void Renderer::setSource(std::shared_ptr<const volume::BrickSource> source) {
    impl_->source = source;
    impl_->residency.setSource(std::move(source));
}

const volume::BrickSource* Renderer::source() const {
    return impl_->source.get();
}

ViewTargetPtr Renderer::makeTarget() {
    return ViewTargetPtr(new ViewTarget);
}

FrameStatus Renderer::render(ViewTarget& target, const Scene& scene, const FrameRequest& request) {
    const Clock::time_point start = Clock::now();
    FrameStatus status;
    if (request.size.x <= 0 || request.size.y <= 0) {
        status.complete = true;
        return status;
    }
    const SavedState saved;
    target.resize(request.size, impl_->options.exactTextures);
    status.texture = target.output.name();
    status.complete = true;

    RayPlan plan;
    bool any = false;
    if (impl_->source) {
        impl_->residency.beginFrame();
        impl_->residency.update(request.wait ? ~std::size_t(0) : kUploadPerFrame);
        plan = planRays(scene, impl_->source->info());
        any = !plan.empty() && impl_->bind(target, scene, request, plan, status);
    }
    const std::uint64_t revision = impl_->residency.revision();
    if (!target.started || !(target.scene == scene) || target.revision != revision ||
        target.source != impl_->source.get()) {
        target.scene = scene;
        target.revision = revision;
        target.source = impl_->source.get();
        target.started = true;
        target.reducedValid = target.fullValid = false;
        target.tilesDone = 0;
    }
    if (any) {
        impl_->refine(target, scene, request, plan, start);
    } else if (!target.fullValid) {
        impl_->nothing(target, scene);
    }
    status.complete = status.complete && target.fullValid;
    status.milliseconds = target.passMilliseconds;
    return status;
}

std::optional<Pick> Renderer::pick(ViewTarget& target, glm::ivec2 pixel) {
    if (!target.started || !impl_->source || pixel.x < 0 || pixel.y < 0 || pixel.x >= target.size.x ||
        pixel.y >= target.size.y || !(target.fullValid || target.reducedValid))
        return std::nullopt;
    const bool full = target.fullValid;
    const RayBuffer& from = full ? target.full : target.reduced;
    const glm::dvec2 size(target.size);
    glm::dvec2 at(pixel.x + 0.5, target.size.y - 1 - pixel.y + 0.5);
    const glm::ivec2 texel =
        full ? glm::ivec2(at)
             : glm::min(glm::ivec2(at / size * glm::dvec2(target.reducedSize)), target.reducedSize - 1);
    if (!full) at = (glm::dvec2(texel) + 0.5) / glm::dvec2(target.reducedSize) * size;
    float distance = 0;
    glGetTextureSubImage(from.pick.name(), 0, texel.x, texel.y, 0, 1, 1, 1, GL_RED, GL_FLOAT, sizeof distance,
                         &distance);
    if (distance < -1e8f) return std::nullopt;
    const Ray ray = cameraRay(target.scene.camera, size.x / size.y, at / size * 2.0 - 1.0);
    const WorldFrame frame = worldFrame(impl_->source->info().bounds, target.scene.stretch);
    return Pick{frame.toPhysical(ray.origin + ray.direction * double(distance))};
}

std::vector<glm::vec4> Renderer::readLinear(ViewTarget& target) {
    const std::size_t width(static_cast<std::size_t>(target.size.x)), height(static_cast<std::size_t>(target.size.y));
    std::vector<glm::vec4> pixels(width * height), out(pixels.size());
    if (pixels.empty()) return pixels;
    glGetTextureImage(target.full.color.name(), 0, GL_RGBA, GL_FLOAT, GLsizei(pixels.size() * sizeof(glm::vec4)),
                      pixels.data());
    for (std::size_t y = 0; y < height; ++y)
        std::copy_n(pixels.begin() + std::ptrdiff_t((height - 1 - y) * width), width,
                    out.begin() + std::ptrdiff_t(y * width));
    return out;
}

std::vector<std::uint8_t> Renderer::readPixels(ViewTarget& target, glm::ivec2& size) {
    size = target.size;
    const std::size_t row = static_cast<std::size_t>(size.x) * 4, height = static_cast<std::size_t>(size.y);
    std::vector<std::uint8_t> pixels(row * height), out(pixels.size());
    if (pixels.empty()) return pixels;
    glGetTextureImage(target.output.name(), 0, GL_RGBA, GL_UNSIGNED_BYTE, GLsizei(pixels.size()), pixels.data());
    for (std::size_t y = 0; y < height; ++y)
        std::copy_n(pixels.begin() + std::ptrdiff_t((height - 1 - y) * row), row,
                    out.begin() + std::ptrdiff_t(y * row));
    return out;
}

ResidencyInfo Renderer::residency() const {
    return impl_->residency.info();
}

std::vector<std::string> Renderer::takeMessages() {
    std::vector<std::string> all = std::exchange(impl_->messages, {});
    for (std::string& message : impl_->residency.takeMessages()) all.push_back(std::move(message));
    return all;
}

} // namespace tessera::vis
