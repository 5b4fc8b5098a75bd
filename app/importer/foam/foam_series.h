#pragma once

#include "app/importer/foam/foam_case.h"
#include "app/importer/foam/foam_cells.h"
#include "app/importer/foam/foam_field.h"

#include <map>
#include <string>
#include <vector>
#include <vtkMultiBlockDataSet.h>
#include <vtkSmartPointer.h>

namespace tessera::importer {

/// The fields of a case over its times, and the mesh of each region that was read last.
struct FoamSeries {
    struct Mesh {
        std::vector<FoamMeshFiles> files;
        FoamGrid grid;
        std::vector<std::array<std::size_t, 2>> sizes; ///< cells and points of each piece
        std::vector<std::int32_t> pointOf;
        std::size_t cells = 0, divided = 0; ///< of the mesh; those of them that are divided into tetrahedra
        std::vector<std::int32_t> zone;
        std::vector<std::string> zones;
    };
    FoamCase foam;
    std::map<std::string, Mesh> meshes;                                          ///< by region
    std::vector<std::map<std::string, std::map<std::string, FoamField>>> fields; ///< per time, by region and name
    std::map<std::string, std::string> units;
    std::vector<std::string> notes;
    std::vector<std::size_t> shownAt;

    const Mesh& meshAt(const std::string& region, std::size_t time);
    std::size_t timeCount() const { return fields.size(); }
};

/// Finds the fields of a case, and reads the meshes of its first time.
FoamSeries seriesOfFoam(FoamCase foam);

/// All regions with their fields at a time.
vtkSmartPointer<vtkMultiBlockDataSet> readFoamTime(FoamSeries& series, std::size_t time);

} // namespace tessera::importer
