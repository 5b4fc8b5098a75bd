#include "vis/view/geometry_pass.h"

#include "vis/optics/ray_setup.h"
#include "vis/raycast/clip_uniforms.h"
#include "vis/raycast/lens_uniforms.h"
#include "vis/raycast/light_uniforms.h"
#include "vis/raycast/look_bits.h"
#include "vis/scene/drawn_scene.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

namespace tessera::vis {

namespace {

constexpr int kColors = 1024; ///< entries per row of the colour table
/// Texture units that no ray plan uses.
constexpr int kTableUnit = 42, kFormerUnit = 43, kGrainUnit = 45, kFormerColorUnit = 46;

constexpr GLuint kTintAttribute = 3, kStrokeAttribute = 4;

template <class T> Buffer filledBuffer(const std::vector<T>& content, const char* label) {
    return makeBuffer(GLsizeiptr(content.size() * sizeof(T)), content.data(), 0, label);
}

/// Vertex attribute `index` with `count` floats, at offset `first` (floats) within an element of a buffer.
void attribute(GLuint array, GLuint index, int count, int first, GLuint buffer = 0) {
    glEnableVertexArrayAttrib(array, index);
    glVertexArrayAttribFormat(array, index, count, GL_FLOAT, GL_FALSE, GLuint(first) * GLuint(sizeof(float)));
    glVertexArrayAttribBinding(array, index, buffer);
}

/// Position, normal and scalar per vertex.
std::vector<float> interleaved(const volume::SurfaceMesh& mesh) {
    std::vector<float> out;
    out.reserve(mesh.positions.size() * 7);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::vec3 normal = mesh.normals.empty() ? glm::vec3(0) : mesh.normals[i];
        for (int c = 0; c < 3; ++c) out.push_back(mesh.positions[i][c]);
        for (int c = 0; c < 3; ++c) out.push_back(normal[c]);
        out.push_back(mesh.scalars.empty() ? 0 : mesh.scalars[i]);
    }
    return out;
}

/// End points and their scalars per segment.
std::vector<float> segmentsOf(const LineSet& lines) {
    std::vector<float> out;
    std::uint32_t first = 0;
    for (const std::uint32_t end : lines.ends) {
        for (std::uint32_t i = first; i + 1 < std::min<std::size_t>(end, lines.positions.size()); ++i) {
            for (const std::uint32_t v : {i, i + 1})
                for (int c = 0; c < 3; ++c) out.push_back(lines.positions[v][c]);
            for (const std::uint32_t v : {i, i + 1}) out.push_back(lines.scalars.empty() ? 0 : lines.scalars[v]);
        }
        first = end;
    }
    return out;
}

} // namespace

