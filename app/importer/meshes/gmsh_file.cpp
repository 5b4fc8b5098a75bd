// Follows "MSH file format" of gmsh's reference manual, versions 2.2 and 4.1.
#include "app/importer/meshes/gmsh_file.h"

#include "app/importer/readers/check_file.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstring>
#include <set>
#include <stdexcept>
#include <string_view>
#include <vtkCellType.h>

namespace tessera::importer {

namespace {

/// A type of cells: its points, and where VTK's order finds them (first ones alone: cells of higher order by their
/// corners).
struct GmshKind {
    int type, points, vtkType, dimension;
    std::vector<int> order;
};
std::vector<int> firstOnes(int count) {
    std::vector<int> order;
    for (int n = 0; n < count; ++n) order.push_back(n);
    return order;
}
const std::vector<GmshKind>& gmshKinds() {
    static const std::vector<GmshKind> kKinds = {
        {15, 1, VTK_VERTEX, 0, firstOnes(1)},
        {1, 2, VTK_LINE, 1, firstOnes(2)},
        {8, 3, VTK_LINE, 1, firstOnes(2)},
        {26, 4, VTK_LINE, 1, firstOnes(2)},
        {27, 5, VTK_LINE, 1, firstOnes(2)},
        {28, 6, VTK_LINE, 1, firstOnes(2)},
        {2, 3, VTK_TRIANGLE, 2, firstOnes(3)},
        {9, 6, VTK_QUADRATIC_TRIANGLE, 2, firstOnes(6)},
        {20, 9, VTK_TRIANGLE, 2, firstOnes(3)},
        {21, 10, VTK_TRIANGLE, 2, firstOnes(3)},
        {22, 12, VTK_TRIANGLE, 2, firstOnes(3)},
        {23, 15, VTK_TRIANGLE, 2, firstOnes(3)},
        {3, 4, VTK_QUAD, 2, firstOnes(4)},
        {10, 9, VTK_BIQUADRATIC_QUAD, 2, firstOnes(9)},
        {16, 8, VTK_QUADRATIC_QUAD, 2, firstOnes(8)},
        {36, 16, VTK_QUAD, 2, firstOnes(4)},
        {4, 4, VTK_TETRA, 3, firstOnes(4)},
        {11, 10, VTK_QUADRATIC_TETRA, 3, {0, 1, 2, 3, 4, 5, 6, 7, 9, 8}},
        {29, 20, VTK_TETRA, 3, firstOnes(4)},
        {30, 35, VTK_TETRA, 3, firstOnes(4)},
        {5, 8, VTK_HEXAHEDRON, 3, firstOnes(8)},
        {17, 20, VTK_QUADRATIC_HEXAHEDRON, 3, {0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15}},
        {12, 27, VTK_TRIQUADRATIC_HEXAHEDRON, 3, {0,  1,  2,  3,  4,  5,  6,  7,  8,  11, 13, 9,  16, 18,
                                                  19, 17, 10, 12, 14, 15, 22, 23, 21, 24, 20, 25, 26}},
        {92, 64, VTK_HEXAHEDRON, 3, firstOnes(8)},
        {6, 6, VTK_WEDGE, 3, firstOnes(6)},
        {18, 15, VTK_QUADRATIC_WEDGE, 3, {0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11}},
        {13, 18, VTK_QUADRATIC_WEDGE, 3, {0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11}},
        {90, 40, VTK_WEDGE, 3, firstOnes(6)},
        {7, 5, VTK_PYRAMID, 3, firstOnes(5)},
        {19, 13, VTK_QUADRATIC_PYRAMID, 3, {0, 1, 2, 3, 4, 5, 8, 10, 6, 7, 9, 11, 12}},
        {14, 14, VTK_QUADRATIC_PYRAMID, 3, {0, 1, 2, 3, 4, 5, 8, 10, 6, 7, 9, 11, 12}}};
    return kKinds;
}

const GmshKind& gmshKind(std::int64_t type) {
    const auto at = std::ranges::find(gmshKinds(), type, &GmshKind::type);
    if (at == gmshKinds().end())
        throw std::runtime_error("has cells of gmsh's type " + std::to_string(type) +
                                 ", which is not read: mesh it with order 1 or 2");
    return *at;
}

class GmshReader {
public:
    explicit GmshReader(const std::string& path) : bytes_(readWhole(path)) {}

    GmshMesh read() {
        bool cells = false;
        while (skipBlank(), at_ < bytes_.size()) {
            const std::string name = line();
            if (!name.starts_with("$"))
                throw std::runtime_error("has \"" + name.substr(0, 40) + "\" between its sections");
            if (name == "$MeshFormat")
                readFormat();
            else if (version_ == 0)
                throw std::runtime_error("does not begin with $MeshFormat");
            else if (name == "$PhysicalNames")
                readNames();
            else if (name == "$Entities")
                readEntities();
            else if (name == "$Nodes")
                version_ == 4 ? readNodes4() : readNodes2();
            else if (name == "$Elements")
                cells = true, version_ == 4 ? readCells4() : readCells2();
            else if (name == "$NodeData" || name == "$ElementData")
                readValues(name == "$ElementData");
            else
                skipSection(name);
            expectEnd(name);
        }
        if (!cells) throw std::runtime_error("ends before its cells: truncated");
        finish();
        return std::move(mesh_);
    }

private:
    [[noreturn]] static void cut() { throw std::runtime_error("ends within a section: truncated"); }

