#include "codec/pack/pack.h"
#include "tests/codec/make_dataset.h"
#include "volume/synthetic/casting.h"
#include "volume/synthetic/fuel_cell.h"
#include "volume/synthetic/marschner_lobb.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace tessera::codec {
namespace {

using namespace testing;

/// One parameter of a data set at its last time.
volume::Dataset only(const volume::Dataset& made, int parameter, double time = -1) {
    volume::Dataset one = made;
    one.info.parameters = {made.info.parameters[std::size_t(parameter)]};
    one.info.parameters[0].parts = {};
    one.info.times = {0};
    one.info.quantities.clear();
    const int last = time < 0 ? int(made.info.times.size()) - 1 : int(time);
    one.read = [read = made.read, parameter, last](int, int component, int) {
        return read(parameter, component, last);
    };
    return one;
}

/// A field that is smooth but for where its slope jumps, as temperatures across layers do.
volume::Dataset layers() {
    volume::Dataset made =
        makeDataset({24, 40, 96}, {{"T", volume::ScalarType::F32, 1, Texture::Smooth, false, false}}, 1);
    made.read = [lattice = made.info.lattice](int, int, int) {
        volume::Field field = volume::makeField(lattice, volume::ScalarType::F32);
        std::size_t i = 0;
        for (int z = 0; z < lattice.size.z; ++z)
            for (int y = 0; y < lattice.size.y; ++y)
                for (int x = 0; x < lattice.size.x; ++x, ++i)
                    field.as<float>()[i] = float(360 + 8 * std::exp(-std::abs(y - 19.3) / 6) * std::sin(0.03 * z) +
                                                 0.2 * std::cos(0.7 * x));
        return field;
    };
    return made;
}

/// Bytes of an archive.
double bytesOf(volume::Dataset made, PackOptions options, BccTransform transform, const std::string& path) {
    options.lattice = StoredLattice::BCC;
    options.bccTransform = transform;
    return double(pack(made, options, path).archiveBytes);
}

// What suits rounded samples need not suit rounded coefficients.
TEST(TransformChoice, AutoIsNearlyAsShortAsTheShorterOne) {
    const TemporaryFolder folder;
    const volume::Dataset cell = volume::makeFuelCell({{"times", 2}}), casting = volume::makeCasting({});
    std::vector<std::pair<std::string, volume::Dataset>> fields{{"layers", layers()}, {"casting", casting}};
    for (std::size_t p = 0; p < cell.info.parameters.size(); ++p)
        if (!cell.info.parameters[p].categorical) fields.emplace_back(cell.info.parameters[p].name, only(cell, int(p)));
    fields.emplace_back("Marschner-Lobb", volume::makeMarschnerLobb({}));
    for (const Texture texture : {Texture::Smooth, Texture::Noise, Texture::Decimals})
        fields.emplace_back("made", makeDataset({33, 40, 36}, {{"a", volume::ScalarType::F32, 1, texture}}, 1));
    for (const volume::ScalarType type : {volume::ScalarType::I16, volume::ScalarType::I32})
        fields.emplace_back("made", makeDataset({33, 40, 36}, {{"a", type, 1, Texture::Smooth}}, 1));
    std::vector<PackOptions> all(1);
    for (const double bound : {1e-2, 1e-3, 1e-4}) all.emplace_back().maxError = bound;
    for (const double psnr : {40., 60.}) all.emplace_back().psnr = psnr;
    for (const auto& [name, made] : fields)
        for (const PackOptions& options : all) {
            const double separable = bytesOf(made, options, BccTransform::Separable, folder / "a.tsr"),
                         centred = bytesOf(made, options, BccTransform::BodyCentred, folder / "a.tsr"),
                         chosen = bytesOf(made, options, BccTransform::Auto, folder / "a.tsr");
            EXPECT_LE(chosen, 1.1 * std::min(separable, centred))
                << name << " within " << options.maxError << " " << options.psnr << ": " << separable << " separable, "
                << centred << " body-centred, " << chosen << " chosen";
        }
}

// Of a series the time before gives the transform.
TEST(TransformChoice, HoldsForLaterTimes) {
    const TemporaryFolder folder;
    volume::Dataset made = layers();
    made.info.times = {0, 1, 2, 3};
    made.read = [read = made.read](int p, int c, int time) {
        volume::Field field = read(p, c, 0);
        std::size_t i = 0;
        for (float& sample : field.as<float>()) sample += float(0.3 * time * std::sin(0.01 * double(i++ % 960)));
        return field;
    };
    PackOptions options;
    options.maxError = 1e-3;
    const double separable = bytesOf(made, options, BccTransform::Separable, folder / "a.tsr"),
                 centred = bytesOf(made, options, BccTransform::BodyCentred, folder / "a.tsr"),
                 chosen = bytesOf(made, options, BccTransform::Auto, folder / "a.tsr");
    EXPECT_GT(std::max(separable, centred), 1.1 * std::min(separable, centred)) << "nothing to choose";
    EXPECT_LE(chosen, 1.1 * std::min(separable, centred)) << separable << " " << centred;
}

} // namespace
} // namespace tessera::codec
