#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

/// Axes of grids with uneven spacing.
///
/// Each axis of a lattice has a sheet: an even ruler on which one cell is as long as any other, over the interval that
/// the axis has in space. A rising map leads from the sheet to space. `Lattice::spacing` and `origin` are of the sheet,
/// so what relates lattices to each other and what draws needs no map; places, lengths and numbers go through it.
namespace tessera::volume {

/// One axis. Between its planes the map is linear; beyond them it goes on as in the first and the last cell.
class AxisMap {
public:
    /// What the planes are: borders of cells (n + 1 of n samples, each in the middle of its cell), or samples (n).
    enum class Of { Cells, Points };

    /// @throws Error: fewer than two planes, planes that do not rise strictly or are not finite.
    AxisMap(Of of, std::vector<double> planes);

    double toSpace(double sheet) const;
    double toSheet(double place) const;
    /// Continuous index of values between samples: sample i is at i, linear in space from one sample to the next.
    /// (The cells of a sheet have a knot at their borders, too: a linear field is not linear there.)
    double between(double place) const;

    Of of() const { return of_; }
    const std::vector<double>& planes() const { return planes_; }
    int samples() const { return int(planes_.size()) - (of_ == Of::Cells ? 1 : 0); }
    double lo() const { return planes_.front(); }
    double hi() const { return planes_.back(); }
    /// Distance of samples on the sheet, and the place of the first.
    double spacing() const { return (hi() - lo()) / double(planes_.size() - 1); }
    double origin() const { return lo() + (of_ == Of::Cells ? 0.5 * spacing() : 0); }
    /// Place of a sample in space.
    double sample(int i) const;
    /// Place between sample i - 1 and i; for 0 and `samples()` the ends. Of points the middle of both.
    double border(int i) const;
    /// Length of the cell of sample i: of points half cells at the ends.
    double length(int i) const { return border(i + 1) - border(i); }

    bool operator==(const AxisMap&) const = default;

private:
    Of of_;
    std::vector<double> planes_; ///< rising
};

/// The maps of three axes; one that is missing is even: its sheet is space.
struct AxisMaps {
    std::array<std::shared_ptr<const AxisMap>, 3> of;

    bool isEven() const { return !of[0] && !of[1] && !of[2]; }
    const AxisMap* operator[](int axis) const { return of[std::size_t(axis)].get(); }
    double toSpace(int axis, double sheet) const { return (*this)[axis] ? (*this)[axis]->toSpace(sheet) : sheet; }
    double toSheet(int axis, double place) const { return (*this)[axis] ? (*this)[axis]->toSheet(place) : place; }
    glm::dvec3 toSpace(glm::dvec3 sheet) const {
        if (isEven()) return sheet;
        return {toSpace(0, sheet.x), toSpace(1, sheet.y), toSpace(2, sheet.z)};
    }
    glm::dvec3 toSheet(glm::dvec3 place) const {
        if (isEven()) return place;
        return {toSheet(0, place.x), toSheet(1, place.y), toSheet(2, place.z)};
    }
    /// Of contents.
    bool operator==(const AxisMaps& other) const;
};

} // namespace tessera::volume
