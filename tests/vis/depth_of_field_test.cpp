#include "vis/scene/camera.h"
#include "vis/scene/scene.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <random>

/// Cameras with an aperture against the formula of the thin lens.
namespace tessera::vis {
namespace {

Camera wideOpen(Projection projection) {
    Camera made;
    made.projection = projection;
    made.target = {0.1f, -0.05f, 0.02f};
    made.distance = 1.9f;
    made.aperture = 0.2f;
    made.focus = {0.15f, 0.3f, -0.2f};
    return made;
}

glm::dvec2 lensNdc(const Camera& camera, double aspect, glm::dvec3 world) {
    const glm::dvec4 clip = projectionMatrix(camera, aspect) * viewMatrix(camera) * glm::dvec4(world, 1);
    return glm::dvec2(clip) / clip.w;
}

double lensDepth(const Camera& camera, glm::dvec3 world) {
    return -(viewMatrix(camera) * glm::dvec4(world, 1)).z;
}

TEST(DepthOfField, TheFocalPlaneGoesThroughThePointInFocus) {
    for (const Projection projection : {Projection::Perspective, Projection::Orthographic}) {
        const Camera made = wideOpen(projection);
        EXPECT_NEAR(focalDistance(made), lensDepth(made, made.focus), 1e-6);
        EXPECT_NEAR(blurRadius(made, focalDistance(made)), 0, 1e-12);
    }
}

TEST(DepthOfField, EveryPlaceOnTheLensSeesTheFocalPlaneAlike) {
    constexpr double kAspect = 1.3;
    for (const Projection projection : {Projection::Perspective, Projection::Orthographic}) {
        const Camera made = wideOpen(projection);
        for (int pass = 0; pass < 9; ++pass) {
            const Camera seen = lensCamera(made, pass, 9);
            EXPECT_EQ(seen.lens == glm::vec2(0), pass == 0);
            for (const glm::dvec2 ndc : {glm::dvec2(0, 0), glm::dvec2(0.7, -0.4), glm::dvec2(-0.9, 0.8)}) {
                const Ray sharp = cameraRay(made, kAspect, ndc), ray = cameraRay(seen, kAspect, ndc);
                EXPECT_NEAR(glm::length(ray.direction), 1, 1e-12);
                const auto met = [&](const Ray& own, double depth) {
                    const glm::dvec3 forward = forwardOf(made);
                    const double from = lensDepth(made, own.origin);
                    return own.origin + own.direction * ((depth - from) / glm::dot(own.direction, forward));
                };
                const double focal = focalDistance(made);
                EXPECT_LT(glm::length(met(ray, focal) - met(sharp, focal)), 1e-7);
                if (pass > 0) {
                    EXPECT_GT(glm::length(met(ray, focal + 0.3) - met(sharp, focal + 0.3)), 1e-3);
                }
                // The matrix of the rasteriser says the same of every depth.
                for (const double depth : {focal - 0.4, focal, focal + 0.5}) {
                    const glm::dvec2 back = lensNdc(seen, kAspect, met(ray, depth));
                    EXPECT_LT(glm::length(back - ndc), 1e-6) << pass << " " << depth;
                }
            }
        }
    }
}

/// The mean square distance of places on a disc of radius r from its middle is r^2 / 2.
TEST(DepthOfField, APointIsBlurredToTheDiscOfAThinLens) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> number(-0.4, 0.4);
    for (const Projection projection : {Projection::Perspective, Projection::Orthographic}) {
        const Camera made = wideOpen(projection);
        for (int i = 0; i < 20; ++i) {
            const glm::dvec3 world(number(random), number(random), number(random));
            const double depth = lensDepth(made, world), focal = focalDistance(made);
            double squares = 0, farthest = 0;
            glm::dvec2 mean(0);
            for (int pass = 0; pass < kLensPlaces; ++pass) {
                const glm::dvec2 moved =
                    (lensNdc(lensCamera(made, pass, kLensPlaces), 1, world) - lensNdc(made, 1, world)) / 2.0; // heights
                squares += glm::dot(moved, moved) / kLensPlaces;
                farthest = std::max(farthest, glm::length(moved));
                mean += moved / double(kLensPlaces);
            }
            const double half = std::tan(glm::radians(double(made.fieldOfView)) / 2);
            const double apart = projection == Projection::Perspective
                                     ? std::abs(depth - focal) / (depth * focal * half)
                                     : std::abs(depth - focal) / (double(made.distance) * made.distance * half);
            const double radius = made.aperture / 2 * apart / 2;
            EXPECT_NEAR(blurRadius(made, depth), radius, 1e-6);
            EXPECT_NEAR(farthest, radius, 1e-6);
            EXPECT_NEAR(squares, radius * radius / 2, 1e-3 * radius * radius + 1e-12);
            EXPECT_LT(glm::length(mean), 0.03 * radius + 1e-9) << "around the sharp point";
        }
    }
}

TEST(DepthOfField, WithoutAnApertureThereIsOnePlaceAndTheRaysAskedFor) {
    Scene scene;
    scene.render.samples = 3;
    EXPECT_EQ(raysPerPixel(scene), 3);
    scene.camera.aperture = 0.1f;
    EXPECT_EQ(raysPerPixel(scene), kLensPlaces);
    scene.render.samples = 200;
    EXPECT_EQ(raysPerPixel(scene), 200);
    EXPECT_EQ(lensCamera(Camera{}, 5, 9).lens, glm::vec2(0));
    scene.camera.focus = {0, 0, 90}; // behind the eye
    EXPECT_GT(focalDistance(scene.camera), 0);
}

} // namespace
} // namespace tessera::vis
