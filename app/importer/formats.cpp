#include "app/importer/formats.h"

#include "app/importer/readers/check_file.h"
#include "app/importer/readers/piece_cover.h"
#include "app/importer/readers/read_files.h"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>
#include <vtkCellData.h>
#include <vtkGenericDataObjectReader.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLMultiBlockDataReader.h>
#include <vtkXMLPImageDataReader.h>
#include <vtkXMLPRectilinearGridReader.h>
#include <vtkXMLPStructuredGridReader.h>
#include <vtkXMLPUnstructuredGridReader.h>
#include <vtkXMLPartitionedDataSetCollectionReader.h>
#include <vtkXMLPartitionedDataSetReader.h>
#include <vtkXMLRectilinearGridReader.h>
#include <vtkXMLStructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

namespace tessera::importer {

namespace {

/// Points and cells of an image that lie in no piece are no data: VTK leaves there what memory holds.
void markGaps(Source& source) {
    const std::optional<GridPieces> pieces = piecesOf(source.path);
    if (!pieces) return;
    const std::size_t missing = missingIn(*pieces, false), cells = missingIn(*pieces, true);
    if (missing + cells == 0) return;
    source.notes.push_back("its pieces leave out " + std::to_string(missing) + " samples and " + std::to_string(cells) +
                           " cells of its whole extent: they are absent");
    source.mark = [pieces](vtkDataObject* data) {
        auto* image = vtkImageData::SafeDownCast(data);
        const std::vector<std::uint8_t> points = heldBy(*pieces, false), held = heldBy(*pieces, true);
        const auto add = [](vtkDataSetAttributes* to, vtkIdType count, const std::vector<std::uint8_t>& flags,
                            const char* name, unsigned char present, unsigned char absent) {
            if (vtkIdType(flags.size()) != count) return;
            vtkDataArray* known = to->GetArray(name);
            vtkNew<vtkUnsignedCharArray> array;
            array->SetName(name);
            array->SetNumberOfTuples(count);
            for (vtkIdType i = 0; i < count; ++i) {
                const bool other = known != nullptr && known->GetNumberOfTuples() == count;
                const auto value = static_cast<unsigned char>(other ? int(known->GetComponent(i, 0)) : int(present));
                array->SetValue(i, flags[std::size_t(i)] != 0 ? value : absent);
            }
            to->AddArray(array);
        };
        if (image == nullptr) return;
        add(image->GetPointData(), image->GetNumberOfPoints(), points, "vtkValidPointMask", 1, 0);
        add(image->GetCellData(), image->GetNumberOfCells(), held, "vtkGhostType", 0, vtkDataSetAttributes::HIDDENCELL);
    };
}

template <class XmlReader> void openXml(Source& source) {
    constexpr bool kImage = std::is_same_v<XmlReader, vtkXMLImageDataReader>;
    checkXml(source.path, kImage);
    if constexpr (kImage) markGaps(source);
    vtkNew<XmlReader> reader;
    reader->SetFileName(source.path.c_str());
    source.reader = reader;
}

void openLegacy(Source& source) {
    vtkNew<vtkGenericDataObjectReader> reader;
    reader->SetFileName(source.path.c_str());
    reader->ReadAllScalarsOn();
    reader->ReadAllVectorsOn();
    reader->ReadAllFieldsOn();
    source.reader = reader;
}

constexpr Reader kReaders[] = {
#define TESSERA_FORMAT(name, suffixes, lengthUnit, slices, ...) Reader{name, __VA_ARGS__},
#define TESSERA_UNREAD(name, suffixes, advice)
#include "volume/import/files/format_rows.inc"
};

} // namespace

std::span<const Reader> readers() {
    return kReaders;
}

} // namespace tessera::importer