void GeometryBuffer::resize(glm::ivec2 wanted, int wantedPeels) {
    if (size == wanted && peels >= wantedPeels) return;
    size = wanted;
    peels = wantedPeels;
    framebuffers.clear();
    shown.clear();
    color = makeTexture2DArray(size, peels, GL_RGBA16F, GL_NEAREST, "geometry colours");
    distance = makeTexture2DArray(size, peels, GL_RG32F, GL_NEAREST, "geometry distances");
    depth = makeTexture2D(size, GL_DEPTH_COMPONENT32F, GL_NEAREST, "geometry depth");
    for (int layer = 0; layer < peels; ++layer) {
        GLuint name = 0;
        glCreateFramebuffers(1, &name);
        Framebuffer framebuffer(name);
        glNamedFramebufferTextureLayer(name, GL_COLOR_ATTACHMENT0, color.name(), 0, layer);
        glNamedFramebufferTextureLayer(name, GL_COLOR_ATTACHMENT1, distance.name(), 0, layer);
        glNamedFramebufferTexture(name, GL_DEPTH_ATTACHMENT, depth.name(), 0);
        const GLenum buffers[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
        glNamedFramebufferDrawBuffers(name, 2, buffers);
        glObjectLabel(GL_FRAMEBUFFER, name, -1, "geometry");
        framebuffers.push_back(std::move(framebuffer));
        glCreateQueries(GL_ANY_SAMPLES_PASSED, 1, &name);
        shown.emplace_back(name);
    }
}

const GeometryPass::Uploaded& GeometryPass::upload(const std::shared_ptr<const Geometry>& geometry) {
    std::erase_if(uploaded_, [](const auto& entry) { return entry.second.of.expired(); });
    Uploaded& up = uploaded_[geometry.get()];
    if (up.of.lock() == geometry) return up;
    up = {};
    up.of = geometry;
    if (!geometry->mesh.triangles.empty()) {
        up.vertices = filledBuffer(interleaved(geometry->mesh), "mesh vertices");
        up.indices = filledBuffer(geometry->mesh.triangles, "mesh triangles");
        up.indexCount = GLsizei(geometry->mesh.triangles.size() * 3);
        up.mesh = makeVertexArray("mesh");
        glVertexArrayVertexBuffer(up.mesh.name(), 0, up.vertices.name(), 0, 7 * sizeof(float));
        glVertexArrayElementBuffer(up.mesh.name(), up.indices.name());
        attribute(up.mesh.name(), 0, 3, 0);
        attribute(up.mesh.name(), 1, 3, 3);
        attribute(up.mesh.name(), 2, 1, 6);
        if (!geometry->tints.empty()) {
            up.tints = filledBuffer(geometry->tints, "mesh tints");
            glVertexArrayVertexBuffer(up.mesh.name(), 1, up.tints.name(), 0, sizeof(glm::vec4));
            attribute(up.mesh.name(), kTintAttribute, 4, 0, 1);
        }
        if (!geometry->strokes.empty()) {
            up.strokes = filledBuffer(geometry->strokes, "mesh strokes");
            glVertexArrayVertexBuffer(up.mesh.name(), 2, up.strokes.name(), 0, sizeof(float));
            attribute(up.mesh.name(), kStrokeAttribute, 1, 0, 2);
        }
    }
    if (const std::vector<float> segments = segmentsOf(geometry->lines); !segments.empty()) {
        up.segments = filledBuffer(segments, "line segments");
        up.segmentCount = GLsizei(segments.size() / 8);
        up.lines = makeVertexArray("lines");
        glVertexArrayVertexBuffer(up.lines.name(), 0, up.segments.name(), 0, 8 * sizeof(float));
        glVertexArrayBindingDivisor(up.lines.name(), 0, 1);
        attribute(up.lines.name(), 0, 3, 0);
        attribute(up.lines.name(), 1, 3, 3);
        attribute(up.lines.name(), 2, 2, 6);
    }
    return up;
}

void GeometryPass::table(const Scene& scene, const volume::DatasetInfo& info) {
    std::vector<glm::vec4> colors;
    maps_.clear();
    for (const GeometryLayer& layer : scene.geometry) {
        const glm::dvec3 own = linearFromSrgb(glm::dvec3(layer.style.color));
        const std::optional<DrawnChannel> drawn = colorsOf(scene, info, layer);
        if (!drawn) {
            maps_.emplace_back(0);
            colors.insert(colors.end(), kColors, glm::vec4(own, 1));
            continue;
        }
        const Range range = drawn->range;
        const double width = range.hi - range.lo;
        maps_.push_back(width == 0 ? glm::vec2(0, 0.5) : glm::vec2(1 / width, -range.lo / width));
        for (int i = 0; i < kColors; ++i) {
            const glm::dvec4 srgb = evaluate(*drawn->function, {0, 1}, double(i) / (kColors - 1));
            colors.emplace_back(linearFromSrgb(glm::dvec3(srgb)), 1);
        }
    }
    const int rows = int(scene.geometry.size());
    if (rows > tableRows_) {
        table_ = makeTexture2D({kColors, rows}, GL_RGBA32F, GL_LINEAR, "geometry colour tables");
        tableRows_ = rows;
    }
    glTextureSubImage2D(table_.name(), 0, 0, 0, kColors, rows, GL_RGBA, GL_FLOAT, colors.data());
}

const Program& GeometryPass::program(const GeometryJob& job, bool lines, int look) {
    const std::string bits = std::to_string(look);
    ProgramRecipe recipe{lines ? "geometry_lines.vert.glsl" : "geometry_mesh.vert.glsl",
                         "geometry.frag.glsl",
                         {},
                         {{"LINES", lines ? "1" : "0"}, {"LAYERS", "1"}, {"LOOKS", bits}, {"LAYER_LOOK(i)", bits}}};
    addDriver(recipe, driver_);
    addLighting(recipe, job.scene);
    addClipping(recipe, job.scene);
    addLenses(recipe, job.lenses, job.scene);
    Made& made = programs_[recipe.key()];
    if (!made.program) made.program = makeProgram(recipe);
    made.used = Clock::now();
    return made.program;
}

/// Deletes the programs that were not used for the longest time, as ProgramCache does.
void GeometryPass::dropUnused() {
    while (programs_.size() > limit_.count) {
        const auto oldest = std::ranges::min_element(programs_, {}, [](const auto& each) { return each.second.used; });
        if (Clock::now() - oldest->second.used < limit_.unused) return;
        programs_.erase(oldest);
    }
}

namespace {

/// Sets the uniforms that all layers of a job share.
void setCommon(const Program& program, const GeometryJob& job) {
    const Scene& scene = job.scene;
    const glm::ivec2 size = job.size;
    const double aspect = double(size.x) / size.y;
    const WorldFrame frame = worldFrame(job.info, scene.stretch);
    const Ray middle = cameraRay(scene.camera, aspect, {0, 0});
    // A jittered ray has the ndc of its pixel plus 2 jitter / size, so geometry moves the opposite way.
    const glm::dmat4 moved = glm::translate(glm::dmat4(1), glm::dvec3(-2.0 * job.jitter / glm::dvec2(size), 0));
    const glm::mat4 worldToClip(moved * projectionMatrix(scene.camera, aspect) * viewMatrix(scene.camera));
    program.set("worldScale", glm::vec3(frame.scale));
    glProgramUniformMatrix4fv(program.name(), glGetUniformLocation(program.name(), "worldToClip"), 1, GL_FALSE,
                              &worldToClip[0][0]);
    program.set("rayOrigin", glm::vec3(middle.origin));
    program.set("forward", glm::vec3(middle.direction));
    program.set("perspective", scene.camera.projection == Projection::Perspective ? 1 : 0);
    program.set("halfSize", glm::vec3(glm::max(frame.halfSize, glm::dvec3(1e-5))));
    setLightUniforms(program, scene, frame, job.lightUnit);
    setClipUniforms(program, scene, frame);
    setLensUniforms(program, job.lenses);
    program.set("pixels", glm::vec2(size));
    program.set("colors", kTableUnit);
    program.set("former", kFormerUnit);
    program.set("formerColors", kFormerColorUnit);
    program.set("covers", scene.selection.active() ? 0 : 1); // brushes change the opacity later
}

/// Sets the GL state for geometry; the destructor restores depth test and scissor.
class DrawingState {
public:
    DrawingState(const GeometryJob& job) {
        const glm::ivec2 first = job.first, begin = first + job.tile.begin, edges = job.tile.end - job.tile.begin;
        glDisable(GL_BLEND);
        glEnable(GL_SCISSOR_TEST);
        glScissor(begin.x, begin.y, edges.x, edges.y);
        glEnable(GL_DEPTH_TEST);
        glDepthMask(GL_TRUE);
        glDepthFunc(GL_LESS);
        glViewport(first.x, first.y, job.size.x, job.size.y);
    }
    ~DrawingState() {
        glDisable(GL_DEPTH_TEST);
        glDisable(GL_SCISSOR_TEST);
    }
    DrawingState(const DrawingState&) = delete;
    DrawingState& operator=(const DrawingState&) = delete;
};

void clear(GLuint framebuffer) {
    const float empty[] = {0, 0, 0, 0}, nowhere[] = {kNoGeometry, 0, 0, 0}, far = 1;
    glClearNamedFramebufferfv(framebuffer, GL_COLOR, 0, empty);
    glClearNamedFramebufferfv(framebuffer, GL_COLOR, 1, nowhere);
    glClearNamedFramebufferfv(framebuffer, GL_DEPTH, 0, &far);
}

} // namespace

/// Collects the draw calls, with their common uniforms set.
std::vector<GeometryPass::Draw> GeometryPass::collect(const GeometryJob& job, GrainTexture& grain) {
    std::vector<Draw> draws;
    for (const DrawnGeometry& drawn : drawnGeometry(job.scene, job.lenses)) {
        const GeometryLayer& layer = job.scene.geometry[std::size_t(drawn.layer)];
        const Uploaded& up = upload(layer.geometry);
        if (layer.style.look.charcoal) glBindTextureUnit(kGrainUnit, grain.get());
        for (const bool lines : {false, true}) {
            if ((lines ? up.segmentCount : up.indexCount) == 0) continue;
            const Program& own = program(job, lines, lookBits(layer.style.look));
            setCommon(own, job);
            draws.push_back({std::size_t(drawn.layer), drawn.lens, lines, &up, &own});
        }
    }
    return draws;
}

void GeometryPass::drawOne(const Draw& each, const GeometryJob& job, int peel) const {
    const GeometryLayer& layer = job.scene.geometry[each.layer];
    const Program& own = *each.program;
    const WorldFrame frame = worldFrame(job.info, job.scene.stretch);
    const glm::dvec3 origin = each.lines ? layer.geometry->lines.origin : layer.geometry->mesh.origin;
    own.set("worldOffset", glm::vec3(frame.sheetToWorld(origin)));
    own.set("peel", peel);
    own.set("row", (float(each.layer) + 0.5f) / float(tableRows_));
    own.set("map", maps_[each.layer]);
    own.set("plain", glm::vec3(linearFromSrgb(glm::dvec3(layer.style.color))));
    own.set("opacity", layer.style.opacity);
    own.set("lens", each.lens);
    own.set("lineWidth", layer.style.lineWidth);
    const double edge = pixelAtDepthOne(job.scene.camera, job.size);
    own.set("rim", float(double(layer.style.rim) * edge));
    own.set("pixelEdge", float(edge));
    own.set("cutByBox", int(layer.style.cutByBox));
    own.set("brushEffect", float(int(layer.brushes)));
    // Layers share program variants, so the uniforms of looks are set for each.
    setLookUniforms(own, {layer.style.look.any() ? &layer.style.look : nullptr}, job.scene, frame, job.info.lattice,
                    job.pictureSize, kGrainUnit);
    glUseProgram(own.name());
    own.set("strokes", layer.style.strokes);
    glVertexAttrib4f(kTintAttribute, -1, -1, -1, 1); // of a mesh without tints
    glVertexAttrib1f(kStrokeAttribute, 0);           // of a mesh without strokes
    glBindVertexArray(each.lines ? each.up->lines.name() : each.up->mesh.name());
    if (each.lines)
        glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, each.up->segmentCount);
    else
        glDrawElements(GL_TRIANGLES, each.up->indexCount, GL_UNSIGNED_INT, nullptr);
}

