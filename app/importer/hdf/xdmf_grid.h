#pragma once

#include "app/importer/hdf/xdmf_items.h"

#include <array>
#include <cstddef>
#include <string>
#include <vector>
#include <vtkDataSet.h>

/// One uniform Grid of XDMF: a topology, a geometry, and attributes.
namespace tessera::importer {

struct XdmfField {
    std::string name, unit;
    pugi::xml_node attribute;
    bool ofCells = false, ofGrid = false; ///< else of nodes
};

struct XdmfGrid {
    std::string name;
    pugi::xml_node topology, geometry;
    std::vector<XdmfField> fields;

    bool sameMesh(const XdmfGrid& other) const { return topology == other.topology && geometry == other.geometry; }
};

/// The topology, geometry and attributes below a Grid. Attributes that are of neither nodes, cells nor the grid, and
/// functions of finite elements, are left out with a note.
XdmfGrid openXdmfGrid(const XdmfDocument& document, pugi::xml_node grid, std::vector<std::string>& notes);

/// Dimension of its cells: 3, less for surfaces, lines and points, -1 for a topology that is not read. Mixed ones
/// count as 3.
int cellDimension(const XdmfGrid& grid);

/// Why a field cannot be read; "" = it can. Reads no numbers of HDF5 and binary files.
std::string xdmfFault(const XdmfDocument& document, const XdmfItems& items, const XdmfGrid& grid,
                      const XdmfField& field);

/// The points and cells, without values. Throws with one line of reason.
vtkSmartPointer<vtkDataSet> readXdmfMesh(const XdmfDocument& document, const XdmfItems& items, const XdmfGrid& grid);

/// Adds the values of a field.
void addXdmfField(const XdmfDocument& document, const XdmfItems& items, const XdmfField& field, vtkDataSet& data);

} // namespace tessera::importer
