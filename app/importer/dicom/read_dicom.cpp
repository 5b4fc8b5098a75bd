// DICOM: the images of files in any order become stacks, the largest of which is shown.
#include "app/importer/dicom/dicom_volume.h"
#include "app/importer/readers/check_file.h"
#include "app/importer/readers/read_files.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>

namespace tessera::importer {

namespace fs = std::filesystem;

namespace {

std::string fileName(const std::string& path) {
    return fs::path(path).filename().string();
}

/// The files that a DICOMDIR lists, beside it; those that are not there are counted.
std::vector<std::string> listedFiles(const DicomFile& list, const std::string& path, std::size_t& missing) {
    std::vector<std::string> out;
    for (const DicomItem& record : list.data().items(0x00041220)) {
        fs::path file = fs::path(path).parent_path();
        const std::vector<std::string> parts = record.words(0x00041500);
        if (parts.empty()) continue;
        bool inside = true;
        for (const std::string& part : parts) {
            inside = inside && part != ".." && part.find('/') == std::string::npos;
            std::string small = part;
            std::ranges::transform(small, small.begin(), [](unsigned char c) { return char(std::tolower(c)); });
            file = fs::exists(file / part) || !fs::exists(file / small) ? file / part : file / small;
        }
        if (inside && fs::is_regular_file(file))
            out.push_back(file.string());
        else
            ++missing;
    }
    return out;
}

/// Everything that was found in the files.
struct DicomFind {
    std::vector<std::string> files;
    std::vector<DicomImage> images;
    std::vector<DicomFrame> frames;
    std::vector<std::string> notes;
    std::map<std::string, std::vector<std::string>> without; ///< files without an image, by what they hold
};

void addFile(const std::string& path, bool alone, DicomFind& found) {
    try {
        const DicomFile file(path);
        const std::string other = notAnImage(file);
        if (other.empty()) {
            found.images.push_back(describeDicom(file, path, found.images.size(), found.frames));
            return;
        }
        if (alone && other != "DICOMDIR")
            throw std::runtime_error("holds no image (" + other +
                                     "): name the image files, or the folder that holds them");
        found.without[other].push_back(fileName(path));
    } catch (const DicomUnread& error) {
        if (alone) throw;
        found.notes.push_back(fileName(path) + " is left out: it " + error.what());
    } catch (const std::runtime_error& error) {
        if (alone) throw;
        throw std::runtime_error("its slice " + fileName(path) + " " + error.what());
    }
}

DicomFind findImages(const Source& source) {
    DicomFind found;
    found.files = source.files.empty() ? std::vector<std::string>{source.path} : source.files;
    for (const std::string& path : found.files) addFile(path, found.files.size() == 1, found);
    if (found.images.empty() && found.without.contains("DICOMDIR")) {
        std::size_t missing = 0;
        std::vector<std::string> listed;
        for (const std::string& path : found.files) {
            const DicomFile list(path);
            if (notAnImage(list) != "DICOMDIR") continue;
            const std::vector<std::string> own = listedFiles(list, path, missing);
            listed.insert(listed.end(), own.begin(), own.end());
        }
        if (listed.empty()) throw std::runtime_error("lists files (DICOMDIR), of which none is there");
        if (missing > 0)
            found.notes.push_back(std::to_string(missing) + " files that the DICOMDIR lists are not there");
        found.without.clear();
        found.files = listed;
        for (const std::string& path : listed) addFile(path, false, found);
    }
    for (const auto& [kind, names] : found.without)
        found.notes.push_back(std::to_string(names.size()) + (names.size() == 1 ? " file holds" : " files hold") +
                              " no image and " + (names.size() == 1 ? "is" : "are") + " left out (" + kind +
                              "): " + names.front() + (names.size() > 1 ? ", ..." : ""));
    if (found.images.empty())
        throw std::runtime_error(found.notes.empty() ? "holds no image"
                                                     : "holds no image that is read: " + found.notes.front());
    return found;
}

/// The stacks, the one to show first: the largest, but localizers last.
std::vector<std::vector<std::size_t>> stacksIn(const DicomFind& found) {
    std::map<std::string, std::vector<std::size_t>> byKey;
    std::vector<std::string> order;
    for (std::size_t f = 0; f < found.frames.size(); ++f) {
        std::vector<std::size_t>& stack = byKey[found.frames[f].stack];
        if (stack.empty()) order.push_back(found.frames[f].stack);
        stack.push_back(f);
    }
    std::vector<std::vector<std::size_t>> out;
    for (const std::string& key : order) out.push_back(byKey[key]);
    const auto image = [&](const std::vector<std::size_t>& stack) -> const DicomImage& {
        return found.images[found.frames[stack.front()].image];
    };
    std::ranges::stable_sort(out, [&](const auto& a, const auto& b) {
        const DicomImage &one = image(a), &other = image(b);
        if (one.localizer != other.localizer) return other.localizer;
        return double(a.size()) * double(one.form.pixels()) > double(b.size()) * double(other.form.pixels());
    });
    return out;
}

/// A pattern that fits these names and no others: "b_*.dcm"; "" if there is none.
std::string patternOf(const std::vector<std::string>& names, const std::vector<std::string>& all) {
    std::string begin = names.front(), end = names.front();
    for (const std::string& name : names) {
        begin.resize(std::size_t(std::ranges::mismatch(begin, name).in1 - begin.begin()));
        const auto same = std::mismatch(end.rbegin(), end.rend(), name.rbegin(), name.rend()).first - end.rbegin();
        end = end.substr(end.size() - std::size_t(same));
    }
    if (begin.find_first_of("*?[") != std::string::npos || end.find_first_of("*?[") != std::string::npos) return {};
    for (const std::string& name : all) {
        const bool fits = name.size() >= begin.size() + end.size() && name.starts_with(begin) && name.ends_with(end);
        if (fits && std::ranges::find(names, name) == names.end()) return {};
    }
    return begin + "*" + end;
}

/// The folder that holds these files and no others; "" if there is none.
std::string folderOf(const std::vector<std::string>& names, const std::vector<std::string>& all) {
    const fs::path folder = fs::path(names.front()).parent_path();
    const auto inside = [&](const std::string& name) { return fs::path(name).parent_path() == folder; };
    const bool own =
        std::ranges::all_of(names, inside) && std::size_t(std::ranges::count_if(all, inside)) == names.size();
    return own ? folder.string() : std::string();
}

/// What lies beside the stack that is shown, and how to open it.
std::string aboutOther(const DicomFind& found, const fs::path& home, const std::vector<std::size_t>& stack,
                       const std::set<std::size_t>& shown) {
    const DicomImage& image = found.images[found.frames[stack.front()].image];
    std::set<std::size_t> files;
    for (const std::size_t f : stack) files.insert(found.frames[f].image);
    std::vector<std::string> names, all;
    for (const std::size_t file : files)
        names.push_back(fs::path(found.images[file].path).lexically_relative(home).string());
    for (const std::string& path : found.files) all.push_back(fs::path(path).lexically_relative(home).string());
    std::string text = "not shown: ";
    if (image.localizer) text += "a localizer, ";
    text +=
        "series " + (image.number ? std::to_string(std::int64_t(std::clamp(*image.number, -1e9, 1e9))) : image.series);
    if (!image.seriesName.empty()) text += " \"" + image.seriesName.substr(0, 60) + "\"";
    text += ", " + std::to_string(stack.size()) + (stack.size() == 1 ? " image of " : " images of ") +
            std::to_string(image.form.columns) + " x " + std::to_string(image.form.rows);
    if (std::ranges::any_of(files, [&](std::size_t file) { return shown.contains(file); }))
        return text + " in the same file";
    if (names.size() == 1) return text + ": open " + names.front();
    if (const std::string folder = folderOf(names, all); !folder.empty()) return text + ": open " + folder;
    const std::string pattern = patternOf(names, all);
    if (!pattern.empty()) return text + ": open '" + pattern + "'";
    return text + ": put its " + std::to_string(names.size()) + " files (" + names[0] + ", " + names[1] +
           (names.size() > 2 ? ", ..." : "") + ") into a folder of their own";
}

void noteImage(const DicomImage& image, Source& source) {
    const auto note = [&](const char* text) { source.notes.emplace_back(text); };
    if (image.localizer) note("the images are a localizer");
    if (image.form.photometric == "MONOCHROME1")
        note("stored as negative (MONOCHROME1: high numbers are dark): numbers are shown as stored");
    if (image.form.photometric == "PALETTE COLOR")
        note("a palette of colours is left out: the numbers are its indices");
    if (image.form.samples > 1) note("colours are three parameters: red, green and blue");
    if (image.lookUp)
        note(
            "a table that turns stored numbers into others (modality LUT) is not applied: numbers are shown as stored");
    if (image.overlays) note("drawings over the images (overlay planes) are left out");
    if (image.mosaic) note("each image is a mosaic of slices (Siemens), shown as it is stored: split it with dcm2niix");
    if (image.form.bits == 32 && !image.form.real && image.form.used > 24 && image.doseUnit.empty())
        note("numbers beyond 16 million are rounded to those that 32-bit floats hold");
}

/// One frame of each place, of which the geometry of a segmentation follows.
std::vector<std::size_t> oneOfEachPlace(const DicomFind& found, const std::vector<std::size_t>& stack) {
    std::map<double, std::size_t> byPlace;
    for (const std::size_t f : stack) {
        const DicomFrame& frame = found.frames[f];
        const double along = frame.corner ? glm::dot(*frame.corner, glm::cross(frame.across, frame.down)) : 0;
        byPlace.emplace(std::round(along * 1000), f);
    }
    std::vector<std::size_t> out;
    for (const auto& [place, f] : byPlace) out.push_back(f);
    return out;
}

} // namespace

void openDicom(Source& source) {
    DicomFind found = findImages(source);
    const std::vector<std::vector<std::size_t>> stacks = stacksIn(found);
    const std::vector<std::size_t>& chosen = stacks.front();
    std::set<std::size_t> shown;
    for (const std::size_t f : chosen) shown.insert(found.frames[f].image);
    constexpr std::size_t kMostTold = 6;
    for (std::size_t s = 1; s < stacks.size() && s <= kMostTold; ++s)
        source.notes.push_back(aboutOther(found, fs::path(source.path).parent_path(), stacks[s], shown));
    if (stacks.size() > kMostTold + 1)
        source.notes.push_back("not shown: " + std::to_string(stacks.size() - kMostTold - 1) +
                               " more series or stacks");
    source.notes.insert(source.notes.end(), found.notes.begin(), found.notes.end());
    const DicomImage image = found.images[found.frames[chosen.front()].image];
    noteImage(image, source);
    const bool segments = !image.segmentation.empty() && image.segmentation != "LABELMAP";
    auto volume = std::make_shared<DicomVolume>();
    volume->stack = stackDicom(found.images, found.frames, segments ? oneOfEachPlace(found, chosen) : chosen);
    volume->images = std::move(found.images);
    volume->frames = std::move(found.frames);
    if (segments) { // its empty slices have no frames
        volume->stack.uneven.clear();
        openDicomSegments(volume, chosen, source);
        return;
    }
    source.notes.insert(source.notes.end(), volume->stack.notes.begin(), volume->stack.notes.end());
    openDicomVolume(volume, source);
}

} // namespace tessera::importer
