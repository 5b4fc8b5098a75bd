#include "app/command/merge_layouts.h"

#include "app/data/format.h"
#include "volume/base/byte_text.h"
#include "volume/base/terminal.h"

#include <cmath>
#include <cstdio>
#include <map>

namespace tessera::app {

namespace {

std::string mergeTriple(glm::ivec3 v, const char* between) {
    return std::to_string(v.x) + between + std::to_string(v.y) + between + std::to_string(v.z);
}

/// Number of merged bricks by size in bricks.
std::map<std::string, int> mergeSizes(const MergeLayout& layout) {
    std::map<std::string, int> sizes;
    for (const volume::MergedBrick& box : layout.boxes) ++sizes[mergeTriple(box.end - box.begin, "x")];
    return sizes;
}

std::string mergeName(volume::MergeShape shape) {
    return std::string(volume::kMergeShapeNames[std::size_t(shape)]);
}

} // namespace

codec::MergedBytes MergeLayout::sum() const {
    codec::MergedBytes all;
    for (const codec::MergedBytes& box : bytes) all.apart += box.apart, all.together += box.together;
    return all;
}

std::vector<MergeLayout> mergeLayouts(const codec::Archive& archive, const volume::MergeOptions& options,
                                      const Progress& progress) {
    const std::vector<float> importance = volume::mostImportant(archive);
    constexpr volume::MergeShape kShapes[] = {volume::MergeShape::Uniform, volume::MergeShape::Mixed,
                                              volume::MergeShape::Best};
    std::vector<MergeLayout> layouts;
    for (const volume::MergeShape shape : kShapes) {
        volume::MergeOptions one = options;
        one.shape = shape;
        MergeLayout layout{shape, volume::mergeBricks(archive.grid().count(), importance, one), {}};
        const double done = double(layouts.size());
        layout.bytes =
            codec::bytesOfMerged(archive, layout.boxes, progress.part(done / std::size(kShapes), (done + 1) / 3));
        layouts.push_back(std::move(layout));
    }
    return layouts;
}

void printLayouts(const codec::Archive& archive, const std::vector<MergeLayout>& layouts,
                  const volume::MergeOptions& options) {
    const glm::ivec3 count = archive.grid().count();
    say("  %-10s %8s %10s %10s  %s\n", "merged", "bricks", "apart", "as one", "of each size");
    for (const MergeLayout& layout : layouts) {
        std::string sizes;
        for (const auto& [size, number] : mergeSizes(layout))
            sizes += (sizes.empty() ? "" : ", ") + std::to_string(number) + " of " + size;
        say("  %-10s %8s %10s %10s  %s\n", mergeName(layout.shape).c_str(),
            (std::to_string(layout.boxes.size()) + "/" + std::to_string(count.x * count.y * count.z)).c_str(),
            textOfBytes(double(layout.sum().apart)).c_str(), textOfBytes(double(layout.sum().together)).c_str(),
            sizes.c_str());
    }
    for (const MergeLayout& layout : layouts) {
        if (layout.shape != options.shape) continue;
        say("  %-12s %-12s %10s %10s %10s\n", "from", "to", "importance", "apart", "as one");
        for (std::size_t b = 0; b < layout.boxes.size(); ++b)
            say("  %-12s %-12s %10s %10llu %10llu\n", mergeTriple(layout.boxes[b].begin, ",").c_str(),
                mergeTriple(layout.boxes[b].end - 1, ",").c_str(),
                numberText(std::round(1000 * double(layout.boxes[b].importance)) / 1000).c_str(),
                static_cast<unsigned long long>(layout.bytes[b].apart),
                static_cast<unsigned long long>(layout.bytes[b].together));
    }
}

Json layoutsJson(const std::vector<MergeLayout>& layouts, const volume::MergeOptions& options) {
    Json all = Json::array(), boxes = Json::array();
    for (const MergeLayout& layout : layouts) {
        all.push_back({{"shape", mergeName(layout.shape)},
                       {"bricks", layout.boxes.size()},
                       {"sizes", mergeSizes(layout)},
                       {"bytesApart", layout.sum().apart},
                       {"bytesAsOne", layout.sum().together}});
        for (std::size_t b = 0; layout.shape == options.shape && b < layout.boxes.size(); ++b) {
            const volume::MergedBrick& box = layout.boxes[b];
            boxes.push_back({{"begin", {box.begin.x, box.begin.y, box.begin.z}},
                             {"end", {box.end.x, box.end.y, box.end.z}},
                             {"importance", box.importance},
                             {"bytesApart", layout.bytes[b].apart},
                             {"bytesAsOne", layout.bytes[b].together}});
        }
    }
    return {{"options", toJson(options)}, {"layouts", std::move(all)}, {"bricks", std::move(boxes)}};
}

} // namespace tessera::app
