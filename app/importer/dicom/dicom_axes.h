#pragma once

#include "app/importer/dicom/dicom_elements.h"
#include "app/importer/dicom/dicom_image.h"

#include <optional>
#include <string>
#include <vector>

namespace tessera::importer {

/// What is said of one frame: in its own group, in the group that all share, or of the whole file.
class DicomGroups {
public:
    DicomGroups(const DicomItem& root, std::size_t frame);
    const DicomItem& root() const { return *root_; }
    bool ownHas(DicomTag sequence) const { return own_ != nullptr && own_->item(sequence) != nullptr; }
    /// The item of a sequence, of the frame before the shared one; null if there is none.
    const DicomItem* item(DicomTag sequence) const;
    /// An element of such an item; where there is none, of the file itself.
    std::vector<double> numbers(DicomTag sequence, DicomTag tag) const;
    std::optional<double> number(DicomTag sequence, DicomTag tag) const;
    std::string text(DicomTag sequence, DicomTag tag) const;
    /// FrameType, "" if not stated.
    std::string kind() const;

private:
    const DicomItem* holder(DicomTag sequence, DicomTag tag) const;
    const DicomItem *root_, *shared_ = nullptr, *own_ = nullptr;
};

/// Fills `frame.axes`.
void takeAxes(const DicomGroups& groups, bool several, int index, const DicomImage& image, DicomFrame& frame);

} // namespace tessera::importer
