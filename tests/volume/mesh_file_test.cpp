#include "volume/mesh/mesh_file.h"

#include "volume/base/error.h"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>
#include <unistd.h>

namespace tessera::volume {
namespace {

SurfaceMesh tetrahedron() {
    SurfaceMesh mesh;
    mesh.positions = {{0, 0, 0}, {1.5f, 0, 0}, {0, 2.25f, 0}, {0.1f, 0, 1e-7f}};
    mesh.normals = {{-1, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.scalars = {1, 2.5f, -3, 0.1f};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    return mesh;
}

class MeshFile : public ::testing::Test {
protected:
    std::string path(const std::string& ending) {
        return (std::filesystem::temp_directory_path() / ("mesh-" + std::to_string(getpid()) + ending)).string();
    }
    /// Writes, reads all bytes back, removes.
    std::string bytesOf(const SurfaceMesh& mesh, const std::string& ending) {
        writeMesh(mesh, path(ending), "O2 (mol)");
        std::ifstream file(path(ending), std::ios::binary);
        std::stringstream all;
        all << file.rdbuf();
        std::filesystem::remove(path(ending));
        return all.str();
    }
};

/// Plain readers of the formats, as their descriptions have them.
struct Bytes {
    const std::string& text;
    std::size_t at = 0;
    template <class T> T take() {
        T value;
        if (at + sizeof(T) > text.size()) throw std::runtime_error("too short");
        std::memcpy(&value, text.data() + at, sizeof(T));
        at += sizeof(T);
        return value;
    }
    glm::vec3 vector() {
        const float x = take<float>(), y = take<float>(), z = take<float>();
        return {x, y, z};
    }
};

TEST_F(MeshFile, PlyHoldsEverything) {
    const SurfaceMesh mesh = tetrahedron();
    const std::string text = bytesOf(mesh, ".ply");
    const std::size_t end = text.find("end_header\n");
    ASSERT_NE(end, std::string::npos);
    EXPECT_TRUE(text.starts_with("ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\n"));
    EXPECT_NE(text.find("property float O2__mol_\nelement face 4\nproperty list uchar uint vertex_indices\n"),
              std::string::npos);
    Bytes bytes{text, end + 11};
    SurfaceMesh read;
    for (int i = 0; i < 4; ++i) {
        read.positions.push_back(bytes.vector());
        read.normals.push_back(bytes.vector());
        read.scalars.push_back(bytes.take<float>());
    }
    for (int i = 0; i < 4; ++i) {
        EXPECT_EQ(bytes.take<std::uint8_t>(), 3);
        const auto a = bytes.take<std::uint32_t>(), b = bytes.take<std::uint32_t>(), c = bytes.take<std::uint32_t>();
        read.triangles.emplace_back(a, b, c);
    }
    EXPECT_EQ(bytes.at, text.size());
    EXPECT_EQ(read, mesh);
}

TEST_F(MeshFile, StlHoldsTheTriangles) {
    const SurfaceMesh mesh = tetrahedron();
    const std::string text = bytesOf(mesh, ".stl");
    ASSERT_EQ(text.size(), 84u + 4 * 50);
    EXPECT_FALSE(text.starts_with("solid")); // that would mean text
    Bytes bytes{text, 80};
    ASSERT_EQ(bytes.take<std::uint32_t>(), 4u);
    for (const glm::uvec3& triangle : mesh.triangles) {
        const glm::vec3 normal = bytes.vector();
        if (triangle == glm::uvec3(0, 2, 1)) {
            EXPECT_EQ(normal, glm::vec3(0, 0, -1));
        }
        for (int c = 0; c < 3; ++c) EXPECT_EQ(bytes.vector(), mesh.positions[triangle[c]]);
        EXPECT_EQ(bytes.take<std::uint16_t>(), 0);
    }
}

TEST_F(MeshFile, ObjHoldsPositionsNormalsAndTriangles) {
    const SurfaceMesh mesh = tetrahedron();
    std::istringstream lines(bytesOf(mesh, ".obj"));
    SurfaceMesh read;
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string key;
        words >> key;
        if (key == "v" || key == "vn") {
            glm::vec3 v;
            words >> v.x >> v.y >> v.z;
            (key == "v" ? read.positions : read.normals).push_back(v);
        } else {
            ASSERT_EQ(key, "f");
            glm::uvec3 triangle;
            for (int c = 0; c < 3; ++c) {
                std::uint32_t normal = 0;
                char slash = 0;
                words >> triangle[c] >> slash >> slash >> normal;
                EXPECT_EQ(normal, triangle[c]);
                --triangle[c];
            }
            read.triangles.push_back(triangle);
        }
    }
    read.scalars = mesh.scalars; // not in the format
    EXPECT_EQ(read, mesh);
}

TEST_F(MeshFile, VtpHoldsEverything) {
    const SurfaceMesh mesh = tetrahedron();
    const std::string text = bytesOf(mesh, ".vtp");
    EXPECT_NE(text.find("NumberOfPoints=\"4\""), std::string::npos);
    EXPECT_NE(text.find("NumberOfPolys=\"4\""), std::string::npos);
    const std::size_t data = text.find("<AppendedData encoding=\"raw\">\n_") + 31;
    const auto block = [&](const std::string& name, std::size_t bytes) {
        const std::size_t array = text.find("Name=\"" + name + "\"");
        EXPECT_NE(array, std::string::npos) << name;
        const std::size_t offset = text.find("offset=\"", array) + 8;
        Bytes found{text, data + std::stoul(text.substr(offset))};
        EXPECT_EQ(found.take<std::uint64_t>(), bytes) << name;
        return found;
    };
    Bytes points = block("Points", 48), normals = block("Normals", 48), scalars = block("O2__mol_", 16),
          connectivity = block("connectivity", 48), offsets = block("offsets", 32);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(points.vector(), mesh.positions[i]);
        EXPECT_EQ(normals.vector(), mesh.normals[i]);
        EXPECT_EQ(scalars.take<float>(), mesh.scalars[i]);
        for (int c = 0; c < 3; ++c) EXPECT_EQ(connectivity.take<std::uint32_t>(), mesh.triangles[i][c]);
        EXPECT_EQ(offsets.take<std::int64_t>(), std::int64_t(3 * (i + 1)));
    }
    EXPECT_TRUE(text.ends_with("</VTKFile>\n"));
}

TEST_F(MeshFile, AppearsWholeOrNotAtAll) {
    EXPECT_THROW(writeMesh(tetrahedron(), path(".xyz")), Error);
    EXPECT_FALSE(std::filesystem::exists(path(".xyz")));
    EXPECT_THROW(writeMesh(tetrahedron(), "/nonexistent/folder/a.ply"), MachineError);
    const std::string empty = bytesOf({}, ".stl");
    EXPECT_EQ(empty.size(), 84u);
}

// A mesh with an origin keeps its digits where a format has them.
TEST_F(MeshFile, FarFromZeroPositionsHave64Bits) {
    SurfaceMesh mesh = tetrahedron();
    mesh.origin = {500000, -5000000.25, 0};
    const auto placeOf = [&](std::size_t i) { return mesh.origin + glm::dvec3(mesh.positions[i]); };
    const std::string ply = bytesOf(mesh, ".ply"), vtp = bytesOf(mesh, ".vtp"), obj = bytesOf(mesh, ".obj"),
                      stl = bytesOf(mesh, ".stl");
    const auto vector = [](Bytes& bytes) {
        const double x = bytes.take<double>(), y = bytes.take<double>(), z = bytes.take<double>();
        return glm::dvec3(x, y, z);
    };
    EXPECT_NE(ply.find("property double x\nproperty double y\nproperty double z\nproperty float nx"),
              std::string::npos);
    Bytes ofPly{ply, ply.find("end_header\n") + 11};
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(vector(ofPly), placeOf(i));
        EXPECT_EQ(ofPly.vector(), mesh.normals[i]);
        EXPECT_EQ(ofPly.take<float>(), mesh.scalars[i]);
    }
    EXPECT_EQ(ofPly.take<std::uint8_t>(), 3) << "triangles follow";

