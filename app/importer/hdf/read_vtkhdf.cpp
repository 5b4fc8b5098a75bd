// VTKHDF by its own library: VTK 9.1 knows version 1 of the format only.
#include "app/importer/hdf/vtkhdf_leaf.h"
#include "app/importer/readers/give_times.h"
#include "app/importer/readers/read_files.h"

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <utility>
#include <vtkCompositeDataSet.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>

namespace tessera::importer {

namespace {

constexpr const char* kRoot = "VTKHDF";

bool isComposite(const std::string& type) {
    return type == "MultiBlockDataSet" || type == "PartitionedDataSetCollection";
}

struct Named {
    std::string name, group;
};

/// The blocks below a group of the assembly. Its members are links to the blocks, or groups of more of them.
void findBlocks(const HdfFile& file, const std::string& group, const std::map<std::uint64_t, std::string>& blocks,
                std::set<std::uint64_t>& seen, std::vector<Named>& found) {
    constexpr std::size_t kMost = 10'000;
    for (const std::string& member : file.members(group)) {
        const std::string path = group + "/" + member;
        if (!file.isGroup(path)) continue;
        const std::uint64_t address = file.address(path);
        if (!seen.insert(address).second) continue; // a block linked twice is shown once
        if (const auto block = blocks.find(address); block != blocks.end())
            found.push_back({member, block->second});
        else
            findBlocks(file, path, blocks, seen, found);
        if (found.size() > kMost) throw std::runtime_error("holds too many blocks");
    }
}

std::vector<Named> blocksOf(const HdfFile& file) {
    std::map<std::uint64_t, std::string> blocks;
    std::vector<std::pair<double, std::string>> order;
    for (const std::string& member : file.members(kRoot)) {
        const std::string path = std::string(kRoot) + "/" + member;
        if (member == "Assembly" || member == "Steps" || !file.isGroup(path)) continue;
        blocks.emplace(file.address(path), path);
        const std::vector<double> index = file.attribute(path, "Index");
        order.emplace_back(index.empty() ? double(order.size()) : index[0], path);
    }
    std::vector<Named> found;
    std::set<std::uint64_t> seen;
    findBlocks(file, std::string(kRoot) + "/Assembly", blocks, seen, found);
    std::stable_sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [index, path] : order)
        if (seen.insert(file.address(path)).second) found.push_back({path.substr(path.rfind('/') + 1), path});
    std::map<std::string, int> used;
    for (Named& block : found)
        if (const int count = ++used[block.name]; count > 1) block.name += "_" + std::to_string(count);
    return found;
}

VtkHdfLeaf openAny(const HdfFile& file, const Named& block, std::vector<std::string>& notes) {
    const std::string type = file.word(block.group, "Type");
    if (type == "PolyData") throw std::runtime_error("holds surfaces or points only, no volume");
    if (type == "HyperTreeGrid")
        throw std::runtime_error("holds a hyper tree grid, which is not read: write it as an unstructured grid from "
                                 "ParaView (HyperTreeGrid To UnstructuredGrid)");
    return type == "OverlappingAMR" ? openVtkHdfAmr(file, block.group, block.name, notes)
                                    : openVtkHdfLeaf(file, block.group, block.name, notes);
}

std::vector<VtkHdfLeaf> openBlocks(const HdfFile& file, std::vector<std::string>& notes) {
    std::vector<VtkHdfLeaf> leaves;
    std::string reason;
    for (const Named& block : blocksOf(file)) {
        if (file.word(block.group, "Type").empty()) continue; // an empty block has no type
        try {
            leaves.push_back(openAny(file, block, notes));
        } catch (const std::runtime_error& error) {
            notes.push_back("block \"" + block.name + "\" left out: it " + error.what());
            if (reason.empty()) reason = error.what();
        }
    }
    if (leaves.empty()) throw std::runtime_error(reason.empty() ? "holds no block" : reason);
    return leaves;
}

vtkSmartPointer<vtkDataSet> readAny(const HdfFile& file, const VtkHdfLeaf& leaf, std::size_t step) {
    return leaf.type == "OverlappingAMR" ? readVtkHdfAmr(file, leaf, step) : readVtkHdfLeaf(file, leaf, step);
}

} // namespace

void openVtkHdf(Source& source) {
    const HdfFile file(source.path);
    const std::string type = file.word(kRoot, "Type");
    const std::vector<double> version = file.attribute(kRoot, "Version");
    if (!version.empty() && version[0] > 2)
        throw std::runtime_error("is VTKHDF of version " + std::to_string(int(version[0])) +
                                 ", which is not read: write it as VTK (.vtu, .vti) from ParaView");
    const bool composite = isComposite(type);
    auto leaves = std::make_shared<std::vector<VtkHdfLeaf>>();
    if (composite)
        *leaves = openBlocks(file, source.notes);
    else
        leaves->push_back(openAny(file, {"", kRoot}, source.notes));
    std::vector<double> times;
    bool moves = false;
    for (const VtkHdfLeaf& leaf : *leaves) {
        moves = moves || leaf.moves;
        if (times.empty()) times = leaf.times;
    }
    std::erase_if(*leaves, [&](const VtkHdfLeaf& leaf) {
        const bool other = !leaf.times.empty() && leaf.times.size() != times.size();
        if (other)
            source.notes.push_back("block \"" + leaf.name + "\" left out: it has other times than the first one");
        return other;
    });
    const std::vector<std::size_t> order = giveTimes(source, times);
    if (order.size() > 1) // those of a single time are found in the data
        for (volume::Quantity quantity : vtkHdfQuantities(file, leaves->front())) {
            volume::Quantity sorted{quantity.name, "", {}};
            for (const std::size_t step : order) sorted.values.push_back(quantity.values[step]);
            source.quantities.push_back(std::move(sorted));
        }
    if (moves) {
        source.shownAt.clear();
        for (std::size_t t = 0; t < order.size(); ++t) source.shownAt.push_back(t);
    }
    source.read = [file, leaves, order, composite](std::size_t time) -> vtkSmartPointer<vtkDataObject> {
        const std::size_t step = time < order.size() ? order[time] : 0;
        if (!composite) return readAny(file, leaves->front(), step);
        vtkNew<vtkMultiBlockDataSet> blocks;
        for (const VtkHdfLeaf& leaf : *leaves) {
            const unsigned index = blocks->GetNumberOfBlocks();
            blocks->SetBlock(index, readAny(file, leaf, step));
            blocks->GetMetaData(index)->Set(vtkCompositeDataSet::NAME(), leaf.name.c_str());
        }
        return blocks;
    };
}

} // namespace tessera::importer
