#pragma once

#include "volume/field/dataset.h"

#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <stdexcept>
#include <string>
#include <unistd.h>
#include <vector>

/// Small data sets with known samples for the tests of the codec.
namespace tessera::codec::testing {

/// How the samples of a made parameter look.
enum class Texture { Smooth, Noise, Constant, Decimals, Nasty, Sparse };

struct MadeParameter {
    std::string name;
    volume::ScalarType type = volume::ScalarType::F32;
    int components = 1;
    Texture texture = Texture::Smooth;
    bool masked = false;
    bool categorical = false;
};

/// The stored number of a sample. Nasty: every extreme of the type; for floats also NaN payloads, infinities and -0.
template <class T> T madeSample(Texture texture, glm::ivec3 at, int component, int time, std::mt19937& random) {
    const auto noise = static_cast<std::uint32_t>(random());
    const double smooth = std::sin(at.x * 0.21 + component) + std::cos(at.y * 0.17 + time * 0.3) + at.z * 0.02;
    const int sparse = (at.x + 3 * at.y + 5 * at.z) % 29 == 0 ? 1 + (at.x + at.z) % 2 : 0;
    if constexpr (std::is_same_v<T, float>) {
        switch (texture) {
        case Texture::Smooth:
            return static_cast<float>(400 + 30 * smooth);
        case Texture::Noise:
            return static_cast<float>(int(noise % 2000) - 1000) * 1.000123f;
        case Texture::Constant:
            return 434.25f;
        case Texture::Decimals:
            return static_cast<float>(std::rint(2731.5 + 400 * smooth) / 10.0);
        case Texture::Sparse:
            return static_cast<float>(sparse) * 0.3333f;
        case Texture::Nasty:
            break;
        }
        const std::uint32_t special[] = {0x80000000u, 0x7f800000u, 0xff800000u, 0x7fc01234u,
                                         0xffa00001u, 1u,          0x7f7fffffu};
        return std::bit_cast<float>(noise % 5 == 0 ? special[noise / 5 % 7] : noise);
    } else {
        constexpr double kHigh = double(std::numeric_limits<T>::max()), kLow = double(std::numeric_limits<T>::lowest());
        switch (texture) {
        case Texture::Smooth:
        case Texture::Decimals:
            return static_cast<T>(std::rint(60 + 20 * smooth));
        case Texture::Noise:
            return static_cast<T>(noise % 100);
        case Texture::Constant:
            return T(7);
        case Texture::Sparse:
            return static_cast<T>(50 * sparse);
        case Texture::Nasty:
            break;
        }
        return noise % 3 == 0 ? static_cast<T>(noise % 2 == 0 ? kHigh : kLow) : static_cast<T>(noise);
    }
}

/// A data set whose frames are made when asked for. Masked parameters are absent in a slab, in single places, and hold
/// other numbers there.
inline volume::Dataset makeDataset(glm::ivec3 size, const std::vector<MadeParameter>& parameters, int times,
                                   volume::LatticeKind kind = volume::LatticeKind::CC) {
    volume::Dataset made;
    made.info.name = "made";
    made.info.lattice = {kind, size, {1.0, 1.0, 0.5}, {0, 0, 0}};
    made.info.bounds = {{0, 0, 0}, made.info.lattice.position(size - 1)};
    made.info.times.clear();
    for (int t = 0; t < times; ++t) made.info.times.push_back(0.5 * t);
    for (const MadeParameter& p : parameters) {
        volume::Parameter parameter;
        parameter.name = p.name;
        parameter.unit = "K";
        parameter.components = p.components;
        parameter.type = p.type;
        parameter.categorical = p.categorical;
        if (p.categorical) parameter.labels = {{0, "solid"}, {1, "air \"side\""}};
        made.info.parameters.push_back(parameter);
    }
    made.read = [parameters, lattice = made.info.lattice](int p, int component, int time) {
        const MadeParameter& about = parameters[std::size_t(p)];
        volume::Field field = volume::makeField(lattice, about.type);
        std::mt19937 random(unsigned(p * 1000 + component * 100 + time));
        volume::Mask mask(field.count(), 1);
        volume::dispatch(about.type, [&]<class T>(T) {
            const auto samples = field.as<T>();
            std::size_t i = 0;
            for (int z = 0; z < lattice.size.z; ++z)
                for (int y = 0; y < lattice.size.y; ++y)
                    for (int x = 0; x < lattice.size.x; ++x, ++i) {
                        samples[i] = madeSample<T>(about.texture, {x, y, z}, component, time, random);
                        if (about.masked &&
                            ((y > lattice.size.y / 2 && y < lattice.size.y / 2 + 6) || (x * 7 + z) % 23 == 0)) {
                            mask[i] = 0;
                            samples[i] = T(0);
                        }
                    }
        });
        if (about.masked) field.mask = std::make_shared<const volume::Mask>(std::move(mask));
        return field;
    };
    return made;
}

/// One of every type and texture, some with absent samples, and a label.
inline std::vector<MadeParameter> everyKind() {
    return {{"a", volume::ScalarType::U8, 1, Texture::Smooth, false, false},
            {"b", volume::ScalarType::U8, 1, Texture::Nasty, true, false},
            {"c", volume::ScalarType::I16, 1, Texture::Nasty, false, false},
            {"d", volume::ScalarType::U16, 1, Texture::Smooth, true, false},
            {"e", volume::ScalarType::I32, 1, Texture::Nasty, true, false},
            {"f", volume::ScalarType::F32, 3, Texture::Smooth, true, false},
            {"g", volume::ScalarType::F32, 1, Texture::Nasty, false, false},
            {"h", volume::ScalarType::F32, 1, Texture::Decimals, false, false},
            {"i", volume::ScalarType::F32, 1, Texture::Constant, false, false},
            {"j", volume::ScalarType::F32, 2, Texture::Noise, false, false},
            {"region", volume::ScalarType::U8, 1, Texture::Noise, false, true}};
}

/// A folder of its own that disappears with the object.
class TemporaryFolder {
public:
    TemporaryFolder() {
        // In memory where there is such a place: the hostile tests write thousands of small files.
        std::string name = "/dev/shm/tessera-XXXXXX";
        if (!mkdtemp(name.data())) {
            name = (std::filesystem::temp_directory_path() / "tessera-XXXXXX").string();
            if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
        }
        path_ = name;
    }
    ~TemporaryFolder() { std::filesystem::remove_all(path_); }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    std::string operator/(const std::string& name) const { return path_ + "/" + name; }
    std::size_t files() const { return std::size_t(std::distance(std::filesystem::directory_iterator(path_), {})); }

private:
    std::string path_;
};

inline std::vector<char> readFile(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}
inline void writeFile(const std::string& path, const std::vector<char>& bytes) {
    std::ofstream(path, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
}

/// The same data set, read in parts.
inline volume::Dataset inParts(volume::Dataset made) {
    made.read = [read = made.read](int p, int c, int t, volume::SliceRange slices) { return read(p, c, t, slices); };
    return made;
}

} // namespace tessera::codec::testing
