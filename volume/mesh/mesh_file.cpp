#include "volume/mesh/mesh_file.h"

#include "volume/mesh/mesh_writer.h"

#include <cstdio>
#include <glm/geometric.hpp>

namespace tessera::volume {

namespace {

/// A name that is valid in text formats: letters, digits and _.
std::string word(const std::string& name) {
    std::string out;
    for (const char c : name) {
        const bool plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
        out += plain ? c : '_';
    }
    return out.empty() ? "value" : out;
}

bool isFar(const SurfaceMesh& mesh) {
    return mesh.origin != glm::dvec3(0);
}
/// A position in 32 bits, or with an origin in 64.
void writePlace(MeshWriter& out, const SurfaceMesh& mesh, std::size_t vertex) {
    if (!isFar(mesh)) return out.vector(mesh.positions[vertex]);
    const glm::dvec3 place = placeOf(mesh, vertex);
    for (int c = 0; c < 3; ++c) out.raw(place[c]);
}

void writePly(MeshWriter& out, const SurfaceMesh& mesh, const std::string& scalarName) {
    const std::string property = isFar(mesh) ? "\nproperty double " : "\nproperty float ";
    out.text("ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(mesh.positions.size()) +
             property + "x" + property + "y" + property + "z\n");
    if (!mesh.normals.empty()) out.text("property float nx\nproperty float ny\nproperty float nz\n");
    if (!mesh.scalars.empty()) out.text("property float " + word(scalarName) + "\n");
    out.text("element face " + std::to_string(mesh.triangles.size()) +
             "\nproperty list uchar uint vertex_indices\nend_header\n");
    out.each(mesh.positions.size(), [&](std::size_t i) {
        writePlace(out, mesh, i);
        if (!mesh.normals.empty()) out.vector(mesh.normals[i]);
        if (!mesh.scalars.empty()) out.raw(mesh.scalars[i]);
    });
    out.each(mesh.triangles.size(), [&](std::size_t i) {
        out.raw(std::uint8_t(3));
        for (int c = 0; c < 3; ++c) out.raw(std::uint32_t(mesh.triangles[i][c]));
    });
}

void writeStl(MeshWriter& out, const SurfaceMesh& mesh) {
    std::string header = "binary STL";
    if (const std::string shift = meshShift(mesh, ".stl"); !shift.empty()) header += ", " + shift;
    header.resize(80, ' ');
    out.text(header);
    out.raw(std::uint32_t(mesh.triangles.size()));
    out.each(mesh.triangles.size(), [&](std::size_t i) {
        const glm::uvec3 t = mesh.triangles[i];
        const glm::vec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
        const glm::dvec3 normal = glm::cross(glm::dvec3(b - a), glm::dvec3(c - a));
        const double length = glm::length(normal);
        out.vector(length > 0 ? glm::vec3(normal / length) : glm::vec3(0));
        out.vector(a);
        out.vector(b);
        out.vector(c);
        out.raw(std::uint16_t(0));
    });
}

void writeObj(MeshWriter& out, const SurfaceMesh& mesh) {
    const auto line = [&](std::string_view key, const auto& v) {
        out.text(key);
        for (int i = 0; i < 3; ++i) {
            out.text(" ");
            out.number(v[i]);
        }
        out.text("\n");
    };
    out.each(mesh.positions.size(),
             [&](std::size_t i) { isFar(mesh) ? line("v", placeOf(mesh, i)) : line("v", mesh.positions[i]); });
    out.each(mesh.normals.size(), [&](std::size_t i) { line("vn", mesh.normals[i]); });
    out.each(mesh.triangles.size(), [&](std::size_t i) {
        out.text("f");
        for (int c = 0; c < 3; ++c) {
            const std::uint32_t number = mesh.triangles[i][c] + 1;
            out.text(" ");
            out.number(number);
            if (mesh.normals.empty()) continue;
            out.text("//");
            out.number(number);
        }
        out.text("\n");
    });
}

void writeVtp(MeshWriter& out, const SurfaceMesh& mesh, const std::string& scalarName) {
    const std::uint64_t points = mesh.positions.size(), triangles = mesh.triangles.size();
    std::uint64_t offset = 0;
    const auto array = [&](const std::string& type, const std::string& name, int components, std::uint64_t bytes) {
        out.text("<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
                 std::to_string(components) + "\" format=\"appended\" offset=\"" + std::to_string(offset) + "\"/>\n");
        offset += sizeof(std::uint64_t) + bytes;
    };
    out.text("<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
             "header_type=\"UInt64\">\n<PolyData>\n<Piece NumberOfPoints=\"" +
             std::to_string(points) +
             "\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
             "NumberOfPolys=\"" +
             std::to_string(triangles) + "\">\n<PointData");
    if (!mesh.normals.empty()) out.text(" Normals=\"Normals\"");
    if (!mesh.scalars.empty()) out.text(" Scalars=\"" + word(scalarName) + "\"");
    out.text(">\n");
    if (!mesh.normals.empty()) array("Float32", "Normals", 3, points * 12);
    if (!mesh.scalars.empty()) array("Float32", word(scalarName), 1, points * 4);
    out.text("</PointData>\n<Points>\n");
    const std::uint64_t pointBytes = isFar(mesh) ? points * 24 : points * 12;
    array(isFar(mesh) ? "Float64" : "Float32", "Points", 3, pointBytes);
    out.text("</Points>\n<Polys>\n");
    array("UInt32", "connectivity", 1, triangles * 12);
    array("Int64", "offsets", 1, triangles * 8);
    out.text("</Polys>\n</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_");
    if (!mesh.normals.empty()) {
        out.raw(points * 12);
        out.each(points, [&](std::size_t i) { out.vector(mesh.normals[i]); });
    }
    if (!mesh.scalars.empty()) {
        out.raw(points * 4);
        out.each(points, [&](std::size_t i) { out.raw(mesh.scalars[i]); });
    }
    out.raw(pointBytes);
    out.each(points, [&](std::size_t i) { writePlace(out, mesh, i); });
    out.raw(triangles * 12);
    out.each(triangles, [&](std::size_t i) {
        for (int c = 0; c < 3; ++c) out.raw(std::uint32_t(mesh.triangles[i][c]));
    });
    out.raw(triangles * 8);
    out.each(triangles, [&](std::size_t i) { out.raw(std::int64_t(3 * (i + 1))); });
    out.text("\n</AppendedData>\n</VTKFile>\n");
}

} // namespace

std::string meshShift(const SurfaceMesh& mesh, const std::string& path) {
    if (!isFar(mesh) || !path.ends_with(".stl")) return {};
    char text[128];
    std::snprintf(text, sizeof text, "32-bit coordinates, less (%.10g, %.10g, %.10g)", mesh.origin.x, mesh.origin.y,
                  mesh.origin.z);
    return text;
}

void writeMesh(const SurfaceMesh& mesh, const std::string& path, const std::string& scalarName,
               const Progress& progress) {
    const auto ends = [&](std::string_view ending) { return std::string_view(path).ends_with(ending); };
    if (mesh.triangles.size() >= 0xffffffffu && ends(".stl")) throw Error("too many triangles for STL", path);
    if (!ends(".ply") && !ends(".stl") && !ends(".obj") && !ends(".vtp"))
        throw Error("meshes are written as .ply, .stl, .obj or .vtp", path);
    MeshWriter out(path, progress);
    if (ends(".ply")) writePly(out, mesh, scalarName);
    if (ends(".stl")) writeStl(out, mesh);
    if (ends(".obj")) writeObj(out, mesh);
    if (ends(".vtp")) writeVtp(out, mesh, scalarName);
    out.commit();
}

} // namespace tessera::volume
