#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkSmartPointer.h>

/// What all pictures share whose stacks are volumes: the numbers of pixels, and names and units of their stacks.
namespace tessera::importer {

enum class PixelNumbers { Unsigned, Signed, Float, Complex };

/// How the pixels of one picture are stored: rows from the top, each padded to whole bytes, bytes in the machine's
/// order, samples of fewer than 8 bits (or of 12, 14, ...) packed from the highest bit on.
struct PixelForm {
    std::uint32_t width = 0, height = 0;
    int bits = 8;    ///< of one sample; of a complex one those of both parts
    int samples = 1; ///< of one pixel that lie side by side
    PixelNumbers numbers = PixelNumbers::Unsigned;
    bool operator==(const PixelForm&) const = default;

    std::size_t rowBytes() const { return (std::size_t(width) * std::size_t(samples) * std::size_t(bits) + 7) / 8; }
    std::size_t bytes() const { return rowBytes() * height; }
    /// Numbers that one sample becomes: two of a complex one.
    int parts() const { return numbers == PixelNumbers::Complex ? 2 : 1; }
};

/// "10 x 11 pixels of 16 bits", for messages.
std::string textOf(const PixelForm& form);

/// The type of VTK that holds every value of a sample. Throws std::runtime_error for what is not read.
int vtkTypeOf(const PixelForm& form);

/// Whether rows of one sample per pixel can be copied as they are.
bool isPlain(const PixelForm& form);

/// Takes one sample of each pixel apart from the others. `to[part]` gets width * height numbers of vtkTypeOf(form).
void unpackSample(const char* rows, const PixelForm& form, int sample, const std::vector<void*>& to);

/// An array for `count` numbers of a type.
vtkSmartPointer<vtkDataArray> pixelArray(int vtkType, std::size_t count, const std::string& name);

/// The name of a unit of lengths as microscopes and their programs spell it: "um" for "micron", "\\u00B5m" and a byte
/// 0xB5; "" for pixels, and for what is no length.
std::string lengthUnitOfPicture(std::string_view word);

/// Names without blanks at their ends, none of them empty ("channel 2") or twice.
std::vector<std::string> distinctNames(std::vector<std::string> names);

/// The numbers of names of files that are missing among them, as one sentence; "" if there are none. Names numbered in
/// equal steps lack none.
std::string missingNumbers(const std::vector<std::string>& files);

} // namespace tessera::importer
