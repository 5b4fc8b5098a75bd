#pragma once

#include "app/importer/hdf/hdf_file.h"
#include "app/importer/hdf/xdmf_document.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>
#include <vtkDataArray.h>

/// The numbers of XDMF: DataItems, in the XML itself or in files beside it.
namespace tessera::importer {

struct XdmfNumbers {
    std::vector<std::size_t> dims;        ///< slowest first
    vtkSmartPointer<vtkDataArray> values; ///< of one component

    std::vector<double> list() const;
    std::vector<std::int64_t> integers() const;
};

/// Reads DataItems: Format XML, HDF and Binary; ItemType Uniform, HyperSlab, Coordinates, and Function where it joins.
/// Files stay open. All functions throw std::runtime_error with one line of reason.
class XdmfItems {
public:
    explicit XdmfItems(const XdmfDocument& document) : document_(document) {}

    /// By axis, without reading the numbers.
    std::vector<std::size_t> dims(pugi::xml_node item) const;
    /// Throws where an item cannot be read; reads no numbers of files beside the XML.
    void check(pugi::xml_node item) const { checkItem(item, 0); }
    XdmfNumbers read(pugi::xml_node item) const { return readItem(item, 0); }

private:
    void checkItem(pugi::xml_node item, int depth) const;
    XdmfNumbers readItem(pugi::xml_node item, int depth) const;
    XdmfNumbers readChosen(pugi::xml_node item, const std::string& kind, int depth) const;
    XdmfNumbers readJoined(pugi::xml_node item, int depth) const;
    XdmfNumbers readHdf(pugi::xml_node item, const HdfSlab* slab) const;
    XdmfNumbers readBinary(pugi::xml_node item) const;
    std::pair<const HdfFile*, std::string> hdfOf(pugi::xml_node item) const;
    std::string fileBeside(pugi::xml_node item, const std::string& name) const;

    const XdmfDocument& document_;
    mutable std::map<std::string, std::shared_ptr<const HdfFile>> files_;
};

} // namespace tessera::importer
