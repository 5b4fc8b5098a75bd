#include "vis/lic/surface_strokes.h"

#include "vis/lic/make_strokes.h"
#include "vis/scene/camera.h"
#include "volume/base/parallel.h"
#include "volume/mesh/finer_mesh.h"
#include "volume/reconstruct/probe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <unordered_map>

namespace tessera::vis {

namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kVertexBlock = 4096; ///< vertices that are sampled in one go
constexpr int kMostCrossings = 64;         ///< of edges in one step: where lines of two triangles meet at their edge
constexpr double kVerticesPerArea = 3;     ///< of a mesh whose edges were halved down to 1

/// Runs over the triangles of a field, in the direction of its vectors or against it.
class SurfaceWalker {
public:
    SurfaceWalker(const SurfaceField& field, const std::vector<glm::ivec3>& neighbours)
        : field_(field), neighbours_(neighbours) {}

    /// Moves a point by a length along the line, over as many edges as lie in between; false where it ends before.
    bool go(SurfacePlace& at, double length, double way) const {
        int from = -1; // the edge over which the triangle was entered
        for (int crossings = 0; crossings < kMostCrossings; ++crossings) {
            const std::optional<glm::dvec3> along = direction(at, way);
            if (!along) return false;
            const auto [edge, room] = nextEdge(at, *along, from);
            if (edge < 0 || room >= length) {
                at.place += *along * length;
                return true;
            }
            at.place += *along * room;
            length -= room;
            const int next = neighbours_[at.triangle][edge];
            if (next < 0) return false;
            from = edgeTowards(std::uint32_t(next), at.triangle);
            at.triangle = std::uint32_t(next);
        }
        return false;
    }

private:
    glm::dvec3 corner(std::uint32_t triangle, int i) const { return field_.places[field_.triangles[triangle][i]]; }

    glm::dvec3 normal(std::uint32_t triangle) const {
        const glm::dvec3 first = corner(triangle, 0);
        return glm::cross(corner(triangle, 1) - first, corner(triangle, 2) - first);
    }

    /// Of length 1, in the plane of the triangle; nothing where the vector is absent, 0 or across the surface.
    std::optional<glm::dvec3> direction(const SurfacePlace& at, double way) const {
        const glm::dvec3 across = normal(at.triangle);
        const double square = glm::dot(across, across);
        if (!(square > 0)) return std::nullopt;
        glm::dvec3 vector(0);
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3 a = corner(at.triangle, (i + 1) % 3) - at.place;
            const glm::dvec3 b = corner(at.triangle, (i + 2) % 3) - at.place;
            vector += field_.vectors[field_.triangles[at.triangle][i]] * (glm::dot(glm::cross(a, b), across) / square);
        }
        const double whole = glm::length(vector);
        vector -= across * (glm::dot(vector, across) / square);
        const double length = glm::length(vector);
        if (!(length > 1e-9 * whole)) return std::nullopt; // also where it is no number
        return vector * (way / length);
    }

    /// The edge that a line leaves the triangle over, and how far it is; not the one that it came over.
    std::pair<int, double> nextEdge(const SurfacePlace& at, glm::dvec3 along, int from) const {
        const glm::dvec3 across = normal(at.triangle);
        int found = -1;
        double room = std::numeric_limits<double>::infinity();
        for (int i = 0; i < 3; ++i) {
            if (i == from) continue;
            const glm::dvec3 a = corner(at.triangle, i),
                             inwards = glm::cross(across, corner(at.triangle, (i + 1) % 3) - a);
            const double speed = -glm::dot(along, inwards);
            if (!(speed > 0)) continue;
            const double until = std::max(0.0, glm::dot(at.place - a, inwards) / speed);
            if (until < room) found = i, room = until;
        }
        return {found, room};
    }

    int edgeTowards(std::uint32_t triangle, std::uint32_t other) const {
        for (int i = 0; i < 3; ++i)
            if (neighbours_[triangle][i] == int(other)) return i;
        return -1;
    }

    const SurfaceField& field_;
    const std::vector<glm::ivec3>& neighbours_;
};

/// The vector as drawn and its physical speed in the surface, at the vertices of a mesh.
struct SurfaceVectors {
    std::vector<glm::dvec3> drawn;
    std::vector<double> speeds;
};

