// What fields a case has at which times, in which regions, and what of them can be read.
#include "app/importer/foam/foam_series.h"

#include <algorithm>
#include <set>
#include <stdexcept>

namespace tessera::importer {

namespace {

constexpr std::size_t kMostHeads = 20'000; // files whose beginning is read before any values are

/// Names in the order in which they were found, each once: "T, U".
struct NameList {
    std::vector<std::string> names;
    void add(const std::string& name) {
        if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    }
    std::string text() const {
        std::string out;
        for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
        return out;
    }
};

/// What is left out of a case, said once.
struct LeftOut {
    std::map<std::string, NameList> elsewhere; ///< by where their values are
    std::map<std::size_t, NameList> unread;    ///< by time
    NameList differ;                           ///< fields of several units
};

bool isBackup(const std::string& name) {
    return name.ends_with(".orig") || name.ends_with("~") || name.ends_with(".bak") || name.ends_with(".old");
}

/// Looks at the files of one region at one time.
class FieldFinder {
public:
    FieldFinder(FoamSeries& series, LeftOut& left) : series_(series), left_(left) {}

    void look(const std::string& region, std::size_t time) {
        const FoamCase& foam = series_.foam;
        const FoamPiece piece = foam.piecesAt(time).front();
        const std::string folder = foam.fieldFolder(piece, region, time);
        for (const std::string& name : foamFilesIn(folder)) {
            if (isBackup(name)) continue;
            auto& known = known_[{region, name}];
            const bool look = heads_ < kMostHeads || known.kind.empty() || !known.problem.empty();
            if (look) {
                ++heads_;
                known = readFoamField(foamPlace(folder, name, piece.part, foam.root), foam.root);
            }
            take(region, name, time, known);
        }
    }

private:
    void take(const std::string& region, const std::string& name, std::size_t time, const FoamField& field) {
        if (const std::string where = elsewhereOf(field.kind); !where.empty()) left_.elsewhere[where].add(name);
        if (!foamKind(field.kind)) return;
        if (field.unit) {
            const auto [unit, first] = series_.units.emplace(name, *field.unit);
            if (!first && unit->second != *field.unit) left_.differ.add(name);
        }
        const std::string shown = region.empty() ? name : region + "/" + name;
        if (!field.problem.empty()) {
            left_.unread[time].add(shown + " (" + field.problem + ")");
            return;
        }
        series_.fields[time][region].emplace(name, field);
    }

