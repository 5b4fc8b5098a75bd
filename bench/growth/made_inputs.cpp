#include "bench/growth/made_inputs.h"

#include "volume/base/error.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <vector>

namespace tessera::app {

namespace fs = std::filesystem;

namespace {

std::ofstream opened(const std::string& path) {
    std::ofstream out(path, std::ios::binary);
    if (!out) throw MachineError("cannot be written", path);
    return out;
}

void close(std::ofstream& out, const std::string& path) {
    out.close();
    if (!out) throw MachineError("cannot be written", path);
}

template <class T> void put(std::ofstream& out, const std::vector<T>& values) {
    out.write(reinterpret_cast<const char*>(values.data()), std::streamsize(values.size() * sizeof(T)));
}

int edgeFor(double samples) {
    return std::max(2, int(std::lround(std::cbrt(samples))));
}

/// A wave along each axis, and noise of a hundredth.
class Signal {
public:
    explicit Signal(int seed) : state_(std::uint32_t(seed) * 2654435761u + 1), phase_(0.7 * seed) {}
    float at(double x, double y, double z) {
        state_ = state_ * 1664525u + 1013904223u;
        const double noise = double(state_ >> 8) / double(1u << 24) - 0.5;
        return float(std::sin(0.11 * x + phase_) + std::cos(0.07 * y) * std::sin(0.05 * z + phase_) + 0.01 * noise);
    }

private:
    std::uint32_t state_;
    double phase_;
};

void putSamples(std::ofstream& out, int edge, int seed) {
    Signal signal(seed);
    std::vector<float> slice(std::size_t(edge) * std::size_t(edge));
    for (int z = 0; z < edge; ++z) {
        for (int y = 0; y < edge; ++y)
            for (int x = 0; x < edge; ++x)
                slice[std::size_t(y) * std::size_t(edge) + std::size_t(x)] = signal.at(x, y, z);
        put(out, slice);
    }
}

std::string cube(int edge) {
    const std::string n = std::to_string(edge);
    return n + ", " + n + ", " + n;
}

/// Writes the sidecar of `stem`.raw and gives its path.
std::string makeSidecar(const std::string& stem, int edge, const std::string& type, const std::string& components) {
    const std::string path = stem + ".json";
    std::ofstream out = opened(path);
    out << R"({"dims": [)" << cube(edge) << R"(], "dtype": ")" << type << "\"";
    if (!components.empty()) out << R"(, "components": [)" << components << "]";
    out << "}\n";
    close(out, path);
    return path;
}

std::string numbered(int number) {
    char text[16];
    std::snprintf(text, sizeof text, "%05d", number);
    return text;
}

/// 8x8x8 bytes that differ from time to time.
std::vector<std::uint8_t> smallVolume(int time) {
    constexpr int kEdge = 8;
    Signal signal(time);
    std::vector<std::uint8_t> out;
    for (int z = 0; z < kEdge; ++z)
        for (int y = 0; y < kEdge; ++y)
            for (int x = 0; x < kEdge; ++x)
                out.push_back(std::uint8_t(128 + 60 * double(signal.at(4 * x, 4 * y, 4 * z))));
    return out;
}

} // namespace

std::string makeRawFile(const std::string& folder, double bytes) {
    const int edge = edgeFor(bytes / sizeof(float));
    const std::string stem = folder + "/raw";
    std::ofstream out = opened(stem + ".raw");
    putSamples(out, edge, 1);
    close(out, stem + ".raw");
    return makeSidecar(stem, edge, "float32", "");
}

std::string makeSparseFile(const std::string& folder, double bytes) {
    const int edge = edgeFor(bytes / sizeof(float));
    const std::string stem = folder + "/sparse";
    std::ofstream out = opened(stem + ".raw");
    close(out, stem + ".raw");
    fs::resize_file(stem + ".raw", std::uintmax_t(edge) * std::uintmax_t(edge) * std::uintmax_t(edge) * sizeof(float));
    return makeSidecar(stem, edge, "float32", "");
}

