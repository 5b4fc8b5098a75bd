#include "app/document/surface_export.h"

#include "app/queries/geometry_query.h"
#include "app/session/shown_scene.h"
#include "volume/base/error.h"
#include "volume/mesh/mesh_file.h"

#include <algorithm>
#include <filesystem>

namespace tessera::app {

int chosenSurface(const Session& whole) {
    const Session session = sessionShownIn(whole, volumePane(whole));
    const auto isSurface = [&](std::size_t i) {
        return i < session.layers.size() && std::holds_alternative<vis::IsoLayer>(session.layers[i].technique);
    };
    for (const auto& [pane, view] : session.views)
        if (const auto* layers = std::get_if<LayersView>(&view))
            if (isSurface(std::size_t(std::max(0, layers->selected)))) return layers->selected;
    for (std::size_t i = 0; i < session.layers.size(); ++i)
        if (isSurface(i) && session.layers[i].visible) return int(i);
    return -1;
}

void exportSurface(const Document& document, std::string path, Jobs& jobs, Messages& messages) {
    const Session session = sessionShownIn(document.session(), volumePane(document.session()));
    const int chosen = chosenSurface(document.session());
    if (chosen < 0 || !document.loaded()) return;
    if (!std::filesystem::path(path).has_extension()) path += ".ply";
    const vis::Layer& whole = session.layers[std::size_t(chosen)];
    const vis::IsoLayer layer = std::get<vis::IsoLayer>(whole.technique);
    const volume::TimePair time = volume::timesAround(document.info().times, session.time + whole.timeShift);
    jobs.start("export surface", "Writing " + std::filesystem::path(path).filename().string(),
               [&messages, source = document.sources().numbers, space = document.sources().origin.spaceOfPlane, layer,
                time, path](const Progress& progress) -> Jobs::Finish {
                   const auto geometry = extractLayer(source, layer, time, 0, progress.part(0, 0.7), space);
                   if (!geometry) throw Error("there is no parameter \"" + layer.channel + "\"");
                   volume::writeMesh(geometry->mesh, path, layer.colorBy, progress.part(0.7, 1));
                   const std::size_t triangles = geometry->mesh.triangles.size();
                   std::string more = volume::meshShift(geometry->mesh, path);
                   for (const std::string& note : geometry->notes) more += (more.empty() ? "" : "; ") + note;
                   return [&messages, path, triangles, more] {
                       messages.add("Wrote " + std::to_string(triangles) + " triangles to " + path +
                                    (more.empty() ? "" : ": " + more));
                   };
               });
}

} // namespace tessera::app
