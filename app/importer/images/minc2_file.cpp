// MINC 2: an HDF5 file with the groups /minc-2.0/dimensions and /minc-2.0/image/0, the full resolution.
#include "app/importer/images/minc_file.h"
#include "app/importer/readers/check_file.h"
#include "app/importer/readers/hdf_id.h"

#include <algorithm>
#include <cmath>
#include <hdf5.h>
#include <memory>
#include <stdexcept>

namespace tessera::importer {

namespace {

std::vector<double> numbersAt(hid_t object, const char* name) {
    if (H5Aexists(object, name) <= 0) return {};
    const HdfId attribute(H5Aopen(object, name, H5P_DEFAULT));
    const HdfId type(H5Aget_type(attribute.id())), space(H5Aget_space(attribute.id()));
    const hssize_t count = H5Sget_simple_extent_npoints(space.id());
    const H5T_class_t kind = H5Tget_class(type.id());
    if (count < 1 || count > 4096 || (kind != H5T_INTEGER && kind != H5T_FLOAT)) return {};
    std::vector<double> numbers(static_cast<std::size_t>(count));
    if (H5Aread(attribute.id(), H5T_NATIVE_DOUBLE, numbers.data()) < 0) return {};
    return numbers;
}

std::string textAt(hid_t object, const char* name) {
    if (H5Aexists(object, name) <= 0) return {};
    const HdfId attribute(H5Aopen(object, name, H5P_DEFAULT));
    const HdfId type(H5Aget_type(attribute.id()));
    if (H5Tget_class(type.id()) != H5T_STRING || H5Tis_variable_str(type.id()) > 0) return {};
    std::string text(std::min<std::size_t>(H5Tget_size(type.id()), 4096), '\0');
    if (H5Tget_size(type.id()) > text.size() || H5Aread(attribute.id(), type.id(), text.data()) < 0) return {};
    text.resize(std::min(text.find('\0'), text.size()));
    return text;
}

std::vector<std::string> namesIn(const std::string& list) {
    std::vector<std::string> names;
    for (std::size_t at = 0; at < list.size();) {
        const std::size_t end = std::min(list.find(',', at), list.size());
        names.push_back(list.substr(at, end - at));
        at = end + 1;
    }
    return names;
}

std::vector<hsize_t> sizesOf(hid_t dataset) {
    const HdfId space(H5Dget_space(dataset));
    const int rank = H5Sget_simple_extent_ndims(space.id());
    std::vector<hsize_t> sizes(std::size_t(std::max(rank, 0)));
    if (rank > 0) H5Sget_simple_extent_dims(space.id(), sizes.data(), nullptr);
    return sizes;
}

MincAxis axisNamed(hid_t file, const std::string& name, std::size_t size) {
    MincAxis axis;
    axis.name = name;
    axis.size = size;
    const std::string path = "/minc-2.0/dimensions/" + name;
    const HdfId dimension(H5Oopen(file, path.c_str(), H5P_DEFAULT));
    if (!dimension) return axis;
    const auto first = [&](const char* key, double otherwise) {
        const std::vector<double> stated = numbersAt(dimension.id(), key);
        return stated.empty() ? otherwise : stated[0];
    };
    axis.start = first("start", 0);
    axis.step = first("step", 0);
    axis.cosines = numbersAt(dimension.id(), "direction_cosines");
    axis.unit = textAt(dimension.id(), "units");
    if (!textAt(dimension.id(), "spacing").starts_with("irregular") || H5Iget_type(dimension.id()) != H5I_DATASET ||
        sizesOf(dimension.id()) != std::vector<hsize_t>{hsize_t(size)})
        return axis;
    axis.places.resize(size);
    if (H5Dread(dimension.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, axis.places.data()) < 0)
        axis.places.clear();
    return axis;
}

void readScales2(hid_t file, MincImage& image) {
    const HdfId low(H5Dopen2(file, "/minc-2.0/image/0/image-min", H5P_DEFAULT)),
        high(H5Dopen2(file, "/minc-2.0/image/0/image-max", H5P_DEFAULT));
    if (!low || !high) return;
    const std::vector<hsize_t> sizes = sizesOf(high.id());
    std::size_t all = 1;
    bool fits = sizes.size() <= image.axes.size() && sizesOf(low.id()) == sizes;
    for (std::size_t a = 0; fits && a < sizes.size(); ++a) {
        fits = sizes[a] == image.axes[a].size;
        all *= image.axes[a].size;
    }
    if (!fits || all > 10'000'000) throw std::runtime_error("has scales (image-max) that do not fit its slices");
    image.scaledAxes = sizes.size();
    image.lows.resize(all);
    image.highs.resize(all);
    if (H5Dread(low.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, image.lows.data()) < 0 ||
        H5Dread(high.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, image.highs.data()) < 0)
        throw std::runtime_error("has scales (image-max) that cannot be read");
}

} // namespace

MincImage openMinc2(const std::string& path) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    const auto file = std::make_shared<const HdfId>(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
    if (!*file) throw std::runtime_error("ends early or is damaged");
    MincImage image;
    image.stored = double(bytesIn(path));
    const auto samples = std::make_shared<const HdfId>(H5Dopen2(file->id(), "/minc-2.0/image/0/image", H5P_DEFAULT));
    if (!*samples) throw std::runtime_error("holds no image: a MINC file has /minc-2.0/image/0/image");
    const std::vector<hsize_t> sizes = sizesOf(samples->id());
    const std::vector<std::string> names = namesIn(textAt(samples->id(), "dimorder"));
    if (names.size() != sizes.size()) throw std::runtime_error("does not state the order of its axes (dimorder)");
    for (std::size_t a = 0; a < sizes.size(); ++a)
        image.axes.push_back(axisNamed(file->id(), names[a], std::size_t(sizes[a])));
    const HdfId type(H5Dget_type(samples->id()));
    const H5T_class_t kind = H5Tget_class(type.id());
    if (kind != H5T_INTEGER && kind != H5T_FLOAT)
        throw std::runtime_error("has samples that are no real numbers, which are not read");
    image.floats = kind == H5T_FLOAT;
    const bool isSigned = !image.floats && H5Tget_sign(type.id()) == H5T_SGN_2;
    const double span = std::ldexp(1.0, int(8 * H5Tget_size(type.id())));
    const std::vector<double> valid = numbersAt(samples->id(), "valid_range");
    if (valid.size() == 2) {
        image.lowest = std::min(valid[0], valid[1]);
        image.highest = std::max(valid[0], valid[1]);
    } else if (!image.floats) {
        image.lowest = isSigned ? -span / 2 : 0;
        image.highest = image.lowest + span - 1;
    }
    if (!image.floats) readScales2(file->id(), image);
    image.read = [file, samples](const std::vector<std::size_t>& start, const std::vector<std::size_t>& size) {
        const std::vector<hsize_t> from(start.begin(), start.end()), count(size.begin(), size.end());
        const HdfId space(H5Dget_space(samples->id()));
        const HdfId memory(H5Screate_simple(int(count.size()), count.data(), nullptr));
        std::size_t all = 1;
        for (const std::size_t n : size) all *= n;
        std::vector<double> numbers(all);
        if (H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, from.data(), nullptr, count.data(), nullptr) < 0 ||
            H5Dread(samples->id(), H5T_NATIVE_DOUBLE, memory.id(), space.id(), H5P_DEFAULT, numbers.data()) < 0)
            throw std::runtime_error("its samples cannot be read: truncated or damaged");
        return numbers;
    };
    return image;
}

} // namespace tessera::importer