std::string makeParameters(const std::string& folder, int count) {
    constexpr int kEdge = 32;
    const std::string stem = folder + "/parameters";
    std::ofstream out = opened(stem + ".raw");
    std::string names;
    for (int p = 0; p < count; ++p) {
        putSamples(out, kEdge, p);
        names += (p > 0 ? ", \"" : "\"") + std::string("q") + numbered(p) + "\"";
    }
    close(out, stem + ".raw");
    return makeSidecar(stem, kEdge, "float32", names);
}

std::string makeRawSeries(const std::string& folder, int times) {
    const std::string path = folder + "/series";
    fs::create_directory(path);
    for (int t = 0; t < times; ++t) {
        const std::string stem = path + "/cell_" + numbered(t);
        std::ofstream out = opened(stem + ".raw");
        put(out, smallVolume(t));
        close(out, stem + ".raw");
        makeSidecar(stem, 8, "uint8", "");
    }
    return path;
}

std::string makeImageSeries(const std::string& folder, int times) {
    const std::string path = folder + "/images";
    fs::create_directory(path);
    for (int t = 0; t < times; ++t) {
        const std::string file = path + "/cell_" + numbered(t) + ".vti";
        std::ofstream out = opened(file);
        out << R"(<?xml version="1.0"?>
<VTKFile type="ImageData" version="1.0" byte_order="LittleEndian" header_type="UInt64">
<ImageData WholeExtent="0 7 0 7 0 7" Origin="0 0 0" Spacing="1 1 1"><Piece Extent="0 7 0 7 0 7">
<PointData><DataArray type="UInt8" Name="value" format="appended" offset="0"/></PointData>
</Piece></ImageData>
<AppendedData encoding="raw">_)";
        const std::vector<std::uint8_t> values = smallVolume(t);
        put(out, std::vector<std::uint64_t>{values.size()});
        put(out, values);
        out << "</AppendedData></VTKFile>\n";
        close(out, file);
    }
    return path;
}

std::string makeTable(const std::string& folder, int rows) {
    const int edge = edgeFor(rows);
    const std::string path = folder + "/table.csv";
    std::ofstream out = opened(path);
    out << "x,y,z,value\n";
    Signal signal(1);
    char line[96];
    for (int z = 0; z < edge; ++z)
        for (int y = 0; y < edge; ++y)
            for (int x = 0; x < edge; ++x)
                out.write(line,
                          std::snprintf(line, sizeof line, "%d,%d,%d,%.6f\n", x, y, z, double(signal.at(x, y, z))));
    close(out, path);
    return path;
}

std::string makeWideTable(const std::string& folder, int columns) {
    constexpr int kEdge = 10;
    const std::string path = folder + "/wide.csv";
    std::ofstream out = opened(path);
    out << "x,y,z";
    for (int c = 0; c < columns; ++c) out << ",q" << numbered(c);
    out << "\n";
    Signal signal(1);
    for (int z = 0; z < kEdge; ++z)
        for (int y = 0; y < kEdge; ++y)
            for (int x = 0; x < kEdge; ++x) {
                out << x << ',' << y << ',' << z;
                for (int c = 0; c < columns; ++c) out << ',' << signal.at(x + 3 * c, y, z);
                out << "\n";
            }
    close(out, path);
    return path;
}

std::string makeSweptTable(const std::string& folder, int times) {
    constexpr int kEdge = 4;
    const std::string path = folder + "/swept.csv";
    std::ofstream out = opened(path);
    out << "x,y,z";
    for (int t = 0; t < times; ++t) out << ",T @ t=" << t;
    out << "\n";
    Signal signal(1);
    for (int z = 0; z < kEdge; ++z)
        for (int y = 0; y < kEdge; ++y)
            for (int x = 0; x < kEdge; ++x) {
                out << x << ',' << y << ',' << z;
                for (int t = 0; t < times; ++t) out << ',' << signal.at(x + 3 * t, y, z);
                out << "\n";
            }
    close(out, path);
    return path;
}

