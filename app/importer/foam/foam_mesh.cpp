#include "app/importer/foam/foam_mesh.h"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <unordered_set>

namespace tessera::importer {

namespace {

/// Runs `body` with a cursor on a file; what it throws gets the file's name.
template <class Body> void inFoamFile(const FoamPlace& place, const char* what, const Body& body) {
    if (place.path.empty()) throw std::runtime_error(std::string("has no file polyMesh/") + what);
    const FoamFile file = readFoamFile(place);
    try {
        FoamCursor in(file);
        body(in, file);
        in.expectEnd();
    } catch (const std::runtime_error& error) {
        throw std::runtime_error("its file " + place.shown + " " + error.what());
    }
}

/// A list cannot have more values than its file has bytes.
std::size_t mostIn(const FoamFile& file) {
    return file.bytes.size();
}

void readFaces(FoamCursor& in, const FoamFile& file, FoamMesh& mesh) {
    const std::size_t points = mesh.pointCount();
    if (file.kind == "faceCompactList") {
        const std::vector<std::int32_t> begins = in.labels(mostIn(file));
        mesh.facePoints = in.labels(mostIn(file));
        mesh.faceBegin.assign(begins.begin(), begins.end());
        if (mesh.faceBegin.empty()) mesh.faceBegin.push_back(0);
        if (mesh.faceBegin.front() != 0 || mesh.faceBegin.back() != mesh.facePoints.size() ||
            !std::is_sorted(begins.begin(), begins.end()))
            throw std::runtime_error("has faces that do not follow each other");
    } else {
        const std::int64_t stated = in.count(mostIn(file));
        if (stated != 0 || in.peek() == '(') in.expect('(');
        mesh.faceBegin.reserve(std::size_t(std::max<std::int64_t>(stated, 0)) + 1);
        mesh.facePoints.reserve(4 * mesh.faceBegin.capacity());
        while (in.peek() != ')' && !(stated == 0 && in.peek() == 0)) {
            in.addLabels(mostIn(file), mesh.facePoints);
            mesh.faceBegin.push_back(mesh.facePoints.size());
        }
        if (in.peek() == ')') in.expect(')');
        if (stated > 0 && mesh.faceBegin.size() != std::size_t(stated) + 1)
            throw std::runtime_error("has " + std::to_string(mesh.faceBegin.size() - 1) + " faces in a list of " +
                                     std::to_string(stated));
    }
    for (const std::int32_t point : mesh.facePoints)
        if (point < 0 || std::size_t(point) >= points)
            throw std::runtime_error("names point " + std::to_string(point) + " of " + std::to_string(points));
}

/// Cells on one side of the faces. Each cell has several faces, so there cannot be more cells than faces.
std::vector<std::int32_t> readCellsOfFaces(const FoamPlace& place, const char* what, std::size_t faces) {
    std::vector<std::int32_t> cells;
    inFoamFile(place, what, [&](FoamCursor& in, const FoamFile&) {
        cells = in.labels(faces);
        for (const std::int32_t cell : cells)
            if (cell >= 0 && std::size_t(cell) >= faces)
                throw std::runtime_error("names cell " + std::to_string(cell) + " of a mesh of " +
                                         std::to_string(faces) + " faces");
    });
    return cells;
}

/// The zones of cells: "2 ( name { type cellZone; cellLabels List<label> 3(0 1 2); } ... )". Nothing in the values
/// depends on them, so a file that cannot be read names none.
void readZones(const FoamPlace& place, FoamMesh& mesh) {
    if (place.path.empty() || mesh.cells == 0) return;
    try {
        const FoamFile file = readFoamFile(place);
        FoamCursor in(file);
        std::vector<std::int32_t> zone(mesh.cells, 0);
        std::vector<std::string> names;
        in.count(mostIn(file));
        in.expect('(');
        while (in.peek() != ')') {
            names.emplace_back(in.word());
            in.expect('{');
            while (in.peek() != '}') {
                if (in.word() != "cellLabels") {
                    in.statement();
                    continue;
                }
                if (in.peek() == 'L') in.word(); // List<label>
                for (const std::int32_t cell : in.labels(mesh.cells))
                    if (cell >= 0 && std::size_t(cell) < zone.size())
                        zone[std::size_t(cell)] = static_cast<std::int32_t>(names.size());
                in.expect(';');
            }
            in.expect('}');
        }
        mesh.zone = std::move(zone);
        mesh.zones = std::move(names);
    } catch (const std::runtime_error&) {
    }
}

FoamMesh readPiece(const FoamMeshFiles& files) {
    FoamMesh mesh;
    inFoamFile(files.points, "points",
               [&](FoamCursor& in, const FoamFile& file) { mesh.points = in.numbers(3, mostIn(file)); });
    inFoamFile(files.faces, "faces", [&](FoamCursor& in, const FoamFile& file) { readFaces(in, file, mesh); });
    const std::size_t faces = mesh.faceBegin.size() - 1;
    mesh.owner = readCellsOfFaces(files.owner, "owner", faces);
    if (mesh.owner.size() != faces)
        throw std::runtime_error("its file " + files.owner.shown + " has " + std::to_string(mesh.owner.size()) +
                                 " owners of " + std::to_string(faces) + " faces");
    if (!files.neighbour.path.empty()) mesh.neighbour = readCellsOfFaces(files.neighbour, "neighbour", faces);
    mesh.neighbour.resize(faces, -1); // old meshes name all faces, others the inner ones, which come first
    for (const auto* side : {&mesh.owner, &mesh.neighbour})
        for (const std::int32_t cell : *side) mesh.cells = std::max(mesh.cells, std::size_t(cell + 1));
    if (!files.boundary.path.empty()) // nothing in it is needed, but it is part of the mesh
        inFoamFile(files.boundary, "boundary", [](FoamCursor& in, const FoamFile&) {
            if (in.count(1'000'000) != 0) in.skipBrackets();
        });
    readZones(files.cellZones, mesh);
    return mesh;
}

/// The points of those patches that another processor has, too.
std::unordered_set<std::int32_t> sharedPoints(const FoamMeshFiles& files, const FoamMesh& mesh) {
    std::unordered_set<std::int32_t> shared;
    inFoamFile(files.boundary, "boundary", [&](FoamCursor& in, const FoamFile&) {
        if (in.count(1'000'000) == 0 && in.peek() != '(') return;
        in.expect('(');
        while (in.peek() != ')') {
            in.word();
            in.expect('{');
            std::string type;
            std::int64_t count = 0, first = 0;
            while (in.peek() != '}') {
                const std::string key(in.word());
                const std::string text = in.statement();
                if (key == "type") type = text;
                if (key == "nFaces") count = std::strtoll(text.c_str(), nullptr, 10);
                if (key == "startFace") first = std::strtoll(text.c_str(), nullptr, 10);
            }
            in.expect('}');
            if (type != "processor") continue;
            const auto faces = std::int64_t(mesh.faceCount());
            if (first < 0 || count < 0 || first > faces || count > faces - first)
                throw std::runtime_error("names faces that are not there");
            for (std::size_t p = mesh.faceBegin[std::size_t(first)]; p < mesh.faceBegin[std::size_t(first + count)];
                 ++p)
                shared.insert(mesh.facePoints[p]);
        }
        in.expect(')');
    });
    return shared;
}

} // namespace

FoamMesh readFoamMesh(const std::vector<FoamMeshFiles>& pieces, std::vector<std::array<std::size_t, 2>>& sizes,
                      std::vector<std::int32_t>& pointOf) {
    sizes.clear();
    pointOf.clear();
    if (pieces.size() == 1) {
        FoamMesh mesh = readPiece(pieces.front());
        sizes.push_back({mesh.cells, mesh.pointCount()});
        return mesh;
    }
    FoamMesh all;
    std::map<std::array<double, 3>, std::int32_t> known; // joined points of boundaries between processors
    bool zones = true;
    for (const FoamMeshFiles& files : pieces) {
        const FoamMesh mesh = readPiece(files);
        sizes.push_back({mesh.cells, mesh.pointCount()});
        const std::unordered_set<std::int32_t> shared = sharedPoints(files, mesh);
        const std::size_t before = pointOf.size();
        if (all.cells + mesh.cells > 0x7fffffff || all.pointCount() + mesh.pointCount() > 0x7fffffff)
            throw std::runtime_error("has more than 2^31 cells or points");
        for (std::size_t p = 0; p < mesh.pointCount(); ++p) {
            const std::array<double, 3> x{mesh.points[3 * p], mesh.points[3 * p + 1], mesh.points[3 * p + 2]};
            auto own = static_cast<std::int32_t>(all.pointCount());
            if (shared.contains(static_cast<std::int32_t>(p))) own = known.emplace(x, own).first->second;
            if (std::size_t(own) == all.pointCount()) all.points.insert(all.points.end(), x.begin(), x.end());
            pointOf.push_back(own);
        }
        for (const std::int32_t point : mesh.facePoints) all.facePoints.push_back(pointOf[before + std::size_t(point)]);
        const std::size_t begun = all.faceBegin.back();
        for (std::size_t f = 1; f < mesh.faceBegin.size(); ++f) all.faceBegin.push_back(begun + mesh.faceBegin[f]);
        const auto cells = static_cast<std::int32_t>(all.cells);
        for (const std::int32_t cell : mesh.owner) all.owner.push_back(cell < 0 ? -1 : cell + cells);
        for (const std::int32_t cell : mesh.neighbour) all.neighbour.push_back(cell < 0 ? -1 : cell + cells);
        all.cells += mesh.cells;
        if (mesh.cells == 0) continue;
        if (all.zones.empty()) all.zones = mesh.zones;
        zones = zones && mesh.zones == all.zones && !mesh.zone.empty(); // all processors have the same names
        all.zone.insert(all.zone.end(), mesh.zone.begin(), mesh.zone.end());
    }
    if (!zones) all.zone.clear(), all.zones.clear();
    return all;
}

std::array<double, 6> boxOfFoamPoints(const std::vector<FoamMeshFiles>& pieces) {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    std::array<double, 6> box{kFar, kFar, kFar, -kFar, -kFar, -kFar};
    for (const FoamMeshFiles& files : pieces)
        inFoamFile(files.points, "points", [&](FoamCursor& in, const FoamFile& file) {
            const std::vector<double> points = in.numbers(3, mostIn(file));
            for (std::size_t i = 0; i < points.size(); ++i) {
                box[i % 3] = std::min(box[i % 3], points[i]);
                box[3 + i % 3] = std::max(box[3 + i % 3], points[i]);
            }
        });
    return box;
}

} // namespace tessera::importer
