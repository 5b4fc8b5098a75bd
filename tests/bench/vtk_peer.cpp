// Renders a volume with VTK's ray casters for `tessera bench render`: same samples, camera, transfer function and step.
//
// usage: tessera-vtk-peer JOB       JOB is a text file of words:
//   raw NX NY NZ        unsigned bytes, x fastest, in the file JOB.raw; the longest edge is 1 world unit, centred at 0
//   size N              timed pictures of N x N pixels
//   compare N           size of the picture that is written, seen by the camera as given
//   frames N            timed pictures, the camera turned by a tenth of a degree about its up axis before each
//   clock processor|wall    times are processor time of all threads, or time that passes
//   style composite|maximum|minimum|average|iso VALUE
//   shaded 0|1          with ambient, diffuse, specular, shininess, and the light's direction (world) after it
//   step D              world units between samples;   unit D   world length an opacity stands for
//   camera PX PY PZ  TX TY TZ  UX UY UZ  ANGLE       vertical field of view in degrees
//   table N  R G B A ...   colours as they are to be composited (linear light) over stored values 0..255
// Prints for each mapper "gpu|cpu MEDIAN_MS CHANGED_MS", of a picture and of the first one after the samples have
// changed, and writes a picture as JOB.gpu, JOB.cpu (RGBA bytes, rows bottom up). Composites
// over black.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <string>
#include <vector>
#include <vtkCamera.h>
#include <vtkColorTransferFunction.h>
#include <vtkContourValues.h>
#include <vtkFixedPointVolumeRayCastMapper.h>
#include <vtkImageData.h>
#include <vtkLight.h>
#include <vtkNew.h>
#include <vtkOpenGLGPUVolumeRayCastMapper.h>
#include <vtkPiecewiseFunction.h>
#include <vtkPointData.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>
#include <vtkVolume.h>
#include <vtkVolumeProperty.h>

