#include "vis/image/light_picture.h"

#include "vis/image/image_io.h"
#include "vis/optics/ray_setup.h"
#include "volume/base/error.h"
#include "volume/base/parallel.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <glm/common.hpp>
#include <glm/gtc/constants.hpp>
#include <string_view>

namespace tessera::vis {

namespace {

constexpr std::size_t kMostPixels = std::size_t(1) << 25;
constexpr float kBrightest = 65504; ///< limit for the sun, so that values fit into half floats
constexpr int kPictureEdge = 2 * kSurroundingsEdge;

/// Sequential reader of a file's bytes; throws beyond their end.
class Bytes {
public:
    Bytes(std::span<const std::uint8_t> bytes, const std::string& name) : bytes_(bytes), name_(name) {}
    [[noreturn]] void fail(const std::string& what) const {
        throw Error("damaged picture: " + what, name_, "byte " + std::to_string(at_));
    }
    std::uint8_t next() {
        if (at_ == bytes_.size()) fail("the file ends too early");
        return bytes_[at_++];
    }
    /// Reads the rest of a line, without its end.
    std::string_view line() {
        const auto begin = bytes_.begin() + std::ptrdiff_t(at_), end = std::find(begin, bytes_.end(), '\n');
        if (end == bytes_.end()) fail("the file ends too early");
        at_ += std::size_t(end - begin) + 1;
        return {reinterpret_cast<const char*>(&*begin), std::size_t(end - begin)};
    }
    std::size_t left() const { return bytes_.size() - at_; }
    /// The next four bytes, not consumed.
    std::span<const std::uint8_t> peek() const { return bytes_.subspan(at_, std::min<std::size_t>(left(), 4)); }

private:
    std::span<const std::uint8_t> bytes_;
    const std::string& name_;
    std::size_t at_ = 0;
};

/// Parses "-Y 512 +X 1024": 1024 wide, 512 high.
glm::ivec2 sizeOf(std::string_view line, const Bytes& in) {
    const auto number = [&](std::string_view before) {
        if (!line.starts_with(before)) in.fail("rows must run from left to right and top to bottom");
        line.remove_prefix(before.size());
        int value = 0;
        const auto [end, problem] = std::from_chars(line.data(), line.data() + line.size(), value);
        if (problem != std::errc() || value <= 0) in.fail("its size cannot be read");
        line.remove_prefix(std::size_t(end - line.data()));
        return value;
    };
    const int height = number("-Y "), width = number(" +X ");
    if (!line.empty()) in.fail("its size cannot be read");
    if (std::size_t(width) * std::size_t(height) > kMostPixels) in.fail("it has more than 2^25 pixels");
    return {width, height};
}

using Rgbe = std::array<std::uint8_t, 4>;

/// Reads a run-length coded row, component by component, after its first four bytes.
void readRuns(Bytes& in, std::vector<Rgbe>& row) {
    for (std::size_t part = 0; part < 4; ++part)
        for (std::size_t x = 0; x < row.size();) {
            const std::size_t code = in.next(), count = code > 128 ? code - 128 : code;
            if (count == 0 || count > row.size() - x) in.fail("a run is longer than its row");
            std::uint8_t value = code > 128 ? in.next() : std::uint8_t(0);
            for (std::size_t end = x + count; x < end; ++x) {
                if (code <= 128) value = in.next();
                row[x][part] = value;
            }
        }
}

/// Reads a row of whole pixels; (1, 1, 1, n) repeats the last pixel n times, directly followed by another one 256 n
/// times, ...
void readPixels(Bytes& in, std::vector<Rgbe>& row) {
    int shift = 0;
    for (std::size_t x = 0; x < row.size();) {
        Rgbe pixel;
        for (std::uint8_t& part : pixel) part = in.next();
        if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
            row[x++] = pixel;
            shift = 0;
            continue;
        }
        const std::size_t count = shift < 24 ? std::size_t(pixel[3]) << shift : row.size() + 1;
        if (x == 0 || count > row.size() - x) in.fail("a run is longer than its row");
        std::fill_n(row.begin() + std::ptrdiff_t(x), count, row[x - 1]);
        x += count;
        shift += 8;
    }
}

LightPicture decodeRadiance(std::span<const std::uint8_t> bytes, const std::string& name) {
    Bytes in(bytes, name);
    in.line(); // "#?RADIANCE"
    double exposure = 1;
    for (std::string_view line = in.line(); !line.empty(); line = in.line()) {
        if (line.starts_with("FORMAT=") && line != "FORMAT=32-bit_rle_rgbe") in.fail("its colours are not RGBE");
        if (!line.starts_with("EXPOSURE=")) continue;
        line.remove_prefix(9);
        line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
        double factor = 0;
        std::from_chars(line.data(), line.data() + line.size(), factor);
        if (!(factor > 1e-30 && factor < 1e30)) in.fail("its exposure cannot be read");
        exposure *= factor;
    }
    LightPicture picture;
    picture.size = sizeOf(in.line(), in);
    const auto width = std::size_t(picture.size.x), height = std::size_t(picture.size.y);
    // A row takes at least a byte per 127 pixels, so a header alone cannot request a gigabyte.
    if (in.left() / height < width / 128) in.fail("the file ends too early");
    picture.rgb.resize(width * height);
    std::vector<Rgbe> row(width);
    for (std::size_t y = 0; y < height; ++y) {
        const std::span<const std::uint8_t> head = in.peek();
        const bool runs = width >= 8 && width < 32768 && head.size() == 4 && head[0] == 2 && head[1] == 2 &&
                          std::size_t(head[2]) << 8 == (width & 0x7f00) && head[3] == (width & 0xff);
        if (runs) {
            for (int i = 0; i < 4; ++i) in.next();
            readRuns(in, row);
        } else {
            readPixels(in, row);
        }
        for (std::size_t x = 0; x < width; ++x) {
            const Rgbe& p = row[x];
            const double unit = p[3] == 0 ? 0 : std::ldexp(1.0, int(p[3]) - 136) / exposure;
            const glm::dvec3 color = (glm::dvec3(p[0], p[1], p[2]) + 0.5) * unit;
            picture.rgb[y * width + x] = glm::vec3(glm::min(color, glm::dvec3(kBrightest)));
        }
    }
    return picture;
}

/// Position in an equirectangular picture, 0..1 from the upper left corner.
glm::dvec2 allAround(glm::dvec3 d) {
    return {0.5 + std::atan2(d.x, -d.z) / glm::two_pi<double>(),
            std::acos(glm::clamp(d.y, -1.0, 1.0)) / glm::pi<double>()};
}

/// The same in a cross of 4 x 3 squares, or 3 x 4 if `upright`.
glm::dvec2 onCross(glm::dvec3 d, bool upright) {
    const glm::dvec3 a = glm::abs(d);
    glm::dvec2 square(1, 1), at; // index of the square; position in it, -1..1, y down
    if (a.z >= a.x && a.z >= a.y) {
        at = glm::dvec2(d.x, -d.y) / a.z; // centre
        if (d.z > 0) {
            square = upright ? glm::dvec2(1, 3) : glm::dvec2(3, 1);
            at = upright ? -glm::dvec2(-at.x, at.y) : glm::dvec2(-at.x, at.y);
        }
    } else if (a.x >= a.y) {
        square.x = d.x > 0 ? 2 : 0;
        at = glm::dvec2(d.x > 0 ? d.z : -d.z, -d.y) / a.x;
    } else {
        square.y = d.y > 0 ? 0 : 2;
        at = glm::dvec2(d.x, d.y > 0 ? -d.z : d.z) / a.y;
    }
    return (square + 0.5 + 0.5 * at) / (upright ? glm::dvec2(3, 4) : glm::dvec2(4, 3));
}

} // namespace

