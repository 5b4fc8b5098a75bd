#include "app/importer/fluent/fluent_case.h"

#include "app/importer/fluent/fluent_file.h"

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

namespace tessera::importer {

namespace {

// Numbers of sections in the format guide of Fluent's mesh files.
constexpr int kDimensions = 2, kPoints = 10, kCells = 12, kFaces = 13, kZone = 39, kZoneOld = 45, kFaceTree = 59,
              kInterface = 61, kNonConformal = 62;
constexpr std::int64_t kParentFaces = 31, kInactiveCells = 32;
constexpr std::int64_t kMost = std::int64_t(1) << 31;

/// What is read of a case, before its cells are made.
class CaseReader {
public:
    explicit CaseReader(const std::string& path) : file_(path) {}

    FluentCase read() {
        FluentSection section;
        std::size_t sections = 0;
        for (; file_.next(section); ++sections) take(section);
        if (sections == 0) throw std::runtime_error("is no Fluent file");
        FaceMesh& mesh = case_.mesh;
        if (mesh.places.empty() || mesh.faces() == 0 || mesh.cells == 0)
            throw std::runtime_error("holds no mesh of points, faces and cells: truncated, or not of Fluent");
        if (statedFaces_ > std::int64_t(mesh.faces()) || statedPoints_ * 3 > std::int64_t(mesh.places.size()))
            throw std::runtime_error("ends before its last face or point: truncated");
        finish();
        return std::move(case_);
    }

private:
    void take(const FluentSection& section) {
        switch (section.number) {
        case kDimensions:
            if (const std::int64_t n = headerNumber(section, 0, 10); n == 2 || n == 3) case_.mesh.dimensions = int(n);
            break;
        case kPoints:
            readPoints(section);
            break;
        case kCells:
            readCellZone(section);
            break;
        case kFaces:
            readFaces(section);
            break;
        case kZone:
        case kZoneOld:
            if (section.header.size() >= 3) names_[headerNumber(section, 0, 10)] = section.header[2];
            break;
        case kFaceTree:
            readTree(section);
            break;
        case kInterface:
            pieces_.emplace_back(headerNumber(section, 0, 16), headerNumber(section, 1, 16));
            break;
        case kNonConformal:
            for (std::size_t at = section.begin; !file_.atEnd(section, at); file_.whole(section, at))
                children_.insert(file_.whole(section, at) - 1);
            break;
        default:
            break;
        }
    }

    struct Span {
        std::int64_t zone, first, last;
    };
    /// Zone, first and last number; the zone 0 states how many there are in all.
    static Span spanOf(const FluentSection& section) {
        const Span span{headerNumber(section, 0, 16), headerNumber(section, 1, 16), headerNumber(section, 2, 16)};
        if (span.zone < 0 || span.first < 0 || span.last < 0 || span.last >= kMost ||
            (span.zone > 0 && span.last < span.first - 1))
            throw std::runtime_error("is damaged in the header of a section");
        return span;
    }

    void readPoints(const FluentSection& section) {
        const Span span = spanOf(section);
        if (span.zone == 0) {
            statedPoints_ = span.last;
            return;
        }
        const std::int64_t stated = headerNumber(section, 4, 10);
        const auto axes = std::size_t(stated == 2 || stated == 3 ? stated : case_.mesh.dimensions);
        const auto count = std::size_t(span.last - span.first + 1);
        std::size_t at = section.begin;
        const std::vector<double> numbers = file_.numbers(section, at, axes * count);
        std::vector<double>& places = case_.mesh.places;
        if (places.size() < 3 * std::size_t(span.last)) {
            if (span.first < 1 || std::size_t(span.first - 1) * 3 > places.size())
                throw std::runtime_error("stores its points in another order than their numbers");
            places.resize(3 * std::size_t(span.last), 0);
        }
        for (std::size_t n = 0; n < count; ++n)
            for (std::size_t axis = 0; axis < axes; ++axis)
                places[3 * (std::size_t(span.first) - 1 + n) + axis] = numbers[axes * n + axis];
    }

