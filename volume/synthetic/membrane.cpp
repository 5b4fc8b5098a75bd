#include "volume/synthetic/membrane.h"

#include "volume/base/parallel.h"
#include "volume/field/own_axes.h"
#include "volume/synthetic/settings.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace tessera::volume {

namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr int kLast = int(Membrane::kLayers.size()) - 1;

/// Appends borders of `cells` cells up to `end`, the last of them `ratio` times as long as the first.
void addGraded(std::vector<double>& planes, double end, int cells, double ratio) {
    const double begin = planes.back(), step = cells > 1 ? std::pow(ratio, 1.0 / (cells - 1)) : 1;
    double sum = 0, reached = 0, cell = 1;
    for (int i = 0; i < cells; ++i, cell *= step) sum += cell;
    cell = 1;
    for (int i = 0; i < cells; ++i, cell *= step) {
        reached += cell;
        planes.push_back(i + 1 == cells ? end : begin + (end - begin) * (reached / sum));
    }
}

/// Of a layer: ratio of its last cell to its first.
double ratioOf(int layer) {
    constexpr double kChannel = 10, kDiffusion = 3;
    const double ratio = layer == 0 || layer == kLast ? kChannel : layer == 1 || layer == kLast - 1 ? kDiffusion : 1;
    return layer < Membrane::kMembraneLayer ? 1 / ratio : ratio;
}

/// One parameter of the data set.
struct Column {
    const char *name, *unit;
    int components;
    std::function<double(int component, int layer, double x, double z, double height)> value;
};

std::vector<Column> columnsOf(const Membrane& cell) {
    return {
        {"T", "K", 1, [=](int, int layer, double, double z, double h) { return cell.temperature(layer, z, h); }},
        {"O2", "mol/m3", 1, [=](int, int layer, double x, double z, double h) { return cell.oxygen(layer, x, z, h); }},
        {"H2", "mol/m3", 1,
         [=](int, int layer, double x, double z, double h) { return cell.hydrogen(layer, x, z, h); }},
        {"lambda", "", 1, [=](int, int layer, double, double z, double h) { return cell.water(layer, z, h); }},
        {"phi", "V", 1, [=](int, int layer, double, double z, double h) { return cell.potential(layer, z, h); }},
        {"U", "m/s", 3, [=](int component, int layer, double, double z, double h) {
             const double along = cell.speed(layer, z, h);
             return component == 0 || std::isnan(along) ? along : 0;
         }}};
}

Field columnField(const Column& column, int component, const Lattice& lattice, const std::vector<int>& layers) {
    Field field = makeField(lattice, ScalarType::F32);
    Mask mask(field.count(), 1);
    const auto samples = field.as<float>();
    const std::vector<double>& planes = lattice.axes[2]->planes();
    parallelFor(std::size_t(lattice.size.z), [&](std::size_t k) {
        std::size_t to = lattice.index({0, 0, int(k)});
        for (int j = 0; j < lattice.size.y; ++j)
            for (int i = 0; i < lattice.size.x; ++i, ++to) {
                const double value = column.value(component, layers[k], lattice.axes[0]->sample(i), planes[k],
                                                  planes[k + 1] - planes[k]);
                mask[to] = std::isnan(value) ? 0 : 1;
                samples[to] = static_cast<float>(value);
            }
    });
    if (std::ranges::find(mask, std::uint8_t(0)) != mask.end())
        field.mask = std::make_shared<const Mask>(std::move(mask));
    return field;
}

Field layerField(const Lattice& lattice, const std::vector<int>& layers) {
    Field field = makeField(lattice, ScalarType::U8);
    const auto samples = field.as<std::uint8_t>();
    const std::size_t slice = std::size_t(lattice.size.x) * std::size_t(lattice.size.y);
    for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = std::uint8_t(1 + layers[i / slice]);
    return field;
}

Range presentRange(const Field& field) {
    Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (std::size_t i = 0; i < field.count(); ++i)
        if (field.present(i)) range = {std::min(range.lo, field.value(i)), std::max(range.hi, field.value(i))};
    return range;
}

} // namespace

double Membrane::begin(int layer) {
    double z = 0;
    for (int l = 0; l < layer; ++l) z += kLayers[std::size_t(l)].thickness;
    return z;
}

std::array<int, 7> Membrane::cellsOf() const {
    constexpr MembraneSettings kUsual;
    const auto share = [&](int usual) { return std::max(1, settings_.nz * usual / kUsual.nz); };
    const int diffusion = share(8), catalyst = share(3), both = 2 * (diffusion + catalyst);
    const int channel = (settings_.nz - both - share(4)) / 2;
    return {channel, diffusion, catalyst, settings_.nz - both - 2 * channel, catalyst, diffusion, channel};
}

std::vector<double> Membrane::planesX() const {
    std::vector<double> planes{0};
    addGraded(planes, kLengthX, settings_.nx, 2);
    return planes;
}

std::vector<double> Membrane::planesZ() const {
    std::vector<double> planes{0};
    for (int layer = 0; layer <= kLast; ++layer)
        addGraded(planes, begin(layer + 1), cellsOf()[std::size_t(layer)], ratioOf(layer));
    return planes;
}

