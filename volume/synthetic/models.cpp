#include "volume/synthetic/models.h"

#include "volume/base/error.h"
#include "volume/synthetic/casting.h"
#include "volume/synthetic/fuel_cell.h"
#include "volume/synthetic/marschner_lobb.h"
#include "volume/synthetic/planted.h"

namespace tessera::volume {

std::vector<std::string> modelNames() {
    return {"fuel-cell", "planted", "marschner-lobb", "casting"};
}

Dataset makeModel(const std::string& name, const std::map<std::string, double>& settings, const Progress& progress) {
    if (name == "fuel-cell") return makeFuelCell(settings, progress);
    if (name == "planted") return makePlanted(settings, progress);
    if (name == "marschner-lobb") {
        progress.advance(1, name);
        return makeMarschnerLobb(settings);
    }
    if (name == "casting") {
        progress.advance(1, name);
        return makeCasting(settings);
    }
    std::string known;
    for (const std::string& model : modelNames()) known += (known.empty() ? "" : ", ") + model;
    throw Error("no model of that name; there are: " + known, name);
}

} // namespace tessera::volume
