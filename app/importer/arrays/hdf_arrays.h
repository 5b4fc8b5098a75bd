#pragma once

#include "app/importer/arrays/array_file.h"
#include "app/importer/arrays/conventions.h"
#include "app/importer/readers/hdf_id.h"

#include <hdf5.h>
#include <memory>
#include <string>
#include <vector>

/// What the HDF5 library says of a file: its data sets and their attributes.
namespace tessera::importer {

struct HdfDataset {
    std::string path;
    std::string key;        ///< the same for each path to it
    int vtkType = VTK_VOID; ///< VTK_VOID: no numbers
    std::string problem;    ///< why it is not read: "text", "its file a.raw is missing"; "" = it is
    Dims dims;
    Attributes attributes;
    std::vector<std::string> scales; ///< keys of the scales of its axes, "" = none; empty = none at all
    std::vector<std::string> labels; ///< of its axes
    double statedBytes = 0, storedBytes = 0;
};

class HdfArrays {
public:
    /// Throws if the file is no HDF5 file or is damaged.
    explicit HdfArrays(const std::string& path);

    const std::vector<HdfDataset>& datasets() const { return datasets_; }
    /// Paths of the groups, "" first; none ends with a slash.
    const std::vector<std::string>& groups() const { return groups_; }
    /// Links to other files that lead nowhere.
    const std::vector<std::string>& lostLinks() const { return lost_; }
    const HdfDataset* find(const std::string& path) const;
    const HdfDataset* findKey(const std::string& key) const;
    Attributes attributesOf(const std::string& object) const;
    bool has(const std::string& path) const;

    /// The array of a data set; it keeps the file open.
    StoredArray arrayOf(const HdfDataset& dataset) const;
    std::vector<double> numbers(const HdfDataset& dataset) const;

private:
    void addDataset(const std::string& path);
    static herr_t visitObject(hid_t root, const char* name, const H5O_info_t* info, void* self);
    static herr_t visitLink(hid_t root, const char* name, const H5L_info_t* info, void* self);

    std::shared_ptr<const HdfId> file_;
    std::string folder_;
    std::vector<HdfDataset> datasets_;
    std::vector<std::string> groups_, external_, lost_;
};

} // namespace tessera::importer
