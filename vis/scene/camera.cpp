#include "vis/scene/camera.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <utility>

namespace tessera::vis {

namespace {

constexpr glm::dvec3 kBoxHalf{0.5}; // the world box lies within -1/2..1/2 on every axis
constexpr glm::vec3 kX{1, 0, 0}, kY{0, 1, 0}, kZ{0, 0, 1};
constexpr double kNearestFocus = 1e-3;             // world units from the eye
constexpr double kGoldenAngle = 2.399963229728653; // pi (3 - sqrt 5)

glm::dquat orientation(const Camera& camera) {
    const glm::dquat turn(camera.orientation);
    const double length = glm::length(turn);
    return length > 0 ? turn / length : glm::dquat(1, 0, 0, 0);
}

/// Half the height of the picture in world units at the target's distance.
double halfHeight(const Camera& camera) {
    return camera.distance * std::tan(glm::radians(static_cast<double>(camera.fieldOfView)) / 2);
}

/// Smallest and largest distance of the world box in front of the eye.
Range boxDepth(const Camera& camera) {
    const glm::dvec3 back = glm::conjugate(orientation(camera)) * glm::dvec3(kZ);
    const double middle = camera.distance + glm::dot(back, glm::dvec3(camera.target));
    const double reach = glm::dot(glm::abs(back), kBoxHalf);
    return {middle - reach, middle + reach};
}

/// Point of a virtual trackball under a point of the picture: a sphere in the centre, continued by a hyperboloid.
/// (Bell's form of Chen, Mountford, Sellen: A study in interactive 3-D rotation, 1988.)
glm::vec3 trackball(glm::vec2 ndc) {
    const float squared = glm::dot(ndc, ndc);
    const float z = squared < 0.5f ? std::sqrt(1 - squared) : 0.5f / std::sqrt(squared);
    return glm::normalize(glm::vec3(ndc, z));
}

} // namespace

WorldFrame worldFrame(const volume::Box& bounds, glm::dvec3 stretch, volume::AxisMaps axes) {
    const glm::dvec3 edges = glm::max(bounds.size(), glm::dvec3(0)) * stretch;
    const double longest = std::max({edges.x, edges.y, edges.z});
    WorldFrame frame;
    // A single point has no extent; unit scale keeps the mapping invertible.
    frame.scale = longest > 0 ? stretch / longest : stretch;
    frame.offset = -bounds.center() * frame.scale;
    frame.halfSize = longest > 0 ? edges / longest * 0.5 : glm::dvec3(0);
    frame.axes = std::move(axes);
    return frame;
}

WorldFrame worldFrame(const volume::DatasetInfo& info, glm::dvec3 stretch) {
    return worldFrame(info.bounds, stretch, info.lattice.axes);
}

glm::dmat4 viewMatrix(const Camera& camera) {
    const glm::dmat4 toTarget = glm::translate(glm::dmat4(1), glm::dvec3(0, 0, -camera.distance));
    return glm::translate(toTarget * glm::mat4_cast(orientation(camera)), -glm::dvec3(camera.target));
}

glm::dvec3 WorldFrame::atShare(glm::dvec3 share) const {
    glm::dvec3 world = (2.0 * share - 1.0) * halfSize;
    if (axes.isEven()) return world;
    const glm::dvec3 lo = toPhysical(-halfSize), hi = toPhysical(halfSize), place = toWorld(lo + share * (hi - lo));
    for (int axis = 0; axis < 3; ++axis)
        if (axes[axis]) world[axis] = place[axis];
    return world;
}

glm::dvec3 WorldFrame::shareOf(glm::dvec3 world) const {
    glm::dvec3 share;
    const glm::dvec3 lo = toPhysical(-halfSize), hi = toPhysical(halfSize), place = toPhysical(world);
    for (int axis = 0; axis < 3; ++axis) {
        const double even = halfSize[axis] > 0 ? 0.5 * (world[axis] / halfSize[axis] + 1) : 0.5;
        share[axis] = axes[axis] && hi[axis] > lo[axis] ? (place[axis] - lo[axis]) / (hi[axis] - lo[axis]) : even;
    }
    return share;
}

double focalDistance(const Camera& camera) {
    const double distance = camera.distance + glm::dot(glm::dvec3(camera.focus - camera.target), forwardOf(camera));
    return std::max(distance, kNearestFocus);
}

namespace {

/// The distance over which a ray crosses the picture by its place on the lens.
double lensReach(const Camera& camera) {
    return camera.projection == Projection::Perspective ? focalDistance(camera) : camera.distance;
}

/// How far a ray moves aside per unit of depth, to the right and up: those of one pixel meet in the focal plane.
glm::dvec3 lensSlope(const Camera& camera) {
    return glm::dvec3(camera.lens, 0) / lensReach(camera);
}

} // namespace

double blurRadius(const Camera& camera, double depth) {
    const double inFocus = camera.aperture / 2 * std::abs(depth - focalDistance(camera)) / lensReach(camera);
    const double scale = camera.projection == Projection::Perspective ? camera.distance / depth : 1;
    return inFocus * scale / (2 * halfHeight(camera));
}

Camera lensCamera(Camera camera, int pass, int count) {
    const double radius = camera.aperture / 2 * std::sqrt(pass / std::max(count - 1.0, 1.0)),
                 angle = pass * kGoldenAngle;
    camera.lens += glm::vec2(radius * std::cos(angle), radius * std::sin(angle)); // from that of one eye of two
    return camera;
}

namespace {

/// Moves what is not in the focal plane aside, as an eye elsewhere on the lens sees it; in eye coordinates.
glm::dmat4 throughLens(const Camera& camera) {
    glm::dmat4 matrix(1);
    const glm::dvec3 slope = lensSlope(camera);
    for (int axis = 0; axis < 2; ++axis) {
        matrix[2][axis] = -slope[axis];
        matrix[3][axis] = -slope[axis] * focalDistance(camera);
    }
    return matrix;
}

glm::dmat4 pinholeMatrix(const Camera& camera, double aspect) {
    const Range depth = boxDepth(camera);
    const double margin = 0.01; // for lines and slices on the faces of the box
    const double height = halfHeight(camera), width = height * aspect;
    if (camera.projection == Projection::Orthographic)
        return glm::ortho(-width, width, -height, height, depth.lo - margin, depth.hi + margin);
    // If the eye is in or behind the box, the near plane is as close as a 24-bit depth buffer permits.
    const double far = std::max(depth.hi, 0.0) + margin;
    const double near = std::max(depth.lo - margin, far * 1e-3);
    return glm::perspective(glm::radians(static_cast<double>(camera.fieldOfView)), aspect, near, far);
}

} // namespace

glm::dmat4 projectionMatrix(const Camera& camera, double aspect) {
    const glm::dmat4 pinhole = pinholeMatrix(camera, aspect);
    return camera.lens == glm::vec2(0) ? pinhole : pinhole * throughLens(camera);
}

glm::dvec3 forwardOf(const Camera& camera) {
    return glm::conjugate(orientation(camera)) * glm::dvec3(0, 0, -1);
}

Ray cameraRay(const Camera& camera, double aspect, glm::dvec2 ndc) {
    const glm::dquat toWorld = glm::conjugate(orientation(camera));
    const double height = halfHeight(camera);
    const glm::dvec3 onPicture(ndc.x * height * aspect, ndc.y * height, 0), target(camera.target);
    const glm::dvec3 slope = lensSlope(camera);
    if (camera.projection == Projection::Perspective) {
        const glm::dvec3 eye(0, 0, camera.distance);
        const glm::dvec3 direction = (onPicture - eye) / static_cast<double>(camera.distance) - slope;
        return {target + toWorld * (eye + glm::dvec3(camera.lens, 0)), glm::normalize(toWorld * direction)};
    }
    // Rays of a parallel camera start in front of the box, however close the camera is.
    const double before = std::max<double>(camera.distance, glm::length(target) + glm::length(kBoxHalf));
    const glm::dvec3 direction = glm::normalize(glm::dvec3(0, 0, -1) - slope);
    const double beyondFocus = camera.distance - before - focalDistance(camera);
    glm::dvec3 origin = onPicture + glm::dvec3(0, 0, before) - slope * beyondFocus;
    origin -= direction * glm::dot(onPicture, direction); // all in one plane across the rays
    return {target + toWorld * origin, toWorld * direction};
}

double pixelAtDepthOne(const Camera& camera, glm::ivec2 size) {
    return 2 / (size.y * projectionMatrix(camera, static_cast<double>(size.x) / size.y)[1][1]);
}

void orbit(Camera& camera, glm::vec2 from, glm::vec2 to) {
    const glm::vec3 a = trackball(from), b = trackball(to);
    const glm::vec3 axis = glm::cross(a, b);
    const float sine = glm::length(axis);
    if (sine < 1e-7f) return;
    const glm::quat turn = glm::angleAxis(std::atan2(sine, glm::dot(a, b)), axis / sine);
    camera.orientation = glm::normalize(turn * camera.orientation);
}

void pan(Camera& camera, glm::vec2 ndcDelta, float aspect) {
    const auto height = static_cast<float>(halfHeight(camera));
    const glm::vec3 moved(ndcDelta.x * height * aspect, ndcDelta.y * height, 0);
    camera.target -= glm::conjugate(glm::normalize(camera.orientation)) * moved;
}

void zoom(Camera& camera, float factor) {
    if (factor > 0) camera.distance = std::clamp(camera.distance / factor, 0.01f, 100.0f);
}

void roll(Camera& camera, float radians) {
    camera.orientation = glm::normalize(glm::angleAxis(radians, kZ) * camera.orientation);
}

glm::quat firstOrientation(const WorldFrame& frame) {
    constexpr double kFlat = 0.6;
    const glm::dvec3 edge = frame.halfSize;
    const auto turned = [](float pitch, float yaw) {
        return glm::angleAxis(glm::radians(pitch), glm::vec3(1, 0, 0)) *
               glm::angleAxis(glm::radians(yaw), glm::vec3(0, 1, 0));
    };
    if (edge.y < kFlat * std::min(edge.x, edge.z)) return turned(45, 60);
    if (edge.z < kFlat * std::min(edge.x, edge.y)) return turned(25, 30);
    return Camera{}.orientation;
}

void fit(Camera& camera, const WorldFrame& frame, double aspect) {
    const glm::dquat toEye = orientation(camera);
    const double tangent = std::tan(glm::radians(static_cast<double>(camera.fieldOfView)) / 2);
    double distance = 0.05;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
        const glm::dvec3 eye = toEye * (frame.halfSize * sign);
        const double nearer = camera.projection == Projection::Perspective ? eye.z : 0;
        distance = std::max(distance, nearer + std::max(std::abs(eye.x) / aspect, std::abs(eye.y)) / tangent);
    }
    camera.target = {0, 0, 0};
    camera.distance = static_cast<float>(distance * 1.08); // a margin for axes and labels
}

