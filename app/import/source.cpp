#include "app/import/source.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <vtkAbstractArray.h>
#include <vtkCell.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkDataObjectTree.h>
#include <vtkFieldData.h>
#include <vtkGenericDataObjectReader.h>
#include <vtkGenericEnSightReader.h>
#include <vtkImageReader2.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMetaImageReader.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNIFTIImageReader.h>
#include <vtkNetCDFCFReader.h>
#include <vtkNew.h>
#include <vtkNrrdReader.h>
#include <vtkOpenFOAMReader.h>
#include <vtkOutputWindow.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkStringArray.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLMultiBlockDataReader.h>
#include <vtkXMLPImageDataReader.h>
#include <vtkXMLPUnstructuredGridReader.h>
#include <vtkXMLReader.h>
#include <vtkXMLRectilinearGridReader.h>
#include <vtkXMLStructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

namespace tessera::importer {

namespace fs = std::filesystem;

namespace {

std::string reported; // the first error VTK told since throwReported

/// Sends all messages to stderr and keeps the first error.
class MessageWindow : public vtkOutputWindow {
public:
    static MessageWindow* New() {
        auto* window = new MessageWindow;
        window->InitializeObjectBase();
        return window;
    }
    void DisplayText(const char* text) override {
        const MessageTypes kind = GetCurrentMessageType();
        std::fprintf(stderr, "%s\n", text);
        if (kind == MESSAGE_TYPE_ERROR && reported.empty()) reported = firstReason(text);
    }

private:
    /// "ERROR: In file.cxx, line 12\nvtkReader (0x..): reason\n\n" -> "reason".
    static std::string firstReason(const std::string& text) {
        std::size_t begin = text.find("): ");
        begin = begin == std::string::npos ? 0 : begin + 3;
        std::string line = text.substr(begin, 300);
        for (char& c : line)
            if (static_cast<unsigned char>(c) < ' ') c = ' ';
        while (!line.empty() && line.back() == ' ') line.pop_back();
        return line.empty() ? "error" : line;
    }
};
template <class Reader> vtkSmartPointer<vtkAlgorithm> withName(const std::string& path) {
    vtkNew<Reader> reader;
    reader->SetFileName(path.c_str());
    return reader.Get();
}

std::string lowerEnding(const std::string& path) {
    std::string name = fs::path(path).filename().string();
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    if (name.ends_with(".nii.gz")) return ".nii.gz";
    const std::size_t dot = name.rfind('.');
    return dot == std::string::npos ? std::string() : name.substr(dot);
}

/// Image files are recognised by content, so that a wrong one is refused with a reason.
template <class Reader> vtkSmartPointer<vtkAlgorithm> image(const std::string& path) {
    vtkNew<Reader> reader;
    if (reader->CanReadFile(path.c_str()) == 0) throw std::runtime_error("is damaged or not of this format");
    reader->SetFileName(path.c_str());
    return reader.Get();
}

/// VTK's readers fill what a truncated file lacks with whatever was in memory: these checks refuse it.
std::string readPart(const std::string& path, std::size_t begin, std::size_t count) {
    std::ifstream in(path, std::ios::binary);
    in.seekg(static_cast<std::streamoff>(begin));
    std::string text(count, '\0');
    in.read(text.data(), static_cast<std::streamsize>(count));
    text.resize(static_cast<std::size_t>(in.gcount()));
    return text;
}

void checkXmlEnd(const std::string& path) {
    constexpr std::size_t kTail = 4096;
    const std::size_t size = fs::file_size(path);
    if (readPart(path, 0, kTail).find("<VTKFile") == std::string::npos) throw std::runtime_error("is no VTK XML file");
    if (readPart(path, size - std::min(size, kTail), kTail).find("</VTKFile>") == std::string::npos)
        throw std::runtime_error("ends before its last tag: truncated");
}

void checkImageSize(vtkImageReader2* reader, const std::string& path) {
    const int* extent = reader->GetDataExtent();
    double wanted =
        double(vtkDataArray::GetDataTypeSize(reader->GetDataScalarType())) * reader->GetNumberOfScalarComponents();
    for (int axis = 0; axis < 3; ++axis) wanted *= extent[2 * axis + 1] - extent[2 * axis] + 1.0;
    constexpr std::size_t kHead = 1 << 20;
    const std::string head = readPart(path, 0, kHead);
    std::size_t begin = 0; // where the samples start; 0 = in another file or compressed
    if (head.starts_with("NRRD") && head.find("encoding: raw") < head.find("\n\n"))
        begin = head.find("data file:") < head.find("\n\n") || head.find("datafile:") < head.find("\n\n")
                    ? 0
                    : head.find("\n\n") + 2;
    else if (const std::size_t local = head.find("ElementDataFile = LOCAL");
             local != std::string::npos && head.find("CompressedData = True") == std::string::npos)
        begin = head.find('\n', local) + 1;
    else if (path.ends_with(".nii"))
        begin = 348;
    const double has = double(fs::file_size(path)) - double(begin);
    if (begin != 0 && has < wanted)
        throw std::runtime_error("has " + std::to_string(static_cast<long long>(has)) +
                                 " bytes of samples, its header asks for " +
                                 std::to_string(static_cast<long long>(wanted)));
}

vtkSmartPointer<vtkAlgorithm> openFoam(const std::string& path) {
    vtkNew<vtkOpenFOAMReader> reader;
    const std::string file = fs::is_directory(path) ? (fs::path(path) / "case.foam").string() : path;
    reader->SetFileName(file.c_str());
    reader->UpdateInformation();
    for (int i = 0; i < reader->GetNumberOfPatchArrays(); ++i) {
        const std::string name = reader->GetPatchArrayName(i);
        reader->SetPatchArrayStatus(name.c_str(), name.ends_with("internalMesh") ? 1 : 0);
    }
    reader->EnableAllCellArrays();
    reader->DisableAllLagrangianArrays();
    reader->CreateCellToPointOff(); // done here, for each block on its own
    return reader.Get();
}

/// The dimensions that most variables share: others lie on other grids.
vtkSmartPointer<vtkAlgorithm> openNetCdf(const std::string& path) {
    vtkNew<vtkNetCDFCFReader> reader;
    reader->SetFileName(path.c_str());
    reader->SphericalCoordinatesOff();
    reader->ReplaceFillValueWithNanOn();
    reader->UpdateInformation();
    vtkStringArray* dimensions = reader->GetAllDimensions();
    std::string best;
    vtkIdType most = 0;
    for (vtkIdType d = 0; d < dimensions->GetNumberOfValues(); ++d) {
        const std::string name = dimensions->GetValue(d);
        const auto axes = std::count(name.begin(), name.end(), ',') + 1;
        vtkIdType count = axes >= 2 ? axes * 1000 : 0; // three axes before two
        for (vtkIdType v = 0; v < reader->GetVariableDimensions()->GetNumberOfValues(); ++v)
            count += reader->GetVariableDimensions()->GetValue(v) == name ? 1 : 0;
        if (count > most) {
            most = count;
            best = name;
        }
    }
    if (!best.empty()) reader->SetDimensions(best.c_str());
    return reader.Get();
}

vtkSmartPointer<vtkAlgorithm> openEnSight(const std::string& path) {
    vtkNew<vtkGenericEnSightReader> reader;
    reader->SetCaseFileName(path.c_str());
    reader->ReadAllVariablesOn();
    return reader.Get();
}

vtkSmartPointer<vtkAlgorithm> openLegacy(const std::string& path) {
    vtkNew<vtkGenericDataObjectReader> reader;
    reader->SetFileName(path.c_str());
    reader->ReadAllScalarsOn();
    reader->ReadAllVectorsOn();
    reader->ReadAllFieldsOn();
    return reader.Get();
}

/// The reader of legacy files stops at the end of a truncated one without a word: compares the arrays it gave with
/// those that the file announces.
void checkLegacyArrays(vtkDataObject* data, const std::string& path) {
    const std::string text = readPart(path, 0, fs::file_size(path));
    int announced = 0, found = 0;
    for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 1)) {
        static constexpr const char* kWords[] = {"SCALARS ", "VECTORS ", "NORMALS ", "TENSORS ", "COLOR_SCALARS "};
        for (const char* word : kWords)
            if (text.compare(at + 1, std::strlen(word), word) == 0) ++announced;
        int number = 0;
        if (text.compare(at + 1, 6, "FIELD ") == 0 && std::sscanf(text.c_str() + at + 7, "%*255s %d", &number) == 1)
            announced += number;
        if (text.compare(at + 1, 10, "NULL_ARRAY") == 0) --announced;
    }
    for (const int kind : {vtkDataObject::POINT, vtkDataObject::CELL, vtkDataObject::FIELD})
        if (vtkFieldData* arrays = data->GetAttributesAsFieldData(kind)) found += arrays->GetNumberOfArrays();
    if (found < announced)
        throw std::runtime_error("ends too early: announces " + std::to_string(announced) + " arrays, holds " +
                                 std::to_string(found));
}

