#include "vis/scene/camera.h"

#include <glm/gtc/matrix_inverse.hpp>
#include <gtest/gtest.h>
#include <random>

namespace tessera::vis {
namespace {

struct Random {
    std::mt19937_64 engine{20260101};
    double operator()(double lo, double hi) { return std::uniform_real_distribution(lo, hi)(engine); }
    glm::dvec3 vec(double lo, double hi) { return {(*this)(lo, hi), (*this)(lo, hi), (*this)(lo, hi)}; }
    Camera camera() {
        Camera made;
        made.projection = (*this)(0, 1) < 0.5 ? Projection::Perspective : Projection::Orthographic;
        made.orientation = glm::normalize(glm::quat(glm::dquat((*this)(-1, 1), vec(-1, 1))));
        made.target = glm::vec3(vec(-0.4, 0.4));
        made.distance = static_cast<float>((*this)(0.05, 4));
        made.fieldOfView = static_cast<float>((*this)(10, 90));
        return made;
    }
};

double gap(glm::dvec3 a, glm::dvec3 b) {
    return glm::length(a - b);
}

TEST(WorldFrame, MapsTheBoxToUnitLengthAndBack) {
    Random random;
    for (int i = 0; i < 300; ++i) {
        const glm::dvec3 lo = random.vec(-5, 5), stretch = random.vec(0.1, 40);
        const volume::Box box{lo, lo + random.vec(1e-4, 3)};
        const WorldFrame frame = worldFrame(box, stretch);
        EXPECT_NEAR(std::max({frame.halfSize.x, frame.halfSize.y, frame.halfSize.z}), 0.5, 1e-12);
        EXPECT_LT(gap(frame.toWorld(box.lo), -frame.halfSize), 1e-9);
        EXPECT_LT(gap(frame.toWorld(box.hi), frame.halfSize), 1e-9);
        const glm::dvec3 physical = random.vec(-6, 6);
        EXPECT_LT(gap(frame.toPhysical(frame.toWorld(physical)), physical), 1e-8);
    }
}

TEST(WorldFrame, FlatAndPointBoxesStayInvertible) {
    for (glm::dvec3 size : {glm::dvec3(0), glm::dvec3(1, 0, 0), glm::dvec3(0, 2, 3)}) {
        const volume::Box box{glm::dvec3(7), glm::dvec3(7) + size};
        const WorldFrame frame = worldFrame(box, {1, 2, 3});
        EXPECT_LT(gap(frame.toPhysical(frame.toWorld(box.hi)), box.hi), 1e-12);
    }
}

TEST(Camera, RayThroughAPointProjectsBack) {
    Random random;
    for (int i = 0; i < 500; ++i) {
        const Camera camera = random.camera();
        const double aspect = random(0.3, 3);
        const glm::dvec2 ndc(random(-1, 1), random(-1, 1));
        const Ray ray = cameraRay(camera, aspect, ndc);
        EXPECT_NEAR(glm::length(ray.direction), 1, 1e-12);
        const glm::dmat4 clip = projectionMatrix(camera, aspect) * viewMatrix(camera);
        for (double t : {0.3, 2.0}) {
            const glm::dvec4 at = clip * glm::dvec4(ray.origin + t * ray.direction, 1);
            EXPECT_NEAR(at.x / at.w, ndc.x, 1e-5);
            EXPECT_NEAR(at.y / at.w, ndc.y, 1e-5);
        }
    }
}

TEST(Camera, NearAndFarHoldWhatIsBeforeTheEye) {
    Random random;
    int visible = 0;
    for (int i = 0; i < 500; ++i) {
        const Camera camera = random.camera();
        const glm::dmat4 view = viewMatrix(camera), projection = projectionMatrix(camera, 1);
        for (int j = 0; j < 2; ++j)
            for (int c = 0; c < 4; ++c)
                for (int r = 0; r < 4; ++r) ASSERT_TRUE(std::isfinite(projection[c][r]));
        const glm::dvec4 eye = view * glm::dvec4(random.vec(-0.5, 0.5), 1);
        if (camera.projection == Projection::Perspective && -eye.z < 0.02) continue;
        const glm::dvec4 clip = projection * eye;
        EXPECT_LE(std::abs(clip.z), clip.w * (1 + 1e-9));
        ++visible;
    }
    EXPECT_GT(visible, 300);
}

TEST(Camera, ParallelRaysBeginBeforeTheBox) {
    Random random;
    for (int i = 0; i < 300; ++i) {
        Camera camera = random.camera();
        camera.projection = Projection::Orthographic;
        const Ray ray = cameraRay(camera, 1.5, {random(-1, 1), random(-1, 1)});
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 at(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5);
            EXPECT_GE(glm::dot(at - ray.origin, ray.direction), -1e-6);
        }
    }
}

TEST(Camera, OrbitStaysARotationAndFollowsTheHand) {
    Random random;
    Camera camera = random.camera();
    for (int i = 0; i < 2000; ++i) {
        orbit(camera, {float(random(-2, 2)), float(random(-2, 2))}, {float(random(-2, 2)), float(random(-2, 2))});
        ASSERT_NEAR(glm::length(camera.orientation), 1, 1e-5);
    }
    // A point on the near side moves with the mouse; back again restores the view.
    camera = Camera{};
    const glm::quat before = camera.orientation;
    const glm::vec3 facing = glm::conjugate(before) * glm::vec3(0, 0, 0.3f);
    orbit(camera, {0, 0}, {0.2f, 0.1f});
    const glm::vec3 after = camera.orientation * facing;
    EXPECT_GT(after.x, 0.01);
    EXPECT_GT(after.y, 0.005);
    orbit(camera, {0.2f, 0.1f}, {0, 0});
    EXPECT_NEAR(std::abs(glm::dot(camera.orientation, before)), 1, 1e-6);
    orbit(camera, {0.1f, 0.1f}, {0.1f, 0.1f});
    EXPECT_NEAR(std::abs(glm::dot(camera.orientation, before)), 1, 1e-6);
}

TEST(Camera, PanMovesThePictureByTheGivenDifference) {
    Random random;
    for (int i = 0; i < 100; ++i) {
        Camera camera = random.camera();
        const double aspect = random(0.5, 2);
        const glm::dvec4 point(glm::dvec3(camera.target), 1);
        const glm::vec2 delta(random(-1, 1), random(-1, 1));
        pan(camera, delta, static_cast<float>(aspect));
        const glm::dvec4 at = projectionMatrix(camera, aspect) * viewMatrix(camera) * point;
        EXPECT_NEAR(at.x / at.w, delta.x, 1e-4);
        EXPECT_NEAR(at.y / at.w, delta.y, 1e-4);
    }
}

TEST(Camera, ZoomRollAndFit) {
    Camera camera;
    zoom(camera, 2);
    EXPECT_FLOAT_EQ(camera.distance, 1.1f);
    zoom(camera, 1e9f);
    EXPECT_FLOAT_EQ(camera.distance, 0.01f);
    zoom(camera, 0);
    EXPECT_FLOAT_EQ(camera.distance, 0.01f);
    zoom(camera, 1e-9f);
    EXPECT_FLOAT_EQ(camera.distance, 100) << "as far as a session may state";
    camera = Camera{};
    camera.orientation = standardOrientation(StandardView::Front);
    roll(camera, glm::radians(90.0f));
    EXPECT_LT(gap(camera.orientation * glm::vec3(1, 0, 0), {0, 1, 0}), 1e-6);

    Random random;
    for (int i = 0; i < 200; ++i) {
        Camera fitted = random.camera();
        const WorldFrame frame = worldFrame({glm::dvec3(0), random.vec(0.01, 1)}, glm::dvec3(1));
        const double aspect = random(0.4, 2.5);
        fit(fitted, frame, aspect);
        const glm::dmat4 clip = projectionMatrix(fitted, aspect) * viewMatrix(fitted);
        double reach = 0;
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
            const glm::dvec4 at = clip * glm::dvec4(frame.halfSize * sign, 1);
            ASSERT_GT(at.w, 0);
            reach = std::max({reach, std::abs(at.x / at.w), std::abs(at.y / at.w)});
        }
        EXPECT_LT(reach, 1);
        EXPECT_GT(reach, 0.75);
    }
}