    FoamSeries& series_;
    LeftOut& left_;
    std::map<std::pair<std::string, std::string>, FoamField> known_;
    std::size_t heads_ = 0;
};

std::string timeText(const FoamCase& foam, std::size_t time) {
    return time < foam.times.size() ? "At time " + foam.times[time].folder : "Of the constant fields";
}

/// Lists of another length than the mesh has cells or points, where the mesh is the same at all times.
void leaveOutMisfits(FoamSeries& series, LeftOut& left) {
    for (const std::string& region : series.foam.regions) {
        if (!series.foam.isStill(region)) continue;
        const auto mesh = series.meshes.find(region);
        if (mesh == series.meshes.end()) continue;
        const auto [cells, points] = mesh->second.sizes.front(); // heads are those of the first piece
        for (std::size_t t = 0; t < series.timeCount(); ++t)
            std::erase_if(series.fields[t][region], [&](const auto& entry) {
                const FoamField& field = entry.second;
                const std::size_t wanted = foamKind(field.kind)->ofPoints ? points : cells;
                if (field.uniform || field.count == wanted) return false;
                left.unread[t].add((region.empty() ? "" : region + "/") + entry.first + " (it has " +
                                   std::to_string(field.count) + " values, not " + std::to_string(wanted) + ")");
                return true;
            });
    }
}

/// Where the case is divided into regions, the mesh it was divided from has what they had at first.
void leaveOutUndivided(FoamSeries& series) {
    std::vector<std::string>& regions = series.foam.regions;
    std::size_t sum = 0;
    for (const std::string& region : regions)
        if (!region.empty()) sum += series.meshes[region].cells;
    const auto whole = series.meshes.find("");
    if (regions.size() < 2 || !regions.front().empty() || whole == series.meshes.end()) return;
    const bool others = std::ranges::any_of(series.fields, [](const auto& time) {
        return std::ranges::any_of(time, [](const auto& part) { return !part.first.empty() && !part.second.empty(); });
    });
    if (whole->second.cells != sum || !others) return;
    NameList names;
    for (auto& time : series.fields) {
        for (const auto& [name, field] : time[""]) names.add(name);
        time.erase("");
    }
    if (!names.names.empty())
        series.notes.push_back("Left out, since the case is divided into regions: " + names.text() +
                               " of the mesh as a whole.");
    regions.erase(regions.begin());
    series.meshes.erase("");
}

/// What splitMeshRegions writes into each region is the region's number: the regions say as much.
void leaveOutDivision(FoamSeries& series) {
    if (series.foam.regions.size() < 2) return;
    std::size_t count = 0;
    for (auto& time : series.fields)
        for (auto& [region, fields] : time) count += region.empty() ? 0 : fields.erase("cellToRegion");
    if (count > 0) series.notes.emplace_back("Field cellToRegion is left out: the regions have names.");
}

/// Times that together show all fields, and the box of all meshes.
std::vector<std::size_t> showingTimes(const FoamSeries& series) {
    std::set<std::size_t> shown{0};
    std::set<std::pair<std::string, std::string>> seen;
    for (std::size_t t = 0; t < series.timeCount(); ++t)
        for (const auto& [region, names] : series.fields[t])
            for (const auto& [name, field] : names)
                if (seen.insert({region, name}).second) shown.insert(t);
    for (const std::string& region : series.foam.regions) {
        if (series.foam.isStill(region)) continue;
        std::array<double, 6> box{};
        std::array<std::size_t, 6> at{};
        bool first = true;
        std::vector<FoamMeshFiles> last;
        for (std::size_t t = 0; t < series.timeCount(); ++t) {
            if (!series.foam.hasMeshAt(region, t)) continue;
            std::vector<FoamMeshFiles> files = series.foam.meshAt(region, t);
            if (files == last) continue;
            const std::array<double, 6> now = boxOfFoamPoints(files);
            last = std::move(files);
            for (std::size_t i = 0; i < 6; ++i)
                if (first || (i < 3 ? now[i] < box[i] : now[i] > box[i])) {
                    box[i] = now[i];
                    at[i] = t;
                }
            first = false;
        }
        shown.insert(at.begin(), at.end());
    }
    return {shown.begin(), shown.end()};
}

void sayWhatIsLeft(FoamSeries& series, const LeftOut& left) {
    for (const auto& [where, names] : left.elsewhere)
        series.notes.push_back("Left out, since their values are on " + where + ": " + names.text() + ".");
    constexpr std::size_t kMostTimesSaid = 8;
    std::size_t said = 0;
    for (const auto& [time, names] : left.unread) {
        if (said++ == kMostTimesSaid) {
            series.notes.push_back("So are fields at " + std::to_string(left.unread.size() - kMostTimesSaid) +
                                   " more times.");
            break;
        }
        series.notes.push_back(timeText(series.foam, time) + " these are left out: " + names.text() + ".");
    }
    for (const std::string& name : left.differ.names) {
        series.units.erase(name);
        series.notes.push_back("Field " + name + " has several units: none is shown.");
    }
    if (series.foam.particles) series.notes.emplace_back("Particles (lagrangian) are left out.");
    std::size_t divided = 0, cells = 0;
    for (const auto& [region, mesh] : series.meshes) {
        divided += mesh.divided;
        cells += mesh.cells;
    }
    if (divided > 0)
        series.notes.push_back(std::to_string(divided) + " of " + std::to_string(cells) +
                               " cells are other polyhedra: each is divided into tetrahedra, which have its value.");
}

/// Throws where no field is left.
void wantFields(const FoamSeries& series, const LeftOut& left) {
    for (const auto& time : series.fields)
        for (const auto& [region, fields] : time)
            if (!fields.empty()) return;
    if (!left.unread.empty())
        throw std::runtime_error("has no field that can be read: " + left.unread.begin()->second.text());
    throw std::runtime_error("has a mesh and no values: there is no field of cells or points in " +
                             std::string(series.foam.times.empty() ? "it, and no folder of a time (such as 0)"
                                                                   : "the folders of its times"));
}

} // namespace

const FoamSeries::Mesh& FoamSeries::meshAt(const std::string& region, std::size_t time) {
    Mesh& known = meshes[region];
    std::vector<FoamMeshFiles> files = foam.meshAt(region, time);
    if (known.grid.grid != nullptr && known.files == files) return known;
    Mesh fresh;
    FoamMesh mesh = readFoamMesh(files, fresh.sizes, fresh.pointOf);
    fresh.grid = gridOfFoam(mesh);
    fresh.files = std::move(files);
    fresh.cells = mesh.cells;
    fresh.divided = fresh.grid.middles.size();
    fresh.zone = std::move(mesh.zone);
    fresh.zones = std::move(mesh.zones);
    known = std::move(fresh);
    return known;
}

FoamSeries seriesOfFoam(FoamCase given) {
    FoamSeries series;
    series.foam = std::move(given);
    FoamCase& foam = series.foam;
    series.notes = foam.notes;
    LeftOut left;
    FieldFinder finder(series, left);
    const std::size_t times = std::max<std::size_t>(foam.times.size(), 1);
    series.fields.resize(times);
    for (std::size_t t = 0; t < times; ++t)
        for (const std::string& region : foam.regions)
            if (foam.isStill(region) || foam.hasMeshAt(region, t)) finder.look(region, t);
    leaveOutDivision(series);
    wantFields(series, left);
    for (const std::string& region : foam.regions)
        if (foam.hasMeshAt(region, 0)) series.meshAt(region, 0);
    leaveOutUndivided(series);
    leaveOutMisfits(series, left);
    wantFields(series, left);
    series.shownAt = showingTimes(series);
    sayWhatIsLeft(series, left);
    return series;
}

} // namespace tessera::importer
