#include "app/importer/frame.h"

#include "app/importer/present.h"

#include <algorithm>
#include <cstring>
#include <span>
#include <stdexcept>
#include <vtkTypeTraits.h>

namespace tessera::importer {

using volume::Lattice;
using volume::ScalarType;

namespace {

constexpr std::size_t kMostSamplings = 64;

/// FNV-1a hash of a mesh: its points, its number of cells, and which of them are data.
std::uint64_t meshHash(vtkDataSet* mesh) {
    std::uint64_t hash = 1469598103934665603ull;
    const auto mix = [&](double value) {
        std::uint64_t bits = 0;
        std::memcpy(&bits, &value, sizeof bits);
        hash = (hash ^ bits) * 1099511628211ull;
    };
    mix(double(mesh->GetNumberOfCells()));
    mix(double(mesh->GetNumberOfPoints()));
    for (const std::uint8_t present : presentCells(mesh)) mix(double(present));
    for (vtkIdType p = 0; p < mesh->GetNumberOfPoints(); ++p) {
        double x[3];
        mesh->GetPoint(p, x);
        for (const double coordinate : x) mix(coordinate);
    }
    return hash;
}

std::shared_ptr<const Sampling> samplingOf(KnownSamplings& known, vtkDataSet* mesh, const Lattice& lattice,
                                           const volume::Box& box) {
    const std::uint64_t hash = meshHash(mesh);
    for (auto at = known.begin(); at != known.end(); ++at)
        if (at->mesh == hash && at->lattice == lattice) {
            known.splice(known.begin(), known, at);
            return known.front().sampling;
        }
    known.push_front({hash, lattice, makeSampling(mesh, lattice, box)});
    if (known.size() > kMostSamplings) known.pop_back();
    return known.front().sampling;
}

/// Copies the samples of an image on its own grid.
template <class T> void copyArray(vtkDataArray* array, int component, const StoredForm& form, std::span<T> values) {
    const int components = array->GetNumberOfComponents();
    if (array->GetDataType() == vtkTypeTraits<T>::VTK_TYPE_ID && !form.scales() && array->HasStandardMemoryLayout()) {
        const T* from = static_cast<const T*>(array->GetVoidPointer(0)) + component;
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = from[i * std::size_t(components)];
        return;
    }
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = static_cast<T>(form.offset + form.scale * array->GetComponent(vtkIdType(i), component));
}

} // namespace

const Block* blockAt(const std::vector<Block>& blocks, const std::vector<BlockRef>& described, std::size_t index) {
    const std::string& name = described[index].block.name;
    if (blocks.size() == described.size() && blocks[index].name == name) return &blocks[index];
    auto before = std::count_if(described.begin(), described.begin() + std::ptrdiff_t(index),
                                [&](const BlockRef& ref) { return ref.block.name == name; });
    for (const Block& block : blocks)
        if (block.name == name && before-- == 0) return &block;
    return nullptr;
}

Frame frameOf(const Block* block, const BlockRef& ref, int array, int component, const Lattice& lattice,
              KnownSamplings& known) {
    const ArrayRef* about = array < 0 ? nullptr : &ref.arrays[std::size_t(array)];
    const std::size_t count = lattice.count();
    Frame frame;
    if (about != nullptr) frame.type = about->form.type;
    frame.samples.resize(count * volume::byteSize(frame.type));
    vtkDataArray* from = block != nullptr && about != nullptr ? findArray(block->data, *about) : nullptr;
    if (about != nullptr) component += about->firstComponent;
    if (from != nullptr && from->GetNumberOfComponents() <= component) from = nullptr;
    if (block == nullptr || (about != nullptr && from == nullptr)) {
        frame.mask.assign(count, 0);
        return frame;
    }
    vtkDataSet* data = block->data;
    const ArrayRef cover{.form = {}, .ofCells = ref.block.cellData, .vtkName = {}};
    const bool direct = !ref.block.mesh && lattice == ref.block.lattice;
    if (direct) {
        if (from != nullptr && std::size_t(from->GetNumberOfTuples()) != count)
            throw std::runtime_error("array \"" + about->vtkName + "\" has another size than the grid");
        volume::dispatch(frame.type, [&]<class T>(T) {
            const std::span<T> values(reinterpret_cast<T*>(frame.samples.data()), count);
            if (from != nullptr)
                copyArray(from, component, about->stored, values);
            else
                std::ranges::fill(values, T{1});
        });
        frame.mask = presentValues(data, from, about != nullptr ? *about : cover, component);
        if (frame.mask.size() != count) frame.mask.clear();
        return frame;
    }
    const std::shared_ptr<const Sampling> sampling = samplingOf(known, data, lattice, ref.block.box);
    frame.mask.resize(count);
    for (std::size_t i = 0; i < count; ++i) frame.mask[i] = sampling->cells[i] >= 0 ? 1 : 0;
    if (from == nullptr) {
        std::fill(frame.samples.begin(), frame.samples.end(), std::byte{1});
        return frame;
    }
    const vtkSmartPointer<vtkDataArray> values = valuesOf(data, from, *about);
    if (about->ofCells && frame.type == ScalarType::F32)
        sampleCells(data, *sampling, values, component, reinterpret_cast<float*>(frame.samples.data()), frame.mask);
    else
        sampleArray(data, *sampling, values, about->ofCells, component, frame.type, frame.samples.data(), frame.mask);
    return frame;
}

} // namespace tessera::importer
