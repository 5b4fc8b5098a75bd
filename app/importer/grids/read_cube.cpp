// Gaussian cube: two lines of words, atoms, then values on a grid along any axes, z fastest.
#include "app/importer/grids/grid_file.h"
#include "app/importer/readers/read_files.h"

#include <cmath>
#include <stdexcept>
#include <vtkPointData.h>

namespace tessera::importer {

namespace {

constexpr double kMostOrbitals = 10000;

struct CubeHead {
    glm::ivec3 size{1};
    glm::dvec3 origin{0};
    glm::dmat3 steps{1};
    bool angstrom = false;
    int atoms = 0;
    std::vector<std::string> names;
};

int wholeOfCube(GridWords& words) {
    const double value = words.number();
    if (value != std::floor(value) || std::abs(value) > 1e8) throw std::runtime_error("is no Gaussian cube file");
    return int(value);
}

CubeHead headOfCube(GridWords& words) {
    CubeHead head;
    words.line();
    words.line();
    GridWords first(words.line());
    const int atoms = wholeOfCube(first);
    for (int row = 0; row < 3; ++row) head.origin[row] = first.number();
    const double values = first.atEnd() ? 1 : first.number(); // of each point
    int negative = 0;
    for (int axis = 0; axis < 3; ++axis) {
        GridWords line(words.line());
        const int count = wholeOfCube(line);
        negative += count < 0 ? 1 : 0;
        head.size[axis] = std::abs(count);
        if (count == 0) throw std::runtime_error("states an impossible size");
        for (int row = 0; row < 3; ++row) head.steps[axis][row] = line.number();
    }
    head.angstrom = negative > 0;
    head.atoms = std::abs(atoms);
    for (int atom = 0; atom < head.atoms; ++atom) {
        GridWords line(words.line());
        for (int n = 0; n < 5; ++n) line.number();
    }
    if (atoms < 0) { // orbitals: their number, and that of each
        const double count = words.number();
        if (!(count >= 1) || count > kMostOrbitals) throw std::runtime_error("states an impossible number of orbitals");
        for (int n = 0; n < int(count); ++n) head.names.push_back("orbital " + std::string(words.word()));
        return head;
    }
    if (!(values >= 1) || values > kMostOrbitals) throw std::runtime_error("states an impossible number of values");
    for (int n = 0; n < int(values); ++n)
        head.names.push_back(values == 1 ? "value" : "value " + std::to_string(n + 1));
    return head;
}

} // namespace

void openCube(Source& source) {
    const std::string text = wholeGridText(source.path);
    GridWords words(text);
    const CubeHead head = headOfCube(words);
    samplesOfText(head.size, head.names.size(), words.rest().size());
    source.lengthUnit = head.angstrom ? "angstrom" : "bohr";
    if (head.atoms > 0)
        source.notes.push_back("Its " + std::to_string(head.atoms) + (head.atoms == 1 ? " atom is" : " atoms are") +
                               " left out.");
    source.read = [path = source.path](std::size_t) {
        const std::string all = wholeGridText(path);
        GridWords rest(all);
        checkLastNumber(all);
        const CubeHead form = headOfCube(rest);
        const std::size_t count = samplesOfText(form.size, form.names.size(), rest.rest().size());
        auto image = gridImage(form.size, form.origin, form.steps);
        std::vector<float*> values;
        for (const std::string& name : distinctNames(form.names)) {
            image->GetPointData()->AddArray(pixelArray(VTK_FLOAT, count, name));
            values.push_back(static_cast<float*>(image->GetPointData()->GetArray(name.c_str())->GetVoidPointer(0)));
        }
        readZFastest(rest, form.size, values);
        if (!rest.atEnd()) throw std::runtime_error("holds more numbers than it announces");
        return vtkSmartPointer<vtkDataObject>(image);
    };
}

} // namespace tessera::importer
