// MINC 1: a NetCDF file whose variable "image" has the variables "image-min" and "image-max" beside it.
#include "app/importer/images/minc_file.h"
#include "app/importer/readers/check_file.h"

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <vtk_netcdf.h>

namespace tessera::importer {

namespace {

[[noreturn]] void throwNetCdf(int status) {
    throw std::runtime_error(std::string("cannot be read: ") + nc_strerror(status));
}

void checkNetCdfCall(int status) {
    if (status != NC_NOERR) throwNetCdf(status);
}

std::string mincText(int file, int variable, const char* name) {
    nc_type type = NC_NAT;
    std::size_t length = 0;
    if (nc_inq_att(file, variable, name, &type, &length) != NC_NOERR || type != NC_CHAR || length > 4096) return {};
    std::string text(length, '\0');
    if (nc_get_att_text(file, variable, name, text.data()) != NC_NOERR) return {};
    text.resize(std::min(text.find('\0'), text.size()));
    return text;
}

std::vector<double> mincNumbers(int file, int variable, const char* name) {
    nc_type type = NC_NAT;
    std::size_t length = 0;
    if (nc_inq_att(file, variable, name, &type, &length) != NC_NOERR || type == NC_CHAR || length > 4096) return {};
    std::vector<double> numbers(length);
    if (nc_get_att_double(file, variable, name, numbers.data()) != NC_NOERR) return {};
    return numbers;
}

MincAxis axisOf(int file, int dimension) {
    MincAxis axis;
    char name[NC_MAX_NAME + 1] = {};
    checkNetCdfCall(nc_inq_dim(file, dimension, name, &axis.size));
    axis.name = name;
    int variable = 0;
    if (nc_inq_varid(file, name, &variable) != NC_NOERR) return axis;
    const auto first = [&](const char* key, double otherwise) {
        const std::vector<double> stated = mincNumbers(file, variable, key);
        return stated.empty() ? otherwise : stated[0];
    };
    axis.start = first("start", 0);
    axis.step = first("step", 0);
    axis.cosines = mincNumbers(file, variable, "direction_cosines");
    axis.unit = mincText(file, variable, "units");
    int dimensions = 0, own = -1;
    const bool listed = nc_inq_varndims(file, variable, &dimensions) == NC_NOERR && dimensions == 1 &&
                        nc_inq_vardimid(file, variable, &own) == NC_NOERR && own == dimension &&
                        mincText(file, variable, "spacing") == "irregular" && axis.size <= 1'000'000;
    axis.places.resize(listed ? axis.size : 0);
    if (listed && nc_get_var_double(file, variable, axis.places.data()) != NC_NOERR) axis.places.clear();
    return axis;
}

/// Integers of NetCDF have a sign except bytes; MINC states it apart.
bool hasSign(nc_type type, const std::string& signtype) {
    return signtype.empty() ? type != NC_BYTE : signtype.starts_with("signed");
}

void readScales(int file, const std::vector<int>& imageDimensions, MincImage& image) {
    int low = 0, high = 0, count = 0;
    if (nc_inq_varid(file, "image-min", &low) != NC_NOERR || nc_inq_varid(file, "image-max", &high) != NC_NOERR) return;
    checkNetCdfCall(nc_inq_varndims(file, high, &count));
    std::vector<int> own(static_cast<std::size_t>(count));
    checkNetCdfCall(nc_inq_vardimid(file, high, own.data()));
    if (own.size() > imageDimensions.size() || !std::equal(own.begin(), own.end(), imageDimensions.begin()))
        throw std::runtime_error("has scales (image-max) along other axes than its slices");
    std::size_t all = 1;
    for (std::size_t a = 0; a < own.size(); ++a) all *= image.axes[a].size;
    int lowDimensions = 0;
    checkNetCdfCall(nc_inq_varndims(file, low, &lowDimensions));
    if (all > 10'000'000 || lowDimensions != count) throw std::runtime_error("has scales that do not fit its slices");
    image.scaledAxes = own.size();
    image.lows.resize(all);
    image.highs.resize(all);
    checkNetCdfCall(nc_get_var_double(file, low, image.lows.data()));
    checkNetCdfCall(nc_get_var_double(file, high, image.highs.data()));
}

} // namespace

MincImage openMinc1(const std::string& path) {
    checkNetCdf(path);
    int file = 0;
    checkNetCdfCall(nc_open(path.c_str(), NC_NOWRITE, &file));
    const std::shared_ptr<void> closing(nullptr, [file](void*) { nc_close(file); });
    MincImage image;
    image.stored = double(bytesIn(path));
    int variable = 0, count = 0;
    if (nc_inq_varid(file, "image", &variable) != NC_NOERR)
        throw std::runtime_error("holds no image: a MINC file has a variable \"image\"");
    nc_type type = NC_NAT;
    checkNetCdfCall(nc_inq_vartype(file, variable, &type));
    checkNetCdfCall(nc_inq_varndims(file, variable, &count));
    std::vector<int> dimensions(static_cast<std::size_t>(count));
    checkNetCdfCall(nc_inq_vardimid(file, variable, dimensions.data()));
    for (const int dimension : dimensions) image.axes.push_back(axisOf(file, dimension));
    image.floats = type == NC_FLOAT || type == NC_DOUBLE;
    const bool isSigned = hasSign(type, mincText(file, variable, "signtype"));
    const int bits = type == NC_BYTE ? 8 : type == NC_SHORT ? 16 : 32;
    const double span = double(std::uint64_t(1) << bits);
    std::vector<double> valid = mincNumbers(file, variable, "valid_range");
    if (valid.size() == 2) {
        if (!image.floats && !isSigned)
            for (double& end : valid) end += end < 0 ? span : 0; // the attribute's type has a sign
        image.lowest = std::min(valid[0], valid[1]);
        image.highest = std::max(valid[0], valid[1]);
    } else if (!image.floats) {
        image.lowest = isSigned ? -span / 2 : 0;
        image.highest = image.lowest + span - 1;
    }
    if (!image.floats) readScales(file, dimensions, image);
    const double wrapped = !image.floats && !isSigned ? span : 0, signedByte = type == NC_BYTE && isSigned ? 256 : 0;
    image.read = [file, variable, wrapped, signedByte, closing](const std::vector<std::size_t>& start,
                                                                const std::vector<std::size_t>& size) {
        std::size_t all = 1;
        for (const std::size_t n : size) all *= n;
        std::vector<double> numbers(all);
        checkNetCdfCall(nc_get_vara_double(file, variable, start.data(), size.data(), numbers.data()));
        for (double& number : numbers) {
            if (number < 0) number += wrapped;
            if (signedByte > 0 && number > 127) number -= signedByte;
        }
        return numbers;
    };
    return image;
}

} // namespace tessera::importer
