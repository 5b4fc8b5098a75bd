#include "app/importer/open_source.h"

#include "app/importer/even_grid.h"
#include "app/importer/formats.h"
#include "app/importer/present_cells.h"
#include "app/importer/readers/check_file.h"
#include "app/importer/readers/hdf_names.h"
#include "app/importer/readers/vtk_messages.h"
#include "app/importer/swept_names.h"
#include "app/importer/tables/table_rows.h"
#include "volume/import/files/formats.h"
#include "volume/system/input_file.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <vtkAbstractArray.h>
#include <vtkAppendFilter.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataObjectTree.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPartitionedDataSet.h>
#include <vtkPartitionedDataSetCollection.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkStructuredGrid.h>
#include <vtkUnstructuredGrid.h>

namespace tessera::importer {

namespace fs = std::filesystem;

namespace {

/// Pieces of one data set as one: those of a parallel program.
vtkSmartPointer<vtkDataSet> joined(const std::vector<vtkDataSet*>& pieces) {
    if (pieces.empty()) return nullptr;
    if (pieces.size() == 1) return pieces[0];
    vtkNew<vtkAppendFilter> append;
    append->MergePointsOff();
    for (vtkDataSet* piece : pieces) append->AddInputData(piece);
    append->Update();
    vtkDataSet* whole = append->GetOutput();
    return whole;
}

void flatten(vtkDataObject* data, const std::string& name, std::vector<Block>& blocks) {
    if (auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(data)) {
        for (unsigned i = 0; i < collection->GetNumberOfPartitionedDataSets(); ++i) {
            vtkInformation* about = collection->HasMetaData(i) != 0 ? collection->GetMetaData(i) : nullptr;
            const bool named = about != nullptr && about->Has(vtkCompositeDataSet::NAME()) != 0;
            const std::string own = named ? about->Get(vtkCompositeDataSet::NAME()) : "";
            flatten(collection->GetPartitionedDataSet(i), own.empty() ? name : own, blocks);
        }
        return;
    }
    if (auto* partitioned = vtkPartitionedDataSet::SafeDownCast(data)) { // a vtkMultiPieceDataSet is one, too
        std::vector<vtkDataSet*> pieces;
        for (unsigned i = 0; i < partitioned->GetNumberOfPartitions(); ++i)
            if (vtkDataSet* piece = partitioned->GetPartition(i); piece != nullptr && piece->GetNumberOfCells() > 0)
                pieces.push_back(piece);
        if (const auto whole = joined(pieces)) blocks.push_back({name, whole, {}});
        return;
    }
    if (vtkDataObjectTree::SafeDownCast(data) != nullptr) {
        auto* multi = vtkMultiBlockDataSet::SafeDownCast(data);
        for (unsigned i = 0; multi != nullptr && i < multi->GetNumberOfBlocks(); ++i) {
            std::string inner;
            if (multi->HasMetaData(i) != 0 && multi->GetMetaData(i)->Has(vtkCompositeDataSet::NAME()) != 0)
                inner = multi->GetMetaData(i)->Get(vtkCompositeDataSet::NAME());
            // A region of OpenFOAM, as foamToVTK and ParaView write it, is a block named after it with an inner one.
            const bool keep = inner == "internal" || inner == "internalMesh" || inner == "default" || inner.empty();
            flatten(multi->GetBlock(i), keep && !name.empty() ? name : inner, blocks);
        }
        if (multi == nullptr) throw std::runtime_error("holds a kind of composite data that is not read");
        return;
    }
    auto* leaf = vtkDataSet::SafeDownCast(data);
    if (leaf != nullptr && leaf->GetNumberOfPoints() > 0 && leaf->GetNumberOfCells() > 0)
        blocks.push_back({name, leaf, {}});
}

int arraysIn(vtkDataObject* data) {
    int found = 0;
    for (const int kind : {vtkDataObject::POINT, vtkDataObject::CELL, vtkDataObject::FIELD})
        if (vtkFieldData* arrays = data->GetAttributesAsFieldData(kind)) found += arrays->GetNumberOfArrays();
    return found;
}

/// A copy that a reader cannot fill anew: VTK's shallow copies of blocks share the grids in them.
vtkSmartPointer<vtkDataObject> copyOf(vtkDataObject* output) {
    vtkSmartPointer<vtkDataObject> copy = vtkSmartPointer<vtkDataObject>::Take(output->NewInstance());
    copy->ShallowCopy(output);
    auto* from = vtkMultiBlockDataSet::SafeDownCast(output);
    auto* to = vtkMultiBlockDataSet::SafeDownCast(copy);
    for (unsigned i = 0; from != nullptr && i < from->GetNumberOfBlocks(); ++i)
        if (vtkDataObject* block = from->GetBlock(i)) to->SetBlock(i, copyOf(block));
    return copy;
}

/// The output of VTK's reader at one time: a copy, because the reader reuses its output for the next.
vtkSmartPointer<vtkDataObject> readByVtk(const Source& source, int time) {
    if (static_cast<std::size_t>(time) < source.readerTimes.size())
        source.reader->UpdateTimeStep(source.readerTimes[static_cast<std::size_t>(time)]);
    else
        source.reader->Update();
    vtkDataObject* output = source.reader->GetOutputDataObject(0);
    if (output != nullptr && source.format == "vtk")
        checkLegacy(source.path, static_cast<std::size_t>(arraysIn(output)));
    try {
        throwReported();
    } catch (const std::runtime_error& error) { // "Error reading binary data!"
        if (source.format != "vtk") throw;
        throw std::runtime_error("ends early or is damaged: " + std::string(error.what()));
    }
    if (output == nullptr) throw std::runtime_error("contains no data");
    vtkSmartPointer<vtkDataObject> copy = copyOf(output);
    if (source.mark) source.mark(copy);
    return copy;
}

} // namespace

Source openSource(const std::vector<std::string>& files) {
    const std::string& path = files.front();
    for (const std::string& file : files)
        if (const std::string why = whyNoFile(file); !why.empty() && !fs::is_directory(file))
            throw std::runtime_error(why);
    if (!fs::is_directory(path)) checkHdfNames(path);
    const volume::FileFormat* format = volume::isZarrFolder(path) ? volume::formatNamed("Zarr")
                                       : fs::is_directory(path)   ? volume::formatNamed("OpenFOAM")
                                                                  : volume::formatOfFile(path);
    // Fluent's text exports have any ending, or none.
    const bool anyEnding = format == nullptr || format->name == "Tecplot" || format->name == "PLOT3D";
    if (anyEnding && !fs::is_directory(path) && beginsAsTable(path)) format = volume::formatNamed("CSV");
    if (format == nullptr)
        throw std::runtime_error("unknown ending \"" + fs::path(path).extension().string() +
                                 "\": " + volume::readableSuffixes() + " or .raw");
    const auto known = std::find_if(readers().begin(), readers().end(),
                                    [&](const Reader& reader) { return reader.format == format->name; });
    if (known == readers().end())
        throw std::runtime_error("is " + std::string(format->name) +
                                 ", which is not read: " + std::string(format->advice));
    Source source;
    source.path = path;
    if (files.size() > 1) source.files = files;
    source.format = format->name;
    known->open(source);
    throwReported();
    if (source.reader == nullptr) {
        if (source.format == "CSV") foldSweptNames(source, source.read(0)); // of others reading is not yet wanted
        return source;
    }
    source.reader->UpdateInformation();
    throwReported();
    vtkInformation* information = source.reader->GetOutputInformation(0);
    const auto* key = vtkStreamingDemandDrivenPipeline::TIME_STEPS();
    auto* steps = const_cast<vtkInformationDoubleVectorKey*>(key);
    if (information->Has(steps) != 0 && source.format != "vtk") // whose reader says 0 for every stated time
        source.readerTimes.assign(information->Get(steps), information->Get(steps) + information->Length(steps));
    for (const double time : source.readerTimes) source.times.push_back(meantTime(time));
    if (!std::is_sorted(source.times.begin(), source.times.end(), std::less_equal<>())) source.times.clear();
    if (source.times.size() < 2 && namesSweptArrays(source)) {
        if (source.check) source.check(source, 0);
        foldSweptNames(source, readByVtk(source, 0));
    }
    return source;
}

std::vector<Block> readBlocks(const Source& source, int time) {
    if (source.check) source.check(source, static_cast<std::size_t>(time));
    std::vector<Block> blocks;
    flatten(source.read ? source.read(static_cast<std::size_t>(time)) : readByVtk(source, time), "", blocks);
    int most = 0;
    std::vector<int> dimensions;
    for (const Block& block : blocks) {
        dimensions.push_back(dimensionOf(block.data));
        most = std::max(most, dimensions.back());
    }
    std::vector<Block> kept;
    for (std::size_t i = 0; i < blocks.size(); ++i)
        if (dimensions[i] == most) {
            kept.push_back({blocks[i].name, asAlignedGrid(blocks[i].data), {}});
            if (auto* image = vtkImageData::SafeDownCast(kept.back().data))
                kept.back().data = uprightImage(image, kept.back().note);
        }
    if (kept.empty()) throw std::runtime_error("holds no grid and no cells");
    std::map<std::string, int> named; // blocks of the same name are told apart
    for (Block& block : kept)
        if (const int count = ++named[block.name]; count > 1) block.name += " (" + std::to_string(count) + ")";
    for (const Block& block : kept) {
        const double* box = block.data->GetBounds();
        const bool flat = box[0] == box[1] || box[2] == box[3] || box[4] == box[5];
        if (most < 3 && !flat) throw std::runtime_error("holds surfaces or points only, no volume");
    }
    return kept;
}

} // namespace tessera::importer
