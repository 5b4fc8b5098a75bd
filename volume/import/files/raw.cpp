#include "volume/import/files/raw.h"

#include "volume/base/error.h"
#include "volume/field/own_axes.h"
#include "volume/system/input_file.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <type_traits>

namespace tessera::volume {

namespace fs = std::filesystem;

namespace {

std::size_t storedBytes(RawType type) {
    constexpr std::size_t kBytes[] = {1, 1, 2, 2, 4, 4, 8};
    return kBytes[static_cast<std::size_t>(type)];
}

ScalarType loadedType(RawType type) {
    constexpr ScalarType kTypes[] = {ScalarType::U8,  ScalarType::I16, ScalarType::U16, ScalarType::I16,
                                     ScalarType::I32, ScalarType::F32, ScalarType::F32};
    return kTypes[static_cast<std::size_t>(type)];
}

template <class To, class From> void convert(std::span<const char> bytes, std::span<To> out, bool swap) {
    for (std::size_t i = 0; i < out.size(); ++i) {
        char one[sizeof(From)];
        std::memcpy(one, bytes.data() + i * sizeof(From), sizeof(From));
        if (swap) std::reverse(one, one + sizeof(From));
        out[i] = static_cast<To>(std::bit_cast<From>(one)); // NOLINT(bugprone-signed-char-misuse): int8 is a number
    }
}

/// Reads slices of one component at one time.
Field readComponent(const std::string& path, const RawForm& form, std::size_t component, std::size_t time,
                    SliceRange slices) {
    std::size_t at = form.skip, frame = 0;
    for (std::size_t c = 0; c < form.components.size(); ++c) {
        const std::size_t size = form.lattice.count() * storedBytes(form.components[c].type);
        if (c < component) at += size;
        frame += size;
    }
    const RawForm::Component& what = form.components[component];
    Field field = makeField(slicesOf(form.lattice, slices), loadedType(what.type));
    const std::size_t size = field.count() * storedBytes(what.type);
    at += time * frame + size / std::size_t(field.lattice.size.z) * std::size_t(slices.first);
    field.scale = what.scale;
    field.offset = what.offset;

    std::ifstream in = openInput(path);
    in.seekg(static_cast<std::streamoff>(at));
    const bool swap = form.bigEndian && storedBytes(what.type) > 1;
    const bool direct = what.type != RawType::I8 && what.type != RawType::F64;
    std::vector<char> bytes(direct ? 0 : size);
    char* to = direct ? reinterpret_cast<char*>(field.samples.data()) : bytes.data();
    in.read(to, static_cast<std::streamsize>(size));
    if (static_cast<std::size_t>(in.gcount()) != size)
        throw Error("ends early, the file has changed", path, "byte " + std::to_string(at));
    if (what.type == RawType::I8)
        convert<std::int16_t, std::int8_t>(bytes, field.as<std::int16_t>(), false);
    else if (what.type == RawType::F64)
        convert<float, double>(bytes, field.as<float>(), swap);
    else if (swap)
        for (std::size_t i = 0, step = storedBytes(what.type); i < size; i += step) std::reverse(to + i, to + i + step);

    if (!what.missing.empty()) {
        Mask mask(field.count(), 1);
        dispatch(field.type, [&]<class T>(T) {
            const auto values = field.as<T>();
            for (const double missing : what.missing)
                for (std::size_t i = 0; i < values.size(); ++i)
                    if (std::is_same_v<T, float> ? float(values[i]) == float(missing) : double(values[i]) == missing)
                        mask[i] = 0;
        });
        field.mask = std::make_shared<const Mask>(std::move(mask)); // withAbsent() drops one that lacks nothing
    }
    return field;
}

/// Three components A.x, A.y, A.z of one type and unit that follow each other are the vector A.
bool isVectorAt(const RawForm& form, std::size_t c) {
    if (c + 3 > form.components.size()) return false;
    const auto& first = form.components[c];
    if (first.name.size() < 3 || !first.name.ends_with(".x")) return false;
    const std::string base = first.name.substr(0, first.name.size() - 1);
    for (std::size_t i = 1; i < 3; ++i) {
        const auto& next = form.components[c + i];
        if (next.name != base + "xyz"[i] || next.type != first.type || next.unit != first.unit || next.categorical ||
            !next.presenceOf.empty())
            return false;
    }
    return !first.categorical && first.presenceOf.empty();
}

/// What a JSON document is, in a few words: "an object with name, license and 3 more".
std::string whatJsonIs(const nlohmann::json& document) {
    if (document.is_array()) return "a list of " + std::to_string(document.size());
    if (!document.is_object()) return std::string("a ") + document.type_name();
    if (document.empty()) return "an empty object";
    constexpr std::size_t kNamed = 4, kLongest = 30;
    std::string text = "an object with ";
    std::size_t named = 0;
    for (const auto& [key, value] : document.items()) {
        if (named == kNamed) return text + " and " + std::to_string(document.size() - kNamed) + " more";
        text += (named++ > 0 ? ", " : "") + key.substr(0, kLongest);
    }
    return text;
}

constexpr std::uintmax_t kMostSidecar = 16 << 20; ///< bytes

std::string readSidecar(const fs::path& path) {
    return readInput(path.string(), kMostSidecar);
}

std::string dataFileOf(const std::string& sidecar, const std::string& named, Outside outside) {
    try {
        return namedPath(sidecar, named, outside);
    } catch (const Error& error) {
        throw Error(error.reason(), sidecar);
    }
}

} // namespace

std::string otherThanSidecar(std::string_view text) {
    const auto document = nlohmann::json::parse(text, nullptr, false);
    const bool broken = document.is_discarded();
    return broken || (document.is_object() && document.contains("dims")) ? "" : whatJsonIs(document);
}

std::size_t RawForm::bytes() const {
    std::size_t frame = 0;
    for (const Component& component : components) frame += lattice.count() * storedBytes(component.type);
    return skip + frames() * frame;
}

bool isRaw(const std::string& path, const std::string& rawOption) {
    const std::string ending = fs::path(path).extension().string();
    return ending == ".raw" || ending == ".json" || (!rawOption.empty() && ending != ".vti");
}

bool hasSidecar(const std::string& path) {
    const fs::path file(path), sidecar = fs::path(file).replace_extension(".json");
    std::error_code unknown;
    if (file.extension() != ".raw" || !whyNoFile(sidecar.string()).empty()) return false;
    return fs::file_size(sidecar, unknown) > kMostSidecar || otherThanSidecar(readSidecar(sidecar)).empty();
}

RawForm statedForm(const std::string& rawOption) {
    if (!rawOption.ends_with(".json")) return parseRawOption(rawOption);
    if (const std::string why = whyNoFile(rawOption); !why.empty()) throw Error(why, rawOption, "--raw");
    return parseSidecar(readSidecar(rawOption), rawOption);
}

FileBlock openRaw(const std::string& path, const std::string& rawOption, Outside outside) {
    RawForm form;
    fs::path data = path;
    if (!rawOption.empty()) {
        form = statedForm(rawOption);
    } else {
        fs::path sidecar = path;
        if (sidecar.extension() != ".json") sidecar.replace_extension(".json");
        requireFile(path);
        const bool exists = fs::exists(sidecar);
        const std::string text = exists ? readSidecar(sidecar) : "";
        const std::string other = exists ? otherThanSidecar(text) : "";
        if (!other.empty() && data.extension() == ".json")
            throw Error("is neither a session nor the sidecar of a raw file, which has dims, but " + other, path);
        if (!exists || !other.empty()) {
            std::error_code unknown;
            if (fs::file_size(path, unknown) == 0) throw Error("is empty", path);
            const std::string name = sidecar.filename().string();
            throw Error(
                (exists ? "has no sidecar (" + name + " is " + other + ", without dims)" : "has no sidecar " + name) +
                    "; state its layout, such as dims=64x64x64,type=u8, with --raw or in the field Raw layout "
                    "of File > Open",
                path);
        }
        form = parseSidecar(text, sidecar.string());
        if (data.extension() == ".json") {
            data = sidecar;
            data.replace_extension(".raw");
            if (!form.dataFile.empty()) data = dataFileOf(sidecar.string(), form.dataFile, outside);
        }
    }
    return openForm(form, path, data.string(), "raw");
}

FileBlock openForm(const RawForm& form, const std::string& path, const std::string& data, const std::string& format) {
    requireFile(data);
    const auto size = fs::file_size(data);
    if (size == 0) throw Error("is empty", data);
    const auto counted = [](std::size_t n, const char* one) {
        return std::to_string(n) + " " + one + (n == 1 ? "" : "s");
    };
    if (size != form.bytes())
        throw Error("has " + std::to_string(size) + " bytes, but its layout needs " + std::to_string(form.bytes()) +
                        " (" + std::to_string(form.lattice.size.x) + " x " + std::to_string(form.lattice.size.y) +
                        " x " + std::to_string(form.lattice.size.z) + " samples, " +
                        counted(form.components.size(), "component") + ", " + counted(form.frames(), "time") + ")",
                    data);

    FileBlock block;
    block.file = path;
    block.format = format;
    block.lattice = form.lattice;
    block.cellData = hasCells(form.lattice.axes);
    if (block.cellData) block.box = gridBounds(form.lattice);
    block.times = form.times;
    block.lengthUnit = form.lengthUnit;
    block.timeName = form.timeName;
    block.timeUnit = form.timeUnit;
    block.quantities = form.quantities;
    block.provenance = form.provenance;
    std::vector<std::size_t> firstComponent;
    std::vector<std::size_t> presence; // index + 1 of the component with the presence flags, 0 = none
    for (std::size_t c = 0; c < form.components.size();) {
        const RawForm::Component& what = form.components[c];
        if (!what.presenceOf.empty()) {
            ++c;
            continue;
        }
        Array array{what.name, what.unit, 1, loadedType(what.type), what.categorical, what.labels};
        const bool vector = isVectorAt(form, c);
        if (vector) {
            array.components = 3;
            array.name.resize(array.name.size() - 2);
        }
        std::size_t flags = 0;
        for (std::size_t other = 0; other < form.components.size(); ++other)
            if (form.components[other].presenceOf == array.name) flags = other + 1;
        block.arrays.push_back(std::move(array));
        firstComponent.push_back(c);
        presence.push_back(flags);
        c += vector ? 3 : 1;
    }
    if (block.arrays.empty()) throw Error("holds no parameter", path);
    block.inParts = true;
    block.read = [form, firstComponent, presence, data](int array, int component, int time, const Lattice&,
                                                        SliceRange slices) {
        const auto a = static_cast<std::size_t>(array), t = static_cast<std::size_t>(time);
        Field field = readComponent(data, form, firstComponent[a] + static_cast<std::size_t>(component), t, slices);
        if (presence[a] != 0) {
            const Field flags = readComponent(data, form, presence[a] - 1, t, slices);
            Mask mask(field.count());
            for (std::size_t i = 0; i < mask.size(); ++i) mask[i] = field.present(i) && flags.value(i) != 0 ? 1 : 0;
            field.mask = std::make_shared<const Mask>(std::move(mask));
        }
        return field;
    };
    return block;
}

} // namespace tessera::volume
