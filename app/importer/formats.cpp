#include "app/importer/formats.h"

#include "app/importer/readers/check_file.h"
#include "app/importer/readers/read_files.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>
#include <vtkGenericDataObjectReader.h>
#include <vtkNew.h>
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

template <class XmlReader> void openXml(Source& source) {
    checkXml(source.path);
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
