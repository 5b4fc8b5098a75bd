#include "vis/demand/box_lines.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace tessera::vis {

namespace {

/// Whether the face of the box on side `sign` of `axis` faces the viewer.
bool faces(const Camera& camera, const Ray& middle, glm::dvec3 halfSize, int axis, double sign) {
    return camera.projection == Projection::Perspective ? sign * middle.origin[axis] > halfSize[axis]
                                                        : sign * middle.direction[axis] < 0;
}

} // namespace

glm::ivec4 boxPixels(const Camera& camera, glm::dvec3 halfSize, glm::ivec2 size) {
    const auto found = PictureProjection(camera, size)
                           .bounds(glm::dvec3(0), glm::dmat3(halfSize.x, 0, 0, 0, halfSize.y, 0, 0, 0, halfSize.z));
    if (!found) return {0, 0, size.x, size.y};
    const glm::ivec2 begin = glm::clamp(glm::ivec2(glm::floor(found->lo)) - 1, glm::ivec2(0), size);
    const glm::ivec2 end = glm::clamp(glm::ivec2(glm::ceil(found->hi)) + 1, begin, size);
    return {begin.x, begin.y, end.x, end.y};
}

BoxLines boxLines(const Camera& camera, glm::dvec3 halfSize, glm::ivec2 size) {
    const double aspect = double(size.x) / std::max(size.y, 1);
    const Ray middle = cameraRay(camera, aspect, {0, 0});
    const glm::dmat4 view = viewMatrix(camera), projection = projectionMatrix(camera, aspect);
    BoxLines lines;
    std::vector<glm::vec4> front;
    for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        for (double su : {-1.0, 1.0})
            for (double sv : {-1.0, 1.0}) {
                glm::dvec3 end;
                end[axis] = halfSize[axis];
                end[u] = su * halfSize[u];
                end[v] = sv * halfSize[v];
                glm::dvec3 begin = end;
                begin[axis] = -halfSize[axis];
                glm::dvec4 a = view * glm::dvec4(begin, 1), b = view * glm::dvec4(end, 1);
                if (camera.projection == Projection::Perspective) {
                    if (a.z > -kNear && b.z > -kNear) continue;
                    if (a.z > -kNear) a = glm::mix(a, b, (a.z + kNear) / (a.z - b.z));
                    if (b.z > -kNear) b = glm::mix(b, a, (b.z + kNear) / (b.z - a.z));
                }
                const auto pixel = [&](glm::dvec4 eye) {
                    const glm::dvec4 clip = projection * eye;
                    return (glm::dvec2(clip) / clip.w * 0.5 + 0.5) * glm::dvec2(size);
                };
                const glm::vec4 line(pixel(a), pixel(b));
                const bool before = faces(camera, middle, halfSize, u, su) && faces(camera, middle, halfSize, v, sv);
                (before ? front : lines.edges).push_back(line);
            }
    }
    lines.front = int(front.size());
    lines.edges.insert(lines.edges.end(), front.begin(), front.end());
    return lines;
}

} // namespace tessera::vis
