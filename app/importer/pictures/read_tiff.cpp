// TIFF: the pages of a file, or single pages of numbered files, as the slices of a volume, with channels as parameters
// and frames as times. Not read by VTK, whose reader does not report the library's errors.
#include "app/importer/pictures/tiff_stack.h"
#include "app/importer/readers/check_file.h"
#include "app/importer/readers/read_files.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>

namespace tessera::importer {

namespace {

std::string prefixOf(const TiffStack& stack, std::size_t file) {
    if (stack.files.size() == 1) return {};
    const std::string& path = stack.files[file].path;
    return "its slice " + path.substr(path.rfind('/') + 1) + " ";
}

/// Calls body and names the slice where that fails.
auto ofSlice(const TiffStack& stack, std::size_t file, const auto& body) {
    try {
        return body();
    } catch (const std::runtime_error& error) {
        throw std::runtime_error(prefixOf(stack, file) + error.what());
    }
}

/// Gives the planes of a stack one after another; keeps the file open that it used last.
class PlaneReader {
public:
    explicit PlaneReader(const TiffStack& stack) : stack_(stack) {}

    void read(const TiffPlane& plane, const std::vector<void*>& to) {
        ofSlice(stack_, plane.file, [&] {
            if (plane.file != opened_) {
                file_ = openTiffFile(stack_.files[plane.file].path);
                opened_ = plane.file;
            }
            const TiffPage& page = stack_.files[plane.file].pages[plane.page];
            if (TIFFCurrentDirOffset(file_.get()) != page.directory &&
                TIFFSetSubDirectory(file_.get(), page.directory) == 0)
                throw std::runtime_error("page " + std::to_string(plane.page + 1) + " cannot be read");
            if (plane.behind > 0) return readBehind(page, plane.behind, to);
            readTiffPage(file_.get(), page, to);
        });
    }

private:
    void readBehind(const TiffPage& page, std::size_t behind, const std::vector<void*>& to) {
        const std::uint64_t begin = plainSamplesAt(file_.get(), page).value_or(0);
        const std::size_t bytes = page.form.bytes();
        std::string rows = readPart(stack_.files[opened_].path, std::size_t(begin) + behind * bytes, bytes);
        wantBytes(double(rows.size()), double(bytes));
        const int each = page.form.bits / 8 / page.form.parts();
        if (TIFFIsByteSwapped(file_.get()) != 0 && each > 1)
            for (std::size_t at = 0; at + std::size_t(each) <= rows.size(); at += std::size_t(each))
                std::reverse(rows.begin() + std::ptrdiff_t(at), rows.begin() + std::ptrdiff_t(at) + each);
        for (int sample = 0, part = 0; sample < page.form.samples; ++sample, part += page.form.parts())
            unpackSample(rows.data(), page.form, sample, {to.begin() + part, to.begin() + part + page.form.parts()});
    }

