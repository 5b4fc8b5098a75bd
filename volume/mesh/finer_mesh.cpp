#include "volume/mesh/finer_mesh.h"

#include "volume/base/error.h"

#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <unordered_map>

namespace tessera::volume {

namespace {

constexpr std::uint32_t kWhole = 0xffffffffu; ///< no vertex: an edge that is short enough
constexpr int kMostHalvings = 24;             ///< of an edge, in case of positions that are no numbers

class Refiner {
public:
    Refiner(const SurfaceMesh& mesh, glm::dvec3 scale, double edge) : scale_(scale), square_(edge * edge) {
        out_.mesh = mesh;
        out_.parents.assign(mesh.positions.size(), 0);
        parents_.resize(mesh.triangles.size());
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            parents_[t] = std::uint32_t(t);
            for (int i = 0; i < 3; ++i) out_.parents[mesh.triangles[t][i]] = std::uint32_t(t);
        }
    }

    FinerMesh run() {
        for (int turn = 0; turn < kMostHalvings && halve(); ++turn) {
        }
        return std::move(out_);
    }

private:
    /// Halves all edges that are too long; false if there are none.
    bool halve() {
        middles_.clear();
        std::vector<glm::uvec3> triangles;
        std::vector<std::uint32_t> parents;
        const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t parent) {
            triangles.emplace_back(a, b, c);
            parents.push_back(parent);
        };
        bool any = false;
        for (std::size_t t = 0; t < out_.mesh.triangles.size(); ++t) {
            glm::uvec3 v = out_.mesh.triangles[t];
            const std::uint32_t parent = parents_[t];
            std::array<std::uint32_t, 3> middle{};
            int count = 0;
            for (int i = 0; i < 3; ++i) {
                middle[std::size_t(i)] = middleOf(v[i], v[(i + 1) % 3], parent);
                count += middle[std::size_t(i)] != kWhole;
            }
            any = any || count > 0;
            // Turned so that the first edge is halved, and of two the second one, too.
            for (int turn = 0; turn < 2; ++turn)
                if (count > 0 && (middle[0] == kWhole || (count == 2 && middle[1] == kWhole))) {
                    v = {v.y, v.z, v.x};
                    std::ranges::rotate(middle, middle.begin() + 1);
                }
            if (count == 0) {
                add(v.x, v.y, v.z, parent);
            } else if (count == 1) {
                add(v.x, middle[0], v.z, parent);
                add(middle[0], v.y, v.z, parent);
            } else {
                add(middle[0], v.y, middle[1], parent);
                if (count == 2) {
                    add(v.x, middle[0], middle[1], parent);
                    add(v.x, middle[1], v.z, parent);
                } else {
                    add(v.x, middle[0], middle[2], parent);
                    add(middle[2], middle[1], v.z, parent);
                    add(middle[0], middle[1], middle[2], parent);
                }
            }
        }
        out_.mesh.triangles = std::move(triangles);
        parents_ = std::move(parents);
        return any;
    }

    std::uint32_t middleOf(std::uint32_t a, std::uint32_t b, std::uint32_t parent) {
        if (a > b) std::swap(a, b);
        SurfaceMesh& mesh = out_.mesh;
        const glm::dvec3 along = (glm::dvec3(mesh.positions[b]) - glm::dvec3(mesh.positions[a])) * scale_;
        if (!(glm::dot(along, along) > square_)) return kWhole;
        const auto [entry, fresh] =
            middles_.try_emplace(std::uint64_t(a) << 32 | b, std::uint32_t(mesh.positions.size()));
        if (!fresh) return entry->second;
        if (mesh.positions.size() >= kWhole) throw Error("the surface has more than 4 thousand million vertices");
        mesh.positions.push_back(glm::mix(mesh.positions[a], mesh.positions[b], 0.5f));
        if (!mesh.normals.empty()) {
            const glm::vec3 normal = mesh.normals[a] + mesh.normals[b];
            const float length = glm::length(normal);
            mesh.normals.push_back(length > 0 ? normal / length : glm::vec3(0));
        }
        if (!mesh.scalars.empty()) mesh.scalars.push_back(0.5f * (mesh.scalars[a] + mesh.scalars[b]));
        out_.parents.push_back(parent);
        return entry->second;
    }

    glm::dvec3 scale_;
    double square_;
    std::vector<std::uint32_t> parents_; ///< by triangle
    std::unordered_map<std::uint64_t, std::uint32_t> middles_;
    FinerMesh out_;
};

} // namespace

FinerMesh finerMesh(const SurfaceMesh& mesh, glm::dvec3 scale, double edge) {
    return Refiner(mesh, scale, edge).run();
}

double areaOf(const SurfaceMesh& mesh, glm::dvec3 scale) {
    double area = 0;
    for (const glm::uvec3& t : mesh.triangles) {
        const auto at = [&](int i) { return glm::dvec3(mesh.positions[t[i]]) * scale; };
        area += glm::length(glm::cross(at(1) - at(0), at(2) - at(0))) / 2;
    }
    return area;
}

} // namespace tessera::volume
