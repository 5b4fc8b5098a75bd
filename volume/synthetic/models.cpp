#include "volume/synthetic/models.h"

#include "volume/base/error.h"
#include "volume/synthetic/branching.h"
#include "volume/synthetic/bubbles.h"
#include "volume/synthetic/casting.h"
#include "volume/synthetic/fuel_cell.h"
#include "volume/synthetic/marschner_lobb.h"
#include "volume/synthetic/membrane.h"
#include "volume/synthetic/planted.h"

namespace tessera::volume {

namespace {

using Settings = std::map<std::string, double>;

/// One row for each model.
struct Model {
    const char* name;
    Dataset (*make)(const Settings& settings, const Progress& progress);
};

/// Models that take no time to compute report that they are done.
template <Dataset (*make)(const Settings&)> Dataset atOnce(const Settings& settings, const Progress& progress) {
    progress.advance(1);
    return make(settings);
}

constexpr Model kModels[] = {{"fuel-cell", makeFuelCell},
                             {"planted", makePlanted},
                             {"marschner-lobb", atOnce<makeMarschnerLobb>},
                             {"casting", atOnce<makeCasting>},
                             {"membrane", atOnce<makeMembrane>},
                             {"bubbles", atOnce<makeBubbles>},
                             {"branching-pulse", atOnce<makeBranching>}};

} // namespace

std::vector<std::string> modelNames() {
    std::vector<std::string> names;
    for (const Model& model : kModels) names.emplace_back(model.name);
    return names;
}

Dataset makeModel(const std::string& name, const Settings& settings, const Progress& progress) {
    std::string known;
    for (const Model& model : kModels) {
        if (name == model.name) return model.make(settings, progress);
        known += (known.empty() ? "" : ", ") + std::string(model.name);
    }
    throw Error("no model of that name; there are: " + known, name);
}

} // namespace tessera::volume
