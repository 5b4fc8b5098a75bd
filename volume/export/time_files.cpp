#include "volume/export/time_files.h"

#include "volume/base/number_text.h"
#include "volume/export/export_formats.h"
#include "volume/system/atomic_file.h"

#include <cassert>
#include <cstdio>
#include <filesystem>

namespace tessera::volume {

namespace fs = std::filesystem;

std::string fileOfTime(const std::string& path, std::size_t number) {
    fs::path file = path;
    const std::string ending = file.extension().string();
    char text[32];
    std::snprintf(text, sizeof text, "_%04zu", number);
    return file.replace_extension().string() + text + ending;
}

std::string collectionOf(const std::string& path) {
    return fs::path(path).replace_extension(".pvd").string();
}

void writeCollection(const std::string& path, const std::vector<double>& times, const std::vector<std::string>& files) {
    assert(times.size() == files.size());
    std::string list = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
                       "byte_order=\"LittleEndian\">\n<Collection>\n";
    for (std::size_t t = 0; t < times.size(); ++t)
        list += "<DataSet timestep=\"" + exactText(times[t]) + "\" group=\"\" part=\"0\" file=\"" +
                xmlText(fs::path(files[t]).filename().string()) + "\"/>\n";
    list += "</Collection>\n</VTKFile>\n";
    writeAtomically(collectionOf(path), list);
}

} // namespace tessera::volume