struct Known {
    const char* ending;
    const char* format;
    vtkSmartPointer<vtkAlgorithm> (*open)(const std::string&);
};
constexpr Known kKnown[] = {{".vti", "vti", withName<vtkXMLImageDataReader>},
                            {".pvti", "pvti", withName<vtkXMLPImageDataReader>},
                            {".vtu", "vtu", withName<vtkXMLUnstructuredGridReader>},
                            {".pvtu", "pvtu", withName<vtkXMLPUnstructuredGridReader>},
                            {".vtr", "vtr", withName<vtkXMLRectilinearGridReader>},
                            {".vts", "vts", withName<vtkXMLStructuredGridReader>},
                            {".vtm", "vtm", withName<vtkXMLMultiBlockDataReader>},
                            {".vtk", "vtk", openLegacy},
                            {".nrrd", "nrrd", image<vtkNrrdReader>},
                            {".nhdr", "nrrd", image<vtkNrrdReader>},
                            {".mha", "MetaImage", image<vtkMetaImageReader>},
                            {".mhd", "MetaImage", image<vtkMetaImageReader>},
                            {".nii", "NIfTI", image<vtkNIFTIImageReader>},
                            {".nii.gz", "NIfTI", image<vtkNIFTIImageReader>},
                            {".foam", "OpenFOAM", openFoam},
                            {".case", "EnSight", openEnSight},
                            {".encas", "EnSight", openEnSight},
                            {".nc", "NetCDF", openNetCdf}};

