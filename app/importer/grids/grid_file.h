#pragma once

#include "app/importer/pictures/pixels.h"

#include <cstddef>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <string>
#include <string_view>
#include <vtkImageData.h>
#include <vtkSmartPointer.h>

/// What readers of grids share: their bytes, compressed by gzip or not, numbers in text, and grids along any axes.
namespace tessera::importer {

/// A file that is read from front to back in parts; a compressed one is inflated on the way.
class GridBytes {
public:
    explicit GridBytes(const std::string& path);
    ~GridBytes();
    GridBytes(const GridBytes&) = delete;
    GridBytes& operator=(const GridBytes&) = delete;

    /// Bytes [begin, begin + count), fewer where the file ends. Throws where it is damaged.
    std::string part(std::size_t begin, std::size_t count);
    /// The same into memory; throws where the file ends before.
    void read(std::size_t begin, std::size_t count, char* to);

private:
    std::size_t take(std::size_t begin, std::size_t count, char* to);
    struct Stream;
    std::unique_ptr<Stream> stream_;
};

/// All of a text file, compressed or not. Throws where it has more than 8 GB.
std::string wholeGridText(const std::string& path);

/// Words of a text one after another.
class GridWords {
public:
    explicit GridWords(std::string_view text) : rest_(text) {}
    /// The next word; empty at the end.
    std::string_view word();
    /// The next number. Throws where there is none.
    double number();
    int count();             ///< a number of samples along an axis
    std::string_view line(); ///< up to the next line end, without blanks around it
    std::string_view rest() const { return rest_; }
    bool atEnd();

private:
    std::string_view rest_;
};

/// A number as programs write it, with "D" for an exponent, too; none where the word is not one.
bool parseGridNumber(std::string_view word, double& value);

/// For text without a line end, whose last number may be cut: throws where it lacks digits of the exponent that the one
/// before it has.
void checkLastNumber(std::string_view text);

/// Reads numbers of a text whose last axis runs fastest (z) into the order of VTK (x fastest). `values` holds those
/// of `several` arrays, whose numbers of one place follow one another.
void readZFastest(GridWords& words, glm::ivec3 size, const std::vector<float*>& values);

/// An image whose steps along its axes are the columns of `steps`. Throws where its size is impossible.
vtkSmartPointer<vtkImageData> gridImage(glm::ivec3 size, glm::dvec3 origin, const glm::dmat3& steps);

/// Number of samples; throws where sizes are impossible, or far more than `bytes` of text can hold.
std::size_t samplesOfText(glm::ivec3 size, std::size_t arrays, std::size_t bytes);

} // namespace tessera::importer
