#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tessera::volume {

/// Parts of a parameter, between which its values jump. A label (a categorical parameter) gives the region of each
/// sample; regions across whose borders the parameter is continuous form one part. Samples of different parts are never
/// mixed: every filter uses samples of one part and extrapolates it beyond its border.
struct Parts {
    std::string label;                     ///< name of the categorical parameter; "" = everything is one part
    std::vector<std::vector<int>> regions; ///< values of the label that form each part; a value in none: the first part

    bool operator==(const Parts&) const = default;
    /// How many parts there are, at least 1.
    std::size_t count() const { return regions.empty() ? 1 : regions.size(); }
    /// The part that samples of a label value belong to, 0 .. count() - 1.
    std::size_t partOf(int value) const;
};

} // namespace tessera::volume