    void readCellZone(const FluentSection& section) {
        const Span span = spanOf(section);
        case_.mesh.cells = std::max(case_.mesh.cells, std::size_t(span.last));
        if (span.zone == 0 || span.last < span.first || span.first < 1) return;
        const std::int64_t state = headerNumber(section, 3, 16);
        if (state == 0 || state == kInactiveCells) return;
        case_.zones.push_back({span.zone, "", std::size_t(span.first) - 1, std::size_t(span.last)});
    }

    void readFaces(const FluentSection& section) {
        const Span span = spanOf(section);
        if (span.zone == 0) {
            statedFaces_ = span.last;
            return;
        }
        FaceMesh& mesh = case_.mesh;
        const std::int64_t kind = headerNumber(section, 3, 16), corners = headerNumber(section, 4, 16);
        if (span.first != std::int64_t(mesh.faces()) + 1) {
            if (span.first < 1 || std::size_t(span.first) > mesh.faces() + section.end - section.begin)
                throw std::runtime_error("stores its faces in another order than their numbers");
            while (std::int64_t(mesh.faces()) + 1 < span.first) addNoFace(); // filled by a later section
            if (span.first <= std::int64_t(mesh.faces())) throw std::runtime_error("stores a face twice");
        }
        std::size_t at = section.begin;
        for (std::int64_t f = span.first; f <= span.last; ++f) {
            const std::int64_t count = corners == 0 || corners == 5 ? file_.whole(section, at) : corners;
            if (count < 2 || count > 10'000) throw std::runtime_error("has a face with a bad number of corners");
            for (std::int64_t n = 0; n < count; ++n) mesh.points.push_back(std::int32_t(file_.whole(section, at) - 1));
            for (int side = 0; side < 2; ++side) mesh.sides.push_back(std::int32_t(file_.whole(section, at) - 1));
            mesh.begins.push_back(mesh.points.size());
            use_.push_back(kind == kParentFaces ? 0 : 1);
        }
        if (!file_.atEnd(section, at)) throw std::runtime_error("has more numbers than a section of faces announces");
    }

    void addNoFace() {
        case_.mesh.begins.push_back(case_.mesh.points.size());
        case_.mesh.sides.insert(case_.mesh.sides.end(), 2, -1);
        use_.push_back(0);
    }

    /// Faces that were split: the smaller ones are kept, so that their cells become polyhedra.
    void readTree(const FluentSection& section) {
        std::size_t at = section.begin;
        const std::int64_t first = headerNumber(section, 0, 16), last = headerNumber(section, 1, 16);
        for (std::int64_t f = first; f >= 1 && f <= last && f < kMost; ++f) {
            parents_.insert(f - 1);
            for (std::int64_t kids = file_.whole(section, at); kids > 0; --kids) file_.whole(section, at);
        }
    }

    void finish() {
        for (const std::int64_t f : parents_)
            if (f >= 0 && std::size_t(f) < use_.size()) use_[std::size_t(f)] = 0;
        for (const std::int64_t f : children_) // pieces of the faces at an interface, beside these
            if (f >= 0 && std::size_t(f) < use_.size()) use_[std::size_t(f)] = 0;
        for (const auto& [first, last] : pieces_)
            for (std::int64_t f = std::max<std::int64_t>(first, 1); f <= std::min(last, std::int64_t(use_.size())); ++f)
                use_[std::size_t(f - 1)] = 0;
        if (case_.mesh.cells > 2 * case_.mesh.faces()) throw std::runtime_error("has more cells than faces for them");
        case_.faces = facesOfCells(case_.mesh, use_);
        std::ranges::sort(case_.zones, {}, &FluentZone::first);
        if (case_.zones.empty()) case_.zones.push_back({0, "", 0, case_.mesh.cells});
        for (FluentZone& zone : case_.zones)
            if (const auto name = names_.find(zone.id); name != names_.end()) zone.name = name->second;
    }

    FluentFile file_;
    FluentCase case_;
    std::map<std::int64_t, std::string> names_;
    std::set<std::int64_t> parents_, children_;
    std::vector<std::pair<std::int64_t, std::int64_t>> pieces_; ///< of faces at interfaces, from 1
    std::vector<std::uint8_t> use_;
    std::int64_t statedFaces_ = 0, statedPoints_ = 0;
};

struct Known {
    std::int64_t number;
    const char *storage, *name, *unit;
    int component = -1;
};
// Numbers of variables in .dat files (fluent's xfile.h); units are those of SI, in which Fluent stores.
constexpr Known kKnown[] = {{1, "SV_P", "pressure", "Pa"},
                            {3, "SV_T", "temperature", "K"},
                            {4, "SV_H", "enthalpy", "J/kg"},
                            {5, "SV_K", "turb-kinetic-energy", "m2/s2"},
                            {6, "SV_D", "turb-diss-rate", "m2/s3"},
                            {18, "SV_FLUX", "mass-flux", "kg/s"},
                            {63, "SV_O", "specific-diss-rate", "1/s"},
                            {67, "SV_GT", "granular-temperature", "m2/s2"},
                            {96, "SV_WALL_DIST", "wall-distance", "m"},
                            {101, "SV_DENSITY", "density", "kg/m3"},
                            {102, "SV_MU_LAM", "viscosity-lam", "Pa s"},
                            {103, "SV_MU_T", "viscosity-turb", "Pa s"},
                            {104, "SV_CP", "specific-heat", "J/kg/K"},
                            {105, "SV_KTC", "thermal-conductivity", "W/m/K"},
                            {111, "SV_U", "velocity", "m/s", 0},
                            {112, "SV_V", "velocity", "m/s", 1},
                            {113, "SV_W", "velocity", "m/s", 2},
                            {150, "SV_VOF", "volume-fraction", ""},
                            {192, "SV_TOTAL_P", "total-pressure", "Pa"},
                            {193, "SV_TOTAL_T", "total-temperature", "K"},
                            {400, "SV_P_MEAN", "mean-pressure", "Pa"},
                            {402, "SV_U_MEAN", "mean-velocity", "m/s", 0},
                            {404, "SV_V_MEAN", "mean-velocity", "m/s", 1},
                            {406, "SV_W_MEAN", "mean-velocity", "m/s", 2},
                            {408, "SV_T_MEAN", "mean-temperature", "K"}};

std::string numbered(const char* name, std::int64_t number) {
    return std::string(name) + "-" + std::to_string(number);
}

// Numbers of variables that keep the values of earlier time steps, from and to.
constexpr std::int64_t kEarlier[][2] = {
    {29, 30},   {47, 48},   {64, 65},   {68, 69},   {115, 117}, {119, 120}, {122, 124}, {126, 127}, {138, 149},
    {160, 164}, {170, 174}, {180, 180}, {250, 349}, {412, 413}, {501, 518}, {522, 523}, {525, 526}, {528, 529},
    {532, 533}, {583, 584}, {623, 628}, {636, 637}, {653, 653}, {661, 662}, {750, 849}};

} // namespace

bool isOfEarlierStep(std::int64_t number, const std::string& storage) {
    if (storage.ends_with("_M1") || storage.ends_with("_M2")) return true;
    return storage.empty() && std::ranges::any_of(kEarlier, [number](const std::int64_t(&range)[2]) {
               return number >= range[0] && number <= range[1];
           });
}

FluentCase readFluentCase(const std::string& path) {
    return CaseReader(path).read();
}

FluentVariable fluentVariable(std::int64_t number, const std::string& storage) {
    const auto named = [](const Known& known) { return FluentVariable{known.name, known.unit, known.component}; };
    for (const Known& known : kKnown)
        if (known.number == number) return named(known);
    for (const Known& known : kKnown) // some writers repeat a remark, so that the number counts first
        if (!storage.empty() && known.storage == storage) return named(known);
    if (!storage.empty()) return {storage, "", -1};
    if (number >= 200 && number < 250) return {numbered("mass-fraction", number - 200), "", -1};
    if (number >= 151 && number < 155) return {numbered("volume-fraction", number - 150), "", -1};
    if (number >= 700 && number < 750) return {numbered("user-scalar", number - 700), "", -1};
    return {numbered("variable", number), "", -1};
}

} // namespace tessera::importer