    const std::string head = "type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\" format=\"appended\" offset=\"";
    ASSERT_NE(vtp.find(head), std::string::npos);
    Bytes ofVtp{vtp,
                vtp.find("_", vtp.find("AppendedData")) + 1 + std::stoul(vtp.substr(vtp.find(head) + head.size()))};
    EXPECT_EQ(ofVtp.take<std::uint64_t>(), 4 * 24u);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(vector(ofVtp), placeOf(i));
    EXPECT_EQ(ofVtp.take<std::uint64_t>(), 4 * 12u) << "triangles follow";

    std::istringstream lines(obj);
    for (std::size_t i = 0; i < 4; ++i) {
        std::string key;
        glm::dvec3 v;
        lines >> key >> v.x >> v.y >> v.z;
        EXPECT_EQ(key, "v");
        EXPECT_EQ(v, placeOf(i));
    }

    EXPECT_EQ(meshShift(mesh, "a.stl"), "32-bit coordinates, less (500000, -5000000.25, 0)");
    EXPECT_EQ(meshShift(mesh, "a.ply"), "");
    EXPECT_EQ(meshShift(tetrahedron(), "a.stl"), "");
    EXPECT_NE(stl.substr(0, 80).find("less (500000, -5000000.25, 0)"), std::string::npos);
    Bytes ofStl{stl, 84 + 12};
    EXPECT_EQ(ofStl.vector(), mesh.positions[mesh.triangles[0].x]);
}

} // namespace
} // namespace tessera::volume