    void skipBlank() {
        while (at_ < bytes_.size() && std::isspace(static_cast<unsigned char>(bytes_[at_])) != 0) ++at_;
    }
    std::string line() {
        if (at_ >= bytes_.size()) cut();
        const std::size_t end = std::min(bytes_.size(), bytes_.find('\n', at_));
        std::string text = bytes_.substr(at_, end - at_);
        at_ = std::min(bytes_.size(), end + 1);
        while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) text.pop_back();
        return text;
    }
    std::string_view word() {
        skipBlank();
        const std::size_t begin = at_;
        while (at_ < bytes_.size() && std::isspace(static_cast<unsigned char>(bytes_[at_])) == 0) ++at_;
        if (begin == at_) cut();
        return std::string_view(bytes_).substr(begin, at_ - begin);
    }
    template <class T> T textNumber() {
        std::string_view text = word();
        if (text.starts_with('+')) text.remove_prefix(1);
        T value{};
        const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (failed == std::errc::invalid_argument || end != text.data() + text.size())
            throw std::runtime_error("has \"" + std::string(text.substr(0, 40)) + "\" where a number belongs");
        return value;
    }
    template <class T> T raw() {
        if (bytes_.size() - at_ < sizeof(T)) cut();
        char some[sizeof(T)];
        std::memcpy(some, bytes_.data() + at_, sizeof(T));
        if (swap_) std::reverse(some, some + sizeof(T));
        at_ += sizeof(T);
        T value;
        std::memcpy(&value, some, sizeof(T));
        return value;
    }
    std::int64_t whole() { return binary_ ? std::int64_t(raw<std::int32_t>()) : textNumber<std::int64_t>(); }
    std::int64_t large() { return binary_ ? std::int64_t(raw<std::uint64_t>()) : textNumber<std::int64_t>(); }
    double number() { return binary_ ? raw<double>() : textNumber<double>(); }
    std::size_t count(std::int64_t stated) const {
        if (stated < 0 || std::size_t(stated) > bytes_.size()) cut();
        return std::size_t(stated);
    }
    /// Numbers of a header, which are text in binary files, too.
    std::size_t textCount() { return count(textNumber<std::int64_t>()); }
    void endLine() { at_ = std::min(bytes_.size(), bytes_.find('\n', at_)) + 1; }

    void expectEnd(const std::string& name) {
        skipBlank();
        if (at_ >= bytes_.size()) cut();
        if (const std::string end = line(); end != "$End" + name.substr(1))
            throw std::runtime_error("has \"" + end.substr(0, 40) + "\" where " + name + " ends");
    }
    void skipSection(const std::string& name) {
        const std::size_t end = bytes_.find("$End" + name.substr(1), at_);
        if (end == std::string::npos) cut();
        at_ = end;
        if (name == "$ElementNodeData" || name == "$PartitionedEntities" || name == "$Periodic" ||
            name == "$Parametrizations" || name == "$Comments" || name == "$GhostElements")
            if (name == "$ElementNodeData") mesh_.notes.push_back("values at corners of single cells are left out");
    }

    void readFormat() {
        const auto version = textNumber<double>();
        binary_ = textNumber<std::int64_t>() != 0;
        if (textNumber<std::int64_t>() != 8) throw std::runtime_error("stores numbers of a size other than 8 bytes");
        endLine();
        version_ = version >= 4.1 && version < 5 ? 4 : version >= 2 && version < 3 ? 2 : 0;
        if (version_ == 0)
            throw std::runtime_error(
                "is of a version of gmsh's format that is not read: write it as 4.1 (gmsh file.msh "
                "-save -format msh41 -o new.msh)");
        if (!binary_) return;
        if (raw<std::int32_t>() != 1) swap_ = true;
    }

    void readNames() {
        for (std::size_t n = textCount(); n > 0; --n) {
            const auto dimension = textNumber<int>(), group = textNumber<int>();
            const std::string rest = line();
            const std::size_t open = rest.find('"'), close = rest.rfind('"');
            if (open != std::string::npos && close > open)
                names_[{dimension, group}] = rest.substr(open + 1, close - open - 1);
        }
    }

    void readEntities() {
        std::size_t counts[4];
        for (std::size_t& n : counts) n = count(large());
        for (int dimension = 0; dimension < 4; ++dimension)
            for (std::size_t e = 0; e < counts[dimension]; ++e) {
                const std::int64_t tag = whole();
                for (int n = 0; n < (dimension == 0 ? 3 : 6); ++n) number();
                for (std::size_t groups = count(large()), n = 0; n < groups; ++n) {
                    const std::int64_t group = whole();
                    if (n == 0) groups_[{dimension, tag}] = int(group < 0 ? -group : group);
                    if (n == 1) several_ = true;
                }
                if (dimension > 0)
                    for (std::size_t bounds = count(large()); bounds > 0; --bounds) whole();
            }
    }

