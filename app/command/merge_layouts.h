#pragma once

#include "app/described/describe_json.h"
#include "codec/pack/merged_bytes.h"

namespace tessera::app {

/// One way of merging the bricks of an archive, with the bytes of each merged brick.
struct MergeLayout {
    volume::MergeShape shape{};
    std::vector<volume::MergedBrick> boxes;
    std::vector<codec::MergedBytes> bytes; ///< of each box
    codec::MergedBytes sum() const;
};

/// Layouts of every shape. Throws as bytesOfMerged().
std::vector<MergeLayout> mergeLayouts(const codec::Archive& archive, const volume::MergeOptions& options,
                                      const Progress& progress);

/// For `tessera info --merge`: one line a layout, then the merged bricks of the chosen shape.
void printLayouts(const codec::Archive& archive, const std::vector<MergeLayout>& layouts,
                  const volume::MergeOptions& options);
Json layoutsJson(const std::vector<MergeLayout>& layouts, const volume::MergeOptions& options);

} // namespace tessera::app