TEST(Camera, DefaultShowsALongBoxAcross) {
    const Camera camera;
    EXPECT_NEAR(glm::length(camera.orientation), 1, 1e-6);
    const glm::vec3 along = camera.orientation * glm::vec3(0, 0, 1), up = camera.orientation * glm::vec3(0, 1, 0);
    EXPECT_GT(along.x, 0.8f);
    EXPECT_LT(std::abs(along.y), 0.3f);
    EXPECT_NEAR(up.x, 0, 1e-6);
    EXPECT_GT(up.y, 0.85f);
    EXPECT_GT(up.z, 0.3f); // seen from above
}

TEST(Camera, AFlatBoxIsFirstSeenTowardsItsLargeFaces) {
    const auto seen = [](glm::dvec3 halfSize) { // cosines between the three axes and the direction to the eye
        WorldFrame frame;
        frame.halfSize = halfSize;
        return glm::dvec3(glm::conjugate(firstOrientation(frame)) * glm::vec3(0, 0, 1));
    };
    for (const glm::dvec3 size :
         {glm::dvec3(1), glm::dvec3(1, 0.7, 0.8), glm::dvec3(0.1, 1, 1), glm::dvec3(0.1, 0.1, 1)}) {
        WorldFrame frame;
        frame.halfSize = size;
        EXPECT_EQ(firstOrientation(frame), Camera{}.orientation);
    }
    const glm::dvec3 cube = seen(glm::dvec3(1)), thinZ = seen({1, 1, 0.2}), thinY = seen({1, 0.2, 1});
    EXPECT_GT(std::abs(thinZ.z), 0.75);
    EXPECT_GT(std::abs(thinZ.z), std::abs(cube.z) + 0.2);
    EXPECT_GT(thinY.y, 0.7);
    EXPECT_GT(thinY.y, cube.y + 0.2);
    for (const glm::dvec3 each : {cube, thinZ, thinY}) EXPECT_GT(each.y, 0.4) << "from above";
}

TEST(Camera, StandardViewsLookAlongTheirAxes) {
    const auto toViewer = [](StandardView view) {
        return glm::conjugate(standardOrientation(view)) * glm::vec3(0, 0, 1);
    };
    EXPECT_LT(gap(toViewer(StandardView::Front), {0, 0, 1}), 1e-6);
    EXPECT_LT(gap(toViewer(StandardView::Back), {0, 0, -1}), 1e-6);
    EXPECT_LT(gap(toViewer(StandardView::Left), {-1, 0, 0}), 1e-6);
    EXPECT_LT(gap(toViewer(StandardView::Right), {1, 0, 0}), 1e-6);
    EXPECT_LT(gap(toViewer(StandardView::Top), {0, 1, 0}), 1e-6);
    EXPECT_LT(gap(toViewer(StandardView::Bottom), {0, -1, 0}), 1e-6);
    EXPECT_LT(gap(toViewer(StandardView::Isometric), glm::normalize(glm::dvec3(-1, 1, 1))), 1e-6);
    EXPECT_LT(gap(standardOrientation(StandardView::Left) * glm::vec3(0, 0, 1), {1, 0, 0}), 1e-6);
}

} // namespace
} // namespace tessera::vis