glm::quat standardOrientation(StandardView view) {
    const float quarter = glm::radians(90.0f);
    switch (view) {
    case StandardView::Front:
        break;
    case StandardView::Back:
        return glm::angleAxis(2 * quarter, kY);
    case StandardView::Left:
        return glm::angleAxis(quarter, kY);
    case StandardView::Right:
        return glm::angleAxis(-quarter, kY);
    case StandardView::Top:
        return glm::angleAxis(quarter, kX);
    case StandardView::Bottom:
        return glm::angleAxis(-quarter, kX);
    case StandardView::Isometric: // all three axes equally foreshortened
        return glm::angleAxis(std::atan(std::sqrt(0.5f)), kX) * glm::angleAxis(quarter / 2, kY);
    }
    return {1, 0, 0, 0};
}

Camera planeCamera(int right, int up, const WorldFrame& world) {
    Camera camera;
    camera.projection = Projection::Orthographic;
    glm::vec3 across(0), upward(0);
    across[right] = 1;
    upward[up] = 1;
    // Rows of the rotation are the eye's axes in world space; glm matrices are stored by columns.
    camera.orientation =
        glm::normalize(glm::quat_cast(glm::transpose(glm::mat3(across, upward, glm::cross(across, upward)))));
    camera.fieldOfView = 35;
    camera.distance = static_cast<float>(world.halfSize[up]) / std::tan(glm::radians(camera.fieldOfView) / 2);
    return camera;
}

} // namespace tessera::vis