void GeometryPass::draw(GeometryBuffer& buffer, const GeometryJob& job, GrainTexture& grain) {
    const int peels = peelsOf(job.scene);
    if (peels == 0) return;
    table(job.scene, job.info);
    const std::vector<Draw> draws = collect(job, grain);
    glBindTextureUnit(kTableUnit, table_.name());
    glBindTextureUnit(kFormerUnit, buffer.distance.name());
    glBindTextureUnit(kFormerColorUnit, buffer.color.name());
    const DrawingState state(job);
    for (int peel = 0; peel < peels; ++peel) {
        const GLuint framebuffer = buffer.framebuffers[std::size_t(peel)].name();
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
        clear(framebuffer);
        if (peel >= job.most) continue;
        // Stop after an empty peel: conditional rendering skips the following ones.
        if (peel > 0) glBeginConditionalRender(buffer.shown[std::size_t(peel) - 1].name(), GL_QUERY_WAIT);
        glBeginQuery(GL_ANY_SAMPLES_PASSED, buffer.shown[std::size_t(peel)].name());
        for (const Draw& each : draws) drawOne(each, job, peel);
        glEndQuery(GL_ANY_SAMPLES_PASSED);
        if (peel > 0) glEndConditionalRender();
        glTextureBarrier(); // the next peel reads what this one has written
    }
    dropUnused();
}

} // namespace tessera::vis
