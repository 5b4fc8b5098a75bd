#include "volume/mesh/surface_mesh.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <unordered_map>

namespace tessera::volume {

namespace {

constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();

/// Cuts away vertices with side * (position[axis] - limit) > 0.
class PlaneCut {
public:
    PlaneCut(SurfaceMesh& mesh, int axis, float limit, float side)
        : mesh_(mesh), axis_(axis), limit_(limit), side_(side) {}

    void run() {
        const std::size_t count = mesh_.positions.size();
        const bool any = std::any_of(mesh_.positions.begin(), mesh_.positions.end(),
                                     [&](const glm::vec3& p) { return beyond(p) > 0; });
        if (count == 0 || !any) return;
        std::vector<glm::uvec3> kept;
        kept.reserve(mesh_.triangles.size());
        for (const glm::uvec3& triangle : mesh_.triangles) cut(triangle, kept);
        mesh_.triangles = std::move(kept);
    }

private:
    float beyond(const glm::vec3& p) const { return side_ * (p[axis_] - limit_); }

    void cut(const glm::uvec3& triangle, std::vector<glm::uvec3>& kept) {
        std::uint32_t corners[4];
        int n = 0;
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t a = triangle[i], b = triangle[(i + 1) % 3];
            const bool aOut = beyond(mesh_.positions[a]) > 0, bOut = beyond(mesh_.positions[b]) > 0;
            if (!aOut) corners[n++] = a;
            if (aOut != bOut) corners[n++] = between(std::min(a, b), std::max(a, b));
        }
        if (n >= 3) kept.emplace_back(corners[0], corners[1], corners[2]);
        if (n == 4) kept.emplace_back(corners[0], corners[2], corners[3]);
    }

    /// The vertex where an edge meets the plane; a < b, so that both triangles at the edge share it.
    std::uint32_t between(std::uint32_t a, std::uint32_t b) {
        const auto [entry, fresh] = made_.try_emplace(std::uint64_t(a) << 32 | b, std::uint32_t(0));
        if (!fresh) return entry->second;
        entry->second = std::uint32_t(mesh_.positions.size());
        const float from = beyond(mesh_.positions[a]), to = beyond(mesh_.positions[b]), t = from / (from - to);
        glm::vec3 p = glm::mix(mesh_.positions[a], mesh_.positions[b], t);
        p[axis_] = limit_;
        mesh_.positions.push_back(p);
        if (!mesh_.normals.empty()) {
            const glm::vec3 n = glm::mix(mesh_.normals[a], mesh_.normals[b], t);
            const float length = glm::length(n);
            mesh_.normals.push_back(length > 0 ? n / length : n);
        }
        if (!mesh_.scalars.empty()) mesh_.scalars.push_back(glm::mix(mesh_.scalars[a], mesh_.scalars[b], t));
        return entry->second;
    }

    SurfaceMesh& mesh_;
    int axis_;
    float limit_, side_;
    std::unordered_map<std::uint64_t, std::uint32_t> made_;
};

} // namespace

glm::dvec3 originFor(const Box& box) {
    constexpr double kFar = 16; // extents: a cell of a thousand is then still known to a thousandth
    glm::dvec3 size = box.size(), origin(0);
    const double extent = std::max({size.x, size.y, size.z});
    const glm::dvec3 most = glm::max(glm::abs(box.lo), glm::abs(box.hi));
    if (!(extent > 0) || !(std::max({most.x, most.y, most.z}) > kFar * extent)) return origin;
    const double step = std::pow(10.0, std::floor(std::log10(extent)));
    for (int axis = 0; axis < 3; ++axis) origin[axis] = std::round(0.5 * (box.lo[axis] + box.hi[axis]) / step) * step;
    return origin;
}

std::vector<glm::vec3> faceNormals(const SurfaceMesh& mesh) {
    std::vector<glm::dvec3> sums(mesh.positions.size(), glm::dvec3(0));
    for (const glm::uvec3& triangle : mesh.triangles) {
        const auto at = [&](int i) { return glm::dvec3(mesh.positions[triangle[i]]); };
        const glm::dvec3 area = glm::cross(at(1) - at(0), at(2) - at(0));
        for (int i = 0; i < 3; ++i) sums[triangle[i]] += area;
    }
    std::vector<glm::vec3> normals;
    normals.reserve(sums.size());
    for (const glm::dvec3& sum : sums) {
        const double length = glm::length(sum);
        normals.emplace_back(length > 0 ? sum / length : glm::dvec3(0));
    }
    return normals;
}

void removeUnused(SurfaceMesh& mesh) {
    std::vector<std::uint32_t> place(mesh.positions.size(), kUnused);
    for (const glm::uvec3& triangle : mesh.triangles)
        for (int i = 0; i < 3; ++i) place[triangle[i]] = 0;
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < place.size(); ++i) {
        if (place[i] == kUnused) continue;
        place[i] = count;
        mesh.positions[count] = mesh.positions[i];
        if (!mesh.normals.empty()) mesh.normals[count] = mesh.normals[i];
        if (!mesh.scalars.empty()) mesh.scalars[count] = mesh.scalars[i];
        ++count;
    }
    mesh.positions.resize(count);
    if (!mesh.normals.empty()) mesh.normals.resize(count);
    if (!mesh.scalars.empty()) mesh.scalars.resize(count);
    for (glm::uvec3& triangle : mesh.triangles)
        for (int i = 0; i < 3; ++i) triangle[i] = place[triangle[i]];
}

void clipToBox(SurfaceMesh& mesh, const Box& box) {
    for (int axis = 0; axis < 3; ++axis) {
        PlaneCut(mesh, axis, float(box.lo[axis] - mesh.origin[axis]), -1).run();
        PlaneCut(mesh, axis, float(box.hi[axis] - mesh.origin[axis]), 1).run();
    }
    removeUnused(mesh);
}

} // namespace tessera::volume