    const TiffStack& stack_;
    TiffHandle file_{nullptr, TIFFClose};
    std::size_t opened_ = TiffPlane::kNone;
};

/// The names of the arrays of a stack, channel by channel.
std::vector<std::string> arrayNames(const TiffStack& stack) {
    const std::vector<std::string> samples = sampleNames(stack.form);
    std::vector<std::string> channels = stack.channelNames;
    channels.resize(stack.channels);
    channels = distinctNames(channels);
    std::vector<std::string> names;
    for (const std::string& channel : channels)
        for (const std::string& sample : samples) {
            const bool one = samples.size() == 1, own = channel != "value";
            const std::string name = one ? channel : own ? channel + " " + sample : sample;
            if (stack.form.form.parts() == 1) {
                names.push_back(name);
                continue;
            }
            names.push_back(name + " real");
            names.push_back(name + " imaginary");
        }
    return names;
}

/// ImageJ keeps signed numbers of 16 bits as unsigned ones and adds -32768.
bool isSignedByCalibration(const TiffStack& stack) {
    return stack.calibration == std::vector<double>{-32768, 1} && vtkTypeOf(stack.form.form) == VTK_UNSIGNED_SHORT;
}

/// Applies what is not a scale and an offset.
vtkSmartPointer<vtkDataArray> calibrated(const TiffStack& stack, const vtkSmartPointer<vtkDataArray>& stored) {
    const std::vector<double>& c = stack.calibration;
    const auto count = std::size_t(stored->GetNumberOfTuples());
    if (isSignedByCalibration(stack)) {
        auto out = pixelArray(VTK_SHORT, count, stored->GetName());
        const auto* from = static_cast<const std::uint16_t*>(stored->GetVoidPointer(0));
        auto* to = static_cast<std::int16_t*>(out->GetVoidPointer(0));
        std::transform(from, from + count, to, [](std::uint16_t v) { return std::int16_t(int(v) - 32768); });
        return out;
    }
    if (c.size() < 3) return stored;
    auto out = pixelArray(VTK_DOUBLE, count, stored->GetName());
    auto* to = static_cast<double*>(out->GetVoidPointer(0));
    for (std::size_t i = 0; i < count; ++i) {
        const double x = stored->GetComponent(vtkIdType(i), 0);
        double sum = 0;
        for (std::size_t k = c.size(); k-- > 0;) sum = sum * x + c[k];
        to[i] = sum;
    }
    return out;
}

/// Flags of the planes of a channel that a file holds, one for each pixel.
vtkSmartPointer<vtkDataArray> presence(const TiffStack& stack, std::size_t channel, std::size_t time,
                                       const std::string& name) {
    const std::size_t pixels = std::size_t(stack.form.form.width) * stack.form.form.height;
    auto present = pixelArray(VTK_UNSIGNED_CHAR, pixels * stack.slices, name + ".present");
    auto* flags = static_cast<unsigned char*>(present->GetVoidPointer(0));
    for (std::size_t z = 0; z < stack.slices; ++z) {
        const bool held = stack.planes[stack.planeAt(time, channel, z)].file != TiffPlane::kNone;
        std::fill_n(flags + z * pixels, pixels, static_cast<unsigned char>(held ? 1 : 0));
    }
    return present;
}

/// Whether a plane of the channel is in no file, at any time.
bool lacksPlanes(const TiffStack& stack, std::size_t channel) {
    for (std::size_t time = 0; time < stack.times; ++time)
        for (std::size_t z = 0; z < stack.slices; ++z)
            if (stack.planes[stack.planeAt(time, channel, z)].file == TiffPlane::kNone) return true;
    return false;
}

vtkSmartPointer<vtkDataObject> readTiffStack(const TiffStack& stack, std::size_t time) {
    const PixelForm& form = stack.form.form;
    const auto arraysPerPlane = std::size_t(form.samples) * std::size_t(form.parts());
    const std::size_t pixels = std::size_t(form.width) * form.height;
    vtkNew<vtkImageData> image;
    image->SetDimensions(int(form.width), int(form.height), int(stack.slices));
    image->SetSpacing(stack.spacing.data());
    image->SetOrigin(stack.origin.data());
    const std::vector<std::string> names = arrayNames(stack);
    const int type = vtkTypeOf(form);
    PlaneReader reader(stack);
    for (std::size_t channel = 0; channel < stack.channels; ++channel) {
        std::vector<vtkSmartPointer<vtkDataArray>> arrays;
        for (std::size_t a = 0; a < arraysPerPlane; ++a)
            arrays.push_back(pixelArray(type, pixels * stack.slices, names[channel * arraysPerPlane + a]));
        const auto bytes = std::size_t(arrays[0]->GetDataTypeSize()) * pixels;
        for (std::size_t z = 0; z < stack.slices; ++z) {
            const TiffPlane& plane = stack.planes[stack.planeAt(time, channel, z)];
            std::vector<void*> to;
            for (const auto& array : arrays) to.push_back(static_cast<char*>(array->GetVoidPointer(0)) + z * bytes);
            if (plane.file != TiffPlane::kNone)
                reader.read(plane, to);
            else
                for (void* at : to) std::fill_n(static_cast<char*>(at), bytes, char(0));
        }
        const bool lacking = lacksPlanes(stack, channel);
        for (auto& array : arrays) {
            image->GetPointData()->AddArray(calibrated(stack, array));
            if (lacking) image->GetPointData()->AddArray(presence(stack, channel, time, array->GetName()));
        }
    }
    return image;
}

/// The slices of numbered files, one each, which must be alike.
std::vector<TiffPlane> slicesInFiles(TiffStack& stack, Source& source) {
    std::vector<TiffPlane> planes;
    std::size_t more = 0;
    for (std::size_t f = 0; f < stack.files.size(); ++f) {
        const TiffPage& page = stack.files[f].pages[0];
        if (f == 0) stack.form = page;
        if (!page.fits(stack.form))
            throw std::runtime_error(prefixOf(stack, f) + "has " + textOf(page.form) + ", the first has " +
                                     textOf(stack.form.form) + ": slices must be alike");
        more += stack.files[f].pages.size() - 1;
        planes.push_back({f, 0, 0});
    }
    if (more > 0) source.notes.push_back("Of each slice's file only the first page is read.");
    std::vector<std::string> paths;
    for (const TiffFile& file : stack.files) paths.push_back(file.path);
    if (const std::string note = missingNumbers(paths); !note.empty()) source.notes.push_back(note);
    return planes;
}

void arrange(TiffStack& stack, TIFF* first, Source& source) {
    stack.form = stack.files[0].pages[0];
    const std::string description = tiffText(first, TIFFTAG_IMAGEDESCRIPTION);
    if (const auto resolution = resolutionOf(first)) {
        // 72 points to an inch are what programs write that know no size.
        const bool meant = resolution->unit != "in" || std::abs(resolution->x - 1.0 / 72) > 1e-5;
        if (meant) {
            stack.spacing = {resolution->x, resolution->y, resolution->x};
            source.lengthUnit = resolution->unit;
        }
    }
    const bool several = stack.files.size() > 1;
    if (arrangeOme(stack, description, source)) return;
    if (arrangeMicroscope(stack, first, source)) return;
    if (arrangeImageJ(stack, description, first, source)) return;
    if (!several && arrangeShaped(stack, description, first, source)) return;
    const std::vector<TiffPlane> planes = several ? slicesInFiles(stack, source) : fittingPages(stack, source);
    stack.slices = planes.size();
    stack.planes = planes;
}

void checkStack(const TiffStack& stack, Source& source) {
    const PixelForm& form = stack.form.form;
    vtkTypeOf(form);
    if (std::max(form.width, form.height) > std::uint32_t(std::numeric_limits<int>::max()) || form.width == 0 ||
        form.height == 0)
        throw std::runtime_error("has pages of " + std::to_string(form.width) + " x " + std::to_string(form.height));
    if (stack.slices > std::size_t(std::numeric_limits<int>::max())) throw std::runtime_error("has too many slices");
    double bytes = 0;
    for (const TiffFile& file : stack.files) bytes += double(bytesIn(file.path));
    refuseHollow(double(form.bytes()) * double(stack.planes.size()), bytes);
    for (const TiffPlane& plane : stack.planes)
        if (plane.file != TiffPlane::kNone && !stack.files[plane.file].pages[plane.page].fits(stack.form))
            throw std::runtime_error("page " + std::to_string(plane.page + 1) +
                                     " differs in size or type from the first");
    if (const std::string note = noteOnColours(stack.form); !note.empty()) source.notes.push_back(note);
    const bool scaled = stack.spacing[0] != 1 || !source.lengthUnit.empty();
    if (stack.slices > 1 && scaled && !stack.statesDepth)
        source.notes.emplace_back("The distance of slices is not stated: that of its columns is taken.");
}

} // namespace

void openTiff(Source& source) {
    auto stack = std::make_shared<TiffStack>();
    for (const std::string& path : source.files.empty() ? std::vector<std::string>{source.path} : source.files)
        stack->files.push_back({path, {}});
    TiffHandle first(nullptr, TIFFClose);
    for (std::size_t f = 0; f < stack->files.size(); ++f)
        ofSlice(*stack, f, [&] {
            TiffHandle file = openTiffFile(stack->files[f].path);
            stack->files[f].pages = pagesOf(file.get());
            if (f > 0) return;
            TIFFSetSubDirectory(file.get(), stack->files[f].pages[0].directory);
            first = std::move(file);
        });
    arrange(*stack, first.get(), source);
    first.reset();
    checkStack(*stack, source);
    for (const std::string& name : arrayNames(*stack)) {
        if (!stack->valueUnit.empty()) source.units[name] = stack->valueUnit;
        if (stack->calibration.size() == 2 && !isSignedByCalibration(*stack))
            source.stored[name] = {stack->calibration[1], stack->calibration[0], {}};
    }
    source.read = [stack](std::size_t time) { return readTiffStack(*stack, time); };
}

} // namespace tessera::importer
