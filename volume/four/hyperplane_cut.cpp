#include "volume/four/hyperplane_cut.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <unordered_map>

namespace tessera::volume {

namespace {

/// The vector whose product with any other is the determinant of the three and that one.
glm::dvec4 crossOf(const glm::dvec4& a, const glm::dvec4& b, const glm::dvec4& c) {
    glm::dvec4 out;
    for (int i = 0; i < 4; ++i) {
        glm::dvec4 unit(0);
        unit[i] = 1;
        out[i] = glm::determinant(glm::dmat4(a, b, c, unit));
    }
    return out;
}

class Cutter4 {
public:
    Cutter4(const TetraMesh& mesh, glm::dvec4 normal, double offset) : mesh_(mesh), normal_(normal) {
        double most = -std::numeric_limits<double>::infinity();
        for (const glm::dvec4& point : mesh.points) {
            distances_.push_back(glm::dot(normal, point) - offset);
            most = std::max(most, distances_.back());
        }
        endsHere_ = most == 0;
    }

    TriangleMesh4 cut() {
        for (const glm::uvec4& tetrahedron : mesh_.tetrahedra) add(tetrahedron);
        return std::move(out_);
    }

private:
    bool isAbove(std::uint32_t point) const { return endsHere_ ? distances_[point] >= 0 : distances_[point] > 0; }

    void add(glm::uvec4 tetrahedron) {
        std::array<std::uint32_t, 4> sorted{tetrahedron.x, tetrahedron.y, tetrahedron.z, tetrahedron.w};
        std::ranges::sort(sorted);
        std::vector<std::uint32_t>& above = above_;
        std::vector<std::uint32_t>& below = below_;
        above.clear();
        below.clear();
        for (const std::uint32_t point : sorted) (isAbove(point) ? above : below).push_back(point);
        if (above.empty() || below.empty()) return;
        const auto at = [&](int i) { return mesh_.points[tetrahedron[i]]; };
        const glm::dvec4 down = crossOf(at(1) - at(0), at(2) - at(0), at(3) - at(0));
        const auto crossing = [&](std::size_t a, std::size_t b) { return vertex(below[b], above[a]); };
        if (above.size() == 2) {
            // Cut along the diagonal between both first and both last corners, as faces of simplices are.
            const std::uint32_t first = crossing(0, 0), last = crossing(1, 1);
            addTriangle({first, crossing(0, 1), last}, down);
            addTriangle({first, crossing(1, 0), last}, down);
        } else if (above.size() == 1) {
            addTriangle({crossing(0, 0), crossing(0, 1), crossing(0, 2)}, down);
        } else {
            addTriangle({crossing(0, 0), crossing(1, 0), crossing(2, 0)}, down);
        }
    }

    void addTriangle(glm::uvec3 triangle, const glm::dvec4& down) {
        // Corners in the hyperplane itself are one vertex for all edges that end there.
        if (triangle.x == triangle.y || triangle.y == triangle.z || triangle.x == triangle.z) return;
        const auto at = [&](int i) { return out_.points[triangle[i]]; };
        if (glm::determinant(glm::dmat4(at(1) - at(0), at(2) - at(0), down, normal_)) < 0)
            std::swap(triangle.y, triangle.z);
        out_.triangles.push_back(triangle);
    }

    std::uint32_t vertex(std::uint32_t below, std::uint32_t above) {
        if (distances_[below] == 0) above = below;
        if (distances_[above] == 0) below = above;
        const auto [entry, isNew] =
            known_.try_emplace(std::uint64_t(below) << 32 | above, std::uint32_t(out_.points.size()));
        if (!isNew) return entry->second;
        const double from = distances_[below], to = distances_[above];
        const double share = below == above ? 0 : std::clamp(-from / (to - from), 0.0, 1.0);
        out_.points.push_back(glm::mix(mesh_.points[below], mesh_.points[above], share));
        return entry->second;
    }

    const TetraMesh& mesh_;
    glm::dvec4 normal_;
    std::vector<double> distances_;
    bool endsHere_ = false;
    std::vector<std::uint32_t> above_, below_; ///< of the tetrahedron at hand
    std::unordered_map<std::uint64_t, std::uint32_t> known_;
    TriangleMesh4 out_;
};

} // namespace

TriangleMesh4 cutByHyperplane(const TetraMesh& mesh, glm::dvec4 normal, double offset) {
    return Cutter4(mesh, normal, offset).cut();
}

SurfaceMesh cutAtTime(const TetraMesh& mesh, double time) {
    const TriangleMesh4 cut = cutByHyperplane(mesh, {0, 0, 0, 1}, time);
    SurfaceMesh out;
    if (cut.points.empty()) return out;
    Box box{glm::dvec3(cut.points.front()), glm::dvec3(cut.points.front())};
    for (const glm::dvec4& point : cut.points)
        box = {glm::min(box.lo, glm::dvec3(point)), glm::max(box.hi, glm::dvec3(point))};
    out.origin = originFor(box);
    for (const glm::dvec4& point : cut.points) out.positions.emplace_back(glm::dvec3(point) - out.origin);
    out.triangles = cut.triangles;
    out.normals = faceNormals(out);
    return out;
}

} // namespace tessera::volume
