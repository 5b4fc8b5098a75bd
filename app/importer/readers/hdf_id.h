#pragma once

#include <hdf5.h>

namespace tessera::importer {

/// Owns an identifier of the library, of any kind.
class HdfId {
public:
    explicit HdfId(hid_t id) : id_(id) {}
    ~HdfId() {
        if (id_ >= 0) H5Idec_ref(id_);
    }
    HdfId(const HdfId&) = delete;
    HdfId& operator=(const HdfId&) = delete;
    hid_t id() const { return id_; }
    explicit operator bool() const { return id_ >= 0; }

private:
    hid_t id_;
};

/// The library's type in memory of numbers of a type of VTK.
hid_t hdfTypeInMemory(int vtkType);

} // namespace tessera::importer
