#include "volume/import/names/vectors.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

namespace tessera::volume {

namespace {

bool isLetter(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || static_cast<unsigned char>(c) > 127;
}

std::string lowerLetters(std::string_view text) {
    std::string out;
    for (const char c : text)
        if (isLetter(c)) out += char(std::tolower(static_cast<unsigned char>(c)));
    return out;
}

bool isOneOf(std::string_view word, std::initializer_list<std::string_view> words) {
    return std::ranges::find(words, word) != words.end();
}

bool isVelocity(std::string_view base) {
    return isOneOf(base, {"velocity", "vel", "sv", "velocityfield"});
}

/// Quantities that are vectors, so that a digit or a letter without a mark is enough to tell a component.
bool isVectorWord(std::string_view base) {
    return isVelocity(base) || isOneOf(base, {"u", "momentum", "mom", "force", "displacement", "disp", "flux",
                                              "gradient", "grad", "vorticity", "normal", "normals", "current",
                                              "currentdensity", "wallshearstress", "wallshear", "j", "e", "b"});
}

bool isPosition(std::string_view base) {
    return isOneOf(base, {"", "coordinate", "coordinates", "coord", "coords", "position", "pos", "point", "points",
                          "centroid", "cellcenter", "cellcenters", "center", "centre", "node", "nodes"});
}

/// A name as a component: of which family, and along which axis.
struct Component {
    std::string family; ///< equal for siblings alone
    std::string base;   ///< what the name is without the axis
    int axis = 0;
};

std::optional<int> axisLetter(std::string_view word, std::string_view letters) {
    if (word.size() != 1) return std::nullopt;
    const std::size_t at = letters.find(word[0]);
    return at == std::string_view::npos ? std::nullopt : std::optional(int(at));
}

/// Letters and digits that stand for axes, and the name of each set in families.
constexpr std::string_view kSets[] = {"xyz", "XYZ", "ijk", "uvw", "UVW", "012"};

/// A name without the word [begin, end), and without "component" where that word belongs to it.
std::string without(std::string_view name, std::size_t begin, std::size_t end) {
    std::string base = std::string(name.substr(0, begin)) + std::string(name.substr(end));
    for (const std::string_view word : {"component of", "component", "Component"})
        if (const std::size_t at = base.find(word); at != std::string::npos) base.erase(at, word.size());
    std::string out;
    for (const char c : base) { // marks at both ends, and twice
        const bool mark = !isLetter(c) && c != '(' && c != ')';
        if (mark && (out.empty() || (!isLetter(out.back()) && out.back() != ')'))) continue;
        out += c;
    }
    while (!out.empty() && !isLetter(out.back()) && out.back() != ')') out.pop_back();
    return out;
}

/// Ways to read a name as that of a component, the surest first.
std::vector<Component> readings(const std::string& name) {
    std::vector<Component> out;
    const std::string_view view = name;
    for (const std::string_view set : kSets)
        if (const auto axis = axisLetter(view, set); axis && (set == "uvw" || set == "UVW"))
            return {{"alone:" + std::string(set), "velocity", *axis}};
    // A word of its own: x-velocity, vel_x, U:0, Velocity[i], "Velocity u", "Mean X Velocity".
    std::vector<Component> words;
    for (std::size_t begin = 0; begin < name.size();) {
        std::size_t end = begin;
        while (end < name.size() && isLetter(name[end])) ++end;
        for (const std::string_view set : kSets) {
            const auto axis = axisLetter(view.substr(begin, end - begin), set);
            if (!axis) continue;
            const std::string base = without(view, begin, end), plain = lowerLetters(base);
            const char before = begin > 0 ? name[begin - 1] : ' ';
            const bool bracket = before == '[' && end < name.size() && name[end] == ']';
            const bool velocity = plain.find("vel") != std::string::npos || isVelocity(plain);
            if (set == "ijk" && !bracket) continue;
            if ((set == "uvw" || set == "UVW") && !velocity) continue;
            if (set == "012" && !bracket && (end != name.size() || (before != ':' && !isVectorWord(plain)))) continue;
            words.push_back(
                {std::string(view.substr(0, begin)) + "<" + std::string(set) + ">" + name.substr(end), base, *axis});
        }
        begin = std::max(end, begin + 1);
    }
    if (words.size() == 1) return words; // two would be those of a tensor
    if (!words.empty()) return {};
    // A letter at the end or the start: Ux, VelocityX, velx; xvelocity.
    for (const std::string_view set : {kSets[0], kSets[1]}) {
        if (name.size() > 1 && isLetter(name[name.size() - 2]))
            if (const auto axis = axisLetter(view.substr(name.size() - 1), set)) {
                const std::string base = name.substr(0, name.size() - 1);
                out.push_back({base + "<" + std::string(set) + ">", base, *axis});
            }
        if (const auto axis = axisLetter(view.substr(0, 1), set); axis && isVectorWord(lowerLetters(view.substr(1))))
            out.push_back({"<" + std::string(set) + ">" + name.substr(1), name.substr(1), *axis});
    }
    return out;
}

/// Whether "Sx" + x, y, z are a row of a tensor: what is before the letter has other rows, or is hardly a name.
bool isTensorRow(const std::string& base, const DatasetInfo& info) {
    if (base.empty() || std::string_view("xyzXYZ").find(base.back()) == std::string_view::npos) return false;
    const std::string stem = base.substr(0, base.size() - 1);
    if (stem.size() < 3 || !isLetter(stem.back())) return true;
    return std::ranges::any_of(info.parameters, [&](const Parameter& other) {
        return other.name.size() == stem.size() + 2 && other.name.starts_with(stem) && !other.name.starts_with(base) &&
               std::string_view("xyzXYZ").find(other.name[stem.size()]) != std::string_view::npos &&
               std::string_view("xyzXYZ").find(other.name.back()) != std::string_view::npos;
    });
}

bool belongTogether(const Parameter& a, const Parameter& b) {
    return a.type == b.type && a.unit == b.unit && a.components == 1 && b.components == 1 && !a.categorical &&
           !b.categorical;
}

bool isTaken(const std::string& name, const std::array<int, 3>& own, const DatasetInfo& info,
             const std::vector<NamedVector>& found) {
    for (std::size_t p = 0; p < info.parameters.size(); ++p)
        if (info.parameters[p].name == name && std::ranges::find(own, int(p)) == own.end()) return true;
    return std::ranges::any_of(found, [&](const NamedVector& other) { return other.name == name; });
}

std::string nameOf(const std::string& base, const std::array<int, 3>& own, const DatasetInfo& info,
                   const std::vector<NamedVector>& found) {
    std::vector<std::string> names{base, base + " vector"};
    if (isVelocity(lowerLetters(base))) names.insert(names.begin(), "U");
    for (const std::string& name : names)
        if (!isTaken(name, own, info, found)) return name;
    return {};
}

std::set<std::string> fourthNames(const std::string& family) {
    std::set<std::string> names;
    const std::string set = "<012>";
    if (const std::size_t at = family.find(set); at != std::string::npos)
        names.insert(std::string(family).replace(at, set.size(), "3"));
    return names;
}

Field zeros(Field like) {
    std::ranges::fill(like.samples, std::byte{0});
    like.offset = 0;
    return like;
}

} // namespace

std::vector<NamedVector> findVectors(const DatasetInfo& info, const std::set<std::string>& kept) {
    struct Family {
        std::string base;
        std::array<int, 3> components{-1, -1, -1};
        bool twice = false;
    };
    std::map<std::string, Family> families;
    std::vector<std::string> order;
    for (std::size_t p = 0; p < info.parameters.size(); ++p) {
        const Parameter& parameter = info.parameters[p];
        if (parameter.components != 1 || parameter.categorical || kept.contains(parameter.name)) continue;
        for (const Component& component : readings(parameter.name)) {
            const auto [at, isNew] =
                families.try_emplace(component.family, Family{component.base, {-1, -1, -1}, false});
            if (isNew) order.push_back(component.family);
            int& slot = at->second.components[std::size_t(component.axis)];
            at->second.twice = at->second.twice || slot >= 0;
            slot = int(p);
        }
    }
    std::vector<NamedVector> found;
    std::set<int> used;
    for (const std::string& key : order) {
        const Family& family = families.at(key);
        const std::array<int, 3>& own = family.components;
        const bool inPlane = own[2] < 0 && info.lattice.size.z == 1;
        if (family.twice || own[0] < 0 || own[1] < 0 || (own[2] < 0 && !inPlane)) continue;
        const std::set<std::string> fourth = fourthNames(key);
        bool fits = !isPosition(lowerLetters(family.base)) && !isTensorRow(family.base, info);
        for (const int p : own) {
            if (p < 0) continue;
            fits = fits && !used.contains(p) &&
                   belongTogether(info.parameters[std::size_t(own[0])], info.parameters[std::size_t(p)]);
        }
        fits = fits && std::ranges::none_of(info.parameters,
                                            [&](const Parameter& other) { return fourth.contains(other.name); });
        if (!fits) continue;
        const std::string name = nameOf(family.base, own, info, found);
        if (name.empty()) continue;
        used.insert(own.begin(), own.end());
        used.erase(-1);
        found.push_back({name, own});
    }
    return found;
}

WithVectors withVectors(Dataset dataset, const std::set<std::string>& kept) {
    WithVectors out;
    const std::vector<NamedVector> vectors = findVectors(dataset.info, kept);
    std::vector<Parameter> parameters;
    for (std::size_t p = 0; p < dataset.info.parameters.size(); ++p) {
        const Parameter& parameter = dataset.info.parameters[p];
        const auto of = std::ranges::find_if(vectors, [&](const NamedVector& vector) {
            return std::ranges::find(vector.components, int(p)) != vector.components.end();
        });
        if (of == vectors.end()) {
            parameters.push_back(parameter);
            out.from.push_back({int(p)});
            continue;
        }
        const auto known = std::ranges::find_if(of->components, [](int c) { return c >= 0; });
        const bool first = int(p) == *std::min_element(known, of->components[2] < 0 ? of->components.begin() + 2
                                                                                    : of->components.end());
        if (!first) continue; // the vector stands in the place of its first component
        std::vector<int>& from = out.from.emplace_back();
        std::string names;
        for (const int c : of->components)
            if (c >= 0) {
                from.push_back(c);
                names += (names.empty() ? "" : ", ") + dataset.info.parameters[std::size_t(c)].name;
            }
        parameters.push_back(parameter);
        parameters.back().name = of->name;
        parameters.back().components = 3;
        out.notes.push_back(of->name + " formed from " + names + (from.size() == 2 ? "; along z it is 0" : ""));
    }
    if (!vectors.empty()) {
        dataset.info.parameters = std::move(parameters);
        dataset.read = dataset.read.through(
            [from = out.from](const FrameReader& read, int parameter, int component, int time, SliceRange slices) {
                const std::vector<int>& own = from[std::size_t(parameter)];
                if (own.size() == 1) return read(own.front(), component, time, slices);
                if (component >= int(own.size())) return zeros(read(own.front(), 0, time, slices));
                return read(own[std::size_t(component)], 0, time, slices);
            });
    }
    out.dataset = std::move(dataset);
    return out;
}

} // namespace tessera::volume