SurfaceVectors vectorsAt(const volume::SurfaceMesh& mesh, const volume::BrickSource& source, int parameter, int time,
                         const WorldFrame& frame, const Progress& progress) {
    const volume::DatasetInfo& info = source.info();
    const volume::Lattice& lattice = info.lattice;
    SurfaceVectors out;
    const std::size_t count = mesh.positions.size();
    out.drawn.assign(count, glm::dvec3(kNoNumber));
    out.speeds.assign(count, 0);
    const std::size_t blocks = (count + kVertexBlock - 1) / kVertexBlock;
    parallelFor(blocks, [&](std::size_t block) {
        if (progress.stop.stop_requested()) throw Cancelled();
        const std::size_t begin = block * kVertexBlock, end = std::min(begin + kVertexBlock, count);
        std::vector<glm::dvec3> places;
        for (std::size_t i = begin; i < end; ++i)
            places.push_back(glm::clamp(lattice.axes.toSpace(mesh.origin + glm::dvec3(mesh.positions[i])),
                                        info.bounds.lo, info.bounds.hi));
        std::array<std::vector<volume::ProbeValue>, 3> found;
        for (int c = 0; c < 3; ++c)
            found[std::size_t(c)] = volume::probeAlong(source, info.channelIndex(parameter, c), places, time);
        for (std::size_t i = begin; i < end; ++i) {
            glm::dvec3 vector;
            for (int c = 0; c < 3; ++c) vector[c] = found[std::size_t(c)][i - begin].interpolated.value_or(kNoNumber);
            const glm::dvec3 drawn = frame.scale * (glm::abs(lattice.spacing) / lattice.lengthsAt(places[i - begin]));
            // Without its part along the normal of the surface, which differs from those of its triangles.
            const glm::dvec3 normal = glm::dvec3(mesh.normals[i]) / frame.scale, world = vector * drawn;
            const double length = glm::dot(normal, normal);
            out.drawn[i] = length > 0 ? world - normal * (glm::dot(world, normal) / length) : world;
            const glm::dvec3 across = glm::dvec3(mesh.normals[i]) / frame.scale * drawn;
            const double square = glm::dot(across, across);
            const glm::dvec3 along = square > 0 ? vector - across * (glm::dot(vector, across) / square) : vector;
            if (const double speed = glm::length(along); speed > 0) out.speeds[i] = speed;
        }
    });
    progress.advance(1);
    return out;
}

} // namespace

double spaceNoise(glm::dvec3 place, std::uint32_t seed) {
    const glm::dvec3 low = glm::floor(place), share = place - low;
    const glm::ivec3 first(low);
    double rows[4];
    for (int row = 0; row < 4; ++row) {
        const int y = first.y + (row & 1), z = first.z + (row >> 1);
        rows[row] = std::lerp(noiseAt({first.x, y, z}, seed), noiseAt({first.x + 1, y, z}, seed), share.x);
    }
    return std::lerp(std::lerp(rows[0], rows[1], share.y), std::lerp(rows[2], rows[3], share.y), share.z);
}

std::vector<glm::ivec3> neighboursOf(const std::vector<glm::uvec3>& triangles) {
    std::vector<glm::ivec3> out(triangles.size(), glm::ivec3(-1));
    std::unordered_map<std::uint64_t, std::pair<std::uint32_t, int>> open; // edges of which one side is known
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (int i = 0; i < 3; ++i) {
            const auto [a, b] = std::minmax(triangles[t][i], triangles[t][(i + 1) % 3]);
            const auto [entry, fresh] = open.try_emplace(std::uint64_t(a) << 32 | b, std::pair(std::uint32_t(t), i));
            if (fresh) continue;
            const auto [other, edge] = entry->second;
            out[t][i] = int(other);
            out[other][edge] = int(t);
            open.erase(entry);
        }
    return out;
}

std::vector<glm::dvec3> lineOnSurface(const SurfaceField& field, const std::vector<glm::ivec3>& neighbours,
                                      const SurfacePlace& point, double step, double half, std::size_t& start) {
    const SurfaceWalker walker(field, neighbours);
    std::vector<glm::dvec3> line;
    for (const double way : {-1.0, 1.0}) {
        SurfacePlace at = point;
        for (double gone = 0; gone + step <= half * (1 + 1e-9) && walker.go(at, step, way); gone += step)
            line.push_back(at.place);
        if (way > 0) break;
        std::ranges::reverse(line);
        start = line.size();
        line.push_back(point.place);
    }
    return line;
}