namespace {

struct Job {
    std::array<int, 3> dims{};
    int size = 512, compare = 64, frames = 5, shaded = 0;
    std::string style = "composite", clock = "processor";
    double iso = 0, ambient = 0, diffuse = 0, specular = 0, shininess = 1, step = 0.01, unit = 0.01, angle = 30;
    std::array<double, 3> light{}, position{}, target{}, up{};
    std::vector<std::array<double, 4>> table;
};

/// So far, by the clock named in the job.
double milliseconds(const std::string& clock) {
    if (clock == "processor") return 1000 * double(std::clock()) / CLOCKS_PER_SEC;
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration<double, std::milli>(now).count();
}

bool read(const std::string& path, Job& job) {
    std::ifstream in(path);
    for (std::string word; in >> word;) {
        if (word == "raw")
            for (int& n : job.dims) in >> n;
        else if (word == "size")
            in >> job.size;
        else if (word == "compare")
            in >> job.compare;
        else if (word == "frames")
            in >> job.frames;
        else if (word == "clock")
            in >> job.clock;
        else if (word == "style") {
            in >> job.style;
            if (job.style == "iso") in >> job.iso;
        } else if (word == "shaded") {
            in >> job.shaded >> job.ambient >> job.diffuse >> job.specular >> job.shininess;
            for (double& v : job.light) in >> v;
        } else if (word == "step")
            in >> job.step;
        else if (word == "unit")
            in >> job.unit;
        else if (word == "camera") {
            for (auto* part : {&job.position, &job.target, &job.up})
                for (double& v : *part) in >> v;
            in >> job.angle;
        } else if (word == "table") {
            std::size_t n = 0;
            in >> n;
            job.table.resize(n);
            for (auto& entry : job.table)
                for (double& v : entry) in >> v;
        } else {
            return false;
        }
    }
    return in.eof() && !job.table.empty();
}

vtkSmartPointer<vtkImageData> volume(const std::string& path, const Job& job) {
    auto image = vtkSmartPointer<vtkImageData>::New();
    const double spacing = 1.0 / (*std::max_element(job.dims.begin(), job.dims.end()) - 1);
    image->SetDimensions(job.dims.data());
    image->SetSpacing(spacing, spacing, spacing);
    image->SetOrigin(-0.5 * spacing * (job.dims[0] - 1), -0.5 * spacing * (job.dims[1] - 1),
                     -0.5 * spacing * (job.dims[2] - 1));
    image->AllocateScalars(VTK_UNSIGNED_CHAR, 1);
    std::ifstream in(path, std::ios::binary);
    in.read(static_cast<char*>(image->GetScalarPointer()), image->GetNumberOfPoints());
    return in ? image : nullptr;
}

template <class Mapper> void configure(Mapper& mapper, const Job& job) {
    mapper.SetAutoAdjustSampleDistances(0);
    mapper.SetImageSampleDistance(1);
    mapper.SetSampleDistance(static_cast<float>(job.step));
    if (job.style == "maximum") mapper.SetBlendModeToMaximumIntensity();
    if (job.style == "minimum") mapper.SetBlendModeToMinimumIntensity();
    if (job.style == "average") mapper.SetBlendModeToAverageIntensity();
    if (job.style == "iso") mapper.SetBlendModeToIsoSurface();
}

void run(const char* name, vtkVolumeMapper& mapper, vtkImageData& image, const Job& job, const std::string& path) {
    vtkNew<vtkColorTransferFunction> color;
    vtkNew<vtkPiecewiseFunction> opacity;
    for (std::size_t i = 0; i < job.table.size(); ++i) {
        const double value = 255.0 * double(i) / double(job.table.size() - 1);
        color->AddRGBPoint(value, job.table[i][0], job.table[i][1], job.table[i][2]);
        opacity->AddPoint(value, job.table[i][3]);
    }
    vtkNew<vtkVolumeProperty> property;
    property->SetColor(color);
    property->SetScalarOpacity(opacity);
    property->SetScalarOpacityUnitDistance(job.unit);
    property->SetInterpolationTypeToLinear();
    property->SetShade(job.shaded);
    property->SetAmbient(job.ambient);
    property->SetDiffuse(job.diffuse);
    property->SetSpecular(job.specular);
    property->SetSpecularPower(job.shininess);
    if (job.style == "iso") property->GetIsoSurfaceValues()->SetValue(0, job.iso);
    mapper.SetInputData(&image);
    vtkNew<vtkVolume> prop;
    prop->SetMapper(&mapper);
    prop->SetProperty(property);
    vtkNew<vtkRenderer> renderer;
    renderer->SetBackground(0, 0, 0);
    renderer->AddVolume(prop);
    renderer->AutomaticLightCreationOff();
    vtkNew<vtkLight> light;
    light->SetLightTypeToSceneLight();
    light->SetPositional(0);
    light->SetFocalPoint(0, 0, 0);
    light->SetPosition(job.light.data());
    renderer->AddLight(light);
    vtkNew<vtkRenderWindow> window;
    window->SetOffScreenRendering(1);
    window->SetMultiSamples(0);
    window->SetSize(job.size, job.size);
    window->AddRenderer(renderer);
    vtkCamera* camera = renderer->GetActiveCamera();
    camera->SetPosition(job.position.data());
    camera->SetFocalPoint(job.target.data());
    camera->SetViewUp(job.up.data());
    camera->SetViewAngle(job.angle);

    const auto draw = [&](int size) {
        vtkNew<vtkUnsignedCharArray> pixels;
        window->SetSize(size, size);
        renderer->ResetCameraClippingRange();
        window->Render();
        window->GetRGBACharPixelData(0, 0, size - 1, size - 1, 0, pixels); // waits for the picture
        return std::vector<unsigned char>(pixels->GetPointer(0), pixels->GetPointer(0) + pixels->GetNumberOfValues());
    };
    const auto timed = [&] {
        const double begin = milliseconds(job.clock);
        draw(job.size);
        return milliseconds(job.clock) - begin;
    };
    timed(); // warms up
    std::vector<double> times;
    for (int frame = 0; frame < job.frames; ++frame) {
        camera->Azimuth(0.1);
        times.push_back(timed());
    }
    image.GetPointData()->GetScalars()->Modified();
    image.Modified();
    const double changed = timed();
    camera->SetPosition(job.position.data());
    camera->SetViewUp(job.up.data());
    const std::vector<unsigned char> picture = draw(job.compare);
    std::ofstream(path + "." + name, std::ios::binary)
        .write(reinterpret_cast<const char*>(picture.data()), std::streamsize(picture.size()));
    std::sort(times.begin(), times.end());
    std::printf("%s %.3f %.3f\n", name, times[times.size() / 2], changed);
    std::fflush(stdout);
}

} // namespace

int main(int argc, char** argv) {
    Job job;
    if (argc != 2 || !read(argv[1], job)) {
        std::fprintf(stderr, "usage: tessera-vtk-peer JOB (see the head of its source)\n");
        return 1;
    }
    const std::string path = argv[1];
    const auto image = volume(path + ".raw", job);
    if (image == nullptr) {
        std::fprintf(stderr, "%s.raw: too short\n", path.c_str());
        return 2;
    }
    {
        vtkNew<vtkOpenGLGPUVolumeRayCastMapper> gpu;
        configure(*gpu, job);
        gpu->SetUseJittering(0);
        run("gpu", *gpu, *image, job, path);
    }
    if (job.style != "iso" && job.style != "average") { // which the fixed-point mapper draws as nothing
        vtkNew<vtkFixedPointVolumeRayCastMapper> cpu;
        configure(*cpu, job);
        cpu->SetInteractiveSampleDistance(static_cast<float>(job.step));
        run("cpu", *cpu, *image, job, path);
    }
    return 0;
}
