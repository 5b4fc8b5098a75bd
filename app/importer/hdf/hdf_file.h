#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>
#include <vtkDataArray.h>
#include <vtkSmartPointer.h>

/// HDF5 files by paths: members of groups, attributes, and parts of data sets. Everything throws std::runtime_error
/// with one line of reason, and nothing takes more memory than the file can fill.
namespace tessera::importer {

/// What a data set holds, and how large it is.
struct HdfShape {
    std::vector<std::size_t> dims; ///< slowest first; empty: one value
    bool numbers = false;          ///< whole or real numbers
    bool words = false;
    bool floating = false;
    std::size_t bytes = 0; ///< of one value

    std::size_t count() const; ///< of values
};

/// A block of a data set: by axis the first index, the step between indices, and how many of them.
struct HdfSlab {
    std::vector<std::size_t> begin, stride, count;
};

/// A file that is open while one of its copies lives. Paths are "group/name", "" = the root; soft and external links
/// are followed.
class HdfFile {
public:
    explicit HdfFile(const std::string& path);

    const std::string& path() const { return path_; }
    bool has(const std::string& path) const;
    bool isGroup(const std::string& path) const;
    /// Names of the members of a group, in the order of their creation where the file keeps it, else of their names.
    std::vector<std::string> members(const std::string& group) const;
    /// Where the member of a group lies in the file: the same for all links to one object.
    std::uint64_t address(const std::string& path) const;

    /// Null where there is no data set.
    std::optional<HdfShape> shape(const std::string& path) const;
    /// The numbers of a block, in the file's type where it has at most 32 bits, else as double. One component.
    vtkSmartPointer<vtkDataArray> array(const std::string& path, const HdfSlab& slab) const;
    /// Rows [first, first + count) of the first axis; all other axes whole.
    vtkSmartPointer<vtkDataArray> rows(const std::string& path, std::size_t first, std::size_t count) const;
    vtkSmartPointer<vtkDataArray> all(const std::string& path) const;
    std::vector<std::int64_t> integers(const std::string& path, std::size_t first, std::size_t count) const;
    std::vector<std::int64_t> integers(const std::string& path) const; ///< all; none if there is no such data set
    std::vector<double> doubles(const std::string& path) const;        ///< the same
    std::vector<std::string> texts(const std::string& path) const;

    /// Attributes of a group or data set; empty where there is none.
    std::vector<double> attribute(const std::string& path, const std::string& name) const;
    std::string word(const std::string& path, const std::string& name) const;

private:
    std::string path_;
    std::shared_ptr<const std::int64_t> file_; ///< the library's identifier
};

} // namespace tessera::importer
