// PNG, JPEG, BMP and Netpbm: numbered pictures as the slices of a volume, a single one as one slice.
#include "app/importer/pictures/picture_files.h"
#include "app/importer/readers/check_file.h"
#include "app/importer/readers/read_files.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <memory>
#include <stdexcept>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>

namespace tessera::importer {

namespace {

using ReadPicture = Picture (*)(const std::string& path);

struct PictureStack {
    std::vector<std::string> files;
    ReadPicture read = nullptr;
};

Picture readSlice(const PictureStack& stack, std::size_t index) {
    if (stack.files.size() == 1) return stack.read(stack.files[index]);
    try {
        return stack.read(stack.files[index]);
    } catch (const std::runtime_error& error) {
        throw std::runtime_error("its slice " + std::filesystem::path(stack.files[index]).filename().string() + " " +
                                 error.what());
    }
}

vtkSmartPointer<vtkDataObject> readPictureStack(const PictureStack& stack) {
    Picture first = readSlice(stack, 0);
    const PixelForm form = first.form;
    const std::size_t pixels = std::size_t(form.width) * form.height, slices = stack.files.size();
    vtkNew<vtkImageData> image;
    image->SetDimensions(int(form.width), int(form.height), int(slices));
    std::vector<vtkSmartPointer<vtkDataArray>> arrays;
    for (const std::string& name : first.names) arrays.push_back(pixelArray(vtkTypeOf(form), pixels * slices, name));
    for (std::size_t z = 0; z < slices; ++z) {
        const Picture picture = z == 0 ? std::move(first) : readSlice(stack, z);
        if (picture.form != form)
            throw std::runtime_error("its slice " + std::filesystem::path(stack.files[z]).filename().string() +
                                     " has " + textOf(picture.form) + ", the first has " + textOf(form) +
                                     ": slices must be alike");
        for (std::size_t a = 0; a < arrays.size(); ++a) {
            const auto bytes = std::size_t(arrays[a]->GetDataTypeSize()) * pixels;
            unpackSample(picture.rows.data(), form, int(a),
                         {static_cast<char*>(arrays[a]->GetVoidPointer(0)) + z * bytes});
        }
    }
    for (const auto& array : arrays) image->GetPointData()->AddArray(array);
    return image;
}

void openPictures(Source& source, ReadPicture read) {
    auto stack = std::make_shared<PictureStack>();
    stack->files = source.files.empty() ? std::vector<std::string>{source.path} : source.files;
    stack->read = read;
    const Picture first = readSlice(*stack, 0);
    if (std::max(first.form.width, first.form.height) > std::uint32_t(std::numeric_limits<int>::max()) ||
        first.form.width == 0 || first.form.height == 0)
        throw std::runtime_error("has pixels of " + textOf(first.form));
    double stored = 0;
    for (const std::string& file : stack->files) stored += double(bytesIn(file));
    refuseHollow(double(first.form.bytes()) * double(stack->files.size()), stored);
    if (!first.note.empty()) source.notes.push_back(first.note);
    if (first.form.samples >= 3) source.notes.emplace_back("Its colours are read as separate parameters.");
    if (const std::string note = missingNumbers(stack->files); !note.empty()) source.notes.push_back(note);
    source.read = [stack](std::size_t) { return readPictureStack(*stack); };
}

} // namespace

void openPng(Source& source) {
    openPictures(source, readPng);
}

void openJpeg(Source& source) {
    openPictures(source, readJpeg);
}

void openBmp(Source& source) {
    openPictures(source, readBmp);
}

void openPnm(Source& source) {
    openPictures(source, readPnm);
}

} // namespace tessera::importer
