#include "app/pane/view_parts.h"
#include "app/queries/surface_query.h"
#include "app/workbench/workbench.h"
#include "volume/base/error.h"
#include "volume/mesh/mesh_file.h"

#include <algorithm>
#include <filesystem>

/// An iso-layer of the session as a mesh file.
namespace tessera::app {

/// The iso-layer selected in a layers view, else the first visible one; -1 where there is none.
int Workbench::chosenSurface() const {
    const auto isSurface = [&](std::size_t i) {
        return i < session_.layers.size() && std::holds_alternative<vis::IsoLayer>(session_.layers[i].technique);
    };
    for (const auto& [pane, view] : session_.views)
        if (const auto* layers = std::get_if<LayersView>(&view))
            if (isSurface(std::size_t(std::max(0, layers->selected)))) return layers->selected;
    for (std::size_t i = 0; i < session_.layers.size(); ++i)
        if (isSurface(i) && session_.layers[i].visible) return int(i);
    return -1;
}

void Workbench::exportSurface(std::string path) {
    const int chosen = chosenSurface();
    if (chosen < 0 || !source_) return;
    if (!std::filesystem::path(path).has_extension()) path += ".ply";
    const vis::IsoLayer layer = std::get<vis::IsoLayer>(session_.layers[std::size_t(chosen)].technique);
    const volume::TimePair time = volume::timesAround(source_->info().times, session_.time);
    jobs_.start("export surface", "Writing " + std::filesystem::path(path).filename().string(),
                [this, source = source_, layer, time, path](const Progress& progress) -> Jobs::Finish {
                    const auto geometry = extractLayer(source, layer, time, 0, progress.part(0, 0.7));
                    if (!geometry) throw Error("there is no parameter \"" + layer.channel + "\"");
                    volume::writeMesh(geometry->mesh, path, layer.colorBy, progress.part(0.7, 1));
                    const std::size_t triangles = geometry->mesh.triangles.size();
                    return [this, path, triangles] {
                        message("Wrote " + std::to_string(triangles) + " triangles to " + path);
                    };
                });
}

} // namespace tessera::app