std::string makeTimeTable(const std::string& folder, int columns, int times) {
    const std::string path = folder + "/overtime.csv";
    std::ofstream out = opened(path);
    out << "step";
    for (int c = 0; c < columns; ++c) out << ",q" << numbered(c);
    out << "\n";
    Signal signal(1);
    for (int t = 0; t < times; ++t) {
        out << t;
        for (int c = 0; c < columns; ++c) out << ',' << signal.at(t, c, 0);
        out << "\n";
    }
    close(out, path);
    return path;
}

std::string makeMesh(const std::string& folder, int cells) {
    const int edge = edgeFor(cells), points = edge + 1;
    const auto n = std::uint64_t(edge) * std::uint64_t(edge) * std::uint64_t(edge),
               nodes = std::uint64_t(points) * std::uint64_t(points) * std::uint64_t(points);
    const std::uint64_t bytes[] = {nodes * 12, nodes * 4, n * 8 * 4, n * 4, n};
    const std::string path = folder + "/mesh.vtu";
    std::ofstream out = opened(path);
    std::uint64_t at = 0;
    const auto array = [&](int which, const char* type, const char* name, int components) {
        out << "<DataArray type=\"" << type << "\" Name=\"" << name << "\" NumberOfComponents=\"" << components
            << "\" format=\"appended\" offset=\"" << at << "\"/>\n";
        at += sizeof(std::uint64_t) + bytes[which];
    };
    out << R"(<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64">
<UnstructuredGrid><Piece NumberOfPoints=")"
        << nodes << "\" NumberOfCells=\"" << n << "\">\n<Points>";
    array(0, "Float32", "Points", 3);
    out << "</Points>\n<PointData>";
    array(1, "Float32", "value", 1);
    out << "</PointData>\n<Cells>";
    array(2, "Int32", "connectivity", 1);
    array(3, "Int32", "offsets", 1);
    array(4, "UInt8", "types", 1);
    out << "</Cells>\n</Piece></UnstructuredGrid>\n<AppendedData encoding=\"raw\">_";
    // Moved a little, so that the cells are no boxes.
    Signal moved(2), signal(1);
    const auto begin = [&](int which) { put(out, std::vector<std::uint64_t>{bytes[which]}); };
    const auto eachNode = [&](auto&& give) {
        for (int z = 0; z < points; ++z)
            for (int y = 0; y < points; ++y) {
                std::vector<float> row;
                for (int x = 0; x < points; ++x) give(row, x, y, z);
                put(out, row);
            }
    };
    begin(0);
    eachNode([&](std::vector<float>& row, int x, int y, int z) {
        for (const int place : {x, y, z}) row.push_back(float(place) + 0.1f * moved.at(x, y, z));
    });
    begin(1);
    eachNode([&](std::vector<float>& row, int x, int y, int z) { row.push_back(signal.at(x, y, z)); });
    begin(2);
    for (int z = 0; z < edge; ++z)
        for (int y = 0; y < edge; ++y) {
            std::vector<std::int32_t> row;
            for (int x = 0; x < edge; ++x) {
                const int up = points, above = points * points, first = (z * points + y) * points + x;
                for (const int corner : {0, 1, 1 + up, up, above, above + 1, above + 1 + up, above + up})
                    row.push_back(first + corner);
            }
            put(out, row);
        }
    const auto eachRow = [&](auto&& give) {
        for (std::int32_t first = 0; first < std::int32_t(n); first += edge) give(first);
    };
    begin(3);
    eachRow([&](std::int32_t first) {
        std::vector<std::int32_t> row;
        for (int x = 1; x <= edge; ++x) row.push_back(8 * (first + x));
        put(out, row);
    });
    begin(4);
    eachRow([&](std::int32_t) { put(out, std::vector<std::uint8_t>(std::size_t(edge), 12)); }); // hexahedra
    out << "</AppendedData></VTKFile>\n";
    close(out, path);
    return path;
}

} // namespace tessera::app
