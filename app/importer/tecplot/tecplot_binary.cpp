// Binary Tecplot (.plt): a header with the names of variables and zones, then the numbers of each zone. Follows
// Tecplot's Data Format Guide, "Binary Data File Format"; differences between versions follow the comments of the TecIO
// library. Opening walks through the layout of the whole file, so that a truncated one is refused at once.
#include "app/importer/readers/check_file.h"
#include "app/importer/tecplot/tecplot_bytes.h"
#include "app/importer/tecplot/tecplot_zones.h"
#include "volume/base/trimmed.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <stdexcept>

namespace tessera::importer {

namespace {

constexpr float kZoneMarker = 299, kNewZoneMarker = 298, kEndOfHeader = 357;
constexpr std::size_t kAtOnce = 1 << 20; // values read at once

/// Formats of numbers in a file: 1 float, 2 double, 3 long, 4 short, 5 byte.
struct Format {
    std::size_t bytes;
    int vtkType;
    double (*number)(const char* bytes, bool swap);
};
template <class T> double asDouble(const char* bytes, bool swap) {
    return double(numberAt<T>(bytes, swap));
}
constexpr Format kFormats[] = {{0, VTK_VOID, nullptr},
                               {4, VTK_FLOAT, asDouble<float>},
                               {8, VTK_FLOAT, asDouble<double>},
                               {4, VTK_INT, asDouble<std::int32_t>},
                               {2, VTK_SHORT, asDouble<std::int16_t>},
                               {1, VTK_UNSIGNED_CHAR, asDouble<std::uint8_t>}};

/// Where the numbers of a variable are in the file.
struct Stored {
    std::uint64_t begin = 0;
    std::size_t step = 0; ///< bytes from one to the next
    int format = 0;
    int from = -1; ///< zone that stores them, -1: this one
    bool passive = false;
};

struct BinaryZone {
    TecplotZone zone;
    double time = 0;
    std::int32_t strand = -1;
    bool inPoints = false;          ///< variables interleaved, point by point
    bool faceNeighbours = false;    ///< one for each face of each cell
    std::size_t neighbours = 0;     ///< listed individually
    std::int32_t neighbourMode = 0; ///< local one to one, one to many, global one to one, one to many
    std::vector<Stored> stored;     ///< by variable
    std::uint64_t corners = 0;
    int cornersFrom = -1; ///< zone that stores them, -1: this one
};

struct Layout {
    std::string path;
    int version = 0;
    bool swap = false;
    std::int32_t fileType = 0; ///< 1: a grid alone, 2: a solution alone
    bool drawings = false;
    std::vector<Heading> headings;
    std::vector<BinaryZone> zones;
};

/// The name of a zone in messages.
std::string called(const Layout& layout, std::size_t zone) {
    const std::string& name = layout.zones[zone].zone.name;
    return "zone " + std::to_string(zone + 1) + (name.empty() ? "" : " \"" + name.substr(0, 40) + "\"");
}

void setCellType(TecplotZone& zone, std::int32_t type) {
    static constexpr int kTypes[] = {VTK_EMPTY_CELL, VTK_EMPTY_CELL, VTK_TRIANGLE, VTK_QUAD, VTK_TETRA, VTK_HEXAHEDRON};
    static constexpr const char* kNames[] = {"ORDERED",       "FELINESEG", "FETRIANGLE", "FEQUADRILATERAL",
                                             "FETETRAHEDRON", "FEBRICK",   "FEPOLYGON",  "FEPOLYHEDRON"};
    if (type < 0 || type == 1 || type > 5)
        throw std::runtime_error("has a zone of kind " +
                                 (type < 0 || type > 7 ? std::to_string(type) : std::string(kNames[type])) +
                                 ", which is not read: write it as FEBRICK or FETETRAHEDRON");
    zone.cellType = kTypes[type];
}

/// The auxiliary value "Common.Time" of files older than zone times.
void readZoneAuxiliary(Bytes& bytes, int version, BinaryZone& zone) {
    while (bytes.flag()) {
        const std::string name = bytes.text();
        bytes.integer();
        const std::string value = bytes.text();
        if (version >= 106 || name != "Common.Time") continue;
        zone.time = std::strtod(value.c_str(), nullptr);
        zone.strand = -2;
    }
}

void readZoneHeader(Bytes& bytes, Layout& layout) {
    const int version = layout.version;
    BinaryZone& zone = layout.zones.emplace_back();
    zone.zone.name = volume::trimmed(bytes.text());
    bytes.place = "the header of " + called(layout, layout.zones.size() - 1);
    if (version >= 107) bytes.integer(); // parent
    if (version >= 106) {
        zone.strand = bytes.integer();
        zone.time = bytes.next<double>();
    }
    bytes.integer(); // colour
    setCellType(zone.zone, bytes.integer());
    const bool ordered = zone.zone.cellType == VTK_EMPTY_CELL;
    if (version < 112) zone.inPoints = bytes.flag();
    if (bytes.flag())
        for (std::size_t v = 0; v < layout.headings.size(); ++v) zone.zone.ofCells.push_back(bytes.flag());
    const bool anyOfCells =
        std::find(zone.zone.ofCells.begin(), zone.zone.ofCells.end(), true) != zone.zone.ofCells.end();
    if (zone.inPoints && anyOfCells) throw std::runtime_error("has values of cells in a zone of points");
    if (version < 103 && (!ordered || anyOfCells))
        throw std::runtime_error("is binary Tecplot of version " + std::to_string(version) +
                                 " with cells, which is not read: write it anew with Tecplot 360, or as CGNS");
    if (version >= 108) zone.faceNeighbours = bytes.flag();
    zone.neighbours = bytes.count("neighbours");
    if (zone.neighbours != 0) {
        zone.neighbourMode = bytes.integer();
        if (version >= 108 && !ordered) bytes.integer(); // whether all neighbours are listed
    }
    if (ordered) {
        for (std::size_t& n : zone.zone.size) n = bytes.count("points");
        countOrdered(zone.zone);
    } else {
        zone.zone.points = bytes.count("points");
        zone.zone.cells = bytes.count("cells");
        bytes.skip(12); // never used
    }
    readZoneAuxiliary(bytes, version, zone);
}

void skipAuxiliary(Bytes& bytes) {
    bytes.text();
    bytes.integer();
    bytes.text();
}

void skipGeometry(Bytes& bytes, int version) {
    const std::int32_t system = bytes.integer();
    bytes.skip((version >= 102 ? 8 : 4) + 24 + 16);
    const std::int32_t kind = bytes.integer(); // line, rectangle, square, circle, ellipse
    bytes.skip(4 + 16 + 12 + 16);
    bytes.text();
    const std::uint64_t each = bytes.integer() == 2 ? 8 : 4;
    bytes.skip(4);
    if (kind != 0) {
        bytes.skip(kind == 1 || kind == 4 ? 2 * each : each);
        return;
    }
    for (std::size_t lines = bytes.count("lines"); lines > 0; --lines)
        bytes.skip(bytes.count("points") * each * (system == 4 ? 3 : 2));
}

void skipText(Bytes& bytes) {
    bytes.skip(8 + 24 + 8 + 8 + 4 + 16 + 8 + 16 + 12);
    bytes.text();
    bytes.skip(4);
    bytes.text();
}

void readHeader(Bytes& bytes, Layout& layout) {
    char magic[9] = {};
    for (int i = 0; i < 8; ++i) magic[i] = bytes.next<char>();
    layout.version = std::atoi(magic + 5);
    const int version = layout.version;
    if (version != 101 && version != 102 && !(version >= 108 && version <= 112) && version != 191)
        throw std::runtime_error("is binary Tecplot of version " + std::to_string(version) +
                                 ", which is not read: write it anew with Tecplot 360, or as CGNS");
    const std::int32_t one = bytes.integer();
    if (one != 1 && one != 1 << 24) throw std::runtime_error("is damaged in its header");
    layout.swap = bytes.swap = one != 1;
    if (version >= 109) layout.fileType = bytes.integer();
    bytes.text(); // title
    for (std::size_t left = bytes.count("variables"); left > 0; --left)
        layout.headings.push_back(parseHeading(bytes.text()));
    for (float marker; (marker = bytes.next<float>()) != kEndOfHeader; bytes.place = "its header") {
        if (marker == kZoneMarker || (marker == kNewZoneMarker && version == 191)) {
            readZoneHeader(bytes, layout);
        } else if (marker == 399) {
            skipGeometry(bytes, version);
            layout.drawings = true;
        } else if (marker == 499) {
            skipText(bytes);
            layout.drawings = true;
        } else if (marker == 599) {
            for (std::size_t labels = bytes.count("labels"); labels > 0; --labels) bytes.text();
        } else if (marker == 699) {
            bytes.text();
        } else if (marker == 799) {
            skipAuxiliary(bytes);
        } else if (marker == 899) {
            bytes.integer();
            skipAuxiliary(bytes);
        } else {
            throw std::runtime_error("has a record of an unknown kind at byte " + std::to_string(bytes.at() - 4));
        }
    }
}

/// Cell values of an ordered zone are stored in rows and planes as long as those of points; the last plane is omitted.
std::size_t valuesInFile(const TecplotZone& zone, bool ofCells) {
    if (!ofCells) return zone.points;
    if (zone.cellType != VTK_EMPTY_CELL) return zone.cells;
    const auto [i, j, k] = zone.size;
    return k > 1 ? i * j * (k - 1) : j > 1 ? i * (j - 1) : i > 1 ? i - 1 : 1;
}

void readVariables(Bytes& bytes, Layout& layout, std::size_t z) {
    BinaryZone& zone = layout.zones[z];
    for (std::size_t v = 0; v < layout.headings.size(); ++v) {
        const std::int32_t format = bytes.integer();
        if (format < 1 || format > 6) throw std::runtime_error("is damaged in " + bytes.place);
        if (format == 6)
            throw std::runtime_error("has values of one bit in " + called(layout, z) +
                                     ", which are not read: write them as bytes");
        zone.stored.push_back({});
        zone.stored.back().format = format;
    }
    zone.zone.ofCells.resize(layout.headings.size(), false);
    if (layout.version >= 108 && bytes.flag())
        for (Stored& stored : zone.stored) stored.passive = bytes.flag();
    if (bytes.flag())
        for (Stored& stored : zone.stored) stored.from = bytes.integer();
    zone.cornersFrom = bytes.integer();
    const auto isStored = [](const Stored& stored) { return !stored.passive && stored.from < 0; };
    const auto count = std::count_if(zone.stored.begin(), zone.stored.end(), isStored);
    if (layout.version >= 108) bytes.skip(std::uint64_t(count) * 16); // minimum and maximum
    const std::uint64_t begin = bytes.at();
    std::size_t record = 0;
    for (std::size_t v = 0; v < zone.stored.size(); ++v) {
        Stored& stored = zone.stored[v];
        if (!isStored(stored)) continue;
        stored.step = kFormats[stored.format].bytes;
        stored.begin = zone.inPoints ? begin + record : bytes.at();
        record += stored.step;
        if (zone.inPoints) continue;
        bytes.place = "the values of " + layout.headings[v].name + " of " + called(layout, z);
        bytes.skip(valuesInFile(zone.zone, zone.zone.ofCells[v]) * std::uint64_t(stored.step));
    }
    if (!zone.inPoints) return;
    bytes.place = "the values of " + called(layout, z);
    bytes.skip(zone.zone.points * std::uint64_t(record));
    for (Stored& stored : zone.stored)
        if (isStored(stored)) stored.step = record;
}

void readCells(Bytes& bytes, const Layout& layout, std::size_t z, BinaryZone& zone) {
    if (zone.cornersFrom >= 0 || layout.fileType == 2) return;
    bytes.place = "the cells of " + called(layout, z);
    zone.corners = bytes.at();
    bytes.skip(zone.zone.cells * std::uint64_t(cornersOf(zone.zone.cellType)) * 4);
    bytes.place = "the neighbours of " + called(layout, z);
    if (zone.faceNeighbours)
        bytes.skip(zone.zone.cells *
                   std::uint64_t(zone.zone.cellType == VTK_HEXAHEDRON ? 6 : cornersOf(zone.zone.cellType)) * 4);
    for (std::size_t n = 0; n < zone.neighbours;) {
        if (zone.neighbourMode % 2 == 0) { // one to one
            bytes.skip(zone.neighbourMode == 0 ? 12 : 16);
            ++n;
            continue;
        }
        bytes.skip(12);
        const std::size_t many = bytes.count("neighbours");
        bytes.skip(many * std::uint64_t(zone.neighbourMode == 1 ? 4 : 8));
        n += std::max<std::size_t>(many, 1);
    }
}

/// The zone that stores the data this one shares, following `from`. Throws if there is none.
std::size_t ownerOf(const Layout& layout, std::size_t zone, auto&& from) {
    std::size_t owner = zone;
    for (std::size_t steps = 0; from(layout.zones[owner]) >= 0; ++steps) {
        owner = static_cast<std::size_t>(from(layout.zones[owner]));
        if (owner >= layout.zones.size() || steps > layout.zones.size())
            throw std::runtime_error("shares numbers of a zone that does not exist in " + called(layout, zone));
    }
    return owner;
}

std::vector<double> readValues(const Layout& layout, std::size_t z, std::size_t variable) {
    const BinaryZone& zone = layout.zones[z];
    const Stored& stored = zone.stored[variable];
    const Format& format = kFormats[stored.format];
    const std::size_t count = valuesInFile(zone.zone, zone.zone.ofCells[variable]);
    std::vector<double> values;
    values.reserve(count);
    while (values.size() < count) {
        const std::size_t some = std::min(count - values.size(), kAtOnce);
        const std::size_t wanted = (some - 1) * stored.step + format.bytes;
        const std::string raw = readPart(layout.path, stored.begin + values.size() * stored.step, wanted);
        if (raw.size() < wanted) throw std::runtime_error("has become shorter while it was read");
        for (std::size_t n = 0; n < some; ++n)
            values.push_back(format.number(raw.data() + n * stored.step, layout.swap));
    }
    if (!zone.zone.ofCells[variable] || zone.zone.cellType != VTK_EMPTY_CELL) return values;
    const auto [i, j, k] = zone.zone.size;
    const auto cells = [](std::size_t points) { return std::max<std::size_t>(points, 2) - 1; };
    std::size_t to = 0;
    for (std::size_t c = 0; c < cells(k); ++c)
        for (std::size_t b = 0; b < cells(j); ++b)
            for (std::size_t a = 0; a < cells(i); ++a) values[to++] = values[(c * j + b) * i + a];
    values.resize(to);
    return values;
}

std::vector<vtkIdType> readCorners(const Layout& layout, std::size_t z) {
    const BinaryZone& zone = layout.zones[z];
    const std::size_t count = zone.zone.cells * cornersOf(zone.zone.cellType);
    const std::string raw = readPart(layout.path, zone.corners, count * 4);
    if (raw.size() < count * 4) throw std::runtime_error("has become shorter while it was read");
    std::vector<vtkIdType> corners(count);
    for (std::size_t n = 0; n < count; ++n) corners[n] = numberAt<std::int32_t>(raw.data() + n * 4, layout.swap);
    return corners;
}

/// Resolves shared data of a zone, and sets the functions that read its numbers.
TecplotZone finished(const std::shared_ptr<const Layout>& layout, std::size_t z) {
    const BinaryZone& from = layout->zones[z];
    TecplotZone zone = from.zone;
    std::vector<std::size_t> owners;
    for (std::size_t v = 0; v < from.stored.size(); ++v) {
        const std::size_t owner =
            ownerOf(*layout, z, [v](const BinaryZone& one) { return one.stored[v].passive ? -1 : one.stored[v].from; });
        const BinaryZone& stores = layout->zones[owner];
        owners.push_back(owner);
        zone.types.push_back(stores.stored[v].passive ? VTK_VOID : kFormats[stores.stored[v].format].vtkType);
        if (owner != z && (stores.zone.ofCells[v] != zone.ofCells[v] || stores.zone.points != zone.points ||
                           stores.zone.cells != zone.cells || stores.zone.size != zone.size))
            throw std::runtime_error("shares numbers of another size in " + called(*layout, z));
    }
    zone.values = [layout, owners](std::size_t variable) { return readValues(*layout, owners[variable], variable); };
    if (zone.cellType == VTK_EMPTY_CELL) return zone;
    const std::size_t owner = ownerOf(*layout, z, [](const BinaryZone& one) { return one.cornersFrom; });
    const TecplotZone& stores = layout->zones[owner].zone;
    if (stores.cellType != zone.cellType || stores.cells != zone.cells)
        throw std::runtime_error("shares cells of another kind or number in " + called(*layout, z));
    zone.corners = [layout, owner] { return readCorners(*layout, owner); };
    return zone;
}

} // namespace

bool isTecplotGrid(const std::string& head) {
    if (head.size() < 16 || std::atoi(head.substr(5, 3).c_str()) < 109) return false;
    const std::string type = head.substr(12, 4);
    return type == std::string("\1\0\0\0", 4) || type == std::string("\0\0\0\1", 4);
}

TecplotFile readBinaryTecplot(const std::string& path) {
    Layout read;
    read.path = path;
    Bytes bytes(path);
    readHeader(bytes, read);
    for (std::size_t z = 0; z < read.zones.size(); ++z) {
        bytes.place = called(read, z);
        const float marker = bytes.next<float>();
        if (marker != kZoneMarker && !(marker == kNewZoneMarker && read.version == 191))
            throw std::runtime_error("has something else where " + called(read, z) + " belongs, at byte " +
                                     std::to_string(bytes.at() - 4));
        readVariables(bytes, read, z);
        readCells(bytes, read, z, read.zones[z]);
    }
    if (bytes.left() != 0)
        throw std::runtime_error("has " + std::to_string(bytes.left()) + " bytes more than its zones announce");
    // Zones without a strand are static, unless no zone has one: then their times, if any, are used.
    const auto ofStrand = [](const BinaryZone& zone) { return zone.strand != -1; };
    const bool strands = std::any_of(read.zones.begin(), read.zones.end(), ofStrand);
    const bool times =
        std::any_of(read.zones.begin(), read.zones.end(), [](const BinaryZone& zone) { return zone.time != 0; });
    const auto layout = std::make_shared<const Layout>(std::move(read));
    std::vector<TecplotZone> zones;
    for (std::size_t z = 0; z < layout->zones.size(); ++z) {
        const BinaryZone& from = layout->zones[z];
        if (from.zone.points == 0) continue; // left out when the file was written
        TecplotZone zone = finished(layout, z);
        if (strands ? ofStrand(from) : times) zone.time = from.time;
        if (from.strand >= 0) zone.strand = from.strand;
        zones.push_back(std::move(zone));
    }
    return {layout->headings, std::move(zones), layout->fileType == 1, layout->fileType == 2, layout->drawings};
}

} // namespace tessera::importer
