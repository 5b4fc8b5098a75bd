#include "volume/four/tetra_file.h"

#include "volume/mesh/mesh_writer.h"

namespace tessera::volume {

namespace {

/// A name inside the quotes of XML.
std::string quotedName(const std::string& name) {
    std::string out;
    for (const char c : name) {
        if (c == '&')
            out += "&amp;";
        else if (c == '<')
            out += "&lt;";
        else if (c == '"')
            out += "&quot;";
        else
            out += c;
    }
    return out;
}

} // namespace

void writeTetraMesh(const TetraMesh& mesh, const std::string& path, const std::string& timeName,
                    const Progress& progress) {
    if (!path.ends_with(kTetraEnding)) throw Error("surfaces in space and time are written as .vtu", path);
    constexpr std::uint8_t kVtkTetra = 10;
    const std::uint64_t points = mesh.points.size(), cells = mesh.tetrahedra.size();
    MeshWriter out(path, progress);
    std::uint64_t offset = 0;
    const auto array = [&](const std::string& type, const std::string& name, int components, std::uint64_t bytes) {
        out.text("<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
                 std::to_string(components) + "\" format=\"appended\" offset=\"" + std::to_string(offset) + "\"/>\n");
        offset += sizeof(std::uint64_t) + bytes;
    };
    const std::string time = quotedName(timeName);
    out.text("<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
             "header_type=\"UInt64\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"" +
             std::to_string(points) + "\" NumberOfCells=\"" + std::to_string(cells) + "\">\n<PointData Scalars=\"" +
             time + "\">\n");
    array("Float64", time, 1, points * 8);
    out.text("</PointData>\n<Points>\n");
    array("Float64", "Points", 3, points * 24);
    out.text("</Points>\n<Cells>\n");
    array("UInt32", "connectivity", 1, cells * 16);
    array("Int64", "offsets", 1, cells * 8);
    array("UInt8", "types", 1, cells);
    out.text("</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_");
    out.raw(points * 8);
    out.each(points, [&](std::size_t i) { out.raw(mesh.points[i].w); });
    out.raw(points * 24);
    out.each(points, [&](std::size_t i) {
        for (int c = 0; c < 3; ++c) out.raw(mesh.points[i][c]);
    });
    out.raw(cells * 16);
    out.each(cells, [&](std::size_t i) {
        for (int c = 0; c < 4; ++c) out.raw(std::uint32_t(mesh.tetrahedra[i][c]));
    });
    out.raw(cells * 8);
    out.each(cells, [&](std::size_t i) { out.raw(std::int64_t(4 * (i + 1))); });
    out.raw(cells);
    out.each(cells, [&](std::size_t) { out.raw(kVtkTetra); });
    out.text("\n</AppendedData>\n</VTKFile>\n");
    out.commit();
}

} // namespace tessera::volume