std::vector<int> Membrane::layersZ() const {
    std::vector<int> layers;
    for (int layer = 0; layer <= kLast; ++layer)
        layers.insert(layers.end(), std::size_t(cellsOf()[std::size_t(layer)]), layer);
    return layers;
}

double Membrane::temperature(int layer, double z, double height) const {
    double t = kAirSide;
    for (int l = 0; l < layer; ++l)
        t += settings_.heatFlux * kLayers[std::size_t(l)].thickness / kLayers[std::size_t(l)].conductivity;
    return t + settings_.heatFlux * (z + 0.5 * height - begin(layer)) / kLayers[std::size_t(layer)].conductivity;
}

double Membrane::oxygen(int layer, double x, double z, double height) const {
    if (layer >= kMembraneLayer) return kNothing;
    const double flux = settings_.current / (4 * kFaraday);
    double c = kOxygen * (1 - kOxygenUsed * x / kLengthX);
    for (int l = 1; l < layer; ++l) c -= flux * kLayers[std::size_t(l)].thickness / kLayers[std::size_t(l)].diffusivity;
    return layer == 0 ? c : c - flux * (z + 0.5 * height - begin(layer)) / kLayers[std::size_t(layer)].diffusivity;
}

double Membrane::hydrogen(int layer, double x, double z, double height) const {
    if (layer <= kMembraneLayer) return kNothing;
    const double flux = settings_.current / (2 * kFaraday);
    double c = kHydrogen * (1 - kHydrogenUsed * (kLengthX - x) / kLengthX);
    for (int l = kLast - 1; l > layer; --l)
        c -= flux * kLayers[std::size_t(l)].thickness / kLayers[std::size_t(l)].diffusivity;
    if (layer == kLast) return c;
    return c - flux * (begin(layer + 1) - z - 0.5 * height) / kLayers[std::size_t(layer)].diffusivity;
}

double Membrane::water(int layer, double z, double height) const {
    if (layer != kMembraneLayer) return kNothing;
    return kWet + (kDry - kWet) * (z + 0.5 * height - begin(layer)) / kLayers[std::size_t(layer)].thickness;
}

double Membrane::potential(int layer, double z, double height) const {
    if (!(kLayers[std::size_t(layer)].protons > 0)) return kNothing;
    double phi = 0;
    for (int l = 0; l < layer; ++l)
        if (const Layer& below = kLayers[std::size_t(l)]; below.protons > 0)
            phi += settings_.current * below.thickness / below.protons;
    return phi + settings_.current * (z + 0.5 * height - begin(layer)) / kLayers[std::size_t(layer)].protons;
}

double Membrane::speed(int layer, double z, double height) const {
    const Layer& channel = kLayers[std::size_t(layer)];
    if (channel.speed == 0) return kNothing;
    const double s = (z + 0.5 * height - begin(layer)) / channel.thickness, h = height / channel.thickness;
    return 6 * channel.speed * (s * (1 - s) - h * h / 12); // the mean of the parabola
}

Dataset makeMembrane(const std::map<std::string, double>& given) {
    const auto settings = settingsFrom<MembraneSettings>(given, "membrane");
    const Membrane cell(settings);
    Dataset dataset;
    DatasetInfo& info = dataset.info;
    info.name = "membrane";
    const auto axis = [](std::vector<double> planes) {
        return std::make_shared<const AxisMap>(AxisMap::Of::Cells, std::move(planes));
    };
    Lattice even;
    even.size.y = settings.ny;
    even.spacing.y = Membrane::kLengthY / settings.ny;
    even.origin.y = 0.5 * even.spacing.y;
    info.lattice = withAxes(even, {{axis(cell.planesX()), nullptr, axis(cell.planesZ())}});
    info.bounds = gridBounds(info.lattice);
    info.times = {0};
    info.provenance = "a computed layered cell";
    Parameter region{"region", "", 1, ScalarType::U8, true, {}, {}};
    for (int layer = 0; layer <= kLast; ++layer)
        region.labels.push_back({layer + 1, Membrane::kLayers[std::size_t(layer)].name});
    region.ranges = {{1, kLast + 1}};
    info.parameters = {region};
    const std::vector<int> layers = cell.layersZ();
    const std::vector<Column> columns = columnsOf(cell);
    for (const Column& column : columns) {
        Parameter parameter{column.name, column.unit, column.components, ScalarType::F32, false, {}, {}};
        for (int c = 0; c < column.components; ++c)
            parameter.ranges.push_back(presentRange(columnField(column, c, info.lattice, layers)));
        if (column.components > 1) { // along x alone
            const Range along = parameter.ranges.front();
            double least = std::numeric_limits<double>::infinity();
            const Field field = columnField(column, 0, info.lattice, layers);
            for (std::size_t i = 0; i < field.count(); ++i)
                if (field.present(i)) least = std::min(least, std::abs(field.value(i)));
            parameter.ranges.push_back({least, std::max(std::abs(along.lo), std::abs(along.hi))});
        }
        info.parameters.push_back(std::move(parameter));
    }
    dataset.read = [lattice = info.lattice, layers, columns](int parameter, int component, int) {
        return parameter == 0 ? layerField(lattice, layers)
                              : columnField(columns[std::size_t(parameter) - 1], component, lattice, layers);
    };
    return dataset;
}

} // namespace tessera::volume