LightPicture decodeLightPicture(std::span<const std::uint8_t> bytes, const std::string& name) {
    const auto starts = [&](std::string_view with) {
        return bytes.size() >= with.size() &&
               std::equal(with.begin(), with.end(), bytes.begin(),
                          [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; });
    };
    if (starts("#?")) return decodeRadiance(bytes, name);
    if (!starts("\x89PNG")) throw Error("is neither a Radiance picture nor a PNG", name);
    const Image image = decodePng(bytes, name);
    LightPicture picture;
    picture.size = image.size;
    if (image.rgba.size() / 4 > kMostPixels) throw Error("the picture has more than 2^25 pixels", name);
    double linear[256];
    for (int i = 0; i < 256; ++i) linear[i] = linearFromSrgb(i / 255.0);
    for (std::size_t i = 0; i < image.rgba.size(); i += 4)
        picture.rgb.emplace_back(linear[image.rgba[i]], linear[image.rgba[i + 1]], linear[image.rgba[i + 2]]);
    return picture;
}

CubeMap surroundingsOf(const LightPicture& picture, const std::string& name) {
    const glm::ivec2 size = picture.size;
    const auto shaped = [&](int x, int y) {
        return size.x > 0 && std::int64_t(size.x) * y == std::int64_t(size.y) * x;
    };
    if (!shaped(2, 1) && !shaped(4, 3) && !shaped(3, 4))
        throw Error("a picture of the surroundings must be a panorama of 2:1 or a cube map cross of 4:3 or 3:4, not " +
                        std::to_string(size.x) + " x " + std::to_string(size.y),
                    name);
    CubeMap map;
    map.edge = kPictureEdge;
    map.texels.resize(6 * std::size_t(map.edge) * std::size_t(map.edge));
    // Chosen so that every pixel is sampled about once.
    const int around = shaped(3, 4) ? size.y : size.x;
    const int parts = std::clamp((around + 4 * map.edge - 1) / (4 * map.edge) + 1, 2, 64);
    parallelFor(map.texels.size(), [&](std::size_t i) {
        const auto n = std::size_t(map.edge);
        glm::dvec3 sum(0);
        for (int y = 0; y < parts; ++y)
            for (int x = 0; x < parts; ++x) {
                const double u = double(i % n) + (x + 0.5) / parts, v = double(i / n % n) + (y + 0.5) / parts;
                const glm::dvec3 d = CubeMap::direction(int(i / (n * n)), 2 * u / map.edge - 1, 2 * v / map.edge - 1);
                const glm::dvec2 at = shaped(2, 1) ? allAround(d) : onCross(d, shaped(3, 4));
                const glm::ivec2 pixel = glm::clamp(glm::ivec2(at * glm::dvec2(size)), glm::ivec2(0), size - 1);
                sum += glm::dvec3(picture.rgb[std::size_t(pixel.y) * std::size_t(size.x) + std::size_t(pixel.x)]);
            }
        map.texels[i] = sum / double(parts * parts);
    });
    return map;
}

CubeMap readSurroundings(const std::string& path) {
    return surroundingsOf(decodeLightPicture(readBytes(path), path), path);
}

} // namespace tessera::vis
