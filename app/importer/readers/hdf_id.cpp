#include "app/importer/readers/hdf_id.h"

#include <vtkType.h>

namespace tessera::importer {

hid_t hdfTypeInMemory(int vtkType) {
    switch (vtkType) {
    case VTK_FLOAT:
        return H5T_NATIVE_FLOAT;
    case VTK_SIGNED_CHAR:
        return H5T_NATIVE_SCHAR;
    case VTK_UNSIGNED_CHAR:
        return H5T_NATIVE_UCHAR;
    case VTK_SHORT:
        return H5T_NATIVE_SHORT;
    case VTK_UNSIGNED_SHORT:
        return H5T_NATIVE_USHORT;
    case VTK_INT:
        return H5T_NATIVE_INT;
    case VTK_UNSIGNED_INT:
        return H5T_NATIVE_UINT;
    case VTK_LONG_LONG:
        return H5T_NATIVE_LLONG;
    case VTK_UNSIGNED_LONG_LONG:
        return H5T_NATIVE_ULLONG;
    default:
        return H5T_NATIVE_DOUBLE;
    }
}

} // namespace tessera::importer
