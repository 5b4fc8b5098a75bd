#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <string_view>
#include <vector>

namespace tessera::volume {

/// Arrangement of seed points between two corners of a box.
enum class SeedShape {
    Line,   ///< even distances along its diagonal
    Plane,  ///< a grid on the middle plane across its thinnest direction
    Sphere, ///< at random in the ellipsoid that fills it
    Random, ///< at random everywhere in it
    Even,   ///< with even distances from each other, or from lines (volume/flow/even_lines.h)
};
inline constexpr std::string_view kSeedShapeNames[] = {"line", "plane", "sphere", "random", "even"};

/// The axis that a plane of seeds between two corners lies across: the shortest of these edges, the first of equal
/// ones.
int thinnestAxis(glm::dvec3 edges);

struct SeedSettings {
    SeedShape shape = SeedShape::Random;
    glm::dvec3 from{0}, to{1}; ///< corners, physical
    glm::dvec3 proportions{1}; ///< lengths along the axes are multiplied by this to judge what is thin or even
    int count = 50;            ///< of a plane: about so many; of even distances: at most
    double separation = 0.1;   ///< of even distances, in lengths times the proportions
    std::uint32_t random = 1;  ///< the same points for the same number, on every machine
};

/// Seed points of lines or glyphs. `weight`, 0..1, is the probability that a random point is kept; 0 removes a point of
/// a line or plane, or an even one. Fewer points than requested if the weight leaves no room.
std::vector<glm::dvec3> placeSeeds(const SeedSettings& settings, const std::function<double(glm::dvec3)>& weight);

} // namespace tessera::volume