    void addPoint(std::int64_t id) { mesh_.pointIds.push_back(id); }

    void readNodes2() {
        const std::size_t points = textCount();
        if (binary_) endLine();
        for (std::size_t n = 0; n < points; ++n) {
            addPoint(whole());
            for (int axis = 0; axis < 3; ++axis) mesh_.places.push_back(number());
        }
    }
    void readNodes4() {
        const std::size_t blocks = count(large());
        for (int n = 0; n < 3; ++n) large();
        for (std::size_t b = 0; b < blocks; ++b) {
            const std::int64_t dimension = whole();
            whole();
            const bool parametric = whole() != 0;
            const std::size_t points = count(large());
            for (std::size_t n = 0; n < points; ++n) addPoint(large());
            for (std::size_t n = 0; n < points; ++n) {
                for (int axis = 0; axis < 3; ++axis) mesh_.places.push_back(number());
                for (std::int64_t u = 0; parametric && u < dimension; ++u) number();
            }
        }
    }

    void addCell(const GmshKind& kind, std::int64_t id, int group, const std::vector<std::int64_t>& points) {
        if (kind.dimension < highest_) {
            ++left_;
            return;
        }
        if (kind.dimension > highest_) {
            left_ += mesh_.cells.size();
            mesh_.cells.clear();
            highest_ = kind.dimension;
        }
        GmshCell cell{kind.vtkType, kind.dimension, group, id, {}};
        for (const int n : kind.order) cell.corners.push_back(points[std::size_t(n)]);
        mesh_.cells.push_back(std::move(cell));
    }
    void readCells2() {
        const std::size_t cells = textCount();
        if (binary_) endLine();
        std::vector<std::int64_t> points, tags;
        for (std::size_t done = 0; done < cells;) {
            std::int64_t id = binary_ ? 0 : whole();
            const GmshKind& kind = gmshKind(whole());
            const std::size_t together = binary_ ? count(whole()) : 1, tagCount = count(whole());
            if (together == 0 || together > cells - done) cut();
            for (std::size_t n = 0; n < together; ++n, ++done) {
                if (binary_) id = whole();
                tags.clear();
                points.clear();
                for (std::size_t t = 0; t < tagCount; ++t) tags.push_back(whole());
                for (int p = 0; p < kind.points; ++p) points.push_back(whole());
                addCell(kind, id, tags.empty() ? 0 : int(tags[0]), points);
            }
        }
    }
    void readCells4() {
        const std::size_t blocks = count(large());
        for (int n = 0; n < 3; ++n) large();
        std::vector<std::int64_t> points;
        for (std::size_t b = 0; b < blocks; ++b) {
            const auto dimension = int(whole());
            const std::int64_t tag = whole();
            const GmshKind& kind = gmshKind(whole());
            const auto group = groups_.find({dimension, tag});
            for (std::size_t cells = count(large()); cells > 0; --cells) {
                const std::int64_t id = large();
                points.clear();
                for (int p = 0; p < kind.points; ++p) points.push_back(large());
                addCell(kind, id, group == groups_.end() ? 0 : group->second, points);
            }
        }
    }

    void readValues(bool ofCells) {
        GmshValues values;
        values.ofCells = ofCells;
        for (std::size_t n = textCount(), t = 0; t < n; ++t) {
            skipBlank();
            std::string text = line();
            if (text.size() > 1 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
            if (t == 0) values.name = text;
        }
        for (std::size_t n = textCount(), t = 0; t < n; ++t) {
            const auto real = textNumber<double>();
            if (t == 0) values.time = real;
        }
        std::vector<std::int64_t> numbers;
        for (std::size_t n = textCount(); n > 0; --n) numbers.push_back(textNumber<std::int64_t>());
        if (numbers.size() < 3 || numbers[1] < 1 || numbers[1] > 9)
            throw std::runtime_error("has values without their number of components");
        if (binary_) endLine();
        values.components = std::size_t(numbers[1]);
        for (std::size_t n = count(numbers[2]); n > 0; --n) {
            values.ids.push_back(whole());
            for (std::size_t c = 0; c < values.components; ++c) values.values.push_back(number());
        }
        mesh_.values.push_back(std::move(values));
    }

    void finish() {
        for (const auto& [key, name] : names_)
            if (key.first == highest_) mesh_.groups[key.second] = name;
        if (left_ > 0)
            mesh_.notes.push_back(std::to_string(left_) + " cells of fewer dimensions (of boundaries) are left out");
        if (several_) mesh_.notes.push_back("some cells are in several physical groups: each is shown in its first");
    }

    std::string bytes_;
    std::size_t at_ = 0, left_ = 0;
    int version_ = 0, highest_ = 0;
    bool binary_ = false, swap_ = false, several_ = false;
    std::map<std::pair<int, int>, std::string> names_;
    std::map<std::pair<int, std::int64_t>, int> groups_; ///< of entities, by dimension and tag
    GmshMesh mesh_;
};

} // namespace

GmshMesh readGmshMesh(const std::string& path) {
    return GmshReader(path).read();
}

} // namespace tessera::importer
