#include "app/importer/hdf/fluent_mesh.h"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

namespace tessera::importer {

namespace {

constexpr const char* kMesh = "meshes/1";

struct IdRange {
    std::int64_t first = 1, last = 0; ///< numbers from 1

    std::size_t count() const { return last < first ? 0 : std::size_t(last - first + 1); }
};

IdRange rangeOf(const HdfFile& file, const std::string& path) {
    const std::vector<double> first = file.attribute(path, "minId"), last = file.attribute(path, "maxId");
    if (first.empty() || last.empty() || !(first[0] >= 1 && last[0] < 1e12))
        throw std::runtime_error("is damaged: \"" + path + "\" has no numbers of its first and last");
    return {std::int64_t(first[0]), std::int64_t(last[0])};
}

/// Faces with their corners, and the cells on both sides (0 = none).
struct FluentFaces {
    std::vector<std::int64_t> begins{0}, corners;
    std::vector<std::int64_t> first; ///< number of the first face of each section, and its place in `begins`
    std::vector<std::int64_t> sides[2];
    std::vector<bool> parent, child; ///< of faces that were refined

    std::size_t count() const { return begins.size() - 1; }
};

/// The members of a group that are named by numbers, in their order.
std::vector<std::string> sectionsOf(const HdfFile& file, const std::string& group) {
    std::vector<std::string> names = file.members(group);
    std::erase_if(names,
                  [](const std::string& name) { return name.find_first_not_of("0123456789") != std::string::npos; });
    std::sort(names.begin(), names.end(), [](const std::string& a, const std::string& b) {
        return a.size() != b.size() ? a.size() < b.size() : a < b;
    });
    return names;
}

FluentFaces readFaces(const HdfFile& file) {
    const std::string group = std::string(kMesh) + "/faces";
    FluentFaces faces;
    std::int64_t expected = 1;
    std::vector<std::pair<std::int64_t, std::string>> sections; // by their first face
    for (const std::string& name : sectionsOf(file, group + "/nodes"))
        sections.emplace_back(rangeOf(file, group + "/nodes/" + name).first, group + "/nodes/" + name);
    std::sort(sections.begin(), sections.end());
    for (const auto& [start, path] : sections) {
        const IdRange range = rangeOf(file, path);
        const std::vector<std::int64_t> sizes = file.integers(path + "/nnodes"), nodes = file.integers(path + "/nodes");
        if (range.first != expected || sizes.size() != range.count())
            throw std::runtime_error("is damaged: its faces do not follow each other");
        expected = range.last + 1;
        const std::int64_t before = std::int64_t(faces.corners.size());
        std::int64_t at = before;
        for (const std::int64_t size : sizes) {
            if (size < 0 || size > 10'000)
                throw std::runtime_error("is damaged: a face has an impossible number of nodes");
            faces.begins.push_back(at += size);
        }
        if (at - before > std::int64_t(nodes.size()))
            throw std::runtime_error("is damaged: the nodes of its faces end early");
        faces.corners.insert(faces.corners.end(), nodes.begin(), nodes.begin() + (at - before));
    }
    for (int side = 0; side < 2; ++side) {
        faces.sides[side].assign(faces.count(), 0);
        const std::string cells = group + (side == 0 ? "/c0" : "/c1");
        for (const std::string& name : sectionsOf(file, cells)) {
            const IdRange range = rangeOf(file, cells + "/" + name);
            const std::vector<std::int64_t> list = file.integers(cells + "/" + name);
            if (range.count() != list.size() || range.last > std::int64_t(faces.count()))
                throw std::runtime_error("is damaged: it has cells beside faces that are not there");
            std::copy(list.begin(), list.end(), faces.sides[side].begin() + (range.first - 1));
        }
    }
    return faces;
}

/// Marks what a tree of refinement names: those that were refined, and what became of them.
void readTree(const HdfFile& file, const std::string& group, std::vector<bool>& parent, std::vector<bool>& child) {
    for (const std::string& name : sectionsOf(file, group)) {
        const IdRange range = rangeOf(file, group + "/" + name);
        for (std::int64_t id = range.first; id <= range.last && id <= std::int64_t(parent.size()); ++id)
            parent[std::size_t(id - 1)] = true;
        for (const std::int64_t id : file.integers(group + "/" + name + "/kids"))
            if (id >= 1 && id <= std::int64_t(child.size())) child[std::size_t(id - 1)] = true;
    }
}

/// Faces where two zones that do not match overlap: they stand beside the whole faces of both.
void readInterfaces(const HdfFile& file, FluentFaces& faces) {
    const std::string group = std::string(kMesh) + "/faces/interface";
    const std::vector<double> width = file.attribute(group, "nData");
    if (!file.isGroup(group) || width.empty() || width[0] < 3) return;
    const std::vector<std::int64_t> table = file.integers(group + "/nciTopology");
    for (std::size_t row = 0; row + 3 <= table.size(); row += std::size_t(width[0]))
        for (std::int64_t id = std::max<std::int64_t>(table[row + 1], 1);
             id <= std::min(table[row + 2], std::int64_t(faces.count())); ++id)
            faces.child[std::size_t(id - 1)] = true;
}

/// The coordinates of all nodes, by number from 1; flat ones have z = 0.
std::vector<double> readNodes(const HdfFile& file, bool flat) {
    const std::string group = std::string(kMesh) + "/nodes/coords";
    std::vector<double> nodes;
    for (const std::string& name : sectionsOf(file, group)) {
        const std::string path = group + "/" + name;
        const IdRange range = rangeOf(file, path);
        const std::vector<double> numbers = file.doubles(path);
        const std::size_t axes = flat ? 2 : 3;
        if (numbers.size() != range.count() * axes || range.first < 1)
            throw std::runtime_error("is damaged: it has another number of coordinates than nodes");
        const std::size_t end = std::size_t(range.last) * 3;
        if (end > 8 * (nodes.size() + 3 * range.count()) + 1'000'000)
            throw std::runtime_error("is damaged: nodes are missing");
        if (nodes.size() < end) nodes.resize(end, 0);
        for (std::size_t n = 0; n < range.count(); ++n)
            for (std::size_t axis = 0; axis < axes; ++axis)
                nodes[(std::size_t(range.first) - 1 + n) * 3 + axis] = numbers[n * axes + axis];
    }
    if (nodes.empty()) throw std::runtime_error("holds no nodes");
    return nodes;
}

struct ZoneHead {
    std::string name;
    IdRange cells;
};

std::vector<ZoneHead> readZones(const HdfFile& file, std::size_t faces) {
    const std::string group = std::string(kMesh) + "/cells/zoneTopology";
    const std::vector<std::int64_t> first = file.integers(group + "/minId"), last = file.integers(group + "/maxId"),
                                    ids = file.integers(group + "/id");
    const std::vector<std::string> names = fluentWords(file, group + "/name");
    if (first.empty() || first.size() != last.size()) throw std::runtime_error("holds no cell zones");
    std::vector<ZoneHead> zones;
    for (std::size_t z = 0; z < first.size(); ++z) {
        // A cell has three faces at least, and a face two cells at most.
        if (first[z] < 1 || last[z] > std::int64_t(faces))
            throw std::runtime_error("is damaged: it states more cells than its faces can make");
        const std::string number = z < ids.size() ? std::to_string(ids[z]) : std::to_string(z + 1);
        zones.push_back({z < names.size() && !names[z].empty() ? names[z] : "zone " + number, {first[z], last[z]}});
    }
    return zones;
}

/// The faces of each cell, one cell after the other: face number + 1, negative where the cell is on its second side.
struct FacesOfCells {
    std::vector<std::int64_t> begins, faces;
};

FacesOfCells facesOfCells(const FluentFaces& faces, std::size_t cells) {
    FacesOfCells out;
    out.begins.assign(cells + 1, 0);
    const auto each = [&](const auto& body) {
        for (int side = 0; side < 2; ++side)
            for (std::size_t f = 0; f < faces.count(); ++f) {
                const std::int64_t cell = faces.sides[side][f];
                if (cell >= 1 && cell <= std::int64_t(cells))
                    body(std::size_t(cell - 1), side == 0 ? std::int64_t(f) + 1 : -std::int64_t(f) - 1);
            }
    };
    each([&](std::size_t cell, std::int64_t) { ++out.begins[cell + 1]; });
    for (std::size_t c = 0; c < cells; ++c) out.begins[c + 1] += out.begins[c];
    out.faces.resize(std::size_t(out.begins[cells]));
    std::vector<std::int64_t> next(out.begins.begin(), out.begins.end() - 1);
    each([&](std::size_t cell, std::int64_t face) { out.faces[std::size_t(next[cell]++)] = face; });
    return out;
}

/// The faces of a cell, each as the cell sees it. Beside a finer cell those that were refined count, if they close it.
std::vector<CellFace> facesOf(const FluentFaces& faces, const FacesOfCells& lists, std::size_t cell) {
    const auto chosen = [&](const std::vector<bool>& without) {
        std::vector<CellFace> out;
        for (std::int64_t at = lists.begins[cell]; at < lists.begins[cell + 1]; ++at) {
            const std::int64_t signedFace = lists.faces[std::size_t(at)];
            const auto face = std::size_t(std::abs(signedFace) - 1);
            if (without[face] || faces.begins[face + 1] == faces.begins[face]) continue;
            out.emplace_back(faces.corners.begin() + faces.begins[face],
                             faces.corners.begin() + faces.begins[face + 1]);
            if (signedFace < 0) std::reverse(out.back().begin(), out.back().end());
        }
        return out;
    };
    const bool both =
        std::any_of(lists.faces.begin() + lists.begins[cell], lists.faces.begin() + lists.begins[cell + 1],
                    [&](std::int64_t face) { return faces.parent[std::size_t(std::abs(face) - 1)]; });
    return both ? chosen(faces.parent) : chosen(faces.child);
}

/// A mesh with the nodes that its cells use.
vtkSmartPointer<vtkUnstructuredGrid> meshOfZone(const std::vector<double>& nodes, MeshCells& cells) {
    std::vector<std::int64_t> place(nodes.size() / 3, -1);
    auto points = vtkSmartPointer<vtkPoints>::New();
    points->SetDataTypeToDouble();
    for (std::vector<std::int64_t>* list : {&cells.points, &cells.faces.points})
        for (std::int64_t& corner : *list) { // numbers from 1 become places
            if (corner < 1 || corner > std::int64_t(place.size()))
                throw std::runtime_error("is damaged: a face names a node that is not there");
            std::int64_t& at = place[std::size_t(corner - 1)];
            if (at < 0) at = points->InsertNextPoint(&nodes[3 * std::size_t(corner - 1)]);
            corner = at;
        }
    return meshOf(points, cells);
}

} // namespace

std::vector<std::string> fluentWords(const HdfFile& file, const std::string& path) {
    std::vector<std::string> words;
    for (const std::string& text : file.texts(path))
        for (std::size_t at = 0; at < text.size();) {
            const std::size_t end = std::min(text.find(';', at), text.size());
            words.push_back(text.substr(at, end - at));
            at = end + 1;
        }
    return words;
}

std::vector<FluentHdfZone> readFluentMesh(const HdfFile& file, std::vector<std::string>& notes) {
    const std::vector<double> dimension = file.attribute(kMesh, "dimension");
    const bool flat = !dimension.empty() && dimension[0] == 2;
    FluentFaces faces = readFaces(file);
    faces.parent.assign(faces.count(), false);
    faces.child.assign(faces.count(), false);
    readTree(file, std::string(kMesh) + "/faces/tree", faces.parent, faces.child);
    readInterfaces(file, faces);
    const std::vector<double> nodes = readNodes(file, flat);
    const std::vector<ZoneHead> heads = readZones(file, faces.count());
    std::int64_t most = 0;
    for (const ZoneHead& head : heads) most = std::max(most, head.cells.last);
    std::vector<bool> refined(std::size_t(most), false), kid(std::size_t(most), false);
    readTree(file, std::string(kMesh) + "/cells/tree", refined, kid);
    const FacesOfCells lists = facesOfCells(faces, std::size_t(most));
    std::vector<FluentHdfZone> zones;
    std::size_t left = 0;
    for (const ZoneHead& head : heads) {
        FluentHdfZone zone{head.name, nullptr, {}};
        MeshCells cells;
        for (std::int64_t id = head.cells.first; id <= head.cells.last; ++id) {
            if (refined[std::size_t(id - 1)]) continue; // its parts are cells
            if (addFluentCell(facesOf(faces, lists, std::size_t(id - 1)), flat, cells))
                zone.cells.push_back(id);
            else
                ++left;
        }
        if (zone.cells.empty()) continue;
        zone.mesh = meshOfZone(nodes, cells);
        zones.push_back(std::move(zone));
    }
    if (left > 0) notes.push_back(std::to_string(left) + " cells left out: their faces do not close them");
    if (zones.empty()) throw std::runtime_error("holds no cells");
    return zones;
}

} // namespace tessera::importer