void flatten(vtkDataObject* data, const std::string& name, std::vector<Block>& blocks) {
    if (vtkDataObjectTree::SafeDownCast(data) != nullptr) {
        auto* multi = vtkMultiBlockDataSet::SafeDownCast(data);
        for (unsigned i = 0; multi != nullptr && i < multi->GetNumberOfBlocks(); ++i) {
            std::string inner;
            if (multi->HasMetaData(i) != 0 && multi->GetMetaData(i)->Has(vtkCompositeDataSet::NAME()) != 0)
                inner = multi->GetMetaData(i)->Get(vtkCompositeDataSet::NAME());
            // A region of OpenFOAM is a block named after it that holds "internalMesh".
            const bool keep = inner == "internalMesh" || inner == "default" || inner.empty();
            flatten(multi->GetBlock(i), keep && !name.empty() ? name : inner, blocks);
        }
        if (multi == nullptr) throw std::runtime_error("holds a kind of composite data that is not read");
        return;
    }
    auto* leaf = vtkDataSet::SafeDownCast(data);
    if (leaf != nullptr && leaf->GetNumberOfPoints() > 0 && leaf->GetNumberOfCells() > 0)
        blocks.push_back({name, leaf});
}

int dimensionOf(vtkDataSet* data) {
    const int type = data->GetDataObjectType();
    if (type == VTK_IMAGE_DATA || type == VTK_UNIFORM_GRID || type == VTK_RECTILINEAR_GRID) return 3;
    int most = 0;
    // Cells of different dimension are mixed in practice (patches after volume cells): the first thousand tell.
    const vtkIdType count = std::min<vtkIdType>(data->GetNumberOfCells(), 1000);
    for (vtkIdType i = 0; i < count; ++i) most = std::max(most, data->GetCell(i)->GetCellDimension());
    return most;
}

} // namespace