std::vector<float> surfaceConvolution(const SurfaceField& field, const std::vector<SurfacePlace>& points, double grain,
                                      double length, StrokeKernel kernel, std::uint32_t seed,
                                      const Progress& progress) {
    const std::vector<glm::ivec3> neighbours = neighboursOf(field.triangles);
    const double step = grain / 2, half = std::max(length / 2, 0.0);
    std::vector<float> out(points.size());
    const auto convolve = [&](const SurfacePlace& point) {
        const glm::uvec3 corners = field.triangles[point.triangle];
        for (int i = 0; i < 3; ++i)
            if (std::isnan(field.vectors[corners[i]].x)) return std::numeric_limits<float>::quiet_NaN();
        std::size_t start = 0;
        const std::vector<glm::dvec3> line = lineOnSurface(field, neighbours, point, step, half, start);
        double sum = 0, squares = 0;
        for (std::size_t i = 0; i < line.size(); ++i) {
            const double gone = double(i > start ? i - start : start - i) * step;
            const double weight = kernelWeight(half > 0 ? gone / half : 0, kernel);
            sum += weight * spaceNoise(line[i] / grain, seed);
            squares += weight * weight;
        }
        return float(sum / std::sqrt(squares));
    };
    const std::size_t blocks = (points.size() + kVertexBlock - 1) / kVertexBlock;
    parallelFor(blocks, [&](std::size_t block) {
        if (progress.stop.stop_requested()) throw Cancelled();
        for (std::size_t i = block * kVertexBlock; i < std::min((block + 1) * kVertexBlock, points.size()); ++i)
            out[i] = convolve(points[i]);
    });
    progress.advance(1);
    stretchContrast(out);
    return out;
}

void addStrokes(Geometry& geometry, const volume::BrickSource& source, int time, const Strokes& strokes,
                glm::dvec3 stretch, std::size_t mostVertices, const Progress& progress) {
    const std::optional<int> parameter = vectorNamed(source.info(), strokes.vector);
    if (!parameter || geometry.mesh.triangles.empty()) return;
    const WorldFrame frame = worldFrame(source.info(), stretch);
    volume::SurfaceMesh coarse = std::move(geometry.mesh);
    if (coarse.normals.empty()) coarse.normals = volume::faceNormals(coarse);
    const SurfaceVectors vectors = vectorsAt(coarse, source, *parameter, time, frame, progress.part(0, 0.2));
    double grain = double(strokes.width);
    const double area = volume::areaOf(coarse, frame.scale);
    const double wanted = kVerticesPerArea * area / (grain * grain / 4),
                 factor = std::sqrt(wanted / double(mostVertices));
    if (factor > 1) {
        grain *= factor;
        char text[64];
        std::snprintf(text, sizeof text, "%.1f times as wide as set", factor);
        geometry.notes.push_back("strokes along " + strokes.vector + " on a large surface: " + text);
    }
    volume::FinerMesh fine = volume::finerMesh(coarse, frame.scale, grain / 2);
    SurfaceField field{{}, coarse.triangles, vectors.drawn};
    for (const glm::vec3& position : coarse.positions)
        field.places.push_back(frame.sheetToWorld(coarse.origin + glm::dvec3(position)));
    std::vector<SurfacePlace> points;
    points.reserve(fine.parents.size());
    for (std::size_t i = 0; i < fine.parents.size(); ++i)
        points.push_back({fine.parents[i], frame.sheetToWorld(coarse.origin + glm::dvec3(fine.mesh.positions[i]))});
    geometry.strokes = surfaceConvolution(field, points, grain, double(strokes.length), strokes.kernel,
                                          std::uint32_t(strokes.random), progress.part(0.3, 1));
    const double fastest = *std::ranges::max_element(vectors.speeds);
    for (std::size_t i = 0; i < geometry.strokes.size(); ++i) {
        float& lightness = geometry.strokes[i];
        if (std::isnan(lightness)) lightness = 0;
        if (!strokes.bySpeed || !(fastest > 0)) continue;
        // Of the corners of its triangle, each by how near it is.
        double sum = 0, weights = 0;
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t corner = coarse.triangles[points[i].triangle][k];
            const double weight = 1 / (1e-12 + glm::distance(points[i].place, field.places[corner]));
            sum += weight * vectors.speeds[corner];
            weights += weight;
        }
        lightness *= float(sum / weights / fastest);
    }
    geometry.mesh = std::move(fine.mesh);
}

} // namespace tessera::vis
