#include "app/importer/meshes/cgns_units.h"

#include "app/importer/readers/dimension_units.h"
#include "app/importer/readers/hdf_id.h"
#include "volume/base/unit_conversion.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <string_view>

namespace tessera::importer {

namespace {

constexpr std::string_view kUnitsNode = "/DimensionalUnits/ data", kExponentsNode = "/DimensionalExponents/ data";
constexpr std::size_t kUnits = 5, kWord = 32; // mass, length, time, temperature, angle

struct Found {
    CgnsUnits units;
    std::array<std::string, kUnits> words; ///< of the base
    std::map<std::string, std::array<double, kUnits>> exponents;
};

std::array<std::string, kUnits> wordsIn(hid_t dataset) {
    std::array<std::string, kUnits> words;
    std::array<char, kUnits * kWord> text{};
    if (H5Dget_storage_size(dataset) != text.size() ||
        H5Dread(dataset, H5T_NATIVE_CHAR, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) < 0)
        return words;
    for (std::size_t i = 0; i < kUnits; ++i) {
        words[i].assign(text.data() + i * kWord, kWord);
        words[i].erase(words[i].find_last_not_of(std::string(" \0", 2)) + 1);
    }
    return words;
}

void takeNode(hid_t root, const std::string& place, Found& found) {
    const bool ofUnits = place.ends_with(kUnitsNode), ofArray = place.ends_with(kExponentsNode);
    if (!ofUnits && !ofArray) return;
    const HdfId dataset(H5Dopen2(root, place.c_str(), H5P_DEFAULT));
    if (ofUnits) {
        if (place.find('/') == place.size() - kUnitsNode.size()) found.words = wordsIn(dataset.id());
        return;
    }
    const HdfId space(H5Dget_space(dataset.id()));
    std::array<double, kUnits> exponents{};
    if (H5Sget_simple_extent_npoints(space.id()) != hssize_t(kUnits) ||
        H5Dread(dataset.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, exponents.data()) < 0)
        return;
    const std::string array = place.substr(0, place.size() - kExponentsNode.size());
    found.exponents[array.substr(array.rfind('/') + 1)] = exponents;
}

/// The unit of exponents of mass, length, time and temperature, all of SI; "" for others.
std::string unitBy(const std::array<double, kUnits>& exponents, const std::array<std::string, kUnits>& words) {
    static constexpr std::array<std::string_view, kUnits> kSi = {"Kilogram", "Meter", "Second", "Kelvin", "Radian"};
    for (std::size_t i = 0; i < kUnits; ++i)
        if (!std::isfinite(exponents[i]) || (exponents[i] != 0 && words[i] != kSi[i])) return {};
    if (exponents[4] != 0) return {};
    char brackets[160];
    std::snprintf(brackets, sizeof brackets, "[%g %g %g %g 0 0 0]", exponents[0], exponents[1], exponents[2],
                  exponents[3]);
    return unitOfDimensions(brackets).value_or("");
}

} // namespace

CgnsUnits cgnsUnits(const std::string& path) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    const HdfId file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
    if (!file) return {};
    Found found;
    const auto visit = [](hid_t root, const char* name, const H5O_info_t* info, void* to) -> herr_t {
        if (info->type == H5O_TYPE_DATASET) takeNode(root, name, *static_cast<Found*>(to));
        return 0;
    };
#if H5_VERSION_GE(1, 12, 0) // takes the fields to query as a further argument
    H5Ovisit(file.id(), H5_INDEX_NAME, H5_ITER_INC, visit, &found, H5O_INFO_BASIC);
#else
    H5Ovisit(file.id(), H5_INDEX_NAME, H5_ITER_INC, visit, &found);
#endif
    found.units.length = volume::lengthUnitNamed(found.words[1]);
    for (const auto& [array, exponents] : found.exponents)
        if (const std::string unit = unitBy(exponents, found.words); !unit.empty()) {
            found.units.arrays[array] = unit;
            if (array.ends_with('X')) found.units.arrays[array.substr(0, array.size() - 1)] = unit; // of the vector
        }
    return std::move(found.units);
}

} // namespace tessera::importer