void catchMessages() {
    vtkNew<MessageWindow> window;
    vtkOutputWindow::SetInstance(window);
}

void throwReported() {
    if (reported.empty()) return;
    const std::string reason = reported;
    reported.clear();
    throw std::runtime_error(reason);
}

double meantTime(double time) {
    if (time != double(float(time))) return time;
    char text[32];
    std::snprintf(text, sizeof text, "%.7g", time);
    const double meant = std::stod(text);
    return float(meant) == float(time) ? meant : time;
}

void findTime(vtkDataObject* data, std::vector<double>& times) {
    if (data == nullptr || data->GetFieldData() == nullptr) return;
    for (const char* name : {"TimeValue", "TIME", "Time"}) {
        vtkDataArray* value = data->GetFieldData()->GetArray(name);
        if (value == nullptr || value->GetNumberOfValues() != 1 || !std::isfinite(value->GetComponent(0, 0))) continue;
        times.push_back(meantTime(value->GetComponent(0, 0)));
        return;
    }
}

Source openSource(const std::string& path) {
    if (!fs::exists(path)) throw std::runtime_error("no such file");
    const std::string ending = fs::is_directory(path) ? std::string(".foam") : lowerEnding(path);
    const auto* known =
        std::find_if(std::begin(kKnown), std::end(kKnown), [&](const Known& one) { return ending == one.ending; });
    if (known == std::end(kKnown))
        throw std::runtime_error("unknown ending \"" + ending +
                                 "\": .vti .vtu .vtm .vtr .vts .vtk .nrrd .mha .mhd .nii .foam .case .nc or .raw");
    Source source{path, known->format, known->open(path), {}, {}};
    if (vtkXMLReader::SafeDownCast(source.reader) != nullptr) checkXmlEnd(path);
    source.reader->UpdateInformation();
    throwReported();
    if (auto* images = vtkImageReader2::SafeDownCast(source.reader)) checkImageSize(images, path);
    vtkInformation* information = source.reader->GetOutputInformation(0);
    const auto* key = vtkStreamingDemandDrivenPipeline::TIME_STEPS();
    auto* steps = const_cast<vtkInformationDoubleVectorKey*>(key);
    if (information->Has(steps) != 0)
        source.readerTimes.assign(information->Get(steps), information->Get(steps) + information->Length(steps));
    for (const double time : source.readerTimes) source.times.push_back(meantTime(time));
    if (!std::is_sorted(source.times.begin(), source.times.end(), std::less_equal<>())) source.times.clear();
    return source;
}

std::vector<Block> readBlocks(const Source& source, int time) {
    if (static_cast<std::size_t>(time) < source.readerTimes.size())
        source.reader->UpdateTimeStep(source.readerTimes[static_cast<std::size_t>(time)]);
    else
        source.reader->Update();
    throwReported();
    vtkDataObject* output = source.reader->GetOutputDataObject(0);
    if (output == nullptr) throw std::runtime_error("gave no data");
    if (vtkGenericDataObjectReader::SafeDownCast(source.reader) != nullptr) checkLegacyArrays(output, source.path);
    // A copy, because the reader overwrites its output at the next time.
    vtkSmartPointer<vtkDataObject> copy = vtkSmartPointer<vtkDataObject>::Take(output->NewInstance());
    copy->ShallowCopy(output);
    std::vector<Block> blocks;
    flatten(copy, "", blocks);
    int most = 0;
    std::vector<int> dimensions;
    for (const Block& block : blocks) {
        dimensions.push_back(dimensionOf(block.data));
        most = std::max(most, dimensions.back());
    }
    std::vector<Block> kept;
    for (std::size_t i = 0; i < blocks.size(); ++i)
        if (dimensions[i] == most) kept.push_back(std::move(blocks[i]));
    if (kept.empty()) throw std::runtime_error("holds no grid and no cells");
    for (const Block& block : kept) {
        const double* box = block.data->GetBounds();
        const bool flat = box[0] == box[1] || box[2] == box[3] || box[4] == box[5];
        if (most < 3 && !flat) throw std::runtime_error("holds surfaces or points only, no volume");
    }
    return kept;
}

} // namespace tessera::importer
