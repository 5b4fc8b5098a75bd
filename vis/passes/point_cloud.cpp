#include "vis/passes/point_cloud.h"

#include "vis/gl/handles.h"
#include "vis/gl/program.h"
#include "vis/optics/ray_setup.h"

#include <algorithm>
#include <cmath>

namespace tessera::vis {

struct PointCloud::Impl {
    Buffer buffer;
    VertexArray array;
    std::size_t count = 0;
    Program splat, resolve;
    Texture sums, throughs, picture;
    Framebuffer splats, shown;
    glm::ivec2 size{0};
    std::vector<CloudPoint> points; ///< without OpenGL
    MemoryTexture drawn{.rgba = {}};
    bool inMemory = false;

    void resize(glm::ivec2 wanted) {
        if (size == wanted) return;
        sums = makeTexture2D(wanted, GL_RGBA16F, GL_NEAREST, "splat sums");
        throughs = makeTexture2D(wanted, GL_R16F, GL_NEAREST, "splat transmission");
        picture = makeTexture2D(wanted, GL_RGBA8, GL_LINEAR, "point cloud");
        splats = makeFramebuffer({sums.name(), throughs.name()}, "splats");
        shown = makeFramebuffer({picture.name()}, "point cloud");
        size = wanted;
    }
};

PointCloud::PointCloud() : impl_(std::make_unique<Impl>()) {}
PointCloud::~PointCloud() = default;
PointCloud::PointCloud(PointCloud&&) noexcept = default;
PointCloud& PointCloud::operator=(PointCloud&&) noexcept = default;

std::size_t PointCloud::count() const {
    return impl_->count;
}

void PointCloud::upload(TexturesIn where, std::span<const CloudPoint> points) {
    impl_->count = points.size();
    impl_->inMemory = where == TexturesIn::Memory;
    if (impl_->inMemory) return impl_->points.assign(points.begin(), points.end());
    if (points.empty()) return;
    impl_->buffer = makeBuffer(GLsizeiptr(points.size_bytes()), points.data(), 0, "points");
    impl_->array = makeVertexArray("points");
    const GLuint array = impl_->array.name();
    glVertexArrayVertexBuffer(array, 0, impl_->buffer.name(), 0, sizeof(CloudPoint));
    for (const GLuint attribute : {0u, 1u, 2u, 3u}) {
        glEnableVertexArrayAttrib(array, attribute);
        glVertexArrayAttribFormat(array, attribute, 4, GL_FLOAT, GL_FALSE, attribute * GLuint(sizeof(glm::vec4)));
        glVertexArrayAttribBinding(array, attribute, 0);
    }
}

TextureName PointCloud::draw(const CloudView& view) {
    Impl& own = *impl_;
    if (own.inMemory) {
        own.drawn = drawnCloud(own.points, view);
        return own.drawn.name();
    }
    if (!own.splat) {
        own.splat = makeProgram({"points.vert.glsl", "points.frag.glsl", {}, {}});
        own.resolve = makeProgram({"screen.vert.glsl", "points_resolve.frag.glsl", {}, {}});
    }
    own.resize(glm::max(view.size, glm::ivec2(1)));
    const float none[] = {0, 0, 0, 0}, all[] = {1, 1, 1, 1};
    glClearNamedFramebufferfv(own.splats.name(), GL_COLOR, 0, none);
    glClearNamedFramebufferfv(own.splats.name(), GL_COLOR, 1, all);
    glViewport(0, 0, own.size.x, own.size.y);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_DEPTH_TEST);
    const double share = std::clamp(view.share, 0.0, 1.0);
    if (const auto drawn = GLsizei(std::ceil(double(own.count) * share)); drawn > 0) {
        const glm::mat4 rotation(view.rotation.firstAxes()), further(view.rotation.furtherAxes());
        const GLuint splat = own.splat.name();
        const double smaller = std::min(own.size.x, own.size.y);
        // Radii refer to the centre of the picture, where the magnification depends only on the eye distances.
        const double middle = project(view.projection, 1, glm::dvec4(0)).scale / view.projection.zoom;
        glProgramUniformMatrix4fv(splat, glGetUniformLocation(splat, "rotation"), 1, GL_FALSE, &rotation[0][0]);
        glProgramUniformMatrix4fv(splat, glGetUniformLocation(splat, "furtherRotation"), 1, GL_FALSE, &further[0][0]);
        own.splat.set("eyes", glm::vec4(std::max(view.projection.eye, 1.05), std::max(view.projection.eye3, 1.05),
                                        view.projection.zoom, view.projection.parallel ? 1 : 0));
        own.splat.set("stereo", glm::vec2(view.projection.aside, view.projection.convergence));
        own.splat.set("light", glm::vec4(view.light.towards));
        own.splat.set("ambient", float(view.light.ambient));
        own.splat.set("perPixel", glm::vec2(smaller / glm::dvec2(own.size)));
        own.splat.set("radius", float(view.radiusPixels / middle));
        own.splat.set("opacityPower", float(double(own.count) / drawn));
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, own.splats.name());
        glEnable(GL_PROGRAM_POINT_SIZE);
        glEnable(GL_BLEND);
        glBlendFunci(0, GL_ONE, GL_ONE);
        glBlendFunci(1, GL_ZERO, GL_ONE_MINUS_SRC_COLOR);
        glUseProgram(own.splat.name());
        glBindVertexArray(own.array.name());
        glDrawArrays(GL_POINTS, 0, drawn);
        glDisable(GL_BLEND);
        glDisable(GL_PROGRAM_POINT_SIZE);
        glBlendFunc(GL_ONE, GL_ZERO);
    }
    own.resolve.set("sums", 0);
    own.resolve.set("throughs", 1);
    own.resolve.set("background", glm::vec3(linearFromSrgb(glm::dvec3(view.background))));
    glBindTextureUnit(0, own.sums.name());
    glBindTextureUnit(1, own.throughs.name());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, own.shown.name());
    glUseProgram(own.resolve.name());
    if (!own.array) own.array = makeVertexArray("points");
    glBindVertexArray(own.array.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    return own.picture.name();
}

} // namespace tessera::vis
