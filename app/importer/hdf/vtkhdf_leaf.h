#pragma once

#include "app/importer/hdf/hdf_file.h"
#include "volume/field/dataset.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>
#include <vtkDataSet.h>

/// One data set of a VTKHDF file, at any of its steps. Kitware: "VTKHDF file format specification", versions 1.0
/// to 2.5.
namespace tessera::importer {

/// Where the parts of a mesh lie at one step. The parts of a step follow each other in every list.
struct VtkHdfMeshStep {
    std::size_t firstPart = 0;
    std::vector<std::int64_t> points, cells, corners; ///< by part
    std::size_t pointBegin = 0, cellBegin = 0, cornerBegin = 0;
    std::size_t pointCount = 0, cellCount = 0, cornerCount = 0;
    /// Of polyhedra; empty in files without.
    std::vector<std::int64_t> faces, faceCorners, toFaces;
    std::size_t faceBegin = 0, faceCornerBegin = 0, toFaceBegin = 0;
};

struct VtkHdfArray {
    std::string name, path;
    bool ofCells = false, ofField = false;
    std::vector<std::int64_t> begins; ///< first row by step; empty: that of the geometry
    std::vector<std::int64_t> sizes;  ///< of field data: components and tuples by step; empty: one tuple
};

struct VtkHdfLeaf {
    std::string name, group, type;
    std::vector<double> times; ///< empty: the same at all times
    std::vector<VtkHdfArray> arrays;
    std::vector<VtkHdfMeshStep> steps; ///< of a mesh, at least one
    bool moves = false;                ///< the mesh is not the same at all steps
};

/// Reads what a group states, not its samples. What cannot be read of it is left out, with a note for each. Throws
/// where nothing of it can be read.
VtkHdfLeaf openVtkHdfLeaf(const HdfFile& file, const std::string& group, const std::string& name,
                          std::vector<std::string>& notes);

vtkSmartPointer<vtkDataSet> readVtkHdfLeaf(const HdfFile& file, const VtkHdfLeaf& leaf, std::size_t step);

/// Boxes of several levels of detail as one image of the finest of them that memory takes: larger cells are repeated.
/// Adds a note on what became of the levels.
VtkHdfLeaf openVtkHdfAmr(const HdfFile& file, const std::string& group, const std::string& name,
                         std::vector<std::string>& notes);
vtkSmartPointer<vtkDataSet> readVtkHdfAmr(const HdfFile& file, const VtkHdfLeaf& leaf, std::size_t step);

/// Field data with one number at each step.
std::vector<volume::Quantity> vtkHdfQuantities(const HdfFile& file, const VtkHdfLeaf& leaf);

/// Field data of one step: numbers, and words.
void addVtkHdfFields(const HdfFile& file, const VtkHdfLeaf& leaf, std::size_t step, vtkDataSet& data);

} // namespace tessera::importer
